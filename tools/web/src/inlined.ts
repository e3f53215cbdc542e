/** The kernels as a part of the script, for pages that fetch nothing. */
import scalar from "../built/kernels-scalar.wasm";
import vectors from "../built/kernels.wasm";
import { hasVectors, Kernels } from "./index";

/** The build that this machine can run. */
export function inlinedKernels(): Promise<Kernels> {
    return Kernels.compile(hasVectors() ? vectors : scalar);
}
