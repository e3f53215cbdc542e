/** What is drawn of a stream, made in the thread that decodes: arrays that a page hands to its graphics as they are. */
import { begun } from "./begun";
import type { Attribute } from "./attributes";
import type { Changes } from "./assembly";
import type { ConnectivityEvent, EndEvent, Event, FrameEvent, HeaderEvent, LossEvent, MetadataEvent, RefinementEvent } from "./decoder";
import { checkLimit, DEFAULT_LIMITS, type Limits } from "./limits";
import { inverse } from "./numbering";
import { upTo } from "./numbers";

/** Faces with one material, of one part: `count` corners from `start` on. */
export interface Piece {
    material: number;
    part: number;
    start: number;
    count: number;
}

/** Numbers of the drawn vertices under one name. */
export interface DrawnAttribute {
    name: string;
    components: number;
    values: Float32Array;
}

/** A whole mesh as it is drawn: `vertices` says which vertex of the stream each drawn one is, if that is not the same. */
export interface Shape {
    index: Uint32Array;
    positions: Float32Array;
    normals: Float32Array;
    attributes: DrawnAttribute[];
    vertices?: Int32Array;
    pieces: Piece[];
    center: [number, number, number];
    radius: number;
    low: number[];
    high: number[];
}

/** A mesh that grows has begun, or goes on with the faces of one more section: how many vertices and corners there are now. */
export interface BegunPicture {
    type: "begun";
    vertices: number;
    corners: number;
    loose: ConnectivityEvent["loose"];
    section: number;
}

/**
 * Vertices that have moved or whose normals have, shape (k,), with what they are now, and the corners of faces that can be
 * drawn from now on. `origin`: the block that each came with, -1 if it is not there; `depth`: how many layers have moved it.
 */
export interface GrownPicture {
    type: "grown";
    vertices: Int32Array;
    positions: Float32Array;
    normals: Float32Array;
    origin: Int32Array;
    depth: Uint8Array;
    index: Uint32Array;
    blocks: number;
    layers: number;
}

/** The whole mesh, or the first frame of a sequence; of a later run, that which the frames behind it have. */
export interface WholePicture {
    type: "whole";
    shape: Shape;
    run: number;
}

/** A frame of a sequence: positions of the drawn vertices, and their normals times 32767. */
export interface FramePicture {
    type: "frame";
    index: number;
    positions: Float32Array;
    normals: Int16Array;
}

export type Picture = HeaderEvent | MetadataEvent | BegunPicture | GrownPicture | WholePicture | FramePicture | LossEvent | AttributePicture | EndEvent;

/** An attribute is there, which is drawn once the mesh is whole. */
export interface AttributePicture {
    type: "attribute";
    name: string;
    semantic: Attribute["semantic"];
    domain: Attribute["domain"];
}

type Show = (picture: Picture, moved?: Transferable[]) => void;

/** Milliseconds between pictures of a mesh that grows. */
const PAUSE = 30;
/** Attributes of faces that say what belongs together, and are not drawn. */
const [MATERIAL, PART] = ["material", "part"];
const MOST_NORMAL = 32767;
const BASES = { texcoord: "uv", color: "color", normal: "normal" } as const;

/** Turns the events of a stream into pictures. */
export class Drawing {
    private readonly limits: Limits;
    private faces: Int32Array = new Int32Array(0);
    private points = new Float32Array(0);
    private normals = new Float32Array(0);
    private origin: Int32Array = new Int32Array(0);
    private depth = new Uint8Array(0);
    /** How many corners of each face are not there. */
    private waiting = new Uint8Array(0);
    private around: { starts: Int32Array; members: Int32Array } = { starts: new Int32Array(1), members: new Int32Array(0) };
    /** Vertices that have moved, or lie at a face that has, since the last picture, and which these are. */
    private touched: number[] = [];
    private isTouched = new Uint8Array(0);
    private drawable: number[] = [];
    private blocks = 0;
    private layers = 0;
    /** Vertices that each number of layers has moved at least. */
    private moved: number[] = [];
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
                return this.show({ type: "attribute", name: event.name, semantic: event.semantic, domain: event.domain });
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

    /** A later run begins: its frames are shown when they are there. */
    private turn(run: number): void {
        this.flush();
        this.run = run;
        this.growing = false;
        this.faces = new Int32Array(0);
        [this.points, this.normals, this.origin] = [new Float32Array(0), new Float32Array(0), new Int32Array(0)];
        [this.carried.length, this.shape] = [0, undefined];
    }

