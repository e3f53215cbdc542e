/** Decoder of BSM streams. */
export * from "./errors";
export { checkLimit, DEFAULT_LIMITS, type Limits } from "./limits";
export type { Attribute } from "./attributes";
export type { Header } from "./header";
export { Kernels } from "./kernels";
export * from "./decoder";
export type * from "./drawing";
export { Helper } from "./helper";
export type { Share, SharedBlock } from "./share";
export type { DrawnEvent } from "./worker";
export { openDesk, serve } from "./workerFull";

/**
 * The function that all of this is inside of where `scripts/build.mjs` inlines it, whose text a thread can be made of.
 * @internal
 */
export declare const bsm: unknown;
