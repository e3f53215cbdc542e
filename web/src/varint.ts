/** Integers of any size in as few bytes as they need (specification, F 1.2), and frames, which begin with one. */
import { MAX_VARINT_BYTES, SHORT } from "./constants.json";
import { CorruptError } from "./errors";

/** Throw an error if `isSo` is false. It has no text, since the full decoder then says what is wrong. */
export function demand(isSo: boolean): asserts isSo {
    if (!isSo) throw new CorruptError("");
}

/** The varint at `start`, undefined if the data ends inside it (F 1.2). */
export function parseVarint(data: Uint8Array, start: number, end: number): { value: number; end: number } | undefined {
    let value = 0;
    for (let k = 0; k < MAX_VARINT_BYTES && start + k < end; k++) {
        const byte = data[start + k];
        value += (byte & 127) * 2 ** (7 * k);
        if (byte >= 128) continue;
        demand(byte > 0 || k === 0); // in its shortest form
        return { value, end: start + k + 1 };
    }
    demand(end - start < MAX_VARINT_BYTES);
    return undefined;
}

const BLOCK_TAG = 6;

/** What a tag says, and where the frame's payload and the frame end (F 3). */
export function frameOf(tag: { value: number; end: number }): Record<"type" | "length" | "sum" | "end", number> {
    const type = tag.value % 16;
    const length = Math.floor(tag.value / 16);
    const sum = tag.end + length;
    return { type, length, sum, end: sum + (type === BLOCK_TAG || length < SHORT ? 2 : 4) };
}