    /** Show what has changed. */
    flush(): void {
        if (!this.growing || this.touched.length + this.drawable.length === 0) return;
        const vertices = Int32Array.from(this.touched);
        this.touched = [];
        const [positions, normals] = [new Float32Array(3 * vertices.length), new Float32Array(3 * vertices.length)];
        const [origin, depth] = [new Int32Array(vertices.length), new Uint8Array(vertices.length)];
        vertices.forEach((vertex, row) => {
            this.isTouched[vertex] = 0;
            this.renewNormal(vertex);
            for (let d = 0; d < 3; d++) {
                positions[3 * row + d] = this.points[3 * vertex + d];
                normals[3 * row + d] = this.normals[3 * vertex + d];
            }
            origin[row] = this.origin[vertex];
            depth[row] = this.depth[vertex];
        });
        const index = this.cornersOf(this.drawable);
        this.drawable = [];
        this.shown = performance.now();
        const { blocks, layers } = this;
        this.show(
            { type: "grown", vertices, positions, normals, origin, depth, index, blocks, layers },
            [vertices, positions, normals, origin, depth, index].map(({ buffer }) => buffer),
        );
    }

    private begin({ faces: added, vertices: size, loose, section }: ConnectivityEvent): void {
        this.flush();
        const [known, before] = [this.faces.length, this.origin.length];
        this.faces = grown(this.faces, known + added.length);
        this.faces.set(added, known);
        this.origin = grown(this.origin, size).fill(-1, before);
        this.points = grown(this.points, 3 * size);
        this.normals = grown(this.normals, 3 * size);
        loose.vertices.forEach((vertex, i) => this.points.set(loose.positions.subarray(3 * i, 3 * i + 3), 3 * vertex));
        if (!this.growing) return;
        this.show({ type: "begun", vertices: size, corners: this.faces.length, loose, section });
        this.depth = grown(this.depth, size);
        this.isTouched = grown(this.isTouched, size);
        this.waiting = grown(this.waiting, this.faces.length / 3);
        this.around = inverse(this.faces, size);
        for (let face = known / 3; face < this.waiting.length; face++) this.drawOrWait(face);
        this.flush();
    }

    /** Draw a face that has come if all of its corners are there; wait for the others. */
    private drawOrWait(face: number): void {
        for (let k = 3 * face; k < 3 * face + 3; k++) this.waiting[face] += Number(this.origin[this.faces[k]] < 0);
        if (this.waiting[face] > 0) return;
        this.drawable.push(face);
        for (let k = 3 * face; k < 3 * face + 3; k++) this.touch(this.faces[k]);
    }

    private touch(vertex: number): void {
        if (this.isTouched[vertex]) return;
        this.isTouched[vertex] = 1;
        this.touched.push(vertex);
    }

    private grow(event: Changes & ({ type: "block" } | RefinementEvent)): void {
        const { vertices, positions } = event;
        const { points, origin, growing } = this;
        for (let row = 0; row < vertices.length; row++) {
            const vertex = vertices[row];
            for (let d = 0; d < 3; d++) points[3 * vertex + d] = positions[3 * row + d];
            if (growing) this.settle(vertex);
            else origin[vertex] = this.blocks;
        }
        if (event.type === "block") this.blocks++;
        else if (growing) this.deepen(event);
        if (growing && performance.now() - this.shown > PAUSE) this.flush();
    }

    /** A vertex has moved, for the first time or again. */
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

    private deepen({ layer, vertices }: RefinementEvent): void {
        for (const vertex of vertices) {
            if (this.depth[vertex] <= layer) this.moved[layer] = (this.moved[layer] ?? 0) + 1;
            this.depth[vertex] = layer + 1;
        }
        if (this.moved[layer] === this.depth.length) this.layers = layer + 1;
    }

    /** The normal of a vertex, from the faces that are there. */
    private renewNormal(vertex: number): void {
        const { faces, waiting, normals, points: p } = this;
        const { starts, members } = this.around;
        let [x, y, z] = [0, 0, 0];
        for (let k = starts[vertex]; k < starts[vertex + 1]; k++) {
            const face = Math.floor(members[k] / 3);
            if (waiting[face] > 0) continue;
            const a = 3 * faces[3 * face];
            const b = 3 * faces[3 * face + 1];
            const c = 3 * faces[3 * face + 2];
            const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
            const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
            x += uy * vz - uz * vy;
            y += uz * vx - ux * vz;
            z += ux * vy - uy * vx;
        }
        const length = Math.sqrt(x * x + y * y + z * z) || 1;
        normals[3 * vertex] = x / length;
        normals[3 * vertex + 1] = y / length;
        normals[3 * vertex + 2] = z / length;
    }

    private cornersOf(faces: ArrayLike<number>): Uint32Array {
        const corners = new Uint32Array(3 * faces.length);
        for (let i = 0; i < corners.length; i++) corners[i] = this.faces[3 * faces[Math.floor(i / 3)] + (i % 3)];
        return corners;
    }

