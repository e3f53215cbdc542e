/** A geometry of three.js that is made of pictures, while they come. */
import { Box3, BufferAttribute, BufferGeometry, Sphere, Vector3 } from "three";
import type { Header, Metadata, Picture, PictureOf, Piece, Shape } from "./index";
import type { Bounds } from "./memory";
import type { Build } from "./peek";

const MOST_NORMAL = 32767; // what normals of frames are multiplied by

function bound(geometry: BufferGeometry, { low, high, center, radius }: Bounds): void {
    geometry.boundingBox = new Box3(new Vector3(...low), new Vector3(...high));
    geometry.boundingSphere = new Sphere(new Vector3(...center), radius);
}

function renew(geometry: BufferGeometry, name: string, array: BufferAttribute["array"]): void {
    Object.assign(geometry.getAttribute(name), { array, needsUpdate: true });
}

/** The numbers that a piece has of those of all drawn vertices; all of them where it has no vertices of its own. */
function sliceOf(array: Float32Array, { positions }: Shape, { first, vertices }: Piece): Float32Array {
    if (vertices === 0) return array;
    const width = (3 * array.length) / positions.length;
    return array.subarray(width * first, width * (first + vertices));
}

/** What happens to a geometry while it is filled. */
export interface Progress {
    /** Faces are there; those whose corners have no position yet are not drawn. */
    onConnectivity?: (geometry: BSMGeometry) => void;
    /** Vertices have come, or moved. */
    onBlock?: (geometry: BSMGeometry) => void;
    /** A frame of a sequence is there to be shown. */
    onFrame?: (index: number, geometry: BSMGeometry) => void;
    /** The decoder that the stream is thought to need; its thread starts before the first bytes come. */
    guess?: Build;
    /** Stops this load alone. */
    signal?: AbortSignal;
}

/**
 * Texture coordinates are `uv`, colors `color`, normals `normal`, others have their names, and second ones of a kind a
 * number behind it. While it grows the index has room for all faces; those whose corners are known come first, and the draw
 * range ends behind them. At the end it is indexed by all that a corner has, and its groups have one material each.
 */
export class BSMGeometry extends BufferGeometry {
    /** What the stream says of itself, as soon as that is there. */
    header?: Header;
    /** What its author says of it. */
    readonly metadata: Metadata = new Map();
    /** The block that each vertex came with, -1 as long as it is not there; only of a geometry that grows. */
    origin = new Int32Array(0);
    /** Blocks, or chunks of a grid, that are there. */
    blocks = 0;
    /** Attributes that are there, and are drawn once the mesh is whole. */
    readonly carried: PictureOf<"attribute">[] = [];
    /** Positions of the stream's vertices, shape (n, 3); only of a geometry that grows. */
    points = new Float32Array(0);
    /** The stream's vertex that each drawn one is, where seams have parted them. */
    parted?: Int32Array;
    /** Faces of one part and one material each. */
    pieces: Piece[] = [];
    /** Frames of a sequence that are there, for `showFrame`. */
    readonly frames: (Omit<PictureOf<"frame">, "type"> & { shape: Shape })[] = [];
    shown = -1;
    /** The colors that the stream has, of what is shown. */
    color?: BufferAttribute;
    /** What the frames that come are drawn as, and the one that is shown. */
    private coming?: Shape;
    private worn?: Shape;
    private normals = new Float32Array(0);
    /** Geometries of the pieces, by their numbers, which show the same frame. */
    private readonly parts = new Map<number, BufferGeometry>();
    private drawn = 0;
    /** Whether a piece is drawn no longer. */
    isHidden = (_: Piece): boolean => false;

    constructor(private readonly progress: Progress = {}) {
        super();
    }

    /** Frames per second; 0: the stream is not a sequence, or does not say. */
    get frameRate(): number {
        const rate = this.metadata.get("frame_rate");
        return typeof rate === "number" && rate > 0 && rate < Infinity ? rate : 0;
    }

    /** Bring the geometry up to a picture. */
    accept(picture: Picture): void {
        switch (picture.type) {
            case "header":
                this.header = picture.header;
                return;
            case "metadata":
                return picture.entries.forEach((value, name) => this.metadata.set(name, value));
            case "begun":
                return this.begin(picture);
            case "grown":
                return this.grow(picture);
            case "whole":
                this.coming = picture.shape;
                if (picture.run === 0) this.take(picture.shape);
                if (!picture.growth) return;
                Object.assign(this, picture.growth);
                return this.progress.onBlock?.(this);
            case "attribute":
                return void this.carried.push(picture);
            case "frame":
                return this.keep(picture);
            case "loss":
                return this.lose(picture);
        }
    }

    /** Take the positions of a frame that is there. */
    showFrame(index: number): void {
        const { positions, normals, attributes, shape, ...bounds } = this.frames[index];
        if (index === this.shown) return;
        this.shown = index;
        if (shape !== this.worn) this.take(shape);
        // Arrays change hands; nothing is copied but normals, whose three small numbers not all graphics and tools take.
        const { array: worn } = this.getAttribute("normal");
        const array = worn === shape.normals ? new Float32Array(worn.length) : worn;
        for (let i = 0; i < normals.length; i++) array[i] = normals[i] / MOST_NORMAL;
        const arrays = [
            ["position", positions],
            ["normal", array],
            ...attributes.map(({ name, values }) => [name, values]),
        ];
        for (const [name, array] of arrays as [string, Float32Array][]) {
            renew(this, name, array);
            for (const [number, part] of this.parts)
                if (shape.pieces[number]) renew(part, name, sliceOf(array, shape, shape.pieces[number]));
        }
        bound(this, bounds);
        for (const part of this.parts.values()) this.boundPart(part);
    }

