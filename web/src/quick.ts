/** The decoder of static meshes on grids alone. */
export * from "./errors";
export { DEFAULT_LIMITS, type Limits } from "./limits";
export { Kernels } from "./kernels";
export * from "./grids";
export { openDesk, serve } from "./workerFast";
