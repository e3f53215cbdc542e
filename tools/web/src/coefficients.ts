/** Coded coefficients to levels (specification, M 9; F 6). */
import { Coder, makeBank, unsignedSpan, type Bank } from "./entropy";
import { CorruptError } from "./errors";
import type { Ints, Longs, Memory } from "./kernels";
import { unpackZstd } from "./zstd";

const EXPECTATIONS = 3;
const SITUATIONS = 6;
const NEIGHBOURS = 20;
const NODES = 38;
const SELECTORS = 2;
const BINS = 48;
const ROWS_AROUND = 8 + 3; // rows of zeros in front of the first frequency and behind the last
const ROWS_UNARY = 8;
const ROWS_SPAN = unsignedSpan(ROWS_UNARY);

const WEIGHTS = EXPECTATIONS * SITUATIONS * NEIGHBOURS;
const SLOTS = EXPECTATIONS * BINS * NODES;

/** Which of the two learnt sets of numbers a model starts from (M 9.1). */
export type Layer = "coordinates" | "details";

/** What a chain of blocks has taught the coder; it stays in memory as long as the chain. */
export class CoefficientModel {
    private readonly bank: Bank;
    private readonly rows: Bank;
    private readonly past: readonly [Ints, Ints, Ints, Longs];
    private readonly missing: Longs;
    private readonly expectations: Ints;

    constructor(
        private readonly memory: Memory,
        readonly width: number,
        layer: Layer,
    ) {
        this.bank = makeBank(memory, { slots: SLOTS, selectors: SELECTORS * NODES, inputs: EXPECTATIONS, limit: 400, rate: 4 });
        this.rows = makeBank(memory, { slots: 17 * ROWS_SPAN, selectors: ROWS_SPAN, inputs: 2, limit: 60 });
        const size = 3 * (width + ROWS_AROUND);
        const blocks = memory.longs(1);
        this.past = [memory.ints(size, 3), memory.ints(size, 3), memory.ints(size, 3), blocks];
        this.missing = memory.longs(1);
        this.expectations = memory.ints(WEIGHTS, NEIGHBOURS);
        this.past.forEach((place) => (place === blocks ? blocks.view.fill(0n) : (place as Ints).view.fill(0)));
        this.missing.view.fill(0n);
        memory.call("learn_beforehand", layer === "details" ? 1n : 0n, this.expectations, this.bank[1], this.bank[0]);
    }

    /** Read a block's levels, `count` rows of three, as points in half steps (M 9.6, M 9.11). */
    points(coder: Coder, count: number): Ints {
        if (count > this.width) throw new CorruptError(`${count} coefficients where at most ${this.width} are announced`);
        const levels = this.memory.ints(3 * count, 3);
        const points = this.memory.ints(3 * count, 3);
        levels.view.fill(0);
        this.memory.call("code_block", coder.parts, this.bank, this.past, this.expectations, levels);
        this.memory.run("points_of_levels", levels, points);
        return points;
    }

    /** Read how many rows follow (M 9.8). */
    rowCount(coder: Coder): number {
        const rows = this.memory.call("code_rows", coder.parts, this.rows, this.missing, BigInt(this.width), 0n);
        if (coder.overran) coder.finish();
        if (rows < 0 || rows > this.width) throw new CorruptError(`${rows} rows of levels of at most ${this.width}`);
        return rows;
    }
}

/** Packed coefficients, `count` rows of three, in half steps (M 9.10). */
export function unpackLevels(data: Uint8Array, count: number, bits: number, coarser: number): Float64Array {
    const total = 3 * count;
    const packed = unpackZstd(data, Math.ceil((total * bits) / 8));
    const points = new Float64Array(total);
    const half = 2 ** (bits - 1);
    let at = 0;
    const read = (count: number): number => {
        let value = 0;
        for (let k = 0; k < count; k++, at++) value = 2 * value + ((packed[at >> 3] >> (7 - (at & 7))) & 1);
        return value;
    };
    for (let i = 0; i < total; i++) points[i] = 2 * (read(bits) - half) * (i < 3 ? 2 ** coarser : 1);
    if (read(8 * packed.length - at) !== 0) throw new CorruptError("the bits behind the last packed coefficient are not 0");
    return points;
}
