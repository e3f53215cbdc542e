/** How far a mesh is from its original: vertex by vertex where the faces agree, and from its surface where they do not. */
import { Triangle, Vector3 } from "three";
import type { BSMGeometry } from "../geometry";

const [LEAF, MOST] = [4, 2 ** 23]; // faces of a leaf; faces of a mesh, and vertices of all frames that have colors
const SLICE = 12; // milliseconds of work, after which the page may answer
const CELLS = 1024; // along an axis
/** The bits of a number, with room for those of two others between them. */
const SPREAD = Float64Array.from({ length: CELLS }, (_, cell) => [...cell.toString(2)].reduce((sum, bit) => 8 * sum + Number(bit), 0));

export interface Distances {
    /** Of each vertex in each frame; empty where there are too many, or the faces change. */
    off: Float32Array;
    /** The largest distance of each frame. */
    errors: number[];
    /** The mean distance to the other surface, if faces differ. */
    mean?: number;
}

/** Positions and faces of a stream, and the vertices that faces use. */
interface Body {
    points: Float32Array;
    faces: Uint32Array;
    used: Uint32Array;
}

/** A frame of a stream, without faces that damage has left corners of undecoded. */
function bodyOf({ frames, index, parted, attributes: { position } }: BSMGeometry, frame: number): Body {
    const { positions, shape } = frames[frame] ?? { positions: position.array, shape: { index: index!.array, vertices: parted } };
    const isThere = (i: number): boolean => [0, 1, 2].every((c) => positions[3 * shape.index[i - (i % 3) + c]] < Infinity);
    const whole = positions.every((value) => value < Infinity) ? shape.index : shape.index.filter((_, i) => isThere(i));
    const faces = Uint32Array.from(whole, (drawn) => shape.vertices?.[drawn] ?? drawn);
    const count = faces.reduce((most, vertex) => Math.max(most, vertex + 1), 0);
    if (count === 0) throw new Error("There are no triangles to compare.");
    const [points, seen] = [new Float32Array(3 * count), new Uint8Array(count)];
    whole.forEach((drawn, i) => (points.set(positions.subarray(3 * drawn, 3 * drawn + 3), 3 * faces[i]), (seen[faces[i]] = 1)));
    return { points, faces, used: Uint32Array.from(seen.keys()).filter((vertex) => seen[vertex]) };
}

/** Faces in the order of a curve that fills space, and boxes around 4, 8, 16 ... of them. */
class Tree {
    /** The face that was the nearest one. */
    face = 0;
    private readonly order: Float64Array;
    private readonly boxes: Float32Array;
    private readonly leaves: number;
    private readonly triangle = new Triangle();
    private readonly place = new Vector3();

