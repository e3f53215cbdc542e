import{serve as i}from"./quick.js";i();
