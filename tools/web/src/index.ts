/** Decoder of BSM streams. */
export * from "./errors";
export { DEFAULT_LIMITS, type Limits } from "./limits";
export type { Attribute } from "./attributes";
export type { Header } from "./header";
export { hasVectors, Kernels } from "./kernels";
export * from "./decoder";
