/** Meshes to streams: `encode` runs the encoder in a worker, `encodeHere` where it is called. */
import type { BufferGeometry, Object3D } from "three";
import { EncodeError, encodeWith, type Answer, type EncodeOptions, type MeshInput } from "./encoding";
import { compiled, once, resolved } from "./fetched";
import { sayAlone, started } from "./threads";

export { EncodeError, encodeWith };
export type { AttributeInput, EncodeOptions, MeshInput, Quality } from "./encoding";

/** A `BufferGeometry` or an `Object3D` of three.js. */
export type Drawn = { readonly isBufferGeometry: true } | { readonly isObject3D: true };

type Bytes = Uint8Array<ArrayBuffer>;
type Encodable = MeshInput | Drawn;
const [THREAD, HERE] = ["encode-worker.js", import.meta.url];
const load = once((url: string) => compiled(new URL(url)));

/** The compiled encoder of meshes, or of sequences. */
export async function loadEncoder(wasm?: EncodeOptions["wasm"], moves = false): Promise<WebAssembly.Module> {
    if (wasm instanceof WebAssembly.Module) return wasm;
    const given =
        wasm ?? (moves ? new URL("./encode-moving.wasm", import.meta.url) : new URL("./encode.wasm", import.meta.url));
    if (typeof given !== "string" && !(given instanceof URL)) return WebAssembly.compile(given);
    return load(resolved(given).href);
}

/** The encoder that a mesh needs, and the mesh as it is given, or as three.js draws it, which is there then. */
async function prepared(input: Encodable, { onNote, wasm }: EncodeOptions): Promise<[WebAssembly.Module, MeshInput]> {
    const isMesh = "positions" in input;
    const mesh = isMesh ? input : (await import("./content")).meshOf(input as BufferGeometry | Object3D, onNote);
    return [await loadEncoder(wasm, Boolean(mesh.frames)), mesh];
}

/** Encode in this thread, which waits for that. */
export async function encodeHere(input: Encodable, options: EncodeOptions = {}): Promise<Bytes> {
    return encodeWith(...(await prepared(input, options)), options);
}

/**
 * Encode in a worker: the page goes on meanwhile. Where there are no workers, in this thread. Aborting ends the worker at once.
 *
 *     const bytes = await encode(mesh.geometry, { bits: 14, onProgress: console.log });
 */
export async function encode(input: Encodable, options: EncodeOptions = {}): Promise<Bytes> {
    const { onProgress, onNote: _, signal, wasm: __, ...plain } = options;
    signal?.throwIfAborted();
    const [module, mesh] = await prepared(input, options);
    const alone = (): Bytes => (sayAlone(), encodeWith(module, mesh, options));
    const worker = started(
        () => new Worker(new URL("./encode-worker.js", import.meta.url), { type: "module" }),
        () => new URL(THREAD, HERE),
    );
    if (!worker) return alone();
    try {
        const bytes = await new Promise<Bytes | undefined>((resolve, reject) => {
            signal?.addEventListener("abort", () => reject(signal.reason as Error), { once: true });
            let begun = false;
            worker.onerror = ({ message }) => {
                if (begun) reject(new Error(message || "the worker of the encoder was stopped"));
                else resolve(undefined);
            };
            worker.onmessage = ({ data }: MessageEvent<Answer>) => {
                begun = true;
                if ("part" in data) onProgress?.(data.part);
                else if ("bytes" in data) resolve(data.bytes);
                else reject(new EncodeError(data.message, data.status));
            };
            worker.postMessage({ module, mesh, options: plain });
        });
        return bytes ?? alone();
    } finally {
        worker.terminate();
    }
}

/**
 * Writes what an object of three.js draws, with the methods of `DRACOExporter` and `GLTFExporter`.
 *
 *     const bytes = await new BSMExporter().parseAsync(mesh, { bits: 14 });
 */
export class BSMExporter {
    parse(
        object: Drawn,
        onDone: (bytes: Bytes) => void,
        onError: (error: unknown) => void = console.error,
        options: EncodeOptions = {},
    ): void {
        this.parseAsync(object, options).then(onDone, onError);
    }

    async parseAsync(object: Drawn, options: EncodeOptions = {}): Promise<Bytes> {
        if (!("isBufferGeometry" in object || "isObject3D" in object))
            throw new EncodeError("BSMExporter writes geometries, and objects with meshes", 2);
        return encode(object, options);
    }
}
