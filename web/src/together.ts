/**
 * Files that are given together: meshes with the files that they name, or the frames of a sequence; and the encoder in
 * this thread.
 */
import { rateOf } from "./poses";
import { moving, readMesh, suffixOf, type Given, type Reading } from "./reading";

export { encodeHere } from "./encode";
export { readMesh } from "./reading";

const [MESHES, CACHES, STREAMS] = [/^(obj|ply|stl|glb|gltf)$/, /^(pc2|mdd)$/, /^bsm$/];
const RATE = 24; // frames per second of files that do not say
const order = new Intl.Collator("en", { numeric: true });
const those = (files: Given[], kind: RegExp): Given[] => files.filter((file) => kind.test(suffixOf(file)));

/**
 * What files show: caches of points, or meshes and the streams that are compared with them; the others belong to these.
 */
export function shownAmong(files: Given[]): Given[] {
    const caches = those(files, CACHES);
    return caches.length > 0 ? caches : [...those(files, MESHES), ...those(files, STREAMS)];
}

/** The mesh or sequence of a file, which names others. */
export function readOne(file: Given, files: Given[]): Promise<Reading> {
    return CACHES.test(suffixOf(file)) ? readCache(file, those(files, MESHES)) : readMesh(file, files);
}

/** The frames of files, by the numbers in their names; attributes, but for normals, are those of the first. */
export async function readFrames(files: Given[], rate = RATE, report?: (share: number) => void): Promise<Reading> {
    const ordered = files.toSorted((a, b) => order.compare(a.name, b.name));
    const read = (file: Given): Promise<Reading> =>
        readMesh(file).catch((error: Error) => Promise.reject(new Error(`${file.name}: ${error.message}`)));
    const first = await read(ordered[0]);
    const [faces, { length }] = [Uint32Array.from(first.mesh.faces), first.mesh.positions];
    const positions = new (first.mesh.positions.constructor as Float64ArrayConstructor)(length * files.length);
    for (const [frame, file] of ordered.entries()) {
        const { mesh } = frame > 0 ? await read(file) : first;
        if (
            mesh.faces.length !== faces.length ||
            mesh.positions.length !== length ||
            !faces.every((vertex, i) => vertex === mesh.faces[i])
        )
            throw new Error(
                `${file.name}: it has other faces than ${ordered[0].name}; bsm encode --runs takes such frames`,
            );
        positions.set(mesh.positions, frame * length);
        report?.((frame + 1) / files.length);
    }
    return { ...first, mesh: moving(first.mesh, positions, files.length, rate), used: ordered.map(({ name }) => name) };
}

/** The points of a PC2 or MDD file, and the faces of the mesh that has its name, or is there. */
async function readCache(cache: Given, meshes: Given[]): Promise<Reading> {
    const stem = (name: string): string => name.replace(/\.\w+$/, "");
    const given = meshes.find(({ name }) => stem(name) === stem(cache.name)) ?? meshes[0];
    if (!given)
        throw new Error(
            `Missing: ${stem(cache.name)}.obj. ${cache.name} holds points and no faces; drop its mesh, too.`,
        );
    const [isPc2, view] = [suffixOf(cache) === "pc2", new DataView(await cache.arrayBuffer())];
    if (view.byteLength < 32) throw new Error(`${cache.name} is cut short`);
    const [points, frames] = isPc2
        ? [view.getInt32(16, true), view.getInt32(28, true)]
        : [view.getInt32(4), view.getInt32(0)];
    const start = isPc2 ? 32 : 8 + 4 * frames;
    if (points < 1 || frames < 1 || view.byteLength < start + 12 * points * frames)
        throw new Error(`${cache.name} claims ${frames} frames of ${points} points, and has ${view.byteLength} bytes`);
    const rate = isPc2 ? RATE : rateOf(Array.from({ length: frames }, (_, frame) => view.getFloat32(8 + 4 * frame)));
    const reading = await readMesh(given, meshes);
    const [{ length }, count] = [reading.mesh.positions, points * frames];
    if (length !== 3 * points)
        throw new Error(`${cache.name} has ${points} points, and ${given.name} has ${length / 3} vertices`);
    const positions = Float32Array.from({ length: 3 * count }, (_, i) => view.getFloat32(start + 4 * i, isPc2));
    return { ...reading, mesh: moving(reading.mesh, positions, frames, rate), used: [cache.name, ...reading.used] };
}
