import{serve}from"./quick.js";serve();
