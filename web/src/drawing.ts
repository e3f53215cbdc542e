/** What is drawn of a stream, made in the thread that decodes: arrays that a page hands to its graphics as they are. */
import type { Attribute } from "./attributes";
import type { Event, Loose, EventOf } from "./events";
import { cornersOf, spread, type DrawnAttribute, type DrawnFaces, type Piece } from "./drawn";
import { checkLimit, DEFAULT_LIMITS, type Limits } from "./limits";
import { drawnFaces, numbersOf } from "./parting";

export type { DrawnAttribute, Piece };

/**
 * A whole mesh as it is drawn: `vertices` says which vertex of the stream each drawn one is, if that is not the same.
 */
export interface Shape extends Omit<DrawnFaces, "own"> {
    positions: Float32Array;
    normals: Float32Array;
    center: [number, number, number];
    radius: number;
    low: number[];
    high: number[];
}

/** What can be drawn now; normals of frames are multiplied by 32767, and their attributes are those that change. */
export type Picture =
    | EventOf<"header" | "metadata" | "loss" | "end">
    /** A mesh that grows has begun. */
    | { type: "begun"; vertices: number; corners: number; loose: Loose }
    /**
     * Vertices that have moved or whose normals have, shape (k,), with what they are now, and the corners of faces that can
     * be drawn from now on. `origin`: the block that each came with, -1 if it is not there.
     */
    | {
          type: "grown";
          vertices: Int32Array;
          positions: Float32Array;
          normals: Float32Array;
          origin: Int32Array;
          index: Uint32Array;
          blocks: number;
      }
    /** The whole mesh, or the first frame of a sequence; of a later run, that which the frames behind it have. */
    | { type: "whole"; shape: Shape; run: number }
    | { type: "frame"; index: number; positions: Float32Array; normals: Int16Array; attributes: DrawnAttribute[] }
    /** It is there, and drawn once the mesh is whole. */
    | { type: "attribute"; name: string; semantic: Attribute["semantic"]; domain: Attribute["domain"] };

/** A picture of a type. */
export type PictureOf<Type> = Extract<Picture, { type: Type }>;

type Show = (picture: Picture, moved?: Transferable[]) => void;

const PAUSE = 30;
const MOST_NORMAL = 32767;

export class Drawing {
    private readonly limits: Limits;
    private faces: Int32Array = new Int32Array(0);
    private points = new Float32Array(0);
    private normals = new Float32Array(0);
    private origin: Int32Array = new Int32Array(0);
    /** How many corners of each face are not there. */
    private waiting = new Uint8Array(0);
    private around: { starts: Int32Array; members: Int32Array } = {
        starts: new Int32Array(1),
        members: new Int32Array(0),
    };
    /** Vertices that have moved, or lie at a face that has, since the last picture, and which these are. */
    private touched: number[] = [];
    private isTouched = new Uint8Array(0);
    private drawable: number[] = [];
    private blocks = 0;
    private shown = 0;
    private readonly carried: Attribute[] = [];
    private shape?: Shape;
    /** Bytes of frames and shapes that are kept. */
    private kept = 0;
    private run = 0;

    constructor(
        private growing: boolean,
        limits: Partial<Limits>,
        private readonly show: Show,
    ) {
        this.limits = { ...DEFAULT_LIMITS, ...limits };
    }

    accept(event: Event): void {
        switch (event.type) {
            case "header":
                return event.header.run > 0 ? this.turn(event.header.run) : this.show(event);
            case "connectivity":
                return this.begin(event);
            case "block":
            case "refinement":
                return this.grow(event);
            case "attribute":
                this.carried.push(event);
                if (this.run > 0) return undefined;
                return this.show({
                    type: "attribute",
                    name: event.name,
                    semantic: event.semantic,
                    domain: event.domain,
                });
            case "frame":
                return this.addFrame(event);
            case "loss":
                this.flush();
                return this.show(event);
            case "end":
                this.flush();
                if (event.positions) this.take(event.positions);
                if (!this.shape) this.finish();
                return this.show({ ...event, positions: undefined });
            default:
                return this.show(event);
        }
    }

    private turn(run: number): void {
        this.flush();
        [this.run, this.growing] = [run, false];
        this.faces = new Int32Array(0);
        [this.points, this.normals, this.origin] = [new Float32Array(0), new Float32Array(0), new Int32Array(0)];
        [this.carried.length, this.shape] = [0, undefined];
    }

