/** Where threads and kernels come from: the files beside this one, or those of a folder that is named. */
import type { StreamWorker, Say, Start } from "./worker";
import { compiled } from "./fetched";
import { hasVectors } from "./threads";
import type { Build } from "./peek";

export interface Source {
    /** A thread that decodes; undefined where there can be none. */
    worker(build: Build): Worker | undefined;
    kernels(build: Build): Promise<WebAssembly.Module>;
    /** The decoder for this thread, where there are no others. */
    local(build: Build): Promise<{ openDesk(start: Start, say: Say): StreamWorker }>;
}

/** What is written out here is what bundlers look for; webpack would make one file of all threads of one name. */
const WORKERS: Record<Build, () => Worker> = {
    whole: () => new Worker(new URL("./worker.js", import.meta.url), { type: "module", name: "BSM" }),
    small: () => new Worker(new URL("./small-worker.js", import.meta.url), { type: "module", name: "BSM-small" }),
    quick: () => new Worker(new URL("./quick-worker.js", import.meta.url), { type: "module", name: "BSM-quick" }),
    moving: () => new Worker(new URL("./moving-worker.js", import.meta.url), { type: "module", name: "BSM-moving" }),
};
const KERNELS: Record<Build | "scalar", () => URL> = {
    whole: () => new URL("./kernels.wasm", import.meta.url),
    small: () => new URL("./small.wasm", import.meta.url),
    quick: () => new URL("./quick.wasm", import.meta.url),
    moving: () => new URL("./moving.wasm", import.meta.url),
    scalar: () => new URL("./kernels-scalar.wasm", import.meta.url),
};
const SCRIPTS: Record<Build, string> = { whole: "worker.js", small: "small-worker.js", quick: "quick-worker.js", moving: "moving-worker.js" };
const FILES: Record<Build | "scalar", string> = { whole: "kernels.wasm", small: "small.wasm", quick: "quick.wasm", moving: "moving.wasm", scalar: "kernels-scalar.wasm" };

/** The lesser builds have vector instructions only; a machine without them has the whole one. */
function buildOf(build: Build): Build {
    return hasVectors() ? build : "whole";
}

/** An address beside this file, of which bundles of CommonJS know nothing. */
function beside(address: () => URL): URL {
    try {
        return address();
    } catch {
        throw new Error("this bundle does not know where the decoder's files are: copy those of bsm-decoder/built, and name their folder with setDecoderPath");
    }
}

function started(start: () => Worker): Worker | undefined {
    if (typeof Worker === "undefined") return undefined;
    try {
        return start();
    } catch {
        return undefined; // the page's policy forbids it
    }
}

/** A promise for each build, asked for once; a failed one is asked for again. */
export function once(load: (build: Build) => Promise<WebAssembly.Module>): (build: Build) => Promise<WebAssembly.Module> {
    const loading = new Map<Build, Promise<WebAssembly.Module>>();
    return (build) => {
        const found = loading.get(build) ?? load(build);
        loading.set(build, found);
        found.catch(() => loading.delete(build));
        return found;
    };
}

const local: Source["local"] = (build) => (build === "quick" && hasVectors() ? import("./quick") : import("./index"));

/** The files beside this one. */
export const here: Source = {
    worker: (build) => started(WORKERS[buildOf(build)]),
    kernels: once(async (build) => compiled(beside(KERNELS[hasVectors() ? build : "scalar"]))),
    local,
};

/** The files in a folder, as those of `built`. */
export function placeOf(path: string): Source {
    const base = new URL(path.endsWith("/") ? path : `${path}/`, globalThis.document?.baseURI ?? globalThis.location?.href);
    return {
        worker: (build) => started(() => new Worker(new URL(SCRIPTS[buildOf(build)], base), { type: "module", name: "BSM" })),
        kernels: once((build) => compiled(new URL(hasVectors() ? FILES[build] : FILES.scalar, base))),
        local,
    };
}
