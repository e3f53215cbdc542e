/** What this machine has. */

/** Vertices of blocks from which on helpers win more than they cost: each starts a thread and decodes all faces. */
export const WORTHWHILE = 8192;

export function processors(): number {
    return globalThis.navigator?.hardwareConcurrency ?? 1;
}

/**
 * A thread, in the first of three ways that works: of its file; of a script of the page that imports the file, which may
 * come from another origin (a CDN) then; none, so that this thread does the work. Where the policy of the page forbids
 * blobs, the second way fails later, by an error event. `start` is for bundlers, which look for the name of a file in it.
 */
export function started(start: () => Worker, address?: () => URL): Worker | undefined {
    try {
        return start();
    } catch {
        return address && imported(address);
    }
}

/** What browsers have in `trustedTypes`, as far as it is used here. */
export interface Policies {
    createPolicy<Rules extends Record<string, (text: string) => string>>(name: string, rules: Rules): Rules;
}
let policy: { createScriptURL: (url: string) => string } | undefined;

/** A thread of a blob that imports the module at an address. */
function imported(address: () => URL): Worker | undefined {
    let blob = "";
    try {
        const text = `import ${JSON.stringify(address().href)};`;
        blob = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
        const { trustedTypes } = globalThis as { trustedTypes?: Policies };
        policy ??= trustedTypes?.createPolicy("bsm-threads", { createScriptURL: (url: string) => url });
        return new Worker(policy?.createScriptURL(blob) ?? blob, { type: "module", name: "BSM" });
    } catch {
        return undefined;
    } finally {
        URL.revokeObjectURL(blob);
    }
}

/** Say once that the work is done in the thread that draws, and what that means. */
export function sayAlone(): void {
    if (isSaid || typeof Worker === "undefined") return; // without workers in the platform there is nothing to report
    isSaid = true;
    const why = "no thread can be started here, so the page waits while it decodes; see worker-src of its policy";
    console.warn(`BSM: ${why}`);
}
let isSaid = false;
