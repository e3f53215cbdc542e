/** Meshes to streams: the encoder in C, compiled to WebAssembly. `encode` runs it in a worker, `encodeHere` where it is called. */
import { compiled } from "./fetched";

/** The quality of an attribute: "exact", a number of bits, the largest error, or of normals degrees or "recompute". */
export type Quality = "exact" | "recompute" | { bits: number } | { bound: number } | { percent: number } | { degrees: number };

/** Values of vertices, of corners or of faces, one after the other. */
export interface AttributeInput {
    name: string;
    values: Uint8Array | Int8Array | Uint16Array | Int16Array | Uint32Array | Int32Array | Float32Array | Float64Array;
    /** Numbers of a value, 1 to 4. */
    components: number;
    domain?: "vertex" | "corner" | "face";
    semantic?: "generic" | "color" | "normal" | "texcoord";
    /** Of corners: the value of each. */
    indices?: Uint32Array;
    quality?: Quality;
}

export interface MeshInput {
    positions: Float32Array | Float64Array;
    /** Three vertices of each face. */
    faces: Uint32Array;
    attributes?: readonly AttributeInput[];
    metadata?: Record<string, string | number | Uint8Array>;
}

/** What `BufferGeometry` of three.js has of this. */
export interface GeometryInput {
    index: { array: ArrayLike<number> } | null;
    attributes: Record<string, { array: ArrayLike<number>; itemSize: number; count: number; normalized?: boolean; isInterleavedBufferAttribute?: boolean; getComponent?(index: number, component: number): number }>;
}

export interface EncodeOptions {
    /** Bits of positions along the longest side, 1 to 20; 14 by default. */
    bits?: number;
    /** Positions at `origin` + k * `cell`, in place of bits. */
    cell?: number;
    origin?: readonly [number, number, number];
    /** Every position and attribute to the bit, in single precision. */
    lossless?: boolean;
    /** The order of vertices and faces, and copies of vertices. */
    keepOrder?: boolean;
    /** Quick to decode, and some more bytes. */
    quick?: boolean;
    /** Of attributes by name. */
    qualities?: Record<string, Quality>;
    /** Is told the finished part, from 0 to 1. */
    onProgress?: (part: number) => void;
    signal?: AbortSignal;
    /** Where encode.wasm is; by default beside this module. */
    wasm?: string | URL | BufferSource | WebAssembly.Module;
}

/** The mesh cannot be encoded so: the message says why. */
export class EncodeError extends Error {
    override readonly name = "EncodeError";
    constructor(message: string, readonly status: number) {
        super(message);
    }
}

interface Exports {
    memory: WebAssembly.Memory;
    page_take(size: number): number;
    page_give(memory: number, size: number): void;
    encode_begin(vertices: number, faces: number, positions: number, single: number, corners: number): void;
    encode_attribute(name: number, domain: number, semantic: number, kind: number, components: number, rows: number, values: number, indices: number, quality: number, amount: number): number;
    encode_metadata(name: number, type: number, value: number, bytes: number, size: number): number;
    encode_run(positions: number, bits: number, cell: number, x: number, y: number, z: number, keepOrder: number, quick: number): number;
    encode_message(): number;
    encode_bytes(): number;
    encode_size(): number;
    encode_end(): void;
}

const KINDS = [Uint8Array, Int8Array, Uint16Array, Int16Array, Uint32Array, Int32Array, Float32Array, Float64Array];
const DOMAINS = ["vertex", "corner", "face"];
const SEMANTICS = ["generic", "color", "normal", "texcoord"];

function qualityOf(quality: Quality | undefined): [number, number] {
    if (quality === undefined) return [0, 0];
    if (quality === "exact") return [1, 0];
    if (quality === "recompute") return [6, 0];
    if ("bits" in quality) return [2, quality.bits];
    if ("bound" in quality) return [3, quality.bound];
    if ("percent" in quality) return [4, quality.percent];
    return [5, quality.degrees];
}