    /** All vertices are there. */
    private take(positions: Float64Array): void {
        this.points = new Float32Array(positions);
        this.origin.fill(0);
    }

    private addFrame({ index, positions: points }: FrameEvent): void {
        this.kept += 18 * (points.length / 3);
        checkLimit(this.limits, "keptBytes", this.kept);
        if (!this.shape) {
            this.take(points);
            this.finish();
        }
        const { vertices } = begun(this.shape);
        const positions = spread(points, 3, vertices);
        const normals = spread(normalsOf(this.faces, this.origin, points), 3, vertices);
        const small = Int16Array.from(normals, (value) => Math.round(value * MOST_NORMAL));
        this.show({ type: "frame", index, positions, normals: small }, [positions.buffer, small.buffer]);
    }

    /** The mesh is whole: part its vertices where its attributes do, and sort its faces by parts and materials. */
    private finish(): void {
        const { faces, origin, points } = this;
        const isThere = (corner: number): boolean => origin[faces[corner]] >= 0;
        const whole = upTo(faces.length / 3).filter((face) => isThere(3 * face) && isThere(3 * face + 1) && isThere(3 * face + 2));
        const labels = [PART, MATERIAL].map((name) => this.carried.find((one) => one.name === name && one.domain === "face" && one.components === 1));
        const [part, material] = labels.map((one) => (face: number): number => one?.values[face] ?? 0);
        if (labels.some((one) => one)) whole.sort((a, b) => part(a) - part(b) || material(a) - material(b) || a - b);
        const pieces: Piece[] = [];
        let last: Piece | undefined;
        whole.forEach((face, i) => {
            if (last?.part === part(face) && last.material === material(face)) last.count += 3;
            else pieces.push((last = { part: part(face), material: material(face), start: 3 * i, count: 3 }));
        });
        const drawn = this.carried.filter((one) => !labels.includes(one));
        const { index, vertices, rows } = parted(faces, whole, drawn, points.length / 3);
        const own = drawn.find(({ semantic, domain }) => semantic === "normal" && domain !== "face");
        const positions = spread(points, 3, vertices);
        const normals = own ? numbersOf(own, rows[drawn.indexOf(own)]) : spread(normalsOf(faces, origin, points), 3, vertices);
        const used = new Map([["position", 1], ["normal", 1]]);
        const attributes = drawn.flatMap((one, i) => {
            if (one === own) return [];
            const base = one.semantic === "generic" ? one.name : BASES[one.semantic];
            const count = used.get(base) ?? 0;
            used.set(base, count + 1);
            return [{ name: count ? `${base}${count}` : base, components: one.components, values: numbersOf(one, rows[i]) }];
        });
        const shape = (this.shape = { index, positions, normals, attributes, vertices, pieces, ...boundsOf(positions) });
        const buffers = [index, positions, normals, ...attributes.map(({ values }) => values)].map(({ buffer }) => buffer);
        if (this.run > 0) this.kept += buffers.reduce((sum, { byteLength }) => sum + byteLength, 0);
        this.show({ type: "whole", shape, run: this.run }, buffers);
    }
}

/** Numbers with room for more behind them. */
function grown<Numbers extends Int32Array | Uint8Array | Float32Array>(numbers: Numbers, length: number): Numbers {
    const more = new (numbers.constructor as new (length: number) => Numbers)(length);
    more.set(numbers);
    return more;
}

/** Normals of all vertices, shape (n, 3); faces that lack a corner count for nothing. */
function normalsOf(faces: Int32Array, origin: Int32Array, p: ArrayLike<number>): Float32Array {
    const n = new Float32Array(p.length);
    for (let k = 0; k < faces.length; k += 3) {
        if (origin[faces[k]] < 0 || origin[faces[k + 1]] < 0 || origin[faces[k + 2]] < 0) continue;
        const a = 3 * faces[k];
        const b = 3 * faces[k + 1];
        const c = 3 * faces[k + 2];
        const ux = p[b] - p[a];
        const uy = p[b + 1] - p[a + 1];
        const uz = p[b + 2] - p[a + 2];
        const vx = p[c] - p[a];
        const vy = p[c + 1] - p[a + 1];
        const vz = p[c + 2] - p[a + 2];
        const x = uy * vz - uz * vy;
        const y = uz * vx - ux * vz;
        const z = ux * vy - uy * vx;
        n[a] += x;
        n[a + 1] += y;
        n[a + 2] += z;
        n[b] += x;
        n[b + 1] += y;
        n[b + 2] += z;
        n[c] += x;
        n[c + 1] += y;
        n[c + 2] += z;
    }
    for (let i = 0; i < n.length; i += 3) {
        const length = Math.sqrt(n[i] * n[i] + n[i + 1] * n[i + 1] + n[i + 2] * n[i + 2]) || 1;
        n[i] /= length;
        n[i + 1] /= length;
        n[i + 2] /= length;
    }
    return n;
}

