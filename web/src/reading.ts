/**
 * Mesh files for the page without a server and for `bsm-encode`: OBJ, PLY and STL as Python reads them (`files/`), and
 * scenes of glTF by the loader of three.js. Notes name what a mesh has not of its file, in the words of `bsm encode`.
 */
import {
    BufferAttribute,
    BufferGeometry,
    Group,
    type InstancedMesh,
    LoadingManager,
    type Material,
    Mesh,
    MeshBasicMaterial,
    type AnimationClip,
    type Object3D,
} from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { meshOf } from "./content";
import type { MeshInput } from "./encoding";
import { readObj } from "./files/obj";
import { readPly } from "./files/ply";
import { meshOfPolygons } from "./files/polygons";
import { readStl } from "./files/stl";
import { unmarked } from "./files/text";
import type { Pool } from "./pool";
import { isPosed, posesOf } from "./poses";
import { EXTENSION } from "./views";

/** A file by its name or its path in a folder. */
export type Given = Pick<File, "name" | "size" | "arrayBuffer">;

/** A mesh or sequence, what is to be said of it, whether something is left out, and names of files read with it. */
export interface Reading {
    mesh: MeshInput & { positions: Float32Array | Float64Array };
    notes: string[];
    less: boolean;
    used: string[];
}

const READERS = new Map([
    ["obj", readObj],
    ["ply", readPly],
    ["stl", readStl],
]);
const NAMES: Record<string, string> = { normal: "normal", uv: "texcoord", color: "color" };
const MATERIALS = "colors and textures of materials";
const IMAGE = /^image\.\d+\.name$/;
const DRACO = "KHR_draco_mesh_compression";
const MESHOPT = "EXT_meshopt_compression";
/** What to do with a scene that is not read here. */
const DECODE_DRACO =
    "Its geometry is compressed by Draco, which is not read here. Run: bsm encode FILE. " +
    "Or decompress it first: npx @gltf-transform/cli copy FILE PLAIN.glb";

export const suffixOf = ({ name }: Given): string => /\.(\w+)$/.exec(name)?.[1].toLowerCase() ?? "";

interface Scene {
    root: Object3D;
    clip?: AnimationClip;
}

/** The names of extensions that a scene needs or uses. */
function extensionsOf(bytes: ArrayBuffer): string[] {
    const isBinary = new DataView(bytes).getUint32(0, true) === 0x46546c67;
    const size = isBinary ? new DataView(bytes).getUint32(12, true) : bytes.byteLength;
    const text = new TextDecoder().decode(new Uint8Array(bytes, isBinary ? 20 : 0, size));
    return (JSON.parse(text) as { extensionsUsed?: string[] }).extensionsUsed ?? [];
}

/** The address of a file beside a scene, whose name `used` gets. */
function addressOf(url: string, beside: Given[], used: string[]): string {
    if (/^(data|blob):/.test(url)) return url;
    const path = decodeURIComponent(url).replace(/^(\.\/)+/, "");
    const file = beside.find(({ name }) => `/${name}`.endsWith(`/${path}`));
    if (!file) throw new Error(`Missing: ${path}. Drop it, too.`);
    used.push(file.name);
    return URL.createObjectURL(file as File);
}

/** A scene; `lost` gets the names of its contents that are left out, `used` those of files beside it that it names. */
async function readScene(
    bytes: ArrayBuffer,
    beside: Given[],
    used: string[],
    lost: Set<string>,
    pool?: Pool,
): Promise<Scene> {
    const manager = new LoadingManager().setURLModifier((url) => addressOf(url, beside, used));
    const loader = new GLTFLoader(manager).register(({ json }) => ({
        name: "plain",
        loadMaterial(index: number) {
            const { name } = (json as { materials: { name?: string }[] }).materials[index];
            return Promise.resolve(new MeshBasicMaterial({ name: String(name ?? "") }));
        },
    }));
    const extensions = extensionsOf(bytes);
    if (extensions.includes(DRACO)) throw new Error(DECODE_DRACO);
    if (extensions.includes(EXTENSION)) {
        const { GLTFBSMExtension } = await import("./gltf");
        loader.register((parser) => new GLTFBSMExtension(parser, pool));
    }
    if (extensions.includes(MESHOPT))
        loader.setMeshoptDecoder((await import("three/addons/libs/meshopt_decoder.module.js")).MeshoptDecoder);
    const { animations, scene, scenes, parser, userData } = await loader.parseAsync(bytes, "");
    const { json } = parser;
    if (!(scene ?? scenes[0])) throw new Error("It has no scene.");
    if ((userData.sequences as unknown[] | undefined)?.length) lost.add("frames of sequences");
    if (scenes.length > 1) lost.add("other scenes");
    if (/color|texture/i.test(JSON.stringify(json.materials ?? []))) lost.add(MATERIALS);
    if (animations.length > 1) lost.add("other animations");
    if (json.cameras?.length) lost.add("cameras");
    return { root: scene ?? scenes[0], clip: animations[0] };
}

