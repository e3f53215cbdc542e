/** How far a mesh is from its original: from its vertices where the faces agree, from its surface where not. */
import { BufferAttribute, BufferGeometry, Vector3 } from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { BSMGeometry } from "../geometry";

const MOST = 2 ** 23; // faces of a mesh, and vertices of all frames that have colors
const SLICE = 12; // milliseconds of work, after which the page may answer

export interface Distances {
    /** Of each vertex in each frame; empty where there are too many, or the faces change. */
    off: Float32Array;
    errors: number[];
    /** The mean distance to the other surface, if faces differ. */
    mean?: number;
}

/** Positions and faces of a frame, and the vertices that faces use. */
interface Body {
    points: Float32Array;
    faces: Uint32Array;
    used: Uint32Array;
}

/** A frame of a stream, without faces that damage has left corners of undecoded. */
function bodyOf({ frames, index, parted, attributes: { position } }: BSMGeometry, frame: number): Body {
    const { positions, shape } = frames[frame] ?? {
        positions: position.array,
        shape: { index: index!.array, vertices: parted },
    };
    const isThere = (i: number): boolean =>
        [0, 1, 2].every((c) => positions[3 * shape.index[i - (i % 3) + c]] < Infinity);
    const whole = positions.every((value) => value < Infinity) ? shape.index : shape.index.filter((_, i) => isThere(i));
    const faces = Uint32Array.from(whole, (drawn) => shape.vertices?.[drawn] ?? drawn);
    const count = faces.reduce((most, vertex) => Math.max(most, vertex + 1), 0);
    if (count === 0) throw new Error("There are no triangles to compare.");
    if (faces.length > 3 * MOST) throw new Error(`There are more than ${MOST} triangles; use bsm compare.`);
    const [points, seen] = [new Float32Array(3 * count), new Uint8Array(count)];
    whole.forEach((drawn, i) => points.set(positions.subarray(3 * drawn, 3 * drawn + 3), 3 * faces[i]));
    for (const vertex of faces) seen[vertex] = 1;
    return { points, faces, used: Uint32Array.from(seen.keys()).filter((vertex) => seen[vertex]) };
}

/** Which triangle of some is the nearest one. */
class Tree {
    /** The first vertex of the face that was the nearest one. */
    vertex = 0;
    private readonly bvh: MeshBVH;
    private readonly hit = { point: new Vector3(), distance: 0, faceIndex: 0 };

    constructor(points: Float32Array, faces: Uint32Array) {
        const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(points, 3));
        this.bvh = new MeshBVH(geometry.setIndex(new BufferAttribute(faces.slice(), 1)));
    }

    /** How far a point is; `vertex` is one of the nearest face then. */
    distance(point: Vector3): number {
        this.bvh.closestPointToPoint(point, this.hit);
        this.vertex = this.bvh.geometry.index!.array[3 * this.hit.faceIndex];
        return this.hit.distance;
    }
}

/** Each face, from its least vertex on. */
function written(faces: Uint32Array): string[] {
    const turned = ([a, b, c]: Uint32Array): number[] => (a < b && a < c ? [a, b, c] : b < c ? [b, c, a] : [c, a, b]);
    return Array.from({ length: faces.length / 3 }, (_, face) => turned(faces.subarray(3 * face, 3 * face + 3)).join());
}

/** The vertex of the original that each one is; undefined where the faces are others. */
function* matched(now: Body, then: Body): Generator<void, ArrayLike<number> | undefined> {
    if (now.faces.length !== then.faces.length || now.used.length !== then.used.length) return undefined;
    const [point, same] = [new Vector3(), Uint32Array.from({ length: now.points.length / 3 }, (_, vertex) => vertex)];
    if (now.faces.every((vertex, i) => vertex === then.faces[i])) return same;
    const points = Uint32Array.from({ length: 3 * then.used.length }, (_, i) => then.used[Math.floor(i / 3)]);
    const tree = new Tree(then.points, points);
    for (const vertex of now.used) {
        tree.distance(point.fromArray(now.points, 3 * vertex));
        same[vertex] = tree.vertex;
        yield;
    }
    const known = new Set(written(then.faces));
    const isOnto = new Set(now.used.map((vertex) => same[vertex])).size === now.used.length;
    const isSame = isOnto && written(now.faces.map((vertex) => same[vertex])).every((face) => known.has(face));
    return isSame ? same : undefined;
}

function* measured(stream: BSMGeometry, original: BSMGeometry): Generator<void, Distances> {
    const [{ length: count }, { length: before }, vertices] = [stream.frames, original.frames, stream.header!.vertices];
    if (count !== before && count * before === 0) throw new Error("One is a sequence, the other one is not.");
    if (count !== before) throw new Error(`It has ${count} frames, and its original has ${before}.`);
    const isOne = vertices * count <= MOST && stream.frames.every(({ shape }) => shape === stream.frames[0].shape);
    const off = new Float32Array(isOne ? vertices * Math.max(count, 1) : 0).fill(NaN);
    const [errors, point, other] = [[] as number[], new Vector3(), new Vector3()];
    let [sum, apart] = [0, 0];
    let [now, then, same]: [Body?, Body?, ArrayLike<number>?] = [];
    for (let frame = 0; frame < Math.max(count, 1); frame++) {
        const last = [now?.faces, then?.faces];
        [now, then] = [bodyOf(stream, frame), bodyOf(original, frame)];
        const isLast = ({ faces }: Body, i: number): boolean =>
            last[i]?.length === faces.length && faces.every((vertex, k) => vertex === last[i]![k]);
        if (![now, then].every(isLast)) same = yield* matched(now, then);
        const [tree, back] = same ? [] : [new Tree(then.points, then.faces), new Tree(now.points, now.faces)];
        let most = 0;
        for (const vertex of now.used) {
            point.fromArray(now.points, 3 * vertex);
            const far = same ? point.distanceTo(other.fromArray(then.points, 3 * same[vertex])) : tree!.distance(point);
            off[frame * vertices + vertex] = far;
            if (far > most) most = far;
            if (tree) [sum, apart] = [sum + far, apart + 1];
            yield;
        }
        for (const vertex of back ? then.used : []) {
            most = Math.max(most, back!.distance(point.fromArray(then.points, 3 * vertex)));
            yield;
        }
        errors.push(most);
    }
    return { off, errors, mean: apart > 0 ? sum / apart : undefined };
}

/** Measure as long as `mine` holds, with pauses for the page. */
export async function distancesOf(
    stream: BSMGeometry,
    original: BSMGeometry,
    mine: () => boolean,
): Promise<Distances | undefined> {
    const work = measured(stream, original);
    for (let begin = performance.now(); ;) {
        const step = work.next();
        if (step.done) return step.value;
        if (performance.now() - begin < SLICE) continue;
        await new Promise((go) => setTimeout(go));
        if (!mine()) return undefined;
        begin = performance.now();
    }
}
