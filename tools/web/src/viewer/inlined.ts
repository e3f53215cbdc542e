/** Threads and kernels as parts of the script, for pages that fetch nothing. */
import scalar from "../../built/kernels-scalar.wasm";
import vectors from "../../built/kernels.wasm";
import { bsm, openDesk } from "../index";
import type { Source } from "../source";
import { hasVectors } from "../threads";

/** The build that this machine can run. */
let kernels: Promise<WebAssembly.Module> | undefined;

export const inlined: Source = {
    worker() {
        const url = URL.createObjectURL(new Blob([`(${bsm})().serve()`], { type: "text/javascript" }));
        try {
            return new Worker(url, { name: "BSM" });
        } catch {
            return undefined; // the page's policy forbids it
        } finally {
            URL.revokeObjectURL(url);
        }
    },
    kernels: () => (kernels ??= WebAssembly.compile(hasVectors() ? vectors : scalar)),
    local: () => Promise.resolve({ openDesk }),
};
