/** Coded coefficients to levels (specification, M 9; F 6). */
import { makeBank, type Bank, type Coder } from "./entropy";
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

const WEIGHTS = EXPECTATIONS * SITUATIONS * NEIGHBOURS;
const SLOTS = EXPECTATIONS * BINS * NODES;

/** What a chain of blocks has taught the coder; it stays in memory as long as the chain. */
export class CoefficientModel {
    private readonly bank: Bank;
    private readonly past: readonly [Ints, Ints, Ints, Longs];
    private readonly expectations: Ints;

    constructor(
        private readonly memory: Memory,
        readonly width: number,
    ) {
        this.bank = makeBank(memory, { slots: SLOTS, selectors: SELECTORS * NODES, inputs: EXPECTATIONS, limit: 400, rate: 4 });
        const size = 3 * (width + ROWS_AROUND);
        const blocks = memory.longs(1);
        this.past = [memory.ints(size, 3), memory.ints(size, 3), memory.ints(size, 3), blocks];
        this.expectations = memory.ints(WEIGHTS, NEIGHBOURS);
        this.past.forEach((place) => (place === blocks ? blocks.view.fill(0n) : (place as Ints).view.fill(0)));
        memory.call("learn_beforehand", this.expectations, this.bank[1], this.bank[0]);
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
