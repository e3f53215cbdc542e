import{Kernels as o}from"./bsm.js";import{here as r}from"./pool.js";export*from"./bsm.js";export*from"./pool.js";async function e(e="whole"){return new o(await r.kernels(e))}export{e as loadKernels};
