/** Mesh files, read with the loaders of three.js: for the page without a server, and for `bsm-encode`. */
import { BufferAttribute, BufferGeometry, Color, Group, type InstancedMesh, type Material, Mesh, MeshBasicMaterial, type Object3D, type SkinnedMesh } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { PLYLoader } from "three/addons/loaders/PLYLoader.js";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
import { meshOf } from "./content";
import { EncodeError, type EncodeOptions, type MeshInput } from "./encoding";

export { encodeHere } from "./encode";

/** A mesh, what is to be said of it, and whether something of the file is left out. */
export interface Reading {
    mesh: MeshInput & { positions: Float32Array | Float64Array };
    notes: string[];
    less: boolean;
}

const NAMES: Record<string, string> = { normal: "normal", uv: "texcoord", color: "color" };
const PLY = /^(x|y|z|n[xyz]|(diffuse_)?(red|green|blue)|[rgb]|[uvst]|texture_[uv]|vertex_ind(ex|ices))$/;
const VERTEX = /^(\s*v(?:ertex)?)\s+(\S+)\s+(\S+)\s+(\S+)/gm;
const FAR = 64; // diagonals from the origin, where single precision begins to count

const text = (bytes: ArrayBuffer): string => new TextDecoder().decode(bytes);

/** The text of a file whose vertices have lines of their own, with these around the origin if single precision, to which loaders round, is too coarse; and where they were. */
function nearOrigin(content: string): { content: string; middle?: number[] } {
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (const [, , ...row] of content.matchAll(VERTEX)) row.map(Number).forEach((x, d) => ([low[d], high[d]] = [Math.min(low[d], x), Math.max(high[d], x)]));
    const far = Math.max(...[...low, ...high].map(Math.abs));
    if (!(far > FAR * Math.hypot(...low.map((x, d) => high[d] - x)) && far < Infinity)) return { content };
    const middle = low.map((x, d) => Math.round((x + high[d]) / 2));
    return { middle, content: content.replace(VERTEX, (_, name: string, ...row: string[]) => [name, ...middle.map((x, d) => Number(row[d]) - x)].join(" ")) };
}

/** The meshes of a file, and where their origin is; `lost` gets the names of what is left out. */
async function read(suffix: string, bytes: ArrayBuffer, lost: Set<string>): Promise<{ root: Object3D | BufferGeometry; middle?: number[] }> {
    if (suffix === "stl") {
        const isText = /^\s*solid[^]*?\bvertex\b/.test(text(bytes.slice(0, 1024)));
        const { content = bytes, middle } = isText ? nearOrigin(text(bytes)) : {};
        return { root: new STLLoader().parse(content as string).deleteAttribute("normal"), middle };
    }
    if (suffix === "obj") {
        const { content, middle } = nearOrigin(text(bytes));
        const root = new OBJLoader().parse(content);
        if (/^(mtllib|usemtl) /m.test(content)) lost.add("colors and textures of materials");
        const isLit = /^vn /m.test(content);
        root.traverse((each) => isLit || (each as Mesh).geometry?.deleteAttribute("normal")); // of faces, as the loader made them
        return { root, middle };
    }
    if (suffix === "ply") return { root: readPly(bytes, lost) };
    if (suffix !== "glb") throw new Error("Only PLY, OBJ, STL and GLB files are read here.");
    const loader = new GLTFLoader().register(({ json }) => ({
        name: "plain",
        loadMaterial: (index: number) => Promise.resolve(new MeshBasicMaterial({ name: String((json as { materials: { name?: string }[] }).materials[index].name ?? "") })),
    }));
    const { scene, scenes, parser: { json } } = await loader.parseAsync(bytes, "");
    if (!(scene ?? scenes[0])) throw new Error("It has no scene.");
    if (scenes.length > 1) lost.add("other scenes");
    if (/color|texture/i.test(JSON.stringify(json.materials ?? []))) lost.add("colors and textures of materials");
    for (const part of ["animations", "skins", "cameras"]) if (json[part]?.length) lost.add(part);
    return { root: scene ?? scenes[0] };
}

