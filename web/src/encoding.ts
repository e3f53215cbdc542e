/** The encoder in C, compiled to WebAssembly: what its worker runs, and who encodes in the calling thread. */
import { DOMAINS, KINDS, SEMANTICS, type Attribute } from "./attributes";
import { messageOf } from "./fetched";

/** The quality of an attribute: "exact", a number of bits, the largest error, or of normals degrees or "recompute". */
export type Quality =
    "exact" | "recompute" | { bits: number } | { bound: number } | { percent: number } | { degrees: number };

/** Values of vertices, of corners or of faces, one after the other. */
export interface AttributeInput {
    name: string;
    /** A typed array as it is; other numbers in single precision. */
    values: ArrayLike<number>;
    /** Numbers of a value, 1 to 4. */
    components: number;
    domain?: Attribute["domain"];
    semantic?: Attribute["semantic"];
    /** Of corners: the value of each. */
    indices?: ArrayLike<number>;
    quality?: Quality;
}

export interface MeshInput {
    /** Of a sequence, those of its first frame, then those of the next one, and so on. */
    positions: ArrayLike<number>;
    /** Frames of a sequence: each coordinate keeps to half a cell of the grid; attributes do not change. */
    frames?: number;
    /** Three vertices of each face. */
    faces: ArrayLike<number>;
    attributes?: readonly AttributeInput[];
    metadata?: Record<string, string | number | Uint8Array>;
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
    qualities?: Record<string, Quality>;
    /** Receives a note for each thing of a geometry or an object that is left out; without it, the console does. */
    onNote?: (note: string) => void;
    /** Receives the finished part, from 0 to 1. */
    onProgress?: (part: number) => void;
    signal?: AbortSignal;
    /** Where encode.wasm is, or encode-moving.wasm for sequences; by default beside this module. */
    wasm?: string | URL | BufferSource | WebAssembly.Module;
}

/** The mesh cannot be encoded so: the message says why. */
export class EncodeError extends Error {
    override readonly name = "EncodeError";
    constructor(
        message: string,
        readonly status: number,
    ) {
        super(message);
    }
}

/** The functions of `library/wasm/encode.c`. */
type EncoderCalls = { memory: WebAssembly.Memory; make_priors?: () => void } & Record<
    `page_${string}` | `encode_${string}`,
    (...numbers: number[]) => number
>;

/** As `bsmenc_quality` numbers them. */
const WAYS = ["default", "exact", "bits", "bound", "percent", "degrees", "recompute"];

/** The kind of an array, of any realm; undefined where C takes no such numbers. */
export function kindOf(values: ArrayLike<number>): Attribute["kind"] | undefined {
    const name = (values as Float32Array | null)?.[Symbol.toStringTag]?.replace("Clamped", "").toLowerCase();
    return KINDS.find((kind) => name === `${kind}array`);
}

export function refuse(what: string): never {
    throw new EncodeError(what, 2);
}

/** Refuse all but arrays of numbers. */
function requireNumbers(values: ArrayLike<unknown> | null | undefined, what: string): void {
    if (kindOf(values as ArrayLike<number>)) return;
    if (!values || Array.from(values).some((value) => typeof value !== "number"))
        refuse(`${what} are not an array of numbers`);
}

/** Numbers of vertices or values, none of them changed on its way to C. */
export function wholes(values: ArrayLike<number>, what: string): Uint32Array {
    requireNumbers(values, what);
    if (kindOf(values) === "uint32") return values as Uint32Array;
    for (let i = 0; i < values.length; i++)
        if (values[i] !== values[i] >>> 0) refuse(`${what} are whole numbers from 0 on, not ${values[i]}`);
    return Uint32Array.from(values);
}

