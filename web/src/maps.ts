/** Canonical msgpack maps (specification, F 1.5): one map has one encoding, and nothing else is accepted. */
import { CorruptError } from "./errors";
import { demand } from "./varint";

const MOST_ENTRIES = 256;

/** A value with its type, since msgpack tells integers from floats and JavaScript does not. */
export type Value =
    | { type: "int"; value: number | bigint }
    | { type: "float"; value: number }
    | { type: "string"; value: string; bytes: Uint8Array }
    | { type: "binary"; value: Uint8Array }
    | { type: "array"; value: Value[] };

export type Key = Extract<Value, { type: "int" } | { type: "string" }>;

/** The pairs of a canonical map, keys strictly ascending. */
export function parseMap(payload: Uint8Array): [Key, Value][] {
    const reader = new MapReader(payload);
    const pairs: [Key, Value][] = [];
    for (let left = reader.mapSize(); left > 0; left--) {
        const key = reader.key();
        const last = pairs.at(-1)?.[0];
        demand(!last || isBefore(last, key));
        pairs.push([key, reader.value(true)]);
    }
    demand(reader.isOver);
    return pairs;
}

function isBefore(a: Key, b: Key): boolean {
    if (a.type === "int" && b.type === "int") return a.value < b.value;
    if (a.type === "int" || b.type === "int") return false; // all are of one type
    const at = a.bytes.findIndex((byte, i) => byte !== b.bytes[i]); // undefined behind the shorter one
    return at < 0 ? a.bytes.length < b.bytes.length : a.bytes[at] < (b.bytes[at] ?? -1);
}

/** Values, or lengths, of one, two or four bytes: the tag of the first, and the least value without a shorter form. */
const LONG = [
    ["int", 0xcc, 128],
    ["string", 0xd9, 32],
    ["binary", 0xc4, 0],
] as const;

class MapReader {
    private readonly view: DataView;
    private at = 0;
    /** Entries that arrays may still have, all of them together. */
    private left = MOST_ENTRIES;

    constructor(private readonly data: Uint8Array) {
        this.view = new DataView(data.buffer, data.byteOffset, data.byteLength);
    }

    get isOver(): boolean {
        return this.at === this.data.length;
    }

    mapSize(): number {
        const tag = this.byte();
        if (tag >= 0x80 && tag <= 0x8f) return tag & 15;
        demand(tag === 0xde);
        return this.size(16);
    }

    key(): Key {
        const key = this.value(false);
        demand(key.type === "string" || (key.type === "int" && key.value >= 0));
        return key as Key;
    }

    value(arrays: boolean): Value {
        const { view } = this;
        const tag = this.byte();
        if (tag < 0x80 || tag >= 0xe0) return { type: "int", value: (tag << 24) >> 24 };
        if (tag >= 0xa0 && tag <= 0xbf) return this.text(tag & 31);
        if (arrays && tag >= 0x90 && tag <= 0x9f) return this.array(tag & 15);
        if (arrays && tag === 0xdc) return this.array(this.size(16));
        for (const [type, first, least] of LONG) {
            if (tag < first || tag > first + 2) continue;
            const value = this.unsigned(1 << (tag - first), [least, 256, 65536][tag - first]);
            if (type === "int") return { type, value };
            return type === "string" ? this.text(value) : { type, value: this.bytes(value) };
        }
        // An integer is beyond all shorter forms.
        if (tag === 0xcf) return this.number("int", view.getBigUint64(this.take(8)), (v) => v >= 1n << 32n);
        if (tag === 0xd0) return this.number("int", view.getInt8(this.take(1)), (v) => v < -32);
        if (tag === 0xd1) return this.number("int", view.getInt16(this.take(2)), (v) => v < -128);
        if (tag === 0xd2) return this.number("int", view.getInt32(this.take(4)), (v) => v < -32768);
        if (tag === 0xd3) return this.number("int", view.getBigInt64(this.take(8)), (v) => v < -(1n << 31n));
        if (tag === 0xca) return this.number("float", view.getFloat32(this.take(4)), Number.isFinite);
        demand(tag === 0xcb);
        const isDouble = (v: number): boolean => Number.isFinite(v) && Math.fround(v) !== v;
        return this.number("float", view.getFloat64(this.take(8)), isDouble);
    }

    private number<Kind extends number | bigint>(
        type: "int" | "float",
        value: Kind,
        isLegal: (value: Kind) => boolean,
    ): Value {
        demand(isLegal(value));
        return { type, value } as Value;
    }

    private array(size: number): Value {
        this.left -= size;
        demand(this.left >= 0);
        return { type: "array", value: Array.from({ length: size }, () => this.value(false)) };
    }

    private text(size: number): Extract<Value, { type: "string" }> {
        const bytes = this.bytes(size);
        try {
            const value = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
            return { type: "string", value, bytes };
        } catch {
            throw new CorruptError("");
        }
    }

    /** How many entries there are, which is more than a shorter form has. */
    private size(least: number): number {
        const size = this.unsigned(2, least);
        demand(size <= MOST_ENTRIES);
        return size;
    }

    private unsigned(size: number, least: number): number {
        const value = this.bytes(size).reduce((value, byte) => 256 * value + byte, 0);
        demand(value >= least);
        return value;
    }

    private byte(): number {
        return this.data[this.take(1)];
    }

    private bytes(count: number): Uint8Array {
        const start = this.take(count);
        return this.data.slice(start, start + count);
    }

    private take(count: number): number {
        demand(count <= this.data.length - this.at);
        this.at += count;
        return this.at - count;
    }
}
