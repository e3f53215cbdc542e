/** The entropy coder as its kernels see it (specification, C 1 to C 3): a coder that reads, and banks that learn. */
import { CorruptError, TruncatedError } from "./errors";
import type { Bytes, Ints, Longs, Memory, Words } from "./memory";

const ONE = 65536;
const SUFFIX_NODES = 24;
const WIDTH = 2 ** 32 - 1;
const POSITION = 2;

/** Nodes of an unsigned integer (C 3.1); a signed one takes two more. */
export function unsignedSpan(unary: number): number {
    return unary + SUFFIX_NODES + 2;
}

/** Adaptive probabilities: slots, weights, settings, in the order of the kernels' structure. */
export type Bank = readonly [slots: Words, weights: Ints, settings: Longs];

/** What a bank is made of; the defaults are those of most models. */
export interface BankOptions {
    slots: number;
    selectors: number;
    inputs: number;
    limit?: number;
    rate?: number;
    probability?: number;
    trust?: number;
}

export function makeBank(memory: Memory, options: BankOptions): Bank {
    const { slots, selectors, inputs, limit = 255, rate = 14, probability = ONE / 2, trust = 0 } = options;
    const bank: Bank = [memory.words(slots), memory.ints(selectors * inputs, inputs), memory.longs(2)];
    const weight = inputs < 3 ? Math.floor(ONE / inputs) : Math.floor((ONE * 5) / (4 * inputs));
    bank[0].view.fill(((probability << 16) | trust) >>> 0);
    bank[1].view.fill(weight);
    bank[2].view.set([BigInt(limit), BigInt(rate)]);
    return bank;
}

/** A range decoder of one payload. */
export class Coder {
    readonly parts: [state: Longs, data: Bytes];

    constructor(memory: Memory, payload: Uint8Array) {
        const code = [0, 1, 2, 3].reduce((value, i) => value * 256 + (payload[i] ?? 0), 0);
        if (code >= WIDTH) throw new CorruptError("an entropy-coded payload cannot begin with ff ff ff ff");
        this.parts = [memory.longs(5), memory.bytes(payload.length)];
        this.parts[0].view.set([BigInt(code), BigInt(WIDTH), 4n, 1n, 0n]);
        this.parts[1].view.set(payload);
    }

    /** Whether more was read than any payload of this length can hold (C 1.6). */
    get overran(): boolean {
        return this.position > this.size + 4;
    }

    /** Check that the payload was read exactly to its end (C 1.5). */
    finish(): void {
        if (this.overran) throw new TruncatedError(`an entropy-coded payload of ${this.size} bytes ends too early`);
        if (this.position < this.size) throw new CorruptError("bytes are left over behind the last symbol of a payload");
    }

    /** The error that nonsense is: truncated if the payload is over. */
    nonsense(problem: string): CorruptError | TruncatedError {
        return this.overran
            ? new TruncatedError(`an entropy-coded payload of ${this.size} bytes ends too early`)
            : new CorruptError(`a payload is damaged: ${problem}`);
    }

    private get position(): number {
        return Number(this.parts[0].view[POSITION]);
    }

    private get size(): number {
        return this.parts[1].length;
    }
}
