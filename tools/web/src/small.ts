/** The decoder of static meshes alone. */
export * from "./errors";
export { DEFAULT_LIMITS, type Limits } from "./limits";
export { hasVectors, Kernels } from "./kernels";
export * from "./decoder";
export { Team } from "./team";
export { serve } from "./desk";
