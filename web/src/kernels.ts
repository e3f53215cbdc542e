/** The decoder in C, or kernels of it, compiled to WebAssembly. */

/** Bytes of memory, at most, that wait for the next decoder. */
const WAITING = 2 ** 24;

export type Exports = Record<string, unknown> & { memory: WebAssembly.Memory };
/** The compiled kernels, and what they start from; one for any number of decoders. */
export class Kernels {
    private waiting?: Exports;

    /** Of a module that is compiled already; it may be sent to other threads. */
    constructor(readonly module: WebAssembly.Module) {}

    /** What one decoder calls, and its memory. */
    borrow(): Exports {
        const exports = this.waiting ?? (new WebAssembly.Instance(this.module).exports as Exports);
        this.waiting = undefined;
        return exports;
    }

    /** Take back that in which nothing is needed any more: the next decoder begins in it sooner than in new memory. */
    take(exports: Exports): void {
        if (exports.memory.buffer.byteLength <= WAITING) this.waiting = exports;
    }
}
