/** What is drawn of a stream, made in the thread that decodes: arrays that a page hands to its graphics as they are. */
import type { Attribute } from "./attributes";
import type { Event, Loose, EventOf } from "./events";
import { composed, spread, type DrawnAttribute, type DrawnFaces, type Piece } from "./drawn";
import { checkLimit, DEFAULT_LIMITS, type Limits } from "./limits";
import type { Bounds, Grown, Memory, Move } from "./memory";
import { drawnFaces, movedAttributes } from "./parting";

export type { DrawnAttribute, Piece };

/** A whole mesh as it is drawn; `vertices`: the vertex of the stream that each drawn one is, if they differ. */
export interface Shape extends Omit<DrawnFaces, "own">, Bounds {
    positions: Float32Array;
    normals: Float32Array;
}

/** What can be drawn now; normals of frames are multiplied by 32767, and their attributes are those that change. */
export type Picture =
    | EventOf<"header" | "metadata" | "loss" | "end">
    /** A mesh that grows has begun. */
    | { type: "begun"; vertices: number; corners: number; loose: Loose }
    /** Vertices that have moved or whose normals have; corners of faces that can be drawn now; `origin`: blocks, or -1. */
    | ({ type: "grown"; blocks: number } & Grown)
    /** The whole mesh, or the first frame of a run; `growth`: the blocks of all vertices of a mesh that grew. */
    | { type: "whole"; shape: Shape; run: number; growth?: { origin: Int32Array; blocks: number } }
    | ({ type: "frame"; index: number; normals: Int16Array } & Omit<Shape, "normals" | "index" | "vertices" | "pieces">)
    /** It is there, and drawn once the mesh is whole. */
    | ({ type: "attribute" } & Pick<Attribute, "name" | "semantic" | "domain">);

export type PictureOf<Type> = Extract<Picture, { type: Type }>;

type Show = (picture: Picture, moved?: Transferable[]) => void;

const MOST_NORMAL = 32767;
const PAUSE = 30; // milliseconds, at least, before each picture of what grows, but the first one of several blocks
const LIGHT_PAUSE = 100; // before the first one of a light grid, whose decoder is as fast as a picture
const SHARE = 4; // times what such a picture takes
const USUAL = 0.766; // the cosine of the usual angle, as in library/wasm/draw.c

export class Drawing {
    private readonly limits: Limits;
    private faces: Int32Array = new Int32Array(0);
    private points: Float64Array = new Float64Array(0);
    private origin: Int32Array = new Int32Array(0);
    /** What has come since vertices were moved last. */
    private moves: Move[] = [];
    private blocks = 0;
    /** When there may be another picture of what grows, and how long what it shows waits for the first. */
    private due = 0;
    private first = PAUSE;
    private timer?: ReturnType<typeof setTimeout>;
    private readonly carried: Attribute[] = [];
    private shape?: Shape;
    /** Bytes of frames and shapes that are kept. */
    private kept = 0;
    private run = 0;
    /** The vertices of the stream that those of `faces` are, once these are parted at sharp edges. */
    private sources?: Int32Array;
    /** The vertices of `faces` that are drawn, if they differ. */
    private rows?: Int32Array;

    constructor(
        private growing: boolean,
        limits: Partial<Limits>,
        private readonly memory: Memory,
        private readonly show: Show,
        /** As in `Start`; null: no edges are sharp, as in the first run. */
        private crease?: number | null,
    ) {
        this.limits = { ...DEFAULT_LIMITS, ...limits };
    }

    accept(event: Event): void {
        switch (event.type) {
            case "header":
                return this.startRun(event);
            case "connectivity":
                return this.begin(event);
            case "block":
            case "refinement":
                return this.grow(event);
            case "attribute": {
                const { type, name, semantic, domain } = event;
                this.carried.push(event);
                return this.run > 0 ? undefined : this.show({ type, name, semantic, domain });
            }
            case "frame":
                return this.addFrame(event);
            case "loss":
                this.flush();
                return this.show(event);
            case "end":
                if (event.positions) this.take(event.positions);
                if (!this.shape) this.finish();
                return this.show({ ...event, positions: undefined });
            default:
                return this.show(event);
        }
    }

    private startRun(event: EventOf<"header">): void {
        const { run, light, blocks } = event.header;
        this.first = light > 0 ? LIGHT_PAUSE : blocks > 1 ? 0 : PAUSE;
        if (!run) return this.show(event); // pages draw meshes of their own with a header of two numbers
        this.flush();
        [this.run, this.growing] = [run, false];
        this.faces = new Int32Array(0);
        [this.points, this.origin] = [new Float64Array(0), new Int32Array(0)];
        [this.carried.length, this.shape, this.sources] = [0, undefined, undefined];
    }

    /** No more bytes are there: show what has come, as soon as there may be another picture. */
    pause(): void {
        clearTimeout(this.timer);
        if (this.growing) this.timer = setTimeout(() => this.flush(), this.due - performance.now());
    }

    /** Show no more of what grows. */
    close(): void {
        this.growing = false;
        clearTimeout(this.timer);
    }

