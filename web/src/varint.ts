/** Integers of any size in as few bytes as they need (specification, F 1.2). */
import { MAX_VARINT_BYTES } from "./constants.json";
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
