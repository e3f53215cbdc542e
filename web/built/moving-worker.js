import{serve as m}from"./moving.js";m();