/** Positions, faces and attributes of a geometry of three.js; without an index, each three vertices are a face. */
export function meshOf(geometry: GeometryInput): MeshInput {
    const numbers = (name: string): AttributeInput["values"] => {
        const { array, itemSize, count, getComponent, isInterleavedBufferAttribute } = geometry.attributes[name];
        if (!isInterleavedBufferAttribute) return array as AttributeInput["values"];
        const attribute = geometry.attributes[name] as Required<(typeof geometry.attributes)[string]>;
        if (!getComponent) throw new EncodeError(`the attribute ${name} is interleaved and cannot be read`, 2);
        return Float32Array.from({ length: count * itemSize }, (_, i) => attribute.getComponent(Math.floor(i / itemSize), i % itemSize));
    };
    const { position } = geometry.attributes;
    if (!position || position.itemSize !== 3) throw new EncodeError("the geometry has no positions", 2);
    const given = numbers("position");
    const semantic = (name: string): AttributeInput["semantic"] => (name === "normal" ? "normal" : name.startsWith("color") ? "color" : /^uv\d*$/.test(name) ? "texcoord" : "generic");
    const others = Object.keys(geometry.attributes).filter((name) => name !== "position" && geometry.attributes[name].itemSize <= 4);
    return {
        positions: given instanceof Float64Array ? given : Float32Array.from(given),
        faces: geometry.index ? Uint32Array.from(geometry.index.array) : Uint32Array.from({ length: position.count }, (_, i) => i),
        attributes: others.map((name) => ({ name, values: numbers(name), components: geometry.attributes[name].itemSize, semantic: semantic(name) })),
    };
}

/** Encode in this thread. */
export function encodeWith(module: WebAssembly.Module, mesh: MeshInput, options: EncodeOptions = {}): Uint8Array {
    let wrong: unknown;
    const progress = (part: number): number => {
        try {
            options.onProgress?.(part);
        } catch (error) {
            wrong = error;
            return 1;
        }
        return options.signal?.aborted ? 1 : 0;
    };
    const calls = new WebAssembly.Instance(module, { page: { progress } }).exports as unknown as Exports;
    const put = (values: ArrayBufferView, zero = false): number => {
        const size = values.byteLength + (zero ? 1 : 0);
        const at = calls.page_take(size);
        if (at === 0) throw new EncodeError("out of memory", 8);
        const to = new Uint8Array(calls.memory.buffer, at, size);
        to.set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength));
        if (zero) to[size - 1] = 0;
        return at;
    };
    const text = (value: string): number => put(new TextEncoder().encode(value), true);
    const refused = (what: string): never => {
        throw new EncodeError(what, 2);
    };
    const { positions, faces, attributes = [], metadata = {} } = mesh;
    if (positions.length % 3 || faces.length % 3) refused("positions and faces are three numbers each");
    const places = put(positions);
    const wide = positions instanceof Float64Array;
    calls.encode_begin(positions.length / 3, faces.length / 3, wide ? places : 0, wide ? 0 : places, put(faces));
    for (const { name, values, components, domain = "vertex", semantic = "generic", indices, quality } of attributes) {
        const kind = KINDS.findIndex((type) => values instanceof type || (type === Uint8Array && values instanceof Uint8ClampedArray));
        const [way, amount] = qualityOf(options.qualities?.[name] ?? quality);
        if (kind < 0 || name.includes("\0") || values.length % components) refused(`the attribute ${name} has values of an unknown kind, or not ${components} of each`);
        const numbers = [DOMAINS.indexOf(domain), SEMANTICS.indexOf(semantic), kind, components, values.length / components] as const;
        if (!calls.encode_attribute(text(name), ...numbers, put(values), indices ? put(indices) : 0, way, amount)) refused("too many attributes");
    }
    for (const [name, value] of Object.entries(metadata)) {
        const bytes = typeof value === "number" ? new Uint8Array() : typeof value === "string" ? new TextEncoder().encode(value) : value;
        const type = typeof value === "number" ? (Number.isSafeInteger(value) ? 1 : 2) : typeof value === "string" ? 3 : 4;
        if (!calls.encode_metadata(text(name), type, typeof value === "number" ? value : 0, put(bytes), bytes.length)) refused("too much metadata");
    }
    const { bits = 0, cell = 0, origin = [0, 0, 0], lossless = false, keepOrder = false, quick = false } = options;
    const status = calls.encode_run(lossless ? 2 : cell > 0 ? 1 : 0, bits, cell, ...origin, Number(keepOrder), Number(quick));
    if (wrong) throw wrong;
    options.signal?.throwIfAborted();
    if (status !== 0) {
        const bytes = new Uint8Array(calls.memory.buffer, calls.encode_message());
        throw new EncodeError(new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0))), status);
    }
    const at = calls.encode_bytes();
    return new Uint8Array(calls.memory.buffer).slice(at, at + calls.encode_size());
}