    flush(): void {
        if (!this.growing || this.touched.length + this.drawable.length === 0) return;
        const vertices = Int32Array.from(this.touched);
        this.touched = [];
        vertices.forEach((vertex) => {
            this.isTouched[vertex] = 0;
            this.renewNormal(vertex);
        });
        const [positions, normals] = [this.points, this.normals].map((numbers) => spread(numbers, 3, vertices));
        const origin = vertices.map((vertex) => this.origin[vertex]);
        const index = cornersOf(this.faces, this.drawable);
        this.drawable = [];
        this.shown = performance.now();
        this.show(
            { type: "grown", vertices, positions, normals, origin, index, blocks: this.blocks },
            [vertices, positions, normals, origin, index].map(({ buffer }) => buffer),
        );
    }

    private begin({ faces, vertices: size, loose }: EventOf<"connectivity">): void {
        this.faces = faces;
        this.origin = new Int32Array(size).fill(-1);
        this.points = new Float32Array(3 * size);
        this.normals = new Float32Array(3 * size);
        loose.vertices.forEach((vertex, i) => this.points.set(loose.positions.subarray(3 * i, 3 * i + 3), 3 * vertex));
        if (!this.growing) return;
        this.show({ type: "begun", vertices: size, corners: faces.length, loose });
        this.isTouched = new Uint8Array(size);
        this.waiting = new Uint8Array(faces.length / 3).fill(3);
        this.around = inverse(faces, size);
    }

    private touch(vertex: number): void {
        if (this.isTouched[vertex]) return;
        this.isTouched[vertex] = 1;
        this.touched.push(vertex);
    }

    private grow(event: EventOf<"block" | "refinement">): void {
        const { vertices, positions } = event;
        const { points, origin, growing } = this;
        for (let row = 0; row < vertices.length; row++) {
            const vertex = vertices[row];
            for (let d = 0; d < 3; d++) points[3 * vertex + d] = positions[3 * row + d];
            if (growing) this.settle(vertex);
            else origin[vertex] = this.blocks;
        }
        if (event.type === "block") this.blocks++;
        if (growing && performance.now() - this.shown > PAUSE) this.flush();
    }

    private settle(vertex: number): void {
        const { faces, waiting, origin } = this;
        const { starts, members } = this.around;
        const isNew = origin[vertex] < 0;
        if (isNew) origin[vertex] = this.blocks;
        this.touch(vertex);
        for (let k = starts[vertex]; k < starts[vertex + 1]; k++) {
            const face = Math.floor(members[k] / 3);
            if (isNew && --waiting[face] === 0) this.drawable.push(face);
            for (let c = 3 * face; c < 3 * face + 3; c++) this.touch(faces[c]);
        }
    }

    private renewNormal(vertex: number): void {
        const { faces, waiting, normals, points } = this;
        const { starts, members } = this.around;
        normals.fill(0, 3 * vertex, 3 * vertex + 3);
        for (let k = starts[vertex]; k < starts[vertex + 1]; k++) {
            const face = Math.floor(members[k] / 3);
            if (waiting[face] === 0) addNormal(normals, points, faces, 3 * face, vertex);
        }
        toLength1(normals, 3 * vertex);
    }

    private take(positions: Float64Array): void {
        this.points = new Float32Array(positions);
        this.origin.fill(0);
    }

    private addFrame({ index, positions: points, attributes: moved }: EventOf<"frame">): void {
        this.kept += 18 * (points.length / 3) + moved.reduce((sum, { values }) => sum + 4 * values.length, 0);
        checkLimit(this.limits, "keptBytes", this.kept);
        if (!this.shape) {
            this.take(points);
            this.finish();
        }
        const { vertices, attributes: drawn } = this.shape!;
        const positions = spread(points, 3, vertices);
        const normals = spread(normalsOf(this.faces, this.origin, points), 3, vertices);
        const small = new Int16Array(normals.length);
        for (let i = 0; i < small.length; i++) small[i] = Math.round(normals[i] * MOST_NORMAL);
        const attributes = moved.flatMap((attribute) => {
            const same = drawn.find(({ source }) => source === attribute.name);
            return same ? [{ ...same, values: numbersOf(attribute, vertices) }] : [];
        });
        const buffers = [positions, small, ...attributes.map(({ values }) => values)].map(({ buffer }) => buffer);
        this.show({ type: "frame", index, positions, normals: small, attributes }, buffers);
    }

