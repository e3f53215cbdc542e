/** The package: the decoder, and threads that run it. */
import { Kernels } from "./index";
import { here, type Build } from "./pool";

export * from "./index";
export * from "./pool";
/** @internal */
export { drawnFaces, linearOf, numbersOf } from "./parting";

/** Kernels for a `Decoder` of one's own, compiled once; those of `quick` are for that of `bsm-decoder/quick` alone. */
export async function loadKernels(build: Build = "whole"): Promise<Kernels> {
    return new Kernels(await here.kernels(build));
}