let loaded: Promise<WebAssembly.Module> | undefined;

/** The compiled encoder. */
export function loadEncoder(wasm: EncodeOptions["wasm"] = new URL("./encode.wasm", import.meta.url)): Promise<WebAssembly.Module> {
    if (wasm instanceof WebAssembly.Module) return Promise.resolve(wasm);
    if (typeof wasm !== "string" && !(wasm instanceof URL)) return WebAssembly.compile(wasm);
    loaded ??= compiled(new URL(wasm, globalThis.document?.baseURI ?? globalThis.location?.href));
    loaded.catch(() => (loaded = undefined));
    return loaded;
}

/** Encode in this thread, which waits for that. */
export async function encodeHere(input: MeshInput | GeometryInput, options: EncodeOptions = {}): Promise<Uint8Array> {
    return encodeWith(await loadEncoder(options.wasm), "positions" in input ? input : meshOf(input), options);
}

type Answer = { part: number } | { bytes: Uint8Array } | { message: string; status: number };

/**
 * Encode in a worker: the page goes on meanwhile. Where there are no workers, in this thread. Aborting ends the worker at once.
 *
 *     const bytes = await encode(mesh.geometry, { bits: 14, onProgress: console.log });
 */
export async function encode(input: MeshInput | GeometryInput, options: EncodeOptions = {}): Promise<Uint8Array> {
    const { onProgress, signal, wasm, ...plain } = options;
    signal?.throwIfAborted();
    if (typeof Worker === "undefined") return encodeHere(input, options);
    const mesh = "positions" in input ? input : meshOf(input);
    const module = await loadEncoder(wasm);
    const worker = new Worker(new URL("./encode-worker.js", import.meta.url), { type: "module" });
    try {
        return await new Promise<Uint8Array>((resolve, reject) => {
            signal?.addEventListener("abort", () => reject(signal.reason as Error), { once: true });
            worker.onerror = (event) => reject(new Error(event.message || "the worker of the encoder could not start"));
            worker.onmessage = ({ data }: MessageEvent<Answer>) => {
                if ("part" in data) onProgress?.(data.part);
                else if ("bytes" in data) resolve(data.bytes);
                else reject(new EncodeError(data.message, data.status));
            };
            worker.postMessage({ module, mesh, options: plain });
        });
    } finally {
        worker.terminate();
    }
}

/** A worker, for one mesh. */
export function serve(): void {
    const scope = globalThis as unknown as { onmessage: unknown; postMessage(answer: Answer, transferred?: Transferable[]): void };
    scope.onmessage = ({ data: { module, mesh, options } }: MessageEvent<{ module: WebAssembly.Module; mesh: MeshInput; options: EncodeOptions }>) => {
        try {
            const bytes = encodeWith(module, mesh, { ...options, onProgress: (part) => scope.postMessage({ part }) });
            scope.postMessage({ bytes }, [bytes.buffer]);
        } catch (error) {
            scope.postMessage({ message: error instanceof Error ? error.message : String(error), status: error instanceof EncodeError ? error.status : 1 });
        }
    };
}

/**
 * Writes the geometry of a mesh of three.js, with the methods of `DRACOExporter` and `GLTFExporter`.
 *
 *     const bytes = await new BSMExporter().parseAsync(mesh, { bits: 14 });
 */
export class BSMExporter {
    /** Encode, and call `onDone` with the stream, or `onError`. */
    parse(object: { geometry?: GeometryInput } | GeometryInput, onDone: (bytes: Uint8Array) => void, onError?: (error: unknown) => void, options: EncodeOptions = {}): void {
        this.parseAsync(object, options).then(onDone, onError ?? ((error: unknown) => console.error(error)));
    }

    parseAsync(object: { geometry?: GeometryInput } | GeometryInput, options: EncodeOptions = {}): Promise<Uint8Array> {
        const geometry = "geometry" in object ? object.geometry : object;
        if (!geometry || !("attributes" in geometry)) return Promise.reject(new EncodeError("BSMExporter writes meshes with a geometry", 2));
        return encode(geometry, options);
    }
}
