/** Canonical msgpack maps (specification, F 1.5): one map has one encoding, and nothing else is accepted. */
import { CorruptError } from "./errors";

const MOST_ENTRIES = 256;

/** A value with its type, since msgpack tells integers from floats and JavaScript does not. */
export type Value =
    | { type: "int"; value: number | bigint }
    | { type: "float"; value: number }
    | { type: "string"; value: string; bytes: Uint8Array }
    | { type: "binary"; value: Uint8Array }
    | { type: "array"; value: Value[] };

export type Key = Extract<Value, { type: "int" } | { type: "string" }>;
type Text = Extract<Value, { type: "string" }>;

/** The pairs of a canonical map, keys strictly ascending. */
export function parseMap(payload: Uint8Array): [Key, Value][] {
    const reader = new MapReader(payload);
    const pairs: [Key, Value][] = [];
    for (let left = reader.mapSize(); left > 0; left--) {
        const key = reader.key();
        const last = pairs.at(-1)?.[0];
        if (last && compareKeys(last, key) >= 0) throw new CorruptError("the keys of a map must ascend");
        pairs.push([key, reader.value(true)]);
    }
    reader.finish();
    return pairs;
}

function compareKeys(a: Key, b: Key): number {
    if (a.type === "int" && b.type === "int") return a.value < b.value ? -1 : a.value > b.value ? 1 : 0;
    if (a.type === "int" || b.type === "int") throw new CorruptError("the keys of a map must be all of one type");
    const at = a.bytes.findIndex((byte, i) => byte !== b.bytes[i]); // undefined behind the shorter one
    return at < 0 ? a.bytes.length - b.bytes.length : a.bytes[at] - (b.bytes[at] ?? -1);
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

    mapSize(): number {
        const tag = this.byte();
        if (tag >= 0x80 && tag <= 0x8f) return tag & 15;
        if (tag !== 0xde) throw new CorruptError("expected a msgpack map in its shortest form");
        return this.atMost(this.shortest(this.unsigned(2), 16));
    }

    key(): Key {
        const key = this.value(false);
        if (key.type === "string" || (key.type === "int" && key.value >= 0)) return key;
        throw new CorruptError("the keys of a map must be unsigned integers or strings");
    }

    finish(): void {
        if (this.at !== this.data.length) throw new CorruptError("bytes behind a map");
    }

    value(arrays: boolean): Value {
        const tag = this.byte();
        if (tag < 0x80 || tag >= 0xe0) return { type: "int", value: (tag << 24) >> 24 };
        if (tag >= 0xa0 && tag <= 0xbf) return this.text(tag & 31);
        if (arrays && tag >= 0x90 && tag <= 0x9f) return this.array(tag & 15);
        if (arrays && tag === 0xdc) return this.array(this.shortest(this.unsigned(2), 16));
        for (const [type, first, least] of LONG) {
            if (tag < first || tag > first + 2) continue;
            const size = tag - first;
            const value = this.shortest(this.unsigned(1 << size), [least, 256, 65536][size]);
            return type === "int"
                ? { type, value }
                : type === "string"
                  ? this.text(value)
                  : { type, value: this.bytes(value) };
        }
        switch (tag) {
            case 0xcf:
                return this.integer(this.view.getBigUint64(this.take(8)), (v) => v >= 1n << 32n);
            case 0xd0:
                return this.integer(this.view.getInt8(this.take(1)), (v) => v < -32);
            case 0xd1:
                return this.integer(this.view.getInt16(this.take(2)), (v) => v < -128);
            case 0xd2:
                return this.integer(this.view.getInt32(this.take(4)), (v) => v < -32768);
            case 0xd3:
                return this.integer(this.view.getBigInt64(this.take(8)), (v) => v < -(1n << 31n));
            case 0xca:
                return { type: "float", value: this.finite(this.view.getFloat32(this.take(4))) };
            case 0xcb:
                return this.double();
        }
        throw new CorruptError(`a map may not hold a value that begins with byte ${tag} here`);
    }

    private array(size: number): Value {
        this.left -= size;
        if (this.left < 0) throw new CorruptError(`the arrays of a map have more than ${MOST_ENTRIES} entries`);
        return { type: "array", value: Array.from({ length: this.atMost(size) }, () => this.value(false)) };
    }

    private text(size: number): Text {
        const bytes = this.bytes(size);
        try {
            return {
                type: "string",
                value: new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes),
                bytes,
            };
        } catch {
            throw new CorruptError("a string of a map is not UTF-8");
        }
    }

    private double(): Value {
        const value = this.finite(this.view.getFloat64(this.take(8)));
        if (Math.fround(value) === value) throw new CorruptError("a number of a map is not in its shortest form");
        return { type: "float", value };
    }

    /** An integer that is beyond all shorter forms. */
    private integer<Whole extends number | bigint>(value: Whole, isBeyond: (value: Whole) => boolean): Value {
        if (!isBeyond(value)) throw new CorruptError("an integer of a map is not in its shortest form");
        return { type: "int", value };
    }

    private shortest(value: number, least: number): number {
        if (value < least) throw new CorruptError("a map is not in its shortest form");
        return value;
    }

    private atMost(size: number): number {
        if (size > MOST_ENTRIES) throw new CorruptError(`more than ${MOST_ENTRIES} entries in a map or an array`);
        return size;
    }

    private finite(value: number): number {
        if (!Number.isFinite(value)) throw new CorruptError("a map may not hold a number that is not finite");
        return value;
    }

    private byte(): number {
        return this.data[this.take(1)];
    }

    private bytes(count: number): Uint8Array {
        const start = this.take(count);
        return this.data.slice(start, start + count);
    }

    private unsigned(size: number): number {
        return this.bytes(size).reduce((value, byte) => 256 * value + byte, 0);
    }

    private take(count: number): number {
        if (count > this.data.length - this.at) throw new CorruptError("a map ends too early");
        this.at += count;
        return this.at - count;
    }
}
