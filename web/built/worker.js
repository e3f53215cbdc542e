import{serve as m}from"./bsm.js";m();