/** Rows of numbers, `width` in each, one for each of `vertices`; without these as they are. */
function spread(numbers: ArrayLike<number>, width: number, vertices?: Int32Array): Float32Array {
    if (!vertices) return new Float32Array(numbers);
    const rows = new Float32Array(width * vertices.length);
    for (let i = 0; i < vertices.length; i++) for (let d = 0; d < width; d++) rows[width * i + d] = numbers[width * vertices[i] + d];
    return rows;
}

/** The value of each corner of some faces that an attribute has; of faces, equal ones have the number of the first. */
function valuesOf({ domain, values, components, indices }: Attribute, faces: Int32Array, chosen: Int32Array): Int32Array {
    const numbers = new Int32Array(3 * chosen.length);
    const first = new Map<string, number>();
    chosen.forEach((face, i) => {
        let ofFace = face;
        if (domain === "face") {
            const key = values.subarray(components * face, components * (face + 1)).join();
            ofFace = first.get(key) ?? face;
            first.set(key, ofFace);
        }
        for (let k = 0; k < 3; k++) {
            const corner = 3 * face + k;
            numbers[3 * i + k] = domain === "face" ? ofFace : domain === "corner" ? indices?.[corner] ?? 0 : faces[corner];
        }
    });
    return numbers;
}

/**
 * A vertex for each vertex of `faces` and values of the attributes that meet at a corner of the `chosen` ones: which drawn vertices these
 * have, which vertex each drawn one is, and which value of each attribute it has. Nothing is parted where nothing needs it.
 */
function parted(faces: Int32Array, chosen: Int32Array, attributes: Attribute[], size: number): { index: Uint32Array; vertices?: Int32Array; rows: (Int32Array | undefined)[] } {
    const index = new Uint32Array(3 * chosen.length);
    const parting = attributes.filter(({ domain }) => domain !== "vertex");
    if (parting.length === 0) {
        chosen.forEach((face, i) => {
            for (let k = 0; k < 3; k++) index[3 * i + k] = faces[3 * face + k];
        });
        return { index, rows: attributes.map(() => undefined) };
    }
    const values = parting.map((one) => valuesOf(one, faces, chosen));
    // The drawn vertices of each vertex are a chain, from the one met last to the first.
    const [heads, next] = [new Int32Array(size).fill(-1), new Int32Array(index.length)];
    const [vertices, corners] = [new Int32Array(index.length), new Int32Array(index.length)];
    let count = 0;
    for (let i = 0; i < index.length; i++) {
        const vertex = faces[3 * chosen[Math.floor(i / 3)] + (i % 3)];
        let drawn = heads[vertex];
        while (drawn >= 0 && !values.every((numbers) => numbers[corners[drawn]] === numbers[i])) drawn = next[drawn];
        if (drawn < 0) {
            drawn = count++;
            [next[drawn], heads[vertex], vertices[drawn], corners[drawn]] = [heads[vertex], drawn, vertex, i];
        }
        index[i] = drawn;
    }
    const used = vertices.slice(0, count);
    const rows = attributes.map((one) => {
        const numbers = values[parting.indexOf(one)];
        return numbers ? corners.subarray(0, count).map((corner) => numbers[corner]) : used;
    });
    return { index, vertices: used, rows };
}

/** Numbers of the drawn vertices; integers of colours are shares of their range. */
function numbersOf({ semantic, kind, components, values }: Attribute, rows?: Int32Array): Float32Array {
    const most = semantic === "color" ? { uint8: 255, uint16: 65535 }[kind as string] ?? 1 : 1;
    const numbers = spread(values, components, rows);
    if (most > 1) for (let i = 0; i < numbers.length; i++) numbers[i] /= most;
    return numbers;
}

function boundsOf(p: Float32Array): Pick<Shape, "center" | "radius" | "low" | "high"> {
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let i = 0; i < p.length; i += 3) {
        for (let d = 0; d < 3; d++) {
            if (p[i + d] < low[d]) low[d] = p[i + d];
            if (p[i + d] > high[d]) high[d] = p[i + d];
        }
    }
    const [x, y, z] = low.map((least, d) => (least + high[d]) / 2);
    let most = 0;
    for (let i = 0; i < p.length; i += 3) most = Math.max(most, (p[i] - x) ** 2 + (p[i + 1] - y) ** 2 + (p[i + 2] - z) ** 2);
    return { center: [x, y, z], radius: Math.sqrt(most), low, high };
}
