/** A thread of a page without a server: it reads a mesh file with the loaders of three.js, and encodes it. */
import { BufferAttribute, BufferGeometry, Color, type InstancedMesh, type InterleavedBufferAttribute, type Mesh, MeshBasicMaterial, type Object3D, type SkinnedMesh } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { OBJLoader } from "three/examples/jsm/loaders/OBJLoader.js";
import { PLYLoader } from "three/examples/jsm/loaders/PLYLoader.js";
import { STLLoader } from "three/examples/jsm/loaders/STLLoader.js";
import { type AttributeInput, encodeHere, type MeshInput } from "../encode";

/** The page sends a `Job`, and gets reports: of progress, then of the result or an error. */
export interface Job {
    file: File;
    preset: string;
}
export interface Result {
    original: Uint8Array;
    stream: Uint8Array;
    notes: string[];
    less: boolean;
}
export type Report = { stage: string; share: number } | { error: string } | Result;

const ATTRIBUTES: Record<string, Pick<AttributeInput, "name" | "semantic">> = { normal: { name: "normal", semantic: "normal" }, uv: { name: "texcoord", semantic: "texcoord" }, color: { name: "color", semantic: "color" } };
const PLY = /^(x|y|z|n[xyz]|(diffuse_)?(red|green|blue)|[rgb]|[uvst]|texture_[uv]|vertex_ind(ex|ices))$/;
const FAR = 64; // diagonals from the origin, where single precision begins to count

const text = (bytes: ArrayBuffer): string => new TextDecoder().decode(bytes);

/** The meshes of a file; `lost` gets the names of what is left out. */
async function read(suffix: string, bytes: ArrayBuffer, lost: Set<string>): Promise<Object3D | BufferGeometry> {
    if (suffix === "stl") return new STLLoader().parse(bytes).deleteAttribute("normal");
    if (suffix === "obj") {
        const content = text(bytes);
        const scene = new OBJLoader().parse(content);
        if (/^(mtllib|usemtl) /m.test(content)) lost.add("materials");
        const isLit = /^vn /m.test(content);
        scene.traverse((each) => isLit || (each as Mesh).geometry?.deleteAttribute("normal")); // of faces, as the loader made them
        return scene;
    }
    if (suffix === "ply") {
        const header = text(bytes.slice(0, 1 << 16)).split("end_header")[0];
        const faces = Number(/^element face (\d+)/m.exec(header)?.[1] ?? 0);
        for (const [, name] of header.matchAll(/^property (?:list \w+ \w+|\w+) (\w+)/gm)) if (!PLY.test(name)) lost.add(name);
        const loader = new PLYLoader();
        const fine = /^property (uchar|uint8) red$/m.test(header); // the loader would round these as linear numbers
        if (fine) loader.setCustomPropertyNameMapping({ bytes: ["red", "green", "blue"] });
        const geometry = loader.parse(bytes);
        if (fine) {
            const [values, color] = [Float32Array.from(geometry.attributes.bytes.array, (value) => value / 255), new Color()];
            for (let i = 0; i < values.length; i += 3) color.fromArray(values, i).convertSRGBToLinear().toArray(values, i);
            geometry.setAttribute("color", new BufferAttribute(values, 3)).deleteAttribute("bytes");
        }
        if ((geometry.index?.count ?? 0) / 3 < faces) throw new Error("It has faces of more than four corners, which this page does not read.");
        return geometry.index ? geometry : new BufferGeometry(); // points
    }
    if (suffix !== "glb") throw new Error("This page reads PLY, OBJ, STL and GLB files.");
    const loader = new GLTFLoader().register(() => ({ name: "plain", loadMaterial: () => Promise.resolve(new MeshBasicMaterial()) }));
    const { scene, parser: { json } } = await loader.parseAsync(bytes, "");
    for (const part of ["materials", "animations", "skins", "cameras"]) if (json[part]?.length) lost.add(part);
    return scene;
}

/** The values of an attribute in some geometries, colors in sRGB, texture coordinates from the bottom. */
function joined(name: string, attributes: (BufferAttribute | InterleavedBufferAttribute)[], flipped: boolean): AttributeInput["values"] {
    const size = attributes[0].itemSize;
    const values = new Float32Array(size * attributes.reduce((sum, { count }) => sum + count, 0));
    const color = new Color();
    let at = 0;
    for (const attribute of attributes) {
        for (let i = 0; i < attribute.count; i++, at += size) {
            for (let c = 0; c < size; c++) values[at + c] = attribute.getComponent(i, c);
            if (name === "uv" && flipped) values[at + 1] = 1 - values[at + 1];
            if (name === "color") color.fromArray(values, at).convertLinearToSRGB().toArray(values, at);
        }
    }
    return name === "color" ? Uint8Array.from(values, (share) => Math.round(255 * Math.min(Math.max(share, 0), 1))) : values;
}

