/** Threads of this very script, where the page may have them. */

/** The function that all of a bundle of the decoder is inside of, see `scripts/build.mjs`; there is none without that. */
declare const bsm: unknown;

/** A thread that runs `serve`; undefined where there can be none. Where it fails later it says so by an error of its own. */
export function startWorker(name: string): Worker | undefined {
    if (typeof bsm !== "function" || typeof Worker === "undefined") return undefined;
    const url = URL.createObjectURL(new Blob([`(${bsm})().serve()`], { type: "text/javascript" }));
    try {
        return new Worker(url, { name });
    } catch {
        return undefined; // the page's policy forbids it
    } finally {
        URL.revokeObjectURL(url);
    }
}

/** Threads that this machine runs at the same time. */
export function processors(): number {
    return globalThis.navigator?.hardwareConcurrency ?? 1;
}
