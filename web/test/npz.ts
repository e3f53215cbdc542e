/** The arrays of an npz file: a zip of npy files, stored or deflated. */
import { inflateRawSync } from "node:zlib";

export interface NumpyArray {
    shape: number[];
    values: InstanceType<(typeof ARRAYS)[string]>;
}

type Make<Values> = new (body: ArrayBuffer) => Values;
const ARRAYS: Record<
    string,
    | Make<Float64Array>
    | Make<Float32Array>
    | Make<Int32Array>
    | Make<Uint32Array>
    | Make<Int16Array>
    | Make<Uint16Array>
    | Make<Int8Array>
    | Make<Uint8Array>
> = {
    "<f8": Float64Array,
    "<f4": Float32Array,
    "<i4": Int32Array,
    "<u4": Uint32Array,
    "<i2": Int16Array,
    "<u2": Uint16Array,
    "|i1": Int8Array,
    "|u1": Uint8Array,
};

export function readNpz(data: Buffer): Record<string, NumpyArray> {
    const arrays: Record<string, NumpyArray> = {};
    let at = data.readUInt32LE(data.lastIndexOf("PK\x05\x06") + 16);
    while (data.readUInt32LE(at) === 0x02014b50) {
        const [method, size, nameSize] = [
            data.readUInt16LE(at + 10),
            data.readUInt32LE(at + 20),
            data.readUInt16LE(at + 28),
        ];
        const name = data.toString("utf8", at + 46, at + 46 + nameSize);
        const local = data.readUInt32LE(at + 42);
        const start = local + 30 + data.readUInt16LE(local + 26) + data.readUInt16LE(local + 28);
        const stored = data.subarray(start, start + size);
        arrays[name.replace(/\.npy$/, "")] = readNpy(method === 0 ? stored : inflateRawSync(stored));
        at += 46 + nameSize + data.readUInt16LE(at + 30) + data.readUInt16LE(at + 32);
    }
    return arrays;
}

function readNpy(data: Buffer): NumpyArray {
    const [start, size] = data[6] === 1 ? [10, data.readUInt16LE(8)] : [12, data.readUInt32LE(8)];
    const header = data.toString("latin1", start, start + size);
    const kind = /'descr': '([^']+)'/.exec(header)?.[1];
    const shape = /'shape': \(([^)]*)\)/
        .exec(header)![1]
        .split(",")
        .filter((part) => part.trim())
        .map(Number);
    const body = new Uint8Array(data.subarray(start + size)).buffer;
    const array = ARRAYS[kind ?? ""];
    if (!array) throw new Error(`an npy file of type ${kind}`);
    return { shape, values: new array(body) };
}
