/**
 * Files that are given together: meshes with the files that they name, or the frames of a sequence; and the encoder in
 * this thread. A sequence is a folder of meshes with the same faces, in the order of the numbers in their names, or a
 * cache of points (PC2, MDD) beside the mesh that has its faces.
 */
import { compact } from "./files/polygons";
import { rateOf } from "./poses";
import type { Pool } from "./pool";
import { moving, readMesh, suffixOf, type Given, type Reading } from "./reading";

export { encodeHere } from "./encode";
export { readMesh } from "./reading";

const [MESHES, CACHES, STREAMS] = [/^(obj|ply|stl|glb|gltf)$/, /^(pc2|mdd)$/, /^bsm$/];
const RATE = 24; // frames per second of files that do not say
const LEAST = 32; // bytes of a cache
const order = new Intl.Collator("en", { numeric: true });
const those = (files: Given[], kind: RegExp): Given[] => files.filter((file) => kind.test(suffixOf(file)));

/** What files show: caches of points, or meshes and the streams that are compared with them; the others belong to these. */
export function shownAmong(files: Given[]): Given[] {
    const caches = those(files, CACHES);
    return caches.length > 0 ? caches : [...those(files, MESHES), ...those(files, STREAMS)];
}

/** The mesh or sequence of a file, which names others. */
export function readOne(file: Given, files: Given[], pool?: Pool): Promise<Reading> {
    return CACHES.test(suffixOf(file)) ? readCache(file, those(files, MESHES)) : readMesh(file, files, pool);
}

/** A mesh in single precision, which streams without loss have, where that moves no vertex visibly. */
export function inSingle<Mesh extends Reading["mesh"]>(mesh: Mesh): Mesh {
    const { positions } = mesh;
    return positions instanceof Float64Array ? { ...mesh, positions: compact(positions, 3) } : mesh;
}

/** The frames of files, by the numbers in their names; attributes, but for normals, are those of the first. */
export async function readFrames(
    files: Given[],
    rate = RATE,
    report?: (share: number) => void,
    pool?: Pool,
): Promise<Reading> {
    const ordered = files.toSorted((a, b) => order.compare(a.name, b.name));
    const read = (file: Given): Promise<Reading> =>
        readMesh(file, [], pool).catch((error: Error) => {
            throw new Error(`${file.name}: ${error.message}`);
        });
    const first = await read(ordered[0]);
    const { faces } = first.mesh;
    const size = first.mesh.positions.length;
    const positions = new Float64Array(size * files.length);
    for (const [frame, file] of ordered.entries()) {
        const { mesh } = frame > 0 ? await read(file) : first;
        const isSame = mesh.faces.length === faces.length && mesh.positions.length === size;
        const runs = "bsm encode --runs takes such frames";
        if (!isSame || !Array.prototype.every.call(faces, (vertex, i) => vertex === mesh.faces[i]))
            throw new Error(`${file.name}: it has other faces than ${ordered[0].name}; ${runs}`);
        positions.set(mesh.positions, frame * size);
        report?.((frame + 1) / files.length);
    }
    const mesh = inSingle(moving(first.mesh, { positions, frames: files.length, rate }));
    return { ...first, mesh, used: ordered.map(({ name }) => name) };
}

/** The points of a PC2 or MDD file, and the faces of the mesh that has its name, or is there. */
async function readCache(cache: Given, meshes: Given[]): Promise<Reading> {
    const { name } = cache;
    const stem = (name: string): string => name.replace(/\.\w+$/, "");
    const given = meshes.find((mesh) => stem(mesh.name) === stem(name)) ?? meshes[0];
    const without = `${name} holds points and no faces; drop its mesh, too.`;
    if (!given) throw new Error(`Missing: ${stem(name)}.obj. ${without}`);
    const view = new DataView(await cache.arrayBuffer());
    const { byteLength: size } = view;
    if (size < LEAST) throw new Error(`${name} is cut short`);
    const isPc2 = suffixOf(cache) === "pc2"; // whose numbers have their least byte first
    const [points, frames] = (isPc2 ? [16, 28] : [4, 0]).map((at) => view.getInt32(at, isPc2));
    const start = isPc2 ? LEAST : 8 + 4 * frames;
    if (points < 1 || frames < 1 || size < start + 12 * points * frames)
        throw new Error(`${name} claims ${frames} frames of ${points} points, and has ${size} bytes`);
    const times = Array.from({ length: isPc2 ? 0 : frames }, (_, frame) => view.getFloat32(8 + 4 * frame));
    const reading = await readMesh(given, meshes);
    const vertices = reading.mesh.positions.length / 3;
    if (vertices !== points)
        throw new Error(`${name} has ${points} points, and ${given.name} has ${vertices} vertices`);
    const positions = new Float32Array(3 * points * frames);
    for (let i = 0; i < positions.length; i++) positions[i] = view.getFloat32(start + 4 * i, isPc2);
    const mesh = moving(reading.mesh, { positions, frames, rate: isPc2 ? RATE : rateOf(times) });
    return { ...reading, mesh, used: [name, ...reading.used] };
}
