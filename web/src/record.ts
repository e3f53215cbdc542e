/** Maps with typed fields: the header, and declarations of attributes (specification, F 4.1 to F 4.5). */
import { CorruptError, UnsupportedError } from "./errors";
import { parseMap, type Value } from "./maps";

type Content = number | number[] | string | Uint8Array;

/** A field: its key, and what is legal; of text, `low` and `high` bound the bytes. */
export interface Field {
    key: number;
    type: "int" | "method" | "float" | "ints" | "floats" | "string";
    low: number;
    high: number;
    default?: Content;
    lengths?: [number, number];
}

export type Fields<Names extends string> = Record<Names, Field>;

const METHODS = 255;

/** The fields in a payload, each in its range; `what` is what errors call the map. */
export function parseFields<Names extends string>(payload: Uint8Array, fields: Fields<Names>, what: string): Record<Names, Content> {
    const names = new Map(Object.entries<Field>(fields).map(([name, field]) => [field.key, name as Names]));
    const found: Partial<Record<Names, Content>> = {};
    const entries = parseMap(payload);
    for (const [key, value] of entries) refuseUnknown(key, value, names, fields, what);
    for (const [key, value] of entries) {
        const name = names.get(Number(key.value))!;
        const content = contentOf(name, fields[name], value, what);
        if (same(content, fields[name].default)) throw new CorruptError(`${what} field ${name} is stored with its default value`);
        found[name] = content;
    }
    for (const [name, field] of Object.entries(fields) as [Names, Field][]) {
        found[name] ??= field.default;
        const given = found[name];
        if (given === undefined) throw new CorruptError(`the ${what} lacks ${name}`);
        checkRange(name, field, given, what);
    }
    return found as Record<Names, Content>;
}

/** Report a later version first, whatever else may seem wrong (F 4.8). */
function refuseUnknown<Names extends string>(key: Value, value: Value, names: Map<number, Names>, fields: Fields<Names>, what: string): void {
    if (key.type !== "int") throw new CorruptError(`a ${what} key is not an integer`);
    const name = names.get(Number(key.value));
    if (name === undefined) throw new UnsupportedError(`${what} key ${key.value} is unknown to this decoder`);
    const { type, high } = fields[name];
    if (type === "method" && value.type === "int" && value.value > high && value.value <= METHODS) {
        throw new UnsupportedError(`${what} field ${name} names method ${value.value}, unknown to this decoder`);
    }
}

function contentOf(name: string, { type }: Field, value: Value, what: string): Content {
    if (type === "floats" || type === "ints") {
        if (value.type === "array") {
            return value.value.map((item) => {
                if (`${item.type}s` === type) return Number(item.value);
                throw new CorruptError(`an entry of the ${what} field ${name} is of type ${item.type}`);
            });
        }
    } else if (type === "string") {
        if (value.type === type) return value.value;
    } else if (value.type === (type === "float" ? "float" : "int")) {
        return Number(value.value);
    }
    throw new CorruptError(`${what} field ${name} is of type ${value.type}`);
}

/** Whether two contents are equal. */
export function same(a: Content, b: Content | undefined): boolean {
    if (typeof a !== "object" || typeof b !== "object") return a === b;
    return a.length === b.length && a.every((item, i) => item === b[i]);
}

function checkRange(name: string, { low, high, lengths = [1, 1] }: Field, content: Content, what: string): void {
    const list = Array.isArray(content) ? content : [content];
    const sizes = list.map((item) => (typeof item === "number" ? item : typeof item === "string" ? new TextEncoder().encode(item).length : item.length));
    if (list.length < lengths[0] || list.length > lengths[1] || !sizes.every((size) => size >= low && size <= high)) {
        throw new CorruptError(`${what} field ${name} = ${content} is outside its legal range`);
    }
}
