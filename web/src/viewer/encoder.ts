/** A thread of a page without a server: it reads files with the loaders of three.js, and encodes what they hold. */
import { Drawing, type Picture } from "../drawing";
import { EncodeError, kindOf, type EncodeOptions } from "../encoding";
import { firstsOf } from "../files/polygons";
import { messageOf } from "../fetched";
import type { Header } from "../header";
import { Engine } from "../engine";
import { Kernels, openDesk } from "../index";
import { Pool } from "../pool";
import { suffixOf, type Reading } from "../reading";
import { encodeHere, inSingle, readFrames, readOne, shownAmong } from "../together";
import type { Content, Layer } from "./facts";

const FINEST = { still: 20, moving: 16 }; // bits of a grid

/** The page sends a `Job`, and gets reports: of progress, then of the result or an error. */
export interface Job {
    files: File[];
    preset: string;
    /** The decoder, for scenes whose geometry is streams. */
    kernels: WebAssembly.Module;
    /** Where edges are sharp, as threads are told. */
    crease: number;
}
export type Status = { stage: string; share: number } | { error: string } | { content: Content };

/** A mesh or sequence as it is drawn, and what of it can change hands. */
function drawn(
    { positions, faces, frames = 0, attributes = [], metadata = {} }: Reading["mesh"],
    kernels: WebAssembly.Module,
    crease: number,
): { pictures: Picture[]; moved: Transferable[] } {
    const [pictures, moved]: [Picture[], Transferable[]] = [[], []];
    const engine = new Engine(new Kernels(kernels), {}, false);
    const show = (picture: Picture, buffers: Transferable[] = []): void => {
        pictures.push(picture);
        moved.push(...buffers);
    };
    const drawing = new Drawing(false, {}, engine, show, crease);
    const size = positions.length / Math.max(frames, 1);
    const [firsts, none] = [firstsOf(positions, size), new Int32Array(0)];
    drawing.accept({ type: "header", header: { vertices: new Set(firsts).size, faces: faces.length / 3 } as Header });
    drawing.accept({ type: "metadata", entries: new Map(Object.entries(metadata)) });
    const loose = { vertices: none, positions: new Float64Array(0) };
    const corners = Int32Array.from(faces, (vertex) => firsts[vertex]);
    drawing.accept({ type: "connectivity", faces: corners, vertices: size / 3, loose });
    for (const { name, values, components, domain = "vertex", semantic = "generic" } of attributes) {
        const [ofVertex, kind] = [domain === "vertex", kindOf(values) ?? "float32"];
        const where = ofVertex ? { domain: "corner" as const, indices: Int32Array.from(faces) } : { domain };
        const numbers = Float64Array.from(values);
        drawing.accept({ type: "attribute", name, semantic, components, kind, values: numbers, ...where });
    }
    for (let index = 0; index < frames; index++) {
        const own = Float64Array.from(positions.subarray(index * size, (index + 1) * size));
        drawing.accept({ type: "frame", index, positions: own, attributes: [] });
    }
    const still = frames > 0 ? undefined : Float64Array.from(positions);
    drawing.accept({ type: "end", missing: none, degraded: none, positions: still });
    engine.release();
    return { pictures, moved };
}

/** Encode to the bit or, where single precision is coarser and of sequences that are compared, on the finest grid. */
async function exact(
    mesh: Reading["mesh"],
    encode: (options: EncodeOptions, mesh?: Reading["mesh"]) => Promise<Uint8Array>,
    compares: boolean,
): Promise<Uint8Array> {
    if (mesh.frames && compares) return encode({ bits: FINEST.moving });
    return encode({ lossless: true }, inSingle(mesh)).catch((error) =>
        error instanceof EncodeError && error.status === 10 ? encode({ bits: FINEST.still }) : Promise.reject(error),
    );
}

async function work(
    { files, preset, kernels, crease }: Job,
    report: (report: Status, moved?: Transferable[]) => void,
): Promise<void> {
    const [begin, all] = [performance.now(), shownAmong(files) as File[]];
    const source = { worker: () => undefined, kernels: async () => kernels, local: async () => ({ openDesk }) };
    const pool = new Pool(source);
    if (all.length === 0)
        throw new Error("There is no PLY, OBJ, STL, GLB or glTF file, and no PC2 or MDD file with its mesh.");
    const [isPair, transfer, notes, used] = [all.length === 2, [] as Transferable[], [] as string[], new Set<string>()];
    const layerOf = async (file: File): Promise<{ name: string; layers: Layer[]; less: boolean }> => {
        const own = file.name.replace(/^.*\//, "");
        const name = all.length > 2 ? own.replace(/[\W_]*\d*\.\w+$/, "") || "sequence" : own;
        const kind = { title: suffixOf(file).toUpperCase(), detail: isPair ? name : preset };
        used.add(file.name);
        if (kind.title === "BSM") {
            const bytes = new Uint8Array(await file.arrayBuffer());
            return { name, less: false, layers: [{ ...kind, size: file.size, bytes }] };
        }
        report({ stage: "reading", share: 0 });
        const { mesh, ...rest } = await (all.length > 2
            ? readFrames(all, undefined, (share) => report({ stage: "reading", share }), pool)
            : readOne(file, files, pool));
        const encode = (options: EncodeOptions, own = mesh): Promise<Uint8Array> =>
            encodeHere(own, { ...options, onProgress: (share) => report({ stage: "encoding", share }) });
        const isExact = isPair || preset === "lossless";
        const encoded = (): Promise<Uint8Array> =>
            isExact ? exact(mesh, encode, isPair) : encode({ bits: parseInt(preset) });
        const bytes = isPair && file === all[0] ? undefined : await encoded();
        const { pictures, moved } = drawn(mesh, kernels, crease);
        transfer.push(...moved);
        rest.used.forEach((each) => used.add(each));
        notes.push(...rest.notes.map((note) => (isPair ? `${name}: ${note}` : note)));
        const size = files.reduce((sum, each) => sum + (rest.used.includes(each.name) ? each.size : 0), 0);
        if (isPair) return { name, less: rest.less, layers: [{ ...kind, size, bytes, pictures }] };
        const original = { title: "Original", detail: "", size, pictures };
        const stream = { title: "BSM", detail: preset, size: bytes!.length, bytes };
        return { name, less: rest.less, layers: [original, stream] };
    };
    const shown = [];
    for (const file of all.slice(0, isPair ? 2 : 1)) shown.push(await layerOf(file));
    const layers = shown.flatMap((each) => each.layers);
    if (isPair) layers[0].title = "Original";
    const seconds = isPair ? undefined : (performance.now() - begin) / 1000;
    const less = shown.some((each) => each.less);
    const unused = files.flatMap((file) => (used.has(file.name) ? [] : file.name));
    const facts = { notes, less, seconds, used: [...used], unused };
    report({ content: { name: shown.at(-1)!.name, main: layers.length - 1, layers, facts } }, transfer);
}

self.onmessage = ({ data }: MessageEvent<Job>): void => {
    const report = (report: Status, moved: Transferable[] = []): void => self.postMessage(report, { transfer: moved });
    work(data, report).catch((error: unknown) => report({ error: messageOf(error) }));
};
