/** One zstd frame without its magic number, of a content whose size is known (specification, F 6.2). */
import { decompress } from "fzstd";
import { CorruptError } from "./errors";

const MAGIC = [0x28, 0xb5, 0x2f, 0xfd];
const MOST_WINDOW = 2 ** 23;
const BLOCK_HEADER = 3;
const RLE = 1;

/** The content of `data`, exactly `size` bytes; no more is ever allocated for it. */
export function unpackZstd(data: Uint8Array, size: number): Uint8Array {
    if (data.length === size) return data;
    if (data.length > size) throw new CorruptError(`${data.length} compressed bytes for ${size} bytes of content`);
    checkFrame(data, size);
    const content = new Uint8Array(size);
    let found: Uint8Array;
    try {
        found = decompress(Uint8Array.from([...MAGIC, ...data]), content);
    } catch (error) {
        throw new CorruptError(`a zstd frame is damaged: ${error instanceof Error ? error.message : error}`);
    }
    if (found.length !== size) throw new CorruptError(`a zstd frame holds ${found.length} bytes where ${size} belong`);
    return found;
}

/** What a frame says about itself (RFC 8878, 3.1.1), and that nothing follows it. */
function checkFrame(data: Uint8Array, size: number): void {
    const need = (end: number): void => {
        if (end > data.length) throw new CorruptError("a zstd frame ends too early");
    };
    const number = (at: number, bytes: number): number => {
        need(at + bytes);
        return data.subarray(at, at + bytes).reduceRight((value, byte) => value * 256 + byte, 0);
    };
    const descriptor = number(0, 1);
    const single = (descriptor & 32) !== 0;
    const flag = descriptor >> 6;
    if (descriptor & 8) throw new CorruptError("a zstd frame has a reserved bit");
    if (descriptor & 4) throw new CorruptError("a zstd frame has a checksum of its content");
    if (descriptor & 3) throw new CorruptError("a zstd frame uses a dictionary");
    if (!single && flag === 0) throw new CorruptError("a zstd frame does not state its content size");
    let at = 1;
    let window = size;
    if (!single) {
        const byte = number(at++, 1);
        window = 2 ** (10 + (byte >> 3)) * (1 + (byte & 7) / 8);
    }
    const bytes = [1, 2, 4, 8][flag];
    const stated = number(at, bytes) + (flag === 1 ? 256 : 0);
    at += bytes;
    if (stated !== size) throw new CorruptError(`a zstd frame claims ${stated} bytes where ${size} belong`);
    if (window > MOST_WINDOW) throw new CorruptError(`a zstd frame has a window of ${window} bytes`);
    for (let last = false; !last; ) {
        const header = number(at, BLOCK_HEADER);
        last = (header & 1) === 1;
        at += BLOCK_HEADER + (((header >> 1) & 3) === RLE ? 1 : header >> 3);
        need(at);
    }
    if (at !== data.length) throw new CorruptError("a zstd frame does not end where its bytes end");
}
