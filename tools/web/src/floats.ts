/** Which float of the cell of its value each coordinate is (specification, V 16). */
import { NOT_FINITE } from "./assembly";
import { Coder } from "./entropy";
import { NumericError } from "./errors";
import type { Header } from "./header";
import type { Argument, Memory } from "./kernels";
import { areFinite } from "./numbers";

const SLOTS = 27;
const NO_FLOAT = 1n << 40n;

const single = new Float32Array(1);
const bits = new Int32Array(single.buffer);

/** The number of the float nearest to a number (V 16.1). */
function numberOf(value: number): bigint {
    single[0] = value;
    return BigInt(bits[0] >= 0 ? bits[0] : -1 - (bits[0] & 0x7fffffff));
}

/** The float of a number. */
function floatOf(number: bigint): number {
    bits[0] = Number(number >= 0n ? number : -(1n << 31n) - 1n - number);
    return single[0];
}

/** What is learnt of floats, and the way from values of a grid to them. */
export class Floats {
    private readonly state: Argument;

    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
    ) {
        const span = Math.max(...header.grid) + 1;
        const slots = memory.words(SLOTS);
        const latest = memory.longs(3);
        const known = memory.longs(3 * span, span);
        slots.view.fill(2 ** 31);
        latest.view.fill(0n);
        known.view.fill(NO_FLOAT);
        this.state = [slots, latest, known];
    }

    /** Positions of vertices whose values, three each, are known. */
    decode(payload: Uint8Array, values: Int32Array): Float64Array {
        const { memory, header } = this;
        return memory.scratch(() => {
            const coder = new Coder(memory, payload);
            const given = memory.ints(values.length, 3);
            const [low, nearest, high, chosen] = [0, 1, 2, 3].map(() => memory.longs(values.length, 3));
            given.view.set(values);
            values.forEach((value, i) => {
                low.view[i] = numberOf(header.center[i % 3] + header.scale * (value - 0.5));
                nearest.view[i] = numberOf(header.center[i % 3] + header.scale * value);
                high.view[i] = numberOf(header.center[i % 3] + header.scale * (value + 0.5));
            });
            chosen.view.fill(0n);
            const done = memory.call("code_floats", coder.parts, this.state, given, low, nearest, high, chosen);
            if (coder.overran || done < values.length / 3) throw coder.nonsense(`vertex ${done} is in a cell without floats`);
            coder.finish();
            const positions = Float64Array.from(chosen.view, floatOf);
            if (!areFinite(positions)) throw new NumericError(NOT_FINITE);
            return positions;
        });
    }
}
