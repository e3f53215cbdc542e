/** Mesh files, read with the loaders of three.js: for the page without a server, and for `bsm-encode`. */
import {
    type AnimationClip,
    Box3,
    BufferAttribute,
    BufferGeometry,
    Group,
    type InstancedMesh,
    LoadingManager,
    type Material,
    Mesh,
    MeshBasicMaterial,
    type Object3D,
} from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { PLYLoader } from "three/addons/loaders/PLYLoader.js";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
import { meshOf } from "./content";
import type { MeshInput } from "./encoding";
import { linearOf } from "./parting";
import { isPosed, posesOf } from "./poses";

/** A file by its name or its path in a folder. */
export type Given = Pick<File, "name" | "size" | "arrayBuffer">;

/**
 * A mesh or sequence, what is to be said of it, whether something of the file is left out, and names of files that were
 * read with it.
 */
export interface Reading {
    mesh: MeshInput & { positions: Float32Array | Float64Array };
    notes: string[];
    less: boolean;
    used: string[];
}

const NAMES: Record<string, string> = { normal: "normal", uv: "texcoord", color: "color" };
const PLY = /^(x|y|z|n[xyz]|(diffuse_)?(red|green|blue)|[rgb]|[uvst]|texture_[uv]|vertex_ind(ex|ices))$/;
const VERTEX = /^(\s*v(?:ertex)?)\s+(\S+)\s+(\S+)\s+(\S+)/gm;
const FAR = 64; // diagonals from the origin, where single precision begins to count

const text = (bytes: ArrayBuffer): string => new TextDecoder().decode(bytes);
export const suffixOf = ({ name }: Given): string => /\.(\w+)$/.exec(name)?.[1].toLowerCase() ?? "";

/** Whether vertices are so far from the origin that single precision may round them visibly. */
function isFar(positions: ArrayLike<number>): boolean {
    const { min, max } = new Box3().setFromArray(positions as number[]);
    const far = Math.max(...[...min, ...max].map(Math.abs));
    return far > FAR * min.distanceTo(max) && far < Infinity;
}

/**
 * The text of a file whose loader rounds to single precision and parts vertices, with their numbers as x, and where
 * they are.
 */
function numbered(bytes: ArrayBuffer): { content: string; places: number[] } {
    const places: number[] = [];
    const content = text(bytes).replace(
        VERTEX,
        (_, name: string, ...place: string[]) => `${name} ${places.push(...place.slice(0, 3).map(Number)) / 3 - 1} 0 0`,
    );
    return { content, places };
}

interface Scene {
    root: Object3D | BufferGeometry;
    /** Coordinates of the file's vertices, whose numbers the meshes have in place of x. */
    places?: number[];
    clip?: AnimationClip;
}

/** The meshes of a file; `lost` gets the names of what is left out, `used` those of files beside it that it names. */
async function read(
    suffix: string,
    bytes: ArrayBuffer,
    lost: Set<string>,
    beside: Given[],
    used: string[],
): Promise<Scene> {
    if (suffix === "stl") {
        const isText = /^\s*solid[^]*?\bvertex\b/.test(text(bytes.slice(0, 1024)));
        const { content = bytes, places } = isText ? numbered(bytes) : {};
        return { root: new STLLoader().parse(content as string).deleteAttribute("normal"), places };
    }
    if (suffix === "obj") {
        const { content, places } = numbered(bytes);
        const root = new OBJLoader().parse(content);
        if (/^(mtllib|usemtl) /m.test(content)) lost.add("colors and textures of materials");
        const isLit = /^vn /m.test(content);
        root.traverse((each) => isLit || (each as Mesh).geometry?.deleteAttribute("normal")); // of faces, as the loader made them
        return { root, places };
    }
    if (suffix === "ply") return { root: readPly(bytes, lost) };
    if (!/^gl(b|tf)$/.test(suffix))
        throw new Error("Only PLY, OBJ, STL, GLB and glTF files are read here, PC2 and MDD with their mesh.");
    const manager = new LoadingManager().setURLModifier((url) => {
        if (/^(data|blob):/.test(url)) return url;
        const path = decodeURIComponent(url).replace(/^(\.\/)+/, "");
        const file = beside.find(({ name }) => `/${name}`.endsWith(`/${path}`));
        if (!file) throw new Error(`Missing: ${path}. Drop it, too.`);
        used.push(file.name);
        return URL.createObjectURL(file as File);
    });
    const loader = new GLTFLoader(manager).register(({ json }) => ({
        name: "plain",
        loadMaterial: (index: number) =>
            Promise.resolve(
                new MeshBasicMaterial({
                    name: String((json as { materials: { name?: string }[] }).materials[index].name ?? ""),
                }),
            ),
    }));
    const {
        animations,
        scene,
        scenes,
        parser: { json },
    } = await loader.parseAsync(bytes, "");
    if (!(scene ?? scenes[0])) throw new Error("It has no scene.");
    if (scenes.length > 1) lost.add("other scenes");
    if (/color|texture/i.test(JSON.stringify(json.materials ?? []))) lost.add("colors and textures of materials");
    if (animations.length > 1) lost.add("other animations");
    if (json.cameras?.length) lost.add("cameras");
    return { root: scene ?? scenes[0], clip: animations[0] };
}

