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

/** Values, or lengths, of one, two or four bytes: the tag of the first, and the least value without a shorter form. */
const LONG = [
    ["int", 0xcc, 128],
    ["string", 0xd9, 32],
    ["binary", 0xc4, 0],
] as const;

const UTF8 = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true });

/** The pairs of a canonical map, keys strictly ascending. */
export function parseMap(data: Uint8Array): [Key, Value][] {
    const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
    let [at, left] = [0, MOST_ENTRIES]; // those that arrays may still have, all of them together
    const take = (count: number): number => {
        demand(count <= data.length - at);
        return (at += count) - count;
    };
    const bytes = (count: number): Uint8Array => data.slice(take(count), at);
    const unsigned = (size: number, least: number): number => {
        const value = bytes(size).reduce((value, byte) => 256 * value + byte, 0);
        demand(value >= least);
        return value;
    };
    const text = (size: number): Value => {
        const own = bytes(size);
        try {
            return { type: "string", value: UTF8.decode(own), bytes: own };
        } catch {
            throw new CorruptError("");
        }
    };
    const array = (size: number): Value => {
        demand((left -= size) >= 0);
        return { type: "array", value: Array.from({ length: size }, () => valueOf(false)) };
    };
    const number = <Kind>(type: "int" | "float", value: Kind, isLegal: (value: Kind) => boolean): Value => {
        demand(isLegal(value));
        return { type, value } as Value;
    };
    const valueOf = (arrays: boolean): Value => {
        const tag = data[take(1)];
        if (tag < 0x80 || tag >= 0xe0) return { type: "int", value: (tag << 24) >> 24 };
        if (tag >= 0xa0 && tag <= 0xbf) return text(tag & 31);
        if (arrays && tag >= 0x90 && tag <= 0x9f) return array(tag & 15);
        if (arrays && tag === 0xdc) return array(unsigned(2, 16));
        for (const [type, first, least] of LONG) {
            if (tag < first || tag > first + 2) continue;
            const value = unsigned(1 << (tag - first), [least, 256, 65536][tag - first]);
            if (type === "int") return { type, value };
            return type === "string" ? text(value) : { type, value: bytes(value) };
        }
        // An integer is beyond all shorter forms.
        if (tag === 0xcf) return number("int", view.getBigUint64(take(8)), (v) => v >= 1n << 32n);
        if (tag === 0xd0) return number("int", view.getInt8(take(1)), (v) => v < -32);
        if (tag === 0xd1) return number("int", view.getInt16(take(2)), (v) => v < -128);
        if (tag === 0xd2) return number("int", view.getInt32(take(4)), (v) => v < -32768);
        if (tag === 0xd3) return number("int", view.getBigInt64(take(8)), (v) => v < -(1n << 31n));
        if (tag === 0xca) return number("float", view.getFloat32(take(4)), Number.isFinite);
        demand(tag === 0xcb);
        return number("float", view.getFloat64(take(8)), (v) => Number.isFinite(v) && Math.fround(v) !== v);
    };
    const tag = data[take(1)];
    demand(tag === 0xde || (tag >= 0x80 && tag <= 0x8f));
    const size = tag === 0xde ? unsigned(2, 16) : tag & 15;
    demand(size <= MOST_ENTRIES);
    const pairs: [Key, Value][] = [];
    for (let k = 0; k < size; k++) {
        const key = valueOf(false);
        demand(key.type === "string" || (key.type === "int" && key.value >= 0));
        demand(k === 0 || isBefore(pairs[k - 1][0], key));
        pairs.push([key, valueOf(true)]);
    }
    demand(at === data.length);
    return pairs;
}

function isBefore(a: Key, b: Key): boolean {
    if (a.type === "int" && b.type === "int") return a.value < b.value;
    if (a.type === "int" || b.type === "int") return false; // all are of one type
    const at = a.bytes.findIndex((byte, i) => byte !== b.bytes[i]); // undefined behind the shorter one
    return at < 0 ? a.bytes.length < b.bytes.length : a.bytes[at] < (b.bytes[at] ?? -1);
}
