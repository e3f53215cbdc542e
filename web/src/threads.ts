/** What this machine has. */

/** Vertices from which on helpers win more than they cost. */
export const WORTHWHILE = 8192;

/** Threads that this machine runs at the same time. */
export function processors(): number {
    return globalThis.navigator?.hardwareConcurrency ?? 1;
}

/** A thread; undefined where there are none, or the page's policy forbids it. */
export function started(start: () => Worker): Worker | undefined {
    try {
        return start();
    } catch {
        return undefined;
    }
}
