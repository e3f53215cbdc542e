/** A decoder of static meshes alone, or of sequences, as `scripts/build.mjs` leaves out the others. */
export * from "./errors";
export { DEFAULT_LIMITS, type Limits } from "./limits";
export { Kernels } from "./kernels";
export * from "./decoder";
