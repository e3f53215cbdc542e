/** Numbers in text, read as Python reads them: what is not a number is an error that says where. */

const WORD = /^[+-]?(?:nan|inf(?:inity)?|(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)$/i;

/** A text without blanks around it; other spaces than those of ASCII belong to names. */
export const trimmed = (text: string): string => text.replace(/^[ \t-\r]+|[ \t-\r]+$/g, "");

/** The words of a line. */
export const wordsOf = (line: string): string[] => line.match(/[^ \t-\r]+/g) ?? [];

function numberOf(word: string): number | undefined {
    const number = Number(word);
    if (number - number === 0 && !/[^\d.e+-]/i.test(word)) return number;
    if (!WORD.test(word)) return undefined;
    if (/i/i.test(word)) return word.startsWith("-") ? -Infinity : Infinity;
    return number; // NaN of "nan", too
}

/** The number that a word is; `what` is named where it is none. */
export function numberIn(word: string, what: string): number {
    const number = numberOf(word);
    if (number !== undefined) return number;
    const fault = word.includes("_") ? "it has an underscore" : `'${word.slice(0, 60)}'`;
    throw new Error(`${what} is not made of numbers: ${fault}`);
}

/** Text in Latin-1, which any bytes are; what browsers call so is another code. */
export const latinOf = (bytes: Uint8Array): string => new TextDecoder("utf-16le").decode(Uint16Array.from(bytes));

/** Text in UTF-8, or else line by line in UTF-8 or Latin-1. */
export function textOf(bytes: Uint8Array): string {
    const decode = (some: Uint8Array): string => new TextDecoder("utf-8", { fatal: true }).decode(some);
    try {
        return decode(bytes);
    } catch {
        return latinOf(bytes).replace(/[^\r\n]*[^\0-\x7f][^\r\n]*/g, (line) => {
            try {
                return decode(Uint8Array.from(line, (letter) => letter.charCodeAt(0)));
            } catch {
                return line;
            }
        });
    }
}

/** Bytes without a byte order mark; editors of Windows also write UTF-16. */
export function unmarked(bytes: Uint8Array<ArrayBuffer>): Uint8Array<ArrayBuffer> {
    const [first, second, third] = bytes;
    if (first === 0xef && second === 0xbb && third === 0xbf) return bytes.slice(3);
    if (first + second !== 0x1fd) return bytes;
    const whole = bytes.subarray(0, bytes.length - (bytes.length % 2));
    return new TextEncoder().encode(new TextDecoder(first === 0xff ? "utf-16le" : "utf-16be").decode(whole));
}

/** Lines of numbers: all values in one list, and how many each line has. */
export class Rows {
    readonly values: number[] = [];
    readonly starts: number[] = [];
    readonly counts: number[] = [];

    constructor(private readonly what: string) {}

    add(words: string[]): void {
        this.starts.push(this.values.length);
        for (const word of words) this.values.push(numberIn(word, `${this.what} ${this.counts.length}`));
        this.counts.push(words.length);
    }

    /** The numbers `first` to `first + count` of every line. */
    columns(first: number, count: number): Float64Array {
        const short = this.counts.findIndex((has) => has < first + count);
        if (short >= 0) throw new Error(`${this.what} ${short} has ${this.counts[short]} numbers, too few`);
        const found = new Float64Array(count * this.counts.length);
        this.starts.forEach((start, row) => {
            for (let d = 0; d < count; d++) found[count * row + d] = this.values[start + first + d];
        });
        return found;
    }

    /** The most numbers of a line, and the fewest. */
    get range(): [fewest: number, most: number] {
        return this.counts.reduce(([low, high], count) => [Math.min(low, count), Math.max(high, count)], [100, 0]);
    }
}

/** Metadata in remarks of files that were written by `bsm`, "meta NAME: JSON". */
export function metadataIn(remarks: Iterable<string>): Record<string, string | number> {
    const found: Record<string, string | number> = {};
    for (const remark of remarks) {
        const [, name, value] = /^meta ([\p{L}\p{N}_.-]{1,255}): (.+)$/u.exec(remark.trim()) ?? [];
        if (!name) continue;
        try {
            const parsed: unknown = JSON.parse(value);
            const isText = typeof parsed === "string" && !/\p{Surrogate}/u.test(parsed);
            if (isText || (typeof parsed === "number" && Math.abs(parsed) < 2 ** 63)) found[name] = parsed as string;
        } catch {
            continue; // a remark of someone else
        }
    }
    return found;
}
