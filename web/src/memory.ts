/**
 * The kernels in C, compiled to WebAssembly, and the memory that they work on.
 *
 * Memory is a stack: what is allocated behind a mark is given back as a whole, and everything that a stream can ask for
 * is counted against one limit before it exists. An array is known by its place, since its view changes where memory
 * grows.
 */
import { LimitError } from "./errors";
import type { Exports } from "./kernels";

type Numbers = Uint8Array | Int32Array | Uint32Array | BigInt64Array | Float64Array;

interface Kind<View extends Numbers> {
    readonly BYTES_PER_ELEMENT: number;
    new (buffer: ArrayBufferLike, offset: number, length: number): View;
}

/** What a kernel takes: int64, double, arrays as the structures of bitstream/kernel.h, structures of all these. */
export type Argument = bigint | number | Place<Numbers> | readonly Argument[];

/** An array in the memory of the kernels; of two dimensions if `columns` is given. */
export class Place<View extends Numbers> {
    private numbers?: View;

    constructor(
        private readonly memory: Memory,
        readonly kind: Kind<View>,
        readonly pointer: number,
        readonly length: number,
        readonly columns?: number,
    ) {}

    /** Its numbers, until the next allocation. */
    get view(): View {
        const { buffer } = this.memory;
        const { numbers } = this;
        if (numbers?.buffer === buffer) return numbers;
        return (this.numbers = new this.kind(buffer, this.pointer, this.length));
    }

    get rows(): number {
        return this.columns === undefined ? this.length : this.columns && this.length / this.columns;
    }

    /** The numbers from `start` on, as an array of their own shape. */
    part(start: number, length: number, columns?: number): Place<View> {
        if (start < 0 || length < 0 || start + length > this.length) throw new RangeError("a part outside of its array");
        return new Place(this.memory, this.kind, this.pointer + start * this.kind.BYTES_PER_ELEMENT, length, columns);
    }
}

export type Bytes = Place<Uint8Array>;
export type Ints = Place<Int32Array>;
export type Words = Place<Uint32Array>;
export type Longs = Place<BigInt64Array>;
export type Doubles = Place<Float64Array>;

const PAGE = 65536;
const LINE = 16;
const ARGUMENT_BYTES = 1024;
const MISUSED = -(2n ** 63n);

/** A stack of arrays, and the kernels that take them. */
export class Memory {
    buffer: ArrayBuffer;
    private readonly frame: number;
    private top: number;

    constructor(readonly exports: Exports, private readonly limit: number) {
        this.buffer = exports.memory.buffer;
        this.frame = align((exports.__heap_base as WebAssembly.Global).value as number);
        this.top = this.frame + ARGUMENT_BYTES;
        this.reserve(this.top);
        this.run("make_tables");
    }

    /** What `work` returns; all that it allocates is given back. */
    scratch<Result>(work: () => Result): Result {
        const mark = this.top;
        try {
            return work();
        } finally {
            this.top = mark;
        }
    }

    bytes(length: number): Bytes {
        return this.place(Uint8Array, length);
    }

    ints(length: number, columns?: number): Ints {
        return this.place(Int32Array, length, columns);
    }

    words(length: number): Words {
        return this.place(Uint32Array, length);
    }

    longs(length: number, columns?: number): Longs {
        return this.place(BigInt64Array, length, columns);
    }

    doubles(length: number, columns?: number): Doubles {
        return this.place(Float64Array, length, columns);
    }

    call(name: string, ...args: Argument[]): number {
        const result = this.invoke(name, args);
        if (result === MISUSED) throw new RangeError(`arrays that do not fit together were given to ${name}`);
        return Number(result);
    }

    run(name: string, ...args: Argument[]): number {
        return Number(this.invoke(name, args) ?? 0);
    }

    private invoke(name: string, args: Argument[]): unknown {
        const view = new DataView(this.buffer, this.frame, ARGUMENT_BYTES);
        let at = 0;
        const write = (argument: Argument): void => {
            if (typeof argument === "bigint") view.setBigInt64(at, argument, true);
            else if (typeof argument === "number") view.setFloat64(at, argument, true);
            else if (argument instanceof Place) return writeArray(argument);
            else return argument.forEach(write);
            at += 8;
        };
        const writeArray = ({ pointer, rows, columns }: Place<Numbers>): void => {
            view.setUint32(at, pointer, true);
            for (const size of columns === undefined ? [rows] : [rows, columns]) view.setBigInt64((at += 8), BigInt(size), true);
            at += 8;
        };
        const passed = args.map((argument) => {
            if (typeof argument === "bigint" || typeof argument === "number") return argument;
            const start = at;
            write(argument);
            return this.frame + start;
        });
        return (this.exports[name] as (...args: (bigint | number)[]) => unknown)(...passed);
    }

    private place<View extends Numbers>(kind: Kind<View>, length: number, columns?: number): Place<View> {
        const pointer = this.top;
        const end = align(pointer + length * kind.BYTES_PER_ELEMENT);
        this.reserve(end);
        this.top = end;
        return new Place(this, kind, pointer, length, columns);
    }

    private reserve(end: number): void {
        if (end > this.limit) throw new LimitError(`memory = ${end} bytes is over the limit of ${this.limit}`);
        const size = this.buffer.byteLength;
        if (end <= size) return;
        try {
            // By a quarter at least: each time all views of it are lost.
            this.exports.memory.grow(Math.ceil(Math.max(end - size, Math.min(size / 4, this.limit - size)) / PAGE));
            this.buffer = this.exports.memory.buffer;
        } catch {
            throw new LimitError(`this machine has no ${end} bytes of memory for the decoder`);
        }
    }
}

function align(address: number): number {
    return Math.ceil(address / LINE) * LINE;
}