function readPly(bytes: ArrayBuffer, lost: Set<string>): BufferGeometry {
    const header = text(bytes.slice(0, 1 << 16)).split("end_header")[0];
    const faces = Number(/^element face (\d+)/m.exec(header)?.[1] ?? 0);
    for (const [, name] of header.matchAll(/^property (?:list \w+ \w+|\w+) (\w+)/gm))
        if (!PLY.test(name)) lost.add(name);
    const loader = new PLYLoader();
    if (/^property (uchar|uint8) red$/m.test(header))
        loader.setCustomPropertyNameMapping({ bytes: ["red", "green", "blue"] }); // it would round these as linear numbers
    const geometry = loader.parse(bytes);
    if (/^property (double|float64) x$/m.test(header) && geometry.attributes.position?.array instanceof Float32Array)
        lost.add("digits beyond single precision"); // by three.js of before
    if ((geometry.index?.count ?? 0) / 3 < faces)
        throw new Error("It has faces of more than four corners, which are not read here.");
    return geometry.index ? geometry : new BufferGeometry(); // points
}

/** A geometry with what streams of files have: texture coordinates from the bottom. */
function plainOf(geometry: BufferGeometry, flipped: boolean, lost: Set<string>): BufferGeometry {
    const plain = Object.assign(new BufferGeometry().setIndex(geometry.index), { groups: geometry.groups });
    for (const [name, attribute] of Object.entries(geometry.attributes)) {
        if (name === "bytes")
            plain.setAttribute(
                "color",
                new BufferAttribute(
                    Float32Array.from(attribute.array, (byte) => linearOf(byte / 255)),
                    3,
                ),
            );
        else if (name !== "position" && !NAMES[name]) lost.add(name);
        else
            plain.setAttribute(
                NAMES[name] ?? name,
                name === "uv" && flipped
                    ? new BufferAttribute(
                          Float32Array.from({ length: 2 * attribute.count }, (_, i) =>
                              i % 2 ? 1 - attribute.getY(i >> 1) : attribute.getX(i >> 1),
                          ),
                          2,
                      )
                    : attribute,
            );
    }
    return plain;
}

/** What a file draws. */
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
            if ((each as InstancedMesh).isInstancedMesh) lost.add("copies of parts");
            add(geometry, material, each);
        });
    }
    return drawn;
}

/** A mesh whose vertices have their numbers as x, with the vertices that these are. */
function indexed({ positions, faces, attributes = [], metadata }: Reading["mesh"], places: number[]): Reading["mesh"] {
    const all = isFar(places) ? Float64Array.from(places) : Float32Array.from(places);
    const parted = attributes.map((attribute) =>
        attribute.domain === "face" ? attribute : { ...attribute, domain: "corner" as const, indices: faces },
    );
    return {
        positions: all,
        faces: Uint32Array.from(faces, (corner) => positions[3 * corner]),
        attributes: parted,
        metadata,
    };
}

/** Read a file by the suffix of its name, and files beside it that it names. */
export async function readMesh(given: Given, beside: Given[] = []): Promise<Reading> {
    const [lost, said, used, suffix] = [new Set<string>(), [] as string[], [given.name], suffixOf(given)];
    const { root, places, clip } = await read(suffix, await given.arrayBuffer(), lost, beside, used);
    let mesh = meshOf(drawnOf(root, /^gl/.test(suffix), lost), (note) => said.push(note)) as Reading["mesh"];
    if (places) mesh = indexed(mesh, places);
    if (/^gl/.test(suffix)) Object.assign(mesh.metadata!, { up: "y", unit: "meters" });
    if (clip || isPosed(root)) {
        const { positions, frames, rate } = posesOf(root as Object3D, clip);
        mesh = frames > 1 ? moving(mesh, positions, frames, rate) : { ...mesh, positions, attributes: still(mesh) };
    }
    if (lost.size > 0) said.push(`Left out: ${[...lost].join(", ")}. bsm encode keeps more.`);
    return { mesh, used, less: said.length > 0, notes: said };
}

/** Attributes that stay while vertices move. */
const still = ({ attributes }: MeshInput): MeshInput["attributes"] =>
    attributes?.filter(({ semantic }) => semantic !== "normal");

/** A mesh that moves. */
export function moving(
    mesh: MeshInput,
    positions: Reading["mesh"]["positions"],
    frames: number,
    rate: number,
): Reading["mesh"] {
    return { ...mesh, positions, frames, attributes: still(mesh), metadata: { ...mesh.metadata, frame_rate: rate } };
}
