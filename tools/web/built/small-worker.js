import{serve}from"./small.js";serve();