/** Texture coordinates from the bottom, as streams have them; those of scenes are from the top. */
function fromBottom(uv: BufferGeometry["attributes"][string]): BufferAttribute {
    const values = new Float32Array(2 * uv.count);
    for (let i = 0; i < uv.count; i++) values.set([uv.getX(i), 1 - uv.getY(i)], 2 * i);
    return new BufferAttribute(values, 2);
}

/** What a scene draws, with the attributes that streams of files have. */
function drawnOf(root: Object3D, lost: Set<string>): Group {
    const drawn = new Group();
    root.updateMatrixWorld(true);
    root.traverse((each) => {
        const { geometry, isMesh, material, name, matrixWorld } = each as Mesh;
        if (geometry && !isMesh) return void lost.add("points and lines");
        if (!geometry) return;
        if ((each as InstancedMesh).isInstancedMesh) lost.add("copies of parts");
        const plain = Object.assign(new BufferGeometry().setIndex(geometry.index), { groups: geometry.groups });
        for (const [own, attribute] of Object.entries(geometry.attributes)) {
            if (own !== "position" && !NAMES[own]) lost.add(own);
            else plain.setAttribute(NAMES[own] ?? own, own === "uv" ? fromBottom(attribute) : attribute);
        }
        const mesh = Object.assign(new Mesh(plain, material as Material), { name, matrixAutoUpdate: false });
        mesh.matrix.copy(matrixWorld);
        drawn.add(mesh);
    });
    return drawn;
}

/** Read a file by the suffix of its name, and files beside it that it names; a pool decodes streams in scenes. */
export async function readMesh(given: Given, beside: Given[] = [], pool?: Pool): Promise<Reading> {
    const [suffix, used, lost] = [suffixOf(given), [given.name], new Set<string>()];
    const bytes = await given.arrayBuffer();
    if (bytes.byteLength === 0) throw new Error("the file is empty");
    const reader = READERS.get(suffix);
    if (reader) {
        const { mesh, notes, dropped } = meshOfPolygons(reader(unmarked(new Uint8Array(bytes))));
        const { metadata = {} } = mesh;
        const isThere = (name: string): boolean => beside.some((file) => `/${file.name}`.endsWith(`/${name}`));
        const libraries = metadata.mtllib ? String(metadata.mtllib).split("\n").filter(Boolean) : [];
        const images = Object.entries(metadata).flatMap(([key, name]) => (IMAGE.test(key) ? String(name) : []));
        if ([...libraries, ...images].some(isThere)) lost.add(MATERIALS);
        const noteOf = (name: string, words: string): string | string[] =>
            isThere(name) ? [] : `${words}: no such file beside the mesh`;
        const ofLibraries = libraries.flatMap((name) => noteOf(name, `the materials in ${name} were left out`));
        const ofImages = images.flatMap((name) => noteOf(name, `the image ${name} was left out, its name was kept`));
        return readingOf(mesh, [...notes, ...ofLibraries, ...ofImages], lost, used, dropped.length > 0);
    }
    if (!/^gl(b|tf)$/.test(suffix))
        throw new Error("Only PLY, OBJ, STL, GLB and glTF files are read here, PC2 and MDD with their mesh.");
    const { root, clip } = await readScene(bytes, beside, used, lost, pool);
    const said: string[] = [];
    let mesh = meshOf(drawnOf(root, lost), (note) => said.push(note)) as Reading["mesh"];
    Object.assign(mesh.metadata!, { up: "y", unit: "meters" });
    if (clip || isPosed(root)) {
        const { positions, frames, rate } = posesOf(root, clip);
        const isMoving = frames > 1;
        mesh = isMoving ? moving(mesh, positions, frames, rate) : { ...mesh, positions, attributes: still(mesh) };
    }
    return readingOf(mesh, said, lost, used, said.length > 0);
}

function readingOf(mesh: Reading["mesh"], said: string[], lost: Set<string>, used: string[], less: boolean): Reading {
    const notes = lost.size > 0 ? [`Left out: ${[...lost].join(", ")}. bsm encode keeps more.`, ...said] : said;
    return { mesh, used, notes, less: less || [...lost].some((what) => what !== "cameras") };
}

/** Attributes that stay while vertices move. */
const still = ({ attributes }: MeshInput): MeshInput["attributes"] =>
    attributes?.filter(({ semantic }) => semantic !== "normal");

export function moving(
    mesh: MeshInput,
    positions: Reading["mesh"]["positions"],
    frames: number,
    rate: number,
): Reading["mesh"] {
    return { ...mesh, positions, frames, attributes: still(mesh), metadata: { ...mesh.metadata, frame_rate: rate } };
}
