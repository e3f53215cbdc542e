import{serve as o}from"./encoding.js";o();