    /** The mesh is whole: part its vertices where its attributes do, and sort its faces by parts and materials. */
    private finish(): void {
        this.flush();
        this.growing = false; // nothing is "grown" after the whole picture
        const { faces, origin, points, carried } = this;
        const isThere = (corner: number): boolean => origin[faces[corner]] >= 0;
        const all = new Int32Array(faces.length / 3).map((_, face) => face);
        const whole = origin.includes(-1)
            ? all.filter((face) => isThere(3 * face) && isThere(3 * face + 1) && isThere(3 * face + 2))
            : all;
        const { index, vertices, pieces, attributes, own } =
            carried.length > 0 ? drawnFaces(faces, whole, carried, points.length / 3) : this.bare(whole);
        const positions = spread(points, 3, vertices);
        const normals = own ?? spread(normalsOf(faces, origin, points), 3, vertices);
        const shape = (this.shape = {
            index,
            positions,
            normals,
            attributes,
            vertices,
            pieces,
            ...boundsOf(positions),
        });
        const buffers = [index, positions, normals, ...attributes.map(({ values }) => values)].map(
            ({ buffer }) => buffer,
        );
        if (this.run > 0) this.kept += buffers.reduce((sum, { byteLength }) => sum + byteLength, 0);
        this.show({ type: "whole", shape, run: this.run }, buffers);
    }

    private bare(faces: Int32Array): DrawnFaces {
        const index =
            3 * faces.length === this.faces.length ? new Uint32Array(this.faces) : cornersOf(this.faces, faces);
        return {
            index,
            pieces: index.length > 0 ? [{ part: 0, material: 0, start: 0, count: index.length }] : [],
            attributes: [],
        };
    }
}

/** Add the normal of a face, as long as twice its area, to those of its corners, or of one of them. */
function addNormal(n: Float32Array, p: ArrayLike<number>, faces: Int32Array, corner: number, only = -1): void {
    const [a, b, c] = [3 * faces[corner], 3 * faces[corner + 1], 3 * faces[corner + 2]];
    const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    for (let k = 0; k < 3; k++) {
        const to = only < 0 ? 3 * faces[corner + k] : 3 * only;
        n[to] += uy * vz - uz * vy;
        n[to + 1] += uz * vx - ux * vz;
        n[to + 2] += ux * vy - uy * vx;
        if (only >= 0) return;
    }
}

function toLength1(n: Float32Array, at: number): void {
    const length = Math.sqrt(n[at] * n[at] + n[at + 1] * n[at + 1] + n[at + 2] * n[at + 2]) || 1;
    for (let d = at; d < at + 3; d++) n[d] /= length;
}

/** Normals of all vertices, shape (n, 3); faces that lack a corner count for nothing. */
function normalsOf(faces: Int32Array, origin: Int32Array, points: ArrayLike<number>): Float32Array {
    const normals = new Float32Array(points.length);
    for (let k = 0; k < faces.length; k += 3)
        if (origin[faces[k]] >= 0 && origin[faces[k + 1]] >= 0 && origin[faces[k + 2]] >= 0)
            addNormal(normals, points, faces, k);
    for (let i = 0; i < normals.length; i += 3) toLength1(normals, i);
    return normals;
}

function boundsOf(p: Float32Array): Pick<Shape, "center" | "radius" | "low" | "high"> {
    const [low, high] = [
        [Infinity, Infinity, Infinity],
        [-Infinity, -Infinity, -Infinity],
    ];
    for (let i = 0; i < p.length; i += 3) {
        for (let d = 0; d < 3; d++) {
            if (p[i + d] < low[d]) low[d] = p[i + d];
            if (p[i + d] > high[d]) high[d] = p[i + d];
        }
    }
    const [x, y, z] = low.map((least, d) => (least + high[d]) / 2);
    let most = 0;
    for (let i = 0; i < p.length; i += 3)
        most = Math.max(most, (p[i] - x) ** 2 + (p[i + 1] - y) ** 2 + (p[i + 2] - z) ** 2);
    return { center: [x, y, z], radius: Math.sqrt(most), low, high };
}

/** Which places of `values` have each number below `count`. */
function inverse(values: Int32Array, count: number): { starts: Int32Array; members: Int32Array } {
    const starts = new Int32Array(count + 1);
    for (const value of values) if (value >= 0) starts[value + 1]++;
    for (let k = 0; k < count; k++) starts[k + 1] += starts[k];
    const members = new Int32Array(starts[count]);
    const filled = starts.slice();
    values.forEach((value, place) => value >= 0 && (members[filled[value]++] = place));
    return { starts, members };
}
