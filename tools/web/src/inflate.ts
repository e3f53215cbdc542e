/** A zlib stream whose content has a size that is known (RFC 1950, RFC 1951); nothing is allocated beyond that size. */
import { CorruptError } from "./errors";

const LENGTH_BASES = [3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258];
const MOST_BITS = 15;
const END_OF_BLOCK = 256;
const LENGTH_ORDER = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
const ADLER = 65521;

/** A canonical prefix code: how many words there are of each length, and their symbols in order. */
interface Code {
    counts: Uint16Array;
    symbols: Uint16Array;
}

function makeCode(lengths: ArrayLike<number>): Code {
    const counts = new Uint16Array(MOST_BITS + 1);
    for (let s = 0; s < lengths.length; s++) counts[lengths[s]]++;
    counts[0] = 0;
    let left = 1;
    for (let bits = 1; bits <= MOST_BITS; bits++) left = 2 * left - counts[bits];
    const words = counts.reduce((sum, count) => sum + count, 0);
    // One word of one bit, or none, is all that may be incomplete.
    if (left < 0 || (left > 0 && words > 1)) throw damaged("a code that is none");
    const starts = new Uint16Array(MOST_BITS + 2);
    for (let bits = 1; bits <= MOST_BITS; bits++) starts[bits + 1] = starts[bits] + counts[bits];
    const symbols = new Uint16Array(words);
    for (let s = 0; s < lengths.length; s++) if (lengths[s]) symbols[starts[lengths[s]]++] = s;
    return { counts, symbols };
}

function damaged(problem: string): CorruptError {
    return new CorruptError(`a zlib stream is damaged: ${problem}`);
}

/** The content of `data`, exactly `size` bytes. */
export function inflate(data: Uint8Array, size: number): Uint8Array {
    const out = new Uint8Array(size);
    let [at, filled, held, count] = [2, 0, 0, 0];
    const bits = (wanted: number): number => {
        while (count < wanted) {
            if (at >= data.length) throw damaged("it ends too early");
            held |= data[at++] << count;
            count += 8;
        }
        const value = held & ((1 << wanted) - 1);
        held >>>= wanted;
        count -= wanted;
        return value;
    };
    const symbol = ({ counts, symbols }: Code): number => {
        let [word, first, index] = [0, 0, 0];
        for (let length = 1; length <= MOST_BITS; length++) {
            word |= bits(1);
            if (word - first < counts[length]) return symbols[index + word - first];
            index += counts[length];
            first = (first + counts[length]) << 1;
            word <<= 1;
        }
        throw damaged("a word that is in no code");
    };
    const put = (byte: number): void => {
        if (filled === size) throw damaged(`more than ${size} bytes`);
        out[filled++] = byte;
    };
    const coded = (): [Code, Code] => {
        const [literals, distances, used] = [bits(5) + 257, bits(5) + 1, bits(4) + 4];
        if (literals > 286 || distances > 30) throw damaged("too many symbols");
        const widths = new Uint8Array(19);
        for (let i = 0; i < used; i++) widths[LENGTH_ORDER[i]] = bits(3);
        const code = makeCode(widths);
        const lengths = new Uint8Array(literals + distances);
        for (let i = 0; i < lengths.length; ) {
            const read = symbol(code);
            if (read === 16 && i === 0) throw damaged("nothing to repeat");
            const [value, times] = read < 16 ? [read, 1] : read === 16 ? [lengths[i - 1], 3 + bits(2)] : [0, read === 17 ? 3 + bits(3) : 11 + bits(7)];
            if (i + times > lengths.length) throw damaged("too many lengths");
            lengths.fill(value, i, (i += times));
        }
        return [makeCode(lengths.subarray(0, literals)), makeCode(lengths.subarray(literals))];
    };
    const fixed = (): [Code, Code] => {
        const lengths = Uint8Array.from({ length: 288 }, (_, s) => (s < 144 ? 8 : s < 256 ? 9 : s < 280 ? 7 : 8));
        return [makeCode(lengths), makeCode(new Uint8Array(32).fill(5))];
    };
    const block = ([literals, distances]: [Code, Code]): void => {
        for (let read; (read = symbol(literals)) !== END_OF_BLOCK; ) {
            if (read < END_OF_BLOCK) {
                put(read);
                continue;
            }
            const k = read - END_OF_BLOCK - 1;
            if (k > 28) throw damaged("an unknown length");
            let length = LENGTH_BASES[k] + bits(k < 4 || k === 28 ? 0 : (k >> 2) - 1);
            const d = symbol(distances);
            if (d > 29) throw damaged("an unknown distance");
            const distance = (d < 4 ? d : (2 + (d & 1)) << ((d >> 1) - 1)) + 1 + bits(d < 4 ? 0 : (d >> 1) - 1);
            if (distance > filled) throw damaged("a distance beyond its beginning");
            while (length-- > 0) put(out[filled - distance]);
        }
    };
    const stored = (): void => {
        [held, count] = [0, 0];
        const [length, complement] = [bits(16), bits(16)];
        if ((length ^ complement) !== 0xffff) throw damaged("a stored block without its length");
        for (let i = 0; i < length; i++) put(bits(8));
    };

    if (data.length < 2 || (data[0] & 15) !== 8 || data[0] >> 4 > 7 || (data[0] * 256 + data[1]) % 31 !== 0 || data[1] & 32) {
        throw damaged("its header");
    }
    for (let last = 0; !last; ) {
        last = bits(1);
        const kind = bits(2);
        if (kind === 3) throw damaged("an unknown kind of block");
        if (kind === 0) stored();
        else block(kind === 1 ? fixed() : coded());
    }
    [held, count] = [0, 0];
    let [a, b] = [1, 0];
    for (const byte of out) b = (b + (a = (a + byte) % ADLER)) % ADLER;
    const sum = [b >> 8, b & 255, a >> 8, a & 255];
    if (filled !== size) throw damaged(`${filled} bytes where ${size} belong`);
    if (at + 4 !== data.length || sum.some((byte, i) => data[at + i] !== byte)) throw damaged("its checksum or its end");
    return out;
}
