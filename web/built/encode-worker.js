import{serve as o}from"./encode.js";o();