    constructor(private readonly points: Float32Array, private readonly faces: Uint32Array) {
        const count = faces.length / 3;
        if (count > MOST) throw new Error(`There are more than ${MOST} triangles; use bsm compare.`);
        const [middles, low, high] = [new Float32Array(faces.length), [Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
        for (let i = 0; i < middles.length; i++) {
            const d = i % 3;
            for (let corner = i - d; corner < i - d + 3; corner++) middles[i] += points[3 * faces[corner] + d] / 3;
            [low[d], high[d]] = [Math.min(low[d], middles[i]), Math.max(high[d], middles[i])];
        }
        const cell = (i: number): number => SPREAD[Math.min(CELLS - 1, Math.floor((CELLS * (middles[i] - low[i % 3])) / (high[i % 3] - low[i % 3] || 1)))];
        this.order = Float64Array.from({ length: count }, (_, face) => (cell(3 * face) + 2 * cell(3 * face + 1) + 4 * cell(3 * face + 2)) * MOST + face).sort().map((key) => key % MOST);
        this.leaves = 2 ** Math.ceil(Math.log2(Math.max(1, count / LEAF)));
        const boxes = (this.boxes = new Float32Array(6 * (2 * this.leaves - 1)).map((_, i) => (i % 6 < 3 ? Infinity : -Infinity)));
        const widen = (i: number, value: number): number => (boxes[i] = i % 6 < 3 ? Math.min(boxes[i], value) : Math.max(boxes[i], value));
        for (let i = 0; i < 18 * count; i++) widen(6 * (this.leaves - 1 + Math.floor(i / 18 / LEAF)) + (i % 6), points[3 * faces[3 * this.order[Math.floor(i / 18)] + (Math.floor(i / 6) % 3)] + (i % 3)]);
        for (let i = boxes.length - 1; i >= 6; i--) widen(6 * ((Math.floor(i / 6) - 1) >> 1) + (i % 6), boxes[i]);
    }

    /** How far a point is; `face` is the nearest one then. */
    distance(point: Vector3): number {
        let best = Infinity;
        const measure = (face: number): void => {
            const { a, b, c } = this.triangle;
            [a, b, c].forEach((corner, i) => corner.fromArray(this.points, 3 * this.faces[3 * face + i]));
            const far = this.triangle.closestPointToPoint(point, this.place).distanceToSquared(point);
            if (far < best) [best, this.face] = [far, face];
        };
        measure(this.face); // neighbors are near the same one
        const nodes = [0];
        while (nodes.length > 0) {
            const node = nodes.pop()!;
            if (this.apart(node, point) >= best) continue;
            const [left, leaf] = [2 * node + 1, node - this.leaves + 1];
            if (leaf < 0) nodes.push(...(this.apart(left, point) < this.apart(left + 1, point) ? [left + 1, left] : [left, left + 1]));
            else this.order.subarray(LEAF * leaf, LEAF * (leaf + 1)).forEach(measure);
        }
        return Math.sqrt(best);
    }

    private apart(node: number, { x, y, z }: Vector3): number {
        const gap = (value: number, d: number): number => Math.max(this.boxes[6 * node + d] - value, 0, value - this.boxes[6 * node + 3 + d]);
        return gap(x, 0) ** 2 + gap(y, 1) ** 2 + gap(z, 2) ** 2;
    }
}

/** Each face, from its least vertex on. */
function* written(faces: Uint32Array, name = (vertex: number): number => vertex): Generator<string> {
    for (let i = 0; i < faces.length; i += 3) {
        const [a, b, c] = [name(faces[i]), name(faces[i + 1]), name(faces[i + 2])];
        yield (a < b && a < c ? [a, b, c] : b < c ? [b, c, a] : [c, a, b]).join();
    }
}

/** The vertex of the original that each vertex is, or nothing where the faces are others. */
function* matched(now: Body, then: Body): Generator<void, ((vertex: number) => number) | undefined> {
    if (now.faces.length !== then.faces.length || now.used.length !== then.used.length) return undefined;
    if (now.faces.every((vertex, i) => vertex === then.faces[i])) return (vertex) => vertex;
    const tree = new Tree(then.points, Uint32Array.from({ length: 3 * then.used.length }, (_, i) => then.used[Math.floor(i / 3)])); // of points
    const [names, point, taken] = [new Map<number, number>(), new Vector3(), new Set<number>()];
    for (const vertex of now.used) {
        tree.distance(point.fromArray(now.points, 3 * vertex));
        names.set(vertex, then.used[tree.face]);
        taken.add(then.used[tree.face]);
        yield;
    }
    const known = new Set(written(then.faces));
    if (taken.size < now.used.length) return undefined;
    for (const face of written(now.faces, (vertex) => names.get(vertex)!)) if (!known.has(face)) return undefined;
    return (vertex) => names.get(vertex)!;
}

function* measured(stream: BSMGeometry, original: BSMGeometry): Generator<void, Distances> {
    const [count, before] = [stream, original].map(({ frames }) => frames.length);
    if (count !== before) throw new Error(count * before > 0 ? `It has ${count} frames, and its original has ${before}.` : "One is a sequence, the other one is not.");
    const vertices = stream.header!.vertices;
    const isOne = stream.frames.every(({ shape }) => shape === stream.frames[0].shape) && vertices * count <= MOST;
    const off = new Float32Array(isOne ? vertices * Math.max(count, 1) : 0).fill(NaN);
    const [errors, point]: [number[], Vector3] = [[], new Vector3()];
    let [same, sum, apart]: [((vertex: number) => number) | undefined, number, number] = [undefined, 0, 0];
    for (let frame = 0; frame < Math.max(count, 1); frame++) {
        const [now, then] = [bodyOf(stream, frame), bodyOf(original, frame)];
        if (frame === 0 || stream.frames[frame].shape !== stream.frames[frame - 1].shape || original.frames[frame].shape !== original.frames[frame - 1].shape) same = yield* matched(now, then);
        const tree = same ? undefined : new Tree(then.points, then.faces);
        let most = 0;
        for (const vertex of now.used) {
            point.fromArray(now.points, 3 * vertex);
            const far = same ? Math.hypot(...[0, 1, 2].map((d) => now.points[3 * vertex + d] - then.points[3 * same!(vertex) + d])) : tree!.distance(point);
            off[frame * vertices + vertex] = far;
            if (far > most) most = far;
            if (tree) [sum, apart] = [sum + far, apart + 1];
            yield;
        }
        const back = tree && new Tree(now.points, now.faces);
        for (const vertex of back ? then.used : []) {
            most = Math.max(most, back!.distance(point.fromArray(then.points, 3 * vertex)));
            yield;
        }
        errors.push(most);
    }
    return { off, errors, mean: apart > 0 ? sum / apart : undefined };
}

/** Measure as long as `mine` holds, with pauses for the page. */
export async function distancesOf(stream: BSMGeometry, original: BSMGeometry, mine: () => boolean): Promise<Distances | undefined> {
    const work = measured(stream, original);
    for (let begin = performance.now(); ; ) {
        const step = work.next();
        if (step.done) return step.value;
        if (performance.now() - begin < SLICE) continue;
        await new Promise((go) => setTimeout(go));
        if (!mine()) return undefined;
        begin = performance.now();
    }
}
