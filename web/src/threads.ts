/** What this machine has. */

/** Vertices from which on helpers win more than they cost. */
export const WORTHWHILE = 8192;

/** Threads that this machine runs at the same time. */
export function processors(): number {
    return globalThis.navigator?.hardwareConcurrency ?? 1;
}

/** Whether this machine has the vector instructions of WebAssembly. */
export function hasVectors(): boolean {
    // A function that makes a vector: (func (result v128) i32.const 0 i8x16.splat)
    const probe = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0, 253, 15, 11];
    return WebAssembly.validate(Uint8Array.from(probe));
}
