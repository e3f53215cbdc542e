/** The decoder of static meshes on grids alone. */
export * from "./errors";
export { DEFAULT_LIMITS, type Limits } from "./limits";
export { hasVectors, Kernels } from "./kernels";
export * from "./grids";
