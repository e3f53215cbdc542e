/** Calls of C that was compiled to WebAssembly, and the memory that it works on. */
import { LimitError } from "./errors";
import type { Exports, Kernels } from "./kernels";
import { DEFAULT_LIMITS, type Limits } from "./limits";

const NAMES: Record<number, string> = {
    3: "Format",
    4: "Corrupt",
    5: "Unsupported",
    6: "Limit",
    7: "Numeric",
    8: "Limit",
    12: "Truncated",
};

/** The name of the error that a status of library/bsmdec.h means. */
export function errorName(status: number): string {
    return `${NAMES[status] ?? "Bsm"}Error`;
}

/** The box around vertices, its center, and how far from that the farthest one is. */
export interface Bounds {
    low: number[];
    high: number[];
    center: [number, number, number];
    radius: number;
}

export class Memory {
    /** Undefined once it is given back, or has failed by itself: nothing is called then. */
    private exports?: Exports;
    protected readonly decoder: number;

    /** Call the first function, `begin`, with the limits and more. */
    constructor(
        private readonly kernels: Kernels,
        limits: Partial<Limits>,
        begin: string,
        ...more: number[]
    ) {
        this.exports = kernels.borrow();
        const l = { ...DEFAULT_LIMITS, ...limits };
        const bounds = [
            l.vertices,
            l.faces,
            l.blocks,
            l.blockSize,
            l.coefficients,
            l.frames,
            l.gopFrames,
            l.frameBytes,
            l.metadataBytes,
            l.attributes,
            l.attributeValues,
            l.sequenceBytes,
            l.memory,
            l.work,
            l.workPerVertex,
            l.workPerByte,
            Infinity,
            l.blockMemory,
            l.blockMemoryPerVertex,
            l.memoryPerByte,
            Infinity,
            l.memory,
        ];
        this.decoder = this.lent(8 * bounds.length, (at) => {
            new Float64Array(this.buffer, at).set(bounds);
            return this.call(begin, at, ...more);
        });
        if (!this.decoder) throw new LimitError("this machine has no memory for a decoder");
    }

    protected get buffer(): ArrayBuffer {
        return this.own.memory.buffer;
    }

    protected call(name: string, ...args: number[]): number {
        const { own } = this;
        try {
            return (own[name] as (...args: number[]) => number)(...args) >>> 0;
        } catch (error) {
            this.exports = undefined; // memory that a trap has left in disorder is never used again
            throw error;
        }
    }

    doubles(at: number, count: number): Float64Array {
        return new Float64Array(this.buffer, count > 0 ? at : 0, count).slice();
    }

    /** Normals of vertices at `points`, by the faces whose corners all have an origin, which is 0 or more. */
    normals(faces: Int32Array, origin: Int32Array, points: ArrayLike<number>): Float32Array {
        const size = points.length;
        return this.lent(12 * size + 4 * (origin.length + faces.length), (at) => {
            new Float64Array(this.buffer, at).set(points);
            const [found, origins, corners] = [at + 8 * size, at + 12 * size, at + 12 * size + 4 * origin.length];
            new Int32Array(this.buffer, origins).set(origin);
            new Int32Array(this.buffer, corners).set(faces);
            this.call("page_normals", corners, faces.length, origins, at, found, size / 3);
            return new Float32Array(this.buffer, found, size).slice();
        });
    }

    bounds(points: Float32Array): Bounds {
        return this.lent(80 + 4 * points.length, (at) => {
            new Float32Array(this.buffer, at + 80).set(points);
            this.call("page_bounds", at + 80, points.length / 3, at);
            const [lx, ly, lz, hx, hy, hz, x, y, z, radius] = this.doubles(at, 10);
            return { low: [lx, ly, lz], high: [hx, hy, hz], center: [x, y, z], radius };
        });
    }

    /** The result of `work` with some bytes of the memory, which are free afterwards. */
    protected lent<Result>(size: number, work: (at: number) => Result): Result {
        const at = this.call("page_take", size);
        if (at === 0) throw new LimitError(`this machine has no ${size} bytes for the decoder`);
        try {
            return work(at);
        } finally {
            if (this.exports) this.call("page_give", at, size);
        }
    }

    /** Call the last function, and leave the memory to the next decoder. */
    protected end(name: string): void {
        const { exports } = this;
        if (!exports) return;
        this.call(name);
        this.kernels.take(exports);
        this.exports = undefined;
    }

    private get own(): Exports {
        if (!this.exports) throw new Error("this decoder was released");
        return this.exports;
    }
}