function readPly(bytes: ArrayBuffer, lost: Set<string>): BufferGeometry {
    const header = text(bytes.slice(0, 1 << 16)).split("end_header")[0];
    const faces = Number(/^element face (\d+)/m.exec(header)?.[1] ?? 0);
    for (const [, name] of header.matchAll(/^property (?:list \w+ \w+|\w+) (\w+)/gm)) if (!PLY.test(name)) lost.add(name);
    const loader = new PLYLoader();
    const fine = /^property (uchar|uint8) red$/m.test(header); // the loader would round these as linear numbers
    if (fine) loader.setCustomPropertyNameMapping({ bytes: ["red", "green", "blue"] });
    const geometry = loader.parse(bytes);
    if (/^property (double|float64) x$/m.test(header) && geometry.attributes.position?.array instanceof Float32Array) lost.add("digits beyond single precision"); // by three.js of before
    if ((geometry.index?.count ?? 0) / 3 < faces) throw new Error("It has faces of more than four corners, which are not read here.");
    return geometry.index ? geometry : new BufferGeometry(); // points
}

/** A geometry with what streams of files have: colors in sRGB, texture coordinates from the bottom. */
function plainOf(geometry: BufferGeometry, flipped: boolean, lost: Set<string>): BufferGeometry {
    const plain = new BufferGeometry().setIndex(geometry.index);
    plain.groups = geometry.groups;
    const color = new Color();
    for (const [name, attribute] of Object.entries(geometry.attributes)) {
        if (name === "bytes") plain.setAttribute("color", new BufferAttribute(Uint8Array.from(attribute.array), 3, true));
        else if (name !== "position" && !NAMES[name]) lost.add(name);
        else if (name === "color") {
            const values = Float32Array.from({ length: attribute.count * attribute.itemSize }, (_, i) => attribute.getComponent(Math.floor(i / attribute.itemSize), i % attribute.itemSize));
            for (let i = 0; i < values.length; i += attribute.itemSize) color.fromArray(values, i).convertLinearToSRGB().toArray(values, i);
            plain.setAttribute(name, new BufferAttribute(Uint8Array.from(values, (share) => Math.round(255 * Math.min(Math.max(share, 0), 1))), attribute.itemSize, true));
        } else plain.setAttribute(NAMES[name] ?? name, name === "uv" && flipped ? new BufferAttribute(Float32Array.from({ length: 2 * attribute.count }, (_, i) => (i % 2 ? 1 - attribute.getY(i >> 1) : attribute.getX(i >> 1))), 2) : attribute);
    }
    return plain;
}

/** What a file draws in its first pose. */
function drawnOf(root: Object3D | BufferGeometry, isScene: boolean, lost: Set<string>): Group {
    const drawn = new Group();
    const add = (geometry: BufferGeometry, material?: Material | Material[], from?: Object3D): void => {
        const mesh = new Mesh(plainOf(geometry, isScene, lost), material);
        mesh.name = from?.name ?? "";
        if (from) mesh.matrix.copy(from.matrixWorld);
        mesh.matrixAutoUpdate = false;
        drawn.add(mesh);
    };
    if (root instanceof BufferGeometry) add(root);
    else {
        root.updateMatrixWorld(true);
        root.traverse((each) => {
            const { geometry, isMesh, material } = each as Mesh;
            if (geometry && !isMesh) return void lost.add("points and lines");
            if (!geometry) return;
            if ((each as SkinnedMesh).isSkinnedMesh || geometry.morphAttributes.position) lost.add("poses");
            if ((each as InstancedMesh).isInstancedMesh) lost.add("copies of parts");
            add(geometry, material, each);
        });
    }
    return drawn;
}

/** Read a file by the suffix of its name. */
export async function readMesh(name: string, bytes: ArrayBuffer): Promise<Reading> {
    const suffix = /\.(\w+)$/.exec(name)?.[1].toLowerCase() ?? "";
    const lost = new Set<string>();
    const { root, middle } = await read(suffix, bytes, lost);
    const said: string[] = [];
    const mesh = meshOf(drawnOf(root, suffix === "glb", lost), (note) => said.push(note));
    if (middle) mesh.positions = Float64Array.from(mesh.positions, (x, i) => x + middle[i % 3]);
    if (suffix === "glb") Object.assign(mesh.metadata!, { up: "y", unit: "meters" });
    if (lost.size > 0) said.push(`Left out: ${[...lost].join(", ")}. bsm encode keeps more.`);
    return { mesh, less: said.length > 0, notes: said };
}

/** Encode a mesh to the bit or, where single precision is coarser, on the finest grid. */
export async function carried(encode: (options: EncodeOptions) => Promise<Uint8Array<ArrayBuffer>>): Promise<Uint8Array<ArrayBuffer>> {
    try {
        return await encode({ lossless: true });
    } catch (error) {
        if (error instanceof EncodeError && error.status === 10) return encode({ bits: 20 });
        throw error;
    }
}