    /** Show what has come: its vertices, the faces that are whole by it, and the normals at these. */
    flush(): void {
        if (!this.growing || this.moves.length === 0) return;
        const begin = performance.now();
        const news = this.settle();
        const grown = this.memory.grown(this.faces, this.points, this.origin, news);
        const { vertices, positions, normals, origin, index } = grown;
        const moved = [vertices, positions, normals, origin, index].map(({ buffer }) => buffer);
        this.show({ type: "grown", ...grown, blocks: this.blocks }, moved);
        const now = performance.now();
        this.due = now + Math.max(PAUSE, SHARE * (now - begin));
    }

    private begin({ faces, vertices: size, loose }: EventOf<"connectivity">): void {
        this.faces = faces;
        this.origin = new Int32Array(size).fill(-1);
        this.points = new Float64Array(3 * size);
        loose.vertices.forEach((vertex, i) => this.points.set(loose.positions.subarray(3 * i, 3 * i + 3), 3 * vertex));
        this.due = performance.now() + this.first; // a mesh that is whole by then needs no earlier picture
        if (this.growing) this.show({ type: "begun", vertices: size, corners: faces.length, loose });
    }

    private grow(event: EventOf<"block" | "refinement">): void {
        this.moves.push([event, this.blocks]);
        if (event.type === "block") this.blocks++;
        if (performance.now() > this.due) this.flush();
    }

    /** Move the vertices that have arrived, and return for each whether it is new or has moved. */
    private settle(): Uint8Array {
        return this.memory.moved(this.points, this.origin, this.moves.splice(0));
    }

    private take(positions: Float64Array): void {
        this.settle();
        this.points = positions;
        if (this.blocks === 0) this.origin.fill(0);
        else this.origin = this.origin.map((block) => Math.max(block, 0));
    }

    private addFrame({ index, positions: points, attributes: moved }: EventOf<"frame">): void {
        this.kept += 18 * (points.length / 3) + moved.reduce((sum, { values }) => sum + 4 * values.length, 0);
        checkLimit(this.limits, "keptBytes", this.kept);
        if (!this.shape) {
            this.take(points);
            this.finish();
        }
        const all = this.placesOf(points);
        const [positions, exact] = [all.positions, all.normals].map((each) => spread(each, 3, this.rows));
        const normals = new Int16Array(exact.length);
        for (let i = 0; i < normals.length; i++) normals[i] = Math.round(exact[i] * MOST_NORMAL);
        const attributes = moved.length > 0 ? movedAttributes(this.shape!, moved) : [];
        const buffers = [positions, normals, ...attributes.map(({ values }) => values)].map(({ buffer }) => buffer);
        const bounds = this.memory.bounds(positions);
        this.show({ type: "frame", index, positions, normals, attributes, ...bounds }, buffers);
    }

    /** The mesh is whole: part its vertices where its attributes do, and sort its faces by parts and materials. */
    private finish(): void {
        this.settle();
        this.part();
        const { origin, points, carried, blocks, sources } = this;
        const all = this.placesOf(points);
        const isOwn = this.crease !== undefined;
        const { index, vertices, pieces, attributes, own } =
            carried.length > 0 ? drawnFaces(this.faces, all.origin, carried, sources, isOwn) : bare(all);
        this.rows = vertices;
        const positions = spread(all.positions, 3, vertices);
        const normals = own ?? spread(all.normals, 3, vertices);
        const bounds = this.memory.bounds(positions);
        const places = { index, positions, normals, vertices: composed(vertices, sources) };
        const shape = (this.shape = { ...places, attributes, pieces, ...bounds });
        const arrays = [index, positions, normals, ...attributes.map(({ values }) => values)];
        const buffers = arrays.map(({ buffer }) => buffer);
        if (this.run > 0) this.kept += buffers.reduce((sum, { byteLength }) => sum + byteLength, 0);
        const growth = this.growing ? { origin, blocks } : undefined;
        this.growing = false; // nothing is "grown" after the whole picture
        this.show({ type: "whole", shape, run: this.run, growth }, buffers);
    }

    /** Part vertices at sharp edges, unless the mesh has normals of its own; later runs follow the first. */
    private part(): void {
        const { carried, crease, faces, memory, points } = this;
        const hasNormals = carried.some(({ semantic, domain }) => semantic === "normal" && domain !== "face");
        if (crease === undefined || crease === null || hasNormals) return;
        const creased = memory.creased(faces, points, crease);
        if (creased) [this.faces, this.sources] = creased;
        if (crease < -1) this.crease = creased ? USUAL : null;
    }

    /** The places and normals of all vertices of the faces, where those of the stream are at `points`. */
    private placesOf(points: Float64Array): Grown {
        const { faces, origin, sources, memory } = this;
        if (!sources) return memory.grown(faces, points, origin);
        const origins = sources.map((vertex) => origin[vertex]);
        return memory.grown(faces, spread(points, 3, sources, Float64Array), origins);
    }
}

function bare({ index, vertices }: Grown): DrawnFaces {
    const piece = { part: 0, material: 0, start: 0, count: index.length, first: 0, vertices: vertices.length };
    return { index, pieces: index.length > 0 ? [piece] : [], attributes: [] };
}
