/** Decoder of BSM streams. */
export * from "./errors";
export { checkLimit, DEFAULT_LIMITS, type Limits } from "./limits";
export type { Attribute } from "./attributes";
export type { Share, SharedBlock } from "./share";
export type { Header } from "./header";
export { Kernels } from "./kernels";
export * from "./decoder";
export type * from "./drawing";
export { Helper } from "./helper";
export type { DrawnEvent } from "./worker";
export { openDesk, serve } from "./workerFull";

/** The function around all of this where `scripts/build.mjs` inlines it: its text makes threads. @internal */
export declare const bsm: unknown;
