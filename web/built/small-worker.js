import{serve as m}from"./small.js";m();
