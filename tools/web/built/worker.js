import{serve}from"./bsm.js";serve();
