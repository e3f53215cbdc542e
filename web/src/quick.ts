/** The decoder of static meshes on grids alone. */
export * from "./errors";
export { DEFAULT_LIMITS, type Limits } from "./limits";
export { Kernels } from "./kernels";
export { decode, END_OF_STREAM, GridDecoder as Decoder, type GridEvent, NEED_DATA } from "./grids";
export { openDesk } from "./workerFast";