/** One mesh of all parts of a file. */
function meshOf(root: Object3D | BufferGeometry, isScene: boolean, lost: Set<string>): MeshInput {
    const parts: BufferGeometry[] = [];
    if (root instanceof BufferGeometry) parts.push(root);
    else {
        root.updateMatrixWorld(true);
        root.traverse((each) => {
            const { geometry, isMesh, matrixWorld } = each as Mesh;
            if (geometry && !isMesh) return void lost.add("points and lines");
            if (!geometry) return;
            if ((each as SkinnedMesh).isSkinnedMesh || geometry.morphAttributes.position) lost.add("poses");
            if ((each as InstancedMesh).isInstancedMesh) lost.add("copies of parts");
            const part = geometry.clone().applyMatrix4(matrixWorld);
            const { position } = part.attributes;
            if (matrixWorld.determinant() < 0 && position) part.setIndex([...(part.index?.array ?? Array(position.count).keys())].reverse());
            parts.push(part);
        });
    }
    const whole = parts.filter((part) => part.getAttribute("position")?.count > 0);
    if (whole.length === 0) throw new Error("It has no triangles.");
    let base = 0;
    const faces = whole.map(({ index, attributes: { position } }) => {
        const corners = index ? Uint32Array.from(index.array, (vertex) => base + vertex) : Uint32Array.from({ length: position.count }, (_, i) => base + i);
        base += position.count;
        return corners;
    });
    const all = Uint32Array.from({ length: faces.reduce((sum, { length }) => sum + length, 0) });
    faces.reduce((at, corners) => (all.set(corners, at), at + corners.length), 0);
    const attributes: AttributeInput[] = [];
    for (const name of new Set(whole.flatMap((part) => Object.keys(part.attributes)))) {
        const own = whole.flatMap((part) => part.attributes[name] ?? []);
        if (name === "position") continue;
        if (!ATTRIBUTES[name] || own.length < whole.length || own.some(({ itemSize }) => itemSize !== own[0].itemSize)) lost.add(name);
        else attributes.push({ ...ATTRIBUTES[name], values: joined(name, own, isScene), components: own[0].itemSize });
    }
    const positions = joined("position", whole.map((part) => part.attributes.position), false) as Float32Array;
    return { positions, faces: all, attributes, metadata: isScene ? { up: "y", unit: "meters" } : {} };
}

/** A note where coordinates are so far from the origin that single precision may round them visibly. */
function precisionOf({ positions }: MeshInput): string[] {
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    positions.forEach((x, i) => ([low[i % 3], high[i % 3]] = [Math.min(low[i % 3], x), Math.max(high[i % 3], x)]));
    const [far, diagonal] = [Math.max(...[...low, ...high].map(Math.abs)), Math.hypot(...low.map((x, d) => high[d] - x))];
    return far > FAR * diagonal ? ["Coordinates were read in single precision; bsm encode keeps more."] : [];
}

async function work({ file, preset }: Job, report: (report: Report) => void): Promise<void> {
    report({ stage: "reading", share: 0 });
    const suffix = /\.(\w+)$/.exec(file.name)?.[1].toLowerCase() ?? "";
    const lost = new Set<string>();
    const mesh = meshOf(await read(suffix, await file.arrayBuffer(), lost), suffix === "glb", lost);
    const told = (from: number) => (part: number) => report({ stage: "encoding", share: from + part / 2 });
    const lossless = preset === "lossless";
    const stream = await encodeHere(mesh, { ...(lossless ? { lossless } : { bits: parseInt(preset) }), onProgress: told(0) });
    const original = lossless ? stream : await encodeHere(mesh, { lossless: true, onProgress: told(0.5) });
    const missing = lost.size > 0 ? [`Left out: ${[...lost].join(", ")}. bsm encode keeps more.`] : [];
    report({ original, stream, notes: [...missing, ...precisionOf(mesh)], less: lost.size > 0 });
}

self.onmessage = ({ data }: MessageEvent<Job>): void => {
    const report = (report: Report): void => self.postMessage(report);
    work(data, report).catch((error: unknown) => report({ error: error instanceof Error ? error.message : String(error) }));
};
