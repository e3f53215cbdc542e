/** Calls of C that was compiled to WebAssembly, and the memory that it works on. */
import { LimitError } from "./errors";
import type { Changes } from "./events";
import type { Exports, Kernels } from "./kernels";
import { DEFAULT_LIMITS, type Limits } from "./limits";

const NAMES: Record<number, string> = {
    3: "FormatError",
    4: "CorruptError",
    5: "UnsupportedError",
    6: "LimitError",
    7: "NumericError",
    8: "LimitError",
    12: "TruncatedError",
};

/** Limits in the order of `bsmdec_limits`, as far as that is the one of the constants. */
const COUNTS = Object.keys(DEFAULT_LIMITS).slice(0, 12) as (keyof Limits)[];

/** The name of the error that a status of library/bsmdec.h means. */
export function errorName(status: number): string {
    return NAMES[status] ?? "BsmError";
}

/** The box around vertices, its center, and how far from that the farthest one is. */
export interface Bounds {
    low: number[];
    high: number[];
    center: [number, number, number];
    radius: number;
}

/** A kind of array, over memory. */
export interface ViewType<View> {
    BYTES_PER_ELEMENT: number;
    new (buffer: ArrayBuffer, at: number, length: number): View & { slice(): View };
}

/** What a block, of this number, or levels have changed. */
export type Move = [changes: Pick<Changes, "first" | "vertices" | "positions">, block: number];

/** Vertices that are to be drawn anew, what they are now, and corners of the faces that are whole by them. */
export interface Grown {
    vertices: Int32Array;
    positions: Float32Array;
    normals: Float32Array;
    /** The block that each came with. */
    origin: Int32Array;
    index: Uint32Array;
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
        const all = { ...DEFAULT_LIMITS, ...limits };
        const { work, workPerVertex, workPerByte, memory, memoryPerByte, blockMemory, blockMemoryPerVertex } = all;
        const bounds = [
            ...COUNTS.map((name) => all[name]),
            memory,
            ...[work, workPerVertex, workPerByte, Infinity],
            ...[blockMemory, blockMemoryPerVertex, memoryPerByte, Infinity],
            memory,
        ];
        this.decoder = this.held([new Float64Array(bounds)], (at) => this.invoke(begin, at, ...more));
        if (!this.decoder) throw new LimitError("this machine has no memory for a decoder");
    }

    protected get buffer(): ArrayBuffer {
        return this.own.memory.buffer;
    }

    protected invoke(name: string, ...args: number[]): number {
        const { own } = this;
        try {
            return (own[name] as (...args: number[]) => number)(...args) >>> 0;
        } catch (error) {
            this.exports = undefined; // memory that a trap has left in disorder is never used again
            throw error;
        }
    }

    doubles(at: number, count: number): Float64Array {
        return this.copied(Float64Array, at, count);
    }

    /** Move vertices, and give those that come their origin; returns the news of each, for `grown`. */
    moved(points: Float64Array, origin: Int32Array, moves: Move[]): Uint8Array {
        const size = origin.length;
        return this.held([points, origin, new Uint8Array(size)], (at, origins, news) => {
            for (const [changes, block] of moves) {
                const { first, positions } = changes;
                const chosen = first === undefined ? changes.vertices : new Int32Array(0);
                this.held([positions, chosen], (rows, places) =>
                    this.invoke(
                        "page_move",
                        rows,
                        positions.length / 3,
                        first === undefined ? places : 0,
                        first ?? 0,
                        block,
                        at,
                        origins,
                        news,
                    ),
                );
            }
            points.set(this.doubles(at, 3 * size));
            origin.set(this.copied(Int32Array, origins, size));
            return this.copied(Uint8Array, news, size);
        });
    }

    /** What is to be drawn anew of faces whose corners all have an origin, by the news of vertices: all, without these. */
    grown(
        faces: Int32Array,
        points: Float64Array,
        origin: Int32Array,
        news: Uint8Array = new Uint8Array(origin.length).fill(1),
    ): Grown {
        const size = origin.length;
        const arrays = [faces, origin, points, news, new Int32Array(size + 1), new Float32Array(6 * size)];
        return this.held(arrays, (corners, origins, at, fresh, list, places) => {
            const normals = places + 12 * size;
            const count = this.invoke(
                "page_grow",
                corners,
                faces.length,
                origins,
                at,
                places,
                size,
                fresh,
                list,
                normals,
            );
            return {
                vertices: this.copied(Int32Array, list + 4, count),
                positions: this.copied(Float32Array, places, 3 * count),
                normals: this.copied(Float32Array, normals, 3 * count),
                origin: this.copied(Int32Array, origins, count),
                index: this.copied(Uint32Array, corners, this.copied(Int32Array, list, 1)[0]),
            };
        });
    }

    /** Faces whose vertices are parted at sharp edges, and which of `points` each is; undefined if none is parted. */
    creased(faces: Int32Array, points: Float64Array, least: number): [Int32Array, Int32Array] | undefined {
        const [corners, size] = [faces.length, points.length / 3];
        const work = new Int32Array(2 * size + 3 * corners);
        const arrays = [faces, points, new Int32Array(corners), work, new Float64Array(corners)];
        return this.held(arrays, (list, at, source, scratch, normals) => {
            const count = this.invoke("page_crease", list, corners, at, size, least, source, scratch, normals);
            if (count === 0) return undefined;
            return [this.copied(Int32Array, list, corners), this.copied(Int32Array, source, count)];
        });
    }

    bounds(points: Float32Array): Bounds {
        return this.held([points, new Float64Array(10)], (at, found) => {
            this.invoke("page_bounds", at, points.length / 3, found);
            const [lx, ly, lz, hx, hy, hz, x, y, z, radius] = this.doubles(found, 10);
            return { low: [lx, ly, lz], high: [hx, hy, hz], center: [x, y, z], radius };
        });
    }

    protected copied<View>(kind: ViewType<View>, at: number, count: number): View {
        return new kind(this.buffer, count > 0 ? at : 0, count).slice();
    }

    /** The result of `work` with arrays in the memory, behind places that are known. */
    protected held<Result>(
        [array, ...rest]: ArrayBufferView[],
        work: (...places: number[]) => Result,
        ...places: number[]
    ): Result {
        if (!array) return work(...places);
        const { buffer, byteOffset, byteLength } = array;
        return this.lent(byteLength, (at) => {
            new Uint8Array(this.buffer, at).set(new Uint8Array(buffer, byteOffset, byteLength));
            return this.held(rest, work, ...places, at);
        });
    }

    /** The result of `work` with some bytes of the memory, which are free afterwards. */
    protected lent<Result>(size: number, work: (at: number) => Result): Result {
        const at = this.invoke("page_take", size);
        if (at === 0) throw new LimitError(`this machine has no ${size} bytes for the decoder`);
        try {
            return work(at);
        } finally {
            if (this.exports) this.invoke("page_give", at, size);
        }
    }

    /** Call the last function, and leave the memory to the next decoder. */
    protected end(name: string): void {
        const { exports } = this;
        if (!exports) return;
        this.invoke(name);
        this.kernels.take(exports);
        this.exports = undefined;
    }

    private get own(): Exports {
        if (!this.exports) throw new Error("this decoder was released");
        return this.exports;
    }
}