export function encodeWith(
    module: WebAssembly.Module,
    mesh: MeshInput,
    options: EncodeOptions = {},
): Uint8Array<ArrayBuffer> {
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
    const calls = new WebAssembly.Instance(module, { page: { progress } }).exports as unknown as EncoderCalls;
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
    const { positions: given, frames = 0, attributes = [], metadata = {} } = mesh;
    const faces = wholes(mesh.faces, "vertices of faces");
    requireNumbers(given, "positions");
    const isSingle = kindOf(given) === "float32";
    const positions = isSingle || kindOf(given) === "float64" ? (given as Float64Array) : Float64Array.from(given);
    const vertices = positions.length / 3 / (frames || 1);
    if (![vertices, frames, faces.length / 3].every(Number.isSafeInteger))
        refuse("positions, in each frame, and faces are three numbers each");
    if (frames && !calls.make_priors) refuse("sequences need encode-moving.wasm");
    calls.make_priors?.();
    const places = put(positions);
    calls.encode_begin(vertices, faces.length / 3, isSingle ? 0 : places, isSingle ? places : 0, put(faces), frames);
    for (const attribute of attributes) {
        const { name, values: numbers, components, domain = "vertex", semantic = "generic", indices } = attribute;
        requireNumbers(numbers, `values of ${name}`);
        const values = (kindOf(numbers) ? numbers : Float32Array.from(numbers)) as Float32Array;
        const asked = options.qualities?.[name] ?? attribute.quality ?? "default";
        const [way, amount] = typeof asked === "string" ? [asked, 0] : (Object.entries(asked)[0] ?? ["", 0]);
        const rows = indices && domain === "corner" ? indices.length : values.length / components;
        if (rows !== { vertex: vertices, corner: faces.length, face: faces.length / 3 }[domain])
            refuse(`the attribute ${name} has not ${components} numbers for each ${domain}`);
        const isAmount = way === "bits" ? Number.isInteger(amount) : Number.isFinite(amount);
        if (name.includes("\0") || !isAmount || !WAYS.includes(way))
            refuse(`the attribute ${name.replaceAll("\0", "?")} has a name or a quality that nothing can have`);
        const kinds = [DOMAINS.indexOf(domain), SEMANTICS.indexOf(semantic), KINDS.indexOf(kindOf(values)!)];
        const sizes = [components, values.length / components];
        const places = [put(values), indices ? put(wholes(indices, `indices of ${name}`)) : 0];
        if (!calls.encode_attribute(text(name), ...kinds, ...sizes, ...places, WAYS.indexOf(way), amount))
            refuse("too many attributes");
    }
    for (const [name, value] of Object.entries(metadata)) {
        if (typeof value !== "number" && typeof value !== "string" && kindOf(value) !== "uint8")
            refuse(`the metadata ${name} are neither a number nor a string nor bytes`);
        const isNumber = typeof value === "number";
        const bytes = typeof value === "object" ? value : new TextEncoder().encode(isNumber ? "" : value);
        const type = isNumber ? (Number.isSafeInteger(value) ? 1 : 2) : typeof value === "string" ? 3 : 4;
        if (!calls.encode_metadata(text(name), type, isNumber ? value : 0, put(bytes), bytes.length))
            refuse("too much metadata");
    }
    const { bits = 0, cell = 0, origin = [0, 0, 0], lossless = false, keepOrder = false, quick = false } = options;
    if (!Number.isInteger(bits) || ![cell, ...origin].every(Number.isFinite))
        refuse("bits is a whole number, cell and origin are finite numbers");
    const way = lossless ? 2 : cell > 0 ? 1 : 0;
    const status = calls.encode_run(way, bits, cell, ...origin, Number(keepOrder), Number(quick));
    if (wrong) throw wrong;
    options.signal?.throwIfAborted();
    if (status !== 0) {
        const bytes = new Uint8Array(calls.memory.buffer, calls.encode_message());
        throw new EncodeError(new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0))), status);
    }
    const at = calls.encode_bytes();
    return new Uint8Array(calls.memory.buffer).slice(at, at + calls.encode_size());
}

type Question = { module: WebAssembly.Module; mesh: MeshInput; options: EncodeOptions };
export type Answer = { part: number } | { bytes: Uint8Array<ArrayBuffer> } | { message: string; status: number };

/** A worker, for one mesh. */
export function serve(): void {
    const scope = globalThis as unknown as {
        onmessage: unknown;
        postMessage(answer: Answer, transferred?: Transferable[]): void;
    };
    scope.onmessage = ({ data: { module, mesh, options } }: MessageEvent<Question>) => {
        try {
            const bytes = encodeWith(module, mesh, { ...options, onProgress: (part) => scope.postMessage({ part }) });
            scope.postMessage({ bytes }, [bytes.buffer]);
        } catch (error) {
            const status = error instanceof EncodeError ? error.status : 1;
            scope.postMessage({ message: messageOf(error), status });
        }
    };
}