    /** A geometry of one piece, with vertices and bounds of its own, which shows the frame that this one shows. */
    partOf(number: number): BufferGeometry {
        const part = this.parts.get(number) ?? new BufferGeometry();
        if (this.frames.length > 0) this.parts.set(number, part);
        this.fillPart(number, part);
        return part;
    }

    private fillPart(number: number, part: BufferGeometry): void {
        const { worn } = this;
        const piece = worn?.pieces[number];
        if (part.index) part.dispose();
        if (!worn || !piece) return void part.setIndex([]);
        const { start, count, first } = piece;
        for (const name of Object.keys(this.attributes)) {
            const { array, itemSize } = this.getAttribute(name);
            part.setAttribute(name, new BufferAttribute(sliceOf(array as Float32Array, worn, piece), itemSize));
        }
        part.setIndex(
            new BufferAttribute(
                worn.index.slice(start, start + count).map((drawn) => drawn - first),
                1,
            ),
        );
        this.boundPart(part);
    }

    /** Have bounds computed when they are asked for; while it moves, a sphere that is there is large enough to draw by. */
    private boundPart(part: BufferGeometry): void {
        [part.boundingBox, part.boundingSphere] = [null, this.frames.length > 0 ? this.boundingSphere : null];
    }

    /** Draw some pieces no longer, in all frames. */
    hide(hidden: (piece: Piece) => boolean): void {
        this.isHidden = hidden;
        const index = this.getIndex();
        if (index && this.worn) [index.array, index.needsUpdate] = [this.cornersOf(this.worn), true];
    }

    /** The corners of faces, those of hidden ones in one point. */
    private cornersOf({ index, pieces }: Shape): Uint32Array {
        const hidden = pieces.filter(this.isHidden);
        const corners = hidden.length > 0 ? index.slice() : index;
        for (const { start, count } of hidden) corners.fill(0, start, start + count);
        return corners;
    }

    private begin({ vertices, corners, loose }: PictureOf<"begun">): void {
        this.refuseIfWhole();
        this.points = new Float32Array(3 * vertices);
        this.normals = new Float32Array(3 * vertices);
        this.origin = new Int32Array(vertices).fill(-1);
        loose.vertices.forEach((vertex, i) => this.points.set(loose.positions.subarray(3 * i, 3 * i + 3), 3 * vertex));
        this.setAttribute("position", new BufferAttribute(this.points, 3));
        this.setAttribute("normal", new BufferAttribute(this.normals, 3));
        this.setIndex(new BufferAttribute(new Uint32Array(corners), 1));
        this.setDrawRange(0, this.drawn);
        this.progress.onConnectivity?.(this);
    }

    private grow({ vertices, positions, normals, origin, index, blocks }: PictureOf<"grown">): void {
        this.refuseIfWhole();
        const { points: p, normals: n } = this;
        for (let row = 0; row < vertices.length; row++) {
            // One by one: lists take several times as long before this is compiled.
            for (let d = 0, to = 3 * vertices[row], from = 3 * row; d < 3; d++, to++, from++) {
                p[to] = positions[from];
                n[to] = normals[from];
            }
            this.origin[vertices[row]] = origin[row];
        }
        const corners = this.getIndex();
        corners?.array.set(index, this.drawn);
        this.drawn += index.length;
        for (const attribute of [corners, this.getAttribute("position"), this.getAttribute("normal")]) {
            if (attribute) (attribute as BufferAttribute).needsUpdate = true;
        }
        this.setDrawRange(0, this.drawn);
        [this.boundingBox, this.boundingSphere] = [null, null]; // those of what was there before
        this.blocks = blocks;
        this.progress.onBlock?.(this);
    }

    /** Growth has the stream's vertices and faces; a whole mesh has parted and sorted ones. */
    private refuseIfWhole(): void {
        if (this.worn) throw new Error("this geometry is whole and cannot grow");
    }

    private take(shape: Shape): void {
        const { index, positions, normals, attributes, vertices, pieces } = shape;
        if (this.getIndex()) this.dispose();
        if (this.worn) for (const { name } of this.worn.attributes) this.deleteAttribute(name);
        this.worn = shape;
        this.clearGroups();
        this.parted = vertices;
        this.pieces = pieces;
        this.setIndex(new BufferAttribute(this.cornersOf(shape), 1));
        this.setAttribute("position", new BufferAttribute(positions, 3));
        this.setAttribute("normal", new BufferAttribute(normals, 3));
        for (const { name, values, components } of attributes)
            this.setAttribute(name, new BufferAttribute(values, components));
        this.color = this.attributes.color as BufferAttribute | undefined;
        this.setDrawRange(0, index.length);
        if (pieces.some(({ material }) => material > 0))
            pieces.forEach(({ start, count, material }) => this.addGroup(start, count, material));
        bound(this, shape);
        for (const [number, part] of this.parts) this.fillPart(number, part);
    }

    private keep({ type: _, ...frame }: PictureOf<"frame">): void {
        const { index } = frame;
        this.frames.push({ ...frame, shape: this.coming! });
        if (index === 0) this.showFrame(0);
        this.progress.onFrame?.(index, this);
    }

    private lose({ frames }: PictureOf<"loss">): void {
        const before = this.frames.at(-1);
        for (let k = 0; before && k < (frames?.count ?? 0); k++) this.frames.push(before);
    }
}
