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
    Material,
    Mesh,
    MeshBasicMaterial,
    type AnimationClip,
    type Object3D,
    type SkinnedMesh,
} from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { meshOf } from "./content";
import type { MeshInput } from "./encoding";
import { readObj } from "./files/obj";
import { readPly } from "./files/ply";
import { meshOfPolygons, requireFinite } from "./files/polygons";
import { readStl } from "./files/stl";
import { unmarked } from "./files/text";
import type { Pool } from "./pool";
import { posesOf, type Poses } from "./poses";
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
/** Attributes of three.js that streams have, too: normals, and sets of texture coordinates and colors. */
const DRAWN = /^(?:(normal)|uv(\d*)|color(?:_(\d+))?)$/;
const MATERIALS = "colors and textures of materials";
const TURNED = 1e-6; // by which bones at rest may move a vertex
const IMAGE = /^image\.\d+\.name$/;
const DRACO = "KHR_draco_mesh_compression";
const MESHOPT = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
/** What to do with a scene that is not read here. */
const DECODE_DRACO =
    "Its geometry is compressed by Draco, which is not read here. Run: bsm encode FILE. " +
    "Or decompress it first: npx @gltf-transform/cli copy FILE PLAIN.glb";

export const suffixOf = ({ name }: Given): string => /\.(\w+)$/.exec(name)?.[1].toLowerCase() ?? "";

type PartAttribute = BufferGeometry["attributes"][string];
interface Scene {
    root: Object3D;
    clip?: AnimationClip;
}

/** The names of extensions that a scene needs or uses. */
function extensionsOf(bytes: ArrayBuffer): string[] {
    const [magic, version, , size] = new Uint32Array(bytes.slice(0, bytes.byteLength < 20 ? 0 : 16));
    const isBinary = magic === 0x46546c67;
    if (isBinary && version !== 2) throw new Error(`not a GLB of version 2 (version ${version})`);
    const text = new TextDecoder().decode(isBinary ? new Uint8Array(bytes).subarray(20, 20 + size) : bytes);
    const { asset, extensionsUsed } = JSON.parse(text) as { asset?: { version: string }; extensionsUsed?: string[] };
    if (!/^2(\.|$)/.test(`${asset?.version}`))
        throw new Error(`this is glTF ${asset?.version}, and only glTF 2.0 is read; convert it first`);
    return extensionsUsed ?? [];
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
    if (MESHOPT.some((name) => extensions.includes(name)))
        loader.setMeshoptDecoder((await import("three/addons/libs/meshopt_decoder.module.js")).MeshoptDecoder);
    const { animations, scene, scenes, parser, userData } = await loader.parseAsync(bytes, "");
    const { json } = parser;
    if (scenes.length === 0) throw new Error("It has no scene.");
    if ((userData.sequences as unknown[] | undefined)?.length) lost.add("frames of sequences");
    if (scenes.length > 1) lost.add("other scenes");
    if (/color|texture/i.test(JSON.stringify(json.materials ?? []))) lost.add(MATERIALS);
    if (animations.length > 1) lost.add("other animations");
    if (json.cameras?.length) lost.add("cameras");
    const materials = new Map<number | undefined, Material>(); // of which three.js makes several, for colors and lines
    const root = scene ?? scenes[0];
    root.traverse((each) => {
        const { material } = each as Mesh;
        if (!(material instanceof Material)) return;
        const number = parser.associations.get(material)?.materials;
        materials.set(number, materials.get(number) ?? material);
        (each as Mesh).material = materials.get(number)!;
    });
    return { root, clip: animations[0] };
}

/** Texture coordinates from the bottom, as streams have them; those of scenes are from the top. */
function fromBottom(uv: PartAttribute): BufferAttribute {
    const values = new Float32Array(2 * uv.count);
    for (let i = 0; i < uv.count; i++) values.set([uv.getX(i), 1 - uv.getY(i)], 2 * i);
    return new BufferAttribute(values, 2);
}

/** Give parts what others have: colors white, texture coordinates zero. Normals that not all have are left out. */
function fillIn(parts: BufferGeometry[], name: string, notes: string[]): void {
    const own = parts.flatMap(({ attributes }) => (attributes[name] as PartAttribute | undefined) ?? []);
    const width = Math.max(...own.map(({ itemSize }) => itemSize));
    const lacking = parts.length - own.length;
    if (/^(normal|position)$/.test(name)) return;
    const [what, filling] = name.startsWith("color") ? ["colors", "white"] : ["texture coordinates", "zeros"];
    const called = /\d$/.test(name) ? name : what;
    if (lacking > 0) notes.push(`parts without ${called} were given ${filling}: ${lacking}`);
    for (const part of parts) {
        const { count } = part.attributes.position;
        const given = part.attributes[name] as PartAttribute | undefined;
        if (given?.itemSize === width) continue;
        const values = new Float32Array(width * count).fill(filling === "white" ? 1 : 0);
        for (let i = 0; given && i < count; i++) values.set([given.getX(i), given.getY(i), given.getZ(i)], width * i);
        part.setAttribute(name, new BufferAttribute(values, width));
    }
}

/** The rows of attributes that a part uses of a table, which other parts use as well. */
function ownRows({ index, attributes, groups }: BufferGeometry): BufferGeometry {
    const rows = Uint32Array.from(new Set(index!.array)).sort();
    const places = new Map(Array.from(rows, (row, place) => [row, place]));
    const own = new BufferGeometry().setIndex(Array.from(index!.array, (row) => places.get(row)!));
    for (const [name, given] of Object.entries(attributes)) {
        const values = new (given.array.constructor as Float32ArrayConstructor)(given.itemSize * rows.length);
        const made = new BufferAttribute(values, given.itemSize, given.normalized);
        for (const [row, of] of rows.entries())
            for (let d = 0; d < given.itemSize; d++) made.setComponent(row, d, given.getComponent(of, d));
        own.setAttribute(name, made);
    }
    return Object.assign(own, { groups });
}

