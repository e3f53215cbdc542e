/** Decoder of BSM streams. */
export * from "./errors";
export { checkLimit, DEFAULT_LIMITS, type Limits } from "./limits";
export type { Attribute } from "./attributes";
export type { Header } from "./header";
export { hasVectors, Kernels } from "./kernels";
export * from "./decoder";
export { Helper, type Share, type SharedBlock } from "./helper";
export { Team } from "./team";
export { DecoderThread, type DrawnEvent, type Listener } from "./thread";
export { serve } from "./desk";
