/** Where threads and kernels come from: the files beside this one, or those of a folder that is named. */
import type { StreamWorker, Say, Start } from "./worker";
import { compiled, once, resolved } from "./fetched";
import { started } from "./threads";
import type { Build, Thread } from "./peek";

export interface Source {
    /** A thread that decodes; undefined where there can be none. */
    worker(thread: Thread): Worker | undefined;
    kernels(build: Build): Promise<WebAssembly.Module>;
    /** The decoder for this thread, where there are no others yet. */
    local(build: Build): Promise<{ openDesk(start: Start, say: Say): StreamWorker }>;
    /** A build that is there without a request; no thread starts before the header of a stream asks for one. */
    embedded?: Build;
}

/** What is written out here is what bundlers look for; webpack would make one file of all threads of one name. */
const WORKERS: Record<Thread, () => Worker> = {
    whole: () => new Worker(new URL("./worker.js", import.meta.url), { type: "module", name: "BSM" }),
    small: () => new Worker(new URL("./small-worker.js", import.meta.url), { type: "module", name: "BSM-small" }),
};
/** Where this file is, for those that are not found by bundlers. */
const HERE = import.meta.url;
const fileOf = (thread: Thread): string => (thread === "whole" ? "worker.js" : "small-worker.js");
const KERNELS: Record<Build, () => URL> = {
    whole: () => new URL("./kernels.wasm", import.meta.url),
    small: () => new URL("./small.wasm", import.meta.url),
    quick: () => new URL("./quick.wasm", import.meta.url),
    parts: () => new URL("./parts.wasm", import.meta.url),
    grid: () => new URL("./grid.wasm", import.meta.url),
    blocks: () => new URL("./blocks.wasm", import.meta.url),
    moving: () => new URL("./moving.wasm", import.meta.url),
};

/** An address beside this file, of which bundles of CommonJS know nothing. */
function beside(address: () => URL): URL {
    try {
        return address();
    } catch {
        throw new Error(
            "this bundle does not know where the decoder's files are: " +
                "copy those of bsm-decoder/built, and name their folder with setDecoderPath",
        );
    }
}

const local: Source["local"] = (build) => (build === "whole" ? import("./index") : import("./workerSmall"));

export const here: Source = {
    worker: (thread) => started(WORKERS[thread], () => new URL(fileOf(thread), HERE)),
    kernels: once(async (build) => compiled(beside(KERNELS[build]))),
    local,
};

/** The files in a folder, as those of `built`. */
export function placeOf(path: string): Source {
    const base = resolved(path.endsWith("/") ? path : `${path}/`);
    const address = (thread: Thread): URL => new URL(fileOf(thread), base);
    return {
        worker: (thread) =>
            started(
                () => new Worker(address(thread), { type: "module", name: "BSM" }),
                () => address(thread),
            ),
        kernels: once((build) => compiled(new URL(`${build === "whole" ? "kernels" : build}.wasm`, base))),
        local,
    };
}