/** What a scene draws, with the attributes that streams of files have; copies are parts of their own. */
function drawnOf(root: Object3D, lost: Set<string>, notes: string[], isPosed: boolean): Group {
    const [drawn, users] = [new Group(), new Map<PartAttribute, Set<BufferGeometry>>()];
    root.updateMatrixWorld(true);
    root.traverse((each) => {
        const { geometry } = each as Mesh;
        const place = geometry?.attributes.position;
        if (geometry) users.set(place, (users.get(place) ?? new Set()).add(geometry));
    });
    root.traverse((each) => {
        const { geometry, isMesh, material, name, matrixWorld } = each as Mesh;
        if (geometry && !isMesh) return void lost.add("points and lines");
        if (!geometry) return;
        const { count = 1, isInstancedMesh } = each as InstancedMesh;
        const vertices = (geometry.attributes.position as PartAttribute | undefined)?.count ?? 0;
        const outside = geometry.index?.array.find((vertex) => vertex >= vertices);
        if (outside !== undefined) throw new Error(`a face of this glTF refers to vertex ${outside} of ${vertices}`);
        if (isInstancedMesh && isPosed) lost.add("copies of parts");
        const isShared = !isPosed && geometry.index !== null && users.get(geometry.attributes.position)!.size > 1;
        const { attributes, groups, index } = isShared ? ownRows(geometry) : geometry;
        const plain = Object.assign(new BufferGeometry().setIndex(index), { groups });
        for (const [own, attribute] of Object.entries(attributes)) {
            const [, normal, uv, color = ""] = DRAWN.exec(own) ?? [];
            if (own === "position" || normal) plain.setAttribute(own, attribute);
            else if (uv !== undefined) plain.setAttribute(`texcoord${uv}`, fromBottom(attribute));
            else if (own.startsWith("color")) plain.setAttribute(`color${color}`, attribute);
            else if (!/^(skin|joints|weights)/.test(own))
                lost.add(`${own.replace(/^_/, "").toUpperCase()} of attributes`);
        }
        for (let copy = 0; copy < (isPosed ? 1 : count); copy++) {
            const mesh = Object.assign(new Mesh(plain, material as Material), { name, matrixAutoUpdate: false });
            if (isInstancedMesh && !isPosed) (each as InstancedMesh).getMatrixAt(copy, mesh.matrix);
            mesh.matrix.premultiply(matrixWorld);
            drawn.add(mesh);
        }
    });
    const parts = (drawn.children as Mesh[]).filter(({ geometry }) => geometry.attributes.position?.count > 0);
    const own = [...new Set(parts.map(({ geometry }) => geometry))];
    for (const name of new Set(own.flatMap(({ attributes }) => Object.keys(attributes)))) fillIn(own, name, notes);
    if (parts.length > 1) notes.push(`${parts.length} parts were joined to one mesh`);
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
    const { root, clip } = await readScene(bytes, beside, used, lost, pool).catch(inWords);
    const [said, changes]: string[][] = [[], []];
    const moves = new Set(clip ? ["animations"] : []);
    root.traverse((each) => {
        if ((each as SkinnedMesh).isSkinnedMesh) moves.add("skins");
        if ((each as Mesh).geometry?.morphAttributes.position) moves.add("morph targets");
    });
    const isMoved = moves.size > 0;
    let mesh = meshOf(drawnOf(root, lost, changes, isMoved), (note) => said.push(note)) as Reading["mesh"];
    Object.assign(mesh.metadata!, { up: "y", unit: "meters" });
    if (isMoved) {
        const poses = posesOf(root, clip);
        const { positions, frames } = poses;
        if (frames === 1) for (const what of moves) lost.add(what);
        const isTurned = frames > 1 || positions.some((number, i) => Math.abs(number - mesh.positions[i]) > TURNED);
        const attributes = isTurned ? still(mesh) : mesh.attributes;
        if (attributes!.length < mesh.attributes!.length) changes.push("left out, for they move: normals");
        mesh = frames > 1 ? moving(mesh, poses) : { ...mesh, positions, attributes };
    }
    requireFinite(mesh.positions);
    return readingOf(mesh, [...changes, ...said], lost, used, said.length > 0);
}

/** What programs say of scenes that are none, for people. */
function inWords(error: Error): never {
    const isFault = [TypeError, RangeError, SyntaxError].some((kind) => error instanceof kind);
    const message = error.message.replace(/^THREE\.GLTFLoader: /, "");
    throw isFault || message !== error.message ? new Error(`this is no valid glTF: ${message}`) : error;
}

function readingOf(mesh: Reading["mesh"], said: string[], lost: Set<string>, used: string[], less: boolean): Reading {
    const notes = lost.size > 0 ? [`Left out: ${[...lost].join(", ")}. bsm encode keeps more.`, ...said] : said;
    return { mesh, used, notes, less: less || [...lost].some((what) => what !== "cameras") };
}

/** Attributes that stay while vertices move. */
const still = ({ attributes }: MeshInput): MeshInput["attributes"] =>
    attributes?.filter(({ semantic }) => semantic !== "normal");

export function moving(mesh: MeshInput, { positions, frames, rate }: Poses): Reading["mesh"] {
    return { ...mesh, positions, frames, attributes: still(mesh), metadata: { ...mesh.metadata, frame_rate: rate } };
}
