/** BSM streams in three.js: a loader that fills one geometry block by block while the bytes arrive. */
import { BufferAttribute, BufferGeometry, Loader, type LoadingManager } from "three";
import { Decoder, NEED_DATA, type BlockEvent, type Event, type RefinementEvent } from "./decoder";
import { UnsupportedError } from "./errors";
import type { Header } from "./header";
import type { Kernels } from "./kernels";
import type { Limits } from "./limits";

/** What happens to a geometry while it is filled. */
export interface Progress {
    /** The faces are there; the geometry draws nothing yet. */
    onConnectivity?: (geometry: BufferGeometry) => void;
    /** A block, a chunk of a grid, or levels of a layer are in the geometry: what they moved, and the geometry. */
    onBlock?: (block: BlockEvent | RefinementEvent, geometry: BufferGeometry) => void;
}

/**
 * Fills a geometry from a stream that comes in pieces.
 *
 * The index holds all faces from the beginning, sorted so that those whose corners are known come first, and the
 * draw range ends behind them: a block makes its faces visible, and nothing is copied twice.
 */
export class GeometryFiller {
    readonly geometry = new BufferGeometry();
    /** The block that each vertex came with, -1 as long as it is not there. */
    origin = new Int32Array(0);
    /** What the stream says of itself, as soon as that is there. */
    header?: Header;
    private readonly decoder: Decoder;
    private faces: Int32Array = new Int32Array(0);
    private waiting = new Uint8Array(0);
    private facesAround: { starts: Int32Array; members: Int32Array } = { starts: new Int32Array(1), members: new Int32Array(0) };
    private drawn = 0;
    private blocks = 0;

    constructor(
        kernels: Kernels,
        private readonly progress: Progress = {},
        limits: Partial<Limits> = {},
    ) {
        this.decoder = new Decoder(kernels, limits);
    }

    /** Take bytes, and bring the geometry up to them; the blocks decoded so far. */
    receiveData(data: Uint8Array): number {
        this.decoder.receiveData(data);
        for (let event; (event = this.decoder.nextEvent()) !== NEED_DATA; ) this.accept(event as Event);
        return this.blocks;
    }

    /** Take note that no more bytes will come, and finish the geometry; throws if bytes are missing. */
    finish(): BufferGeometry {
        this.decoder.receiveEof();
        this.decoder.nextEvent();
        this.geometry.computeBoundingSphere();
        return this.geometry;
    }

    private accept(event: Event): void {
        if (event.type === "header") this.acceptHeader(event.header);
        if (event.type === "connectivity") this.acceptFaces(event.faces);
        if (event.type === "block" || event.type === "refinement") this.acceptBlock(event);
    }

    private acceptHeader(header: Header): void {
        if (header.gopFrames > 0) throw new UnsupportedError("this is a sequence, which is no single geometry");
        this.header = header;
    }

    private acceptFaces(faces: Int32Array): void {
        const size = faces.reduce((most, vertex) => Math.max(most, vertex), -1) + 1;
        this.faces = faces;
        this.origin = new Int32Array(size).fill(-1);
        this.waiting = new Uint8Array(faces.length / 3).fill(3);
        this.facesAround = aroundVertices(faces, size);
        this.geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * size), 3));
        this.geometry.setAttribute("normal", new BufferAttribute(new Float32Array(3 * size), 3));
        this.geometry.setIndex(new BufferAttribute(new Uint32Array(faces.length), 1));
        this.geometry.setDrawRange(0, 0);
        this.progress.onConnectivity?.(this.geometry);
    }

    private acceptBlock(block: BlockEvent | RefinementEvent): void {
        const { starts, members } = this.facesAround;
        const positions = this.geometry.getAttribute("position") as BufferAttribute;
        const index = this.geometry.getIndex()!;
        block.vertices.forEach((vertex, i) => {
            positions.setXYZ(vertex, block.positions[3 * i], block.positions[3 * i + 1], block.positions[3 * i + 2]);
            if (this.origin[vertex] >= 0) return;
            this.origin[vertex] = this.blocks;
            for (let k = starts[vertex]; k < starts[vertex + 1]; k++) if (--this.waiting[members[k]] === 0) this.draw(members[k], index);
        });
        this.updateNormals(block.vertices);
        positions.needsUpdate = true;
        index.needsUpdate = true;
        this.geometry.setDrawRange(0, this.drawn);
        if (block.type === "block") this.blocks++;
        this.progress.onBlock?.(block, this.geometry);
    }

    private draw(face: number, index: BufferAttribute): void {
        (index.array as Uint32Array).set(this.faces.subarray(3 * face, 3 * face + 3), this.drawn);
        this.drawn += 3;
    }

    /** Normals of some vertices and of those beside them, from the faces that are there. */
    private updateNormals(vertices: Int32Array): void {
        const { starts, members } = this.facesAround;
        const touched = new Set<number>();
        for (const vertex of vertices) {
            for (let k = starts[vertex]; k < starts[vertex + 1]; k++) for (let c = 0; c < 3; c++) touched.add(this.faces[3 * members[k] + c]);
        }
        const positions = (this.geometry.getAttribute("position") as BufferAttribute).array;
        const normals = this.geometry.getAttribute("normal") as BufferAttribute;
        for (const vertex of touched) {
            let [x, y, z] = [0, 0, 0];
            for (let k = starts[vertex]; k < starts[vertex + 1]; k++) {
                if (this.waiting[members[k]] > 0) continue;
                const [a, b, c] = [0, 1, 2].map((corner) => 3 * this.faces[3 * members[k] + corner]);
                const [ux, uy, uz] = [0, 1, 2].map((d) => positions[b + d] - positions[a + d]);
                const [vx, vy, vz] = [0, 1, 2].map((d) => positions[c + d] - positions[a + d]);
                x += uy * vz - uz * vy;
                y += uz * vx - ux * vz;
                z += ux * vy - uy * vx;
            }
            const length = Math.hypot(x, y, z) || 1;
            normals.setXYZ(vertex, x / length, y / length, z / length);
        }
        normals.needsUpdate = true;
    }
}

function aroundVertices(faces: Int32Array, size: number): { starts: Int32Array; members: Int32Array } {
    const starts = new Int32Array(size + 1);
    for (const vertex of faces) starts[vertex + 1]++;
    for (let v = 0; v < size; v++) starts[v + 1] += starts[v];
    const filled = starts.slice();
    const members = new Int32Array(faces.length);
    faces.forEach((vertex, i) => (members[filled[vertex]++] = Math.floor(i / 3)));
    return { starts, members };
}

/** Loads BSM streams, as DRACOLoader loads its own; the geometry is also there block by block, by `onBlock`. */
export class BSMLoader extends Loader<BufferGeometry> {
    constructor(
        private readonly kernels: Kernels | Promise<Kernels>,
        manager?: LoadingManager,
    ) {
        super(manager);
    }

    override load(
        url: string,
        onLoad: (geometry: BufferGeometry) => void,
        onProgress?: (event: ProgressEvent) => void,
        onError?: (error: unknown) => void,
        onBlock?: Progress["onBlock"],
    ): void {
        this.manager.itemStart(url);
        this.stream(url, onProgress, { onBlock })
            .then(onLoad)
            .catch((error) => {
                if (onError) onError(error);
                else console.error(error);
                this.manager.itemError(url);
            })
            .finally(() => this.manager.itemEnd(url));
    }

    private async stream(url: string, onProgress: ((event: ProgressEvent) => void) | undefined, progress: Progress): Promise<BufferGeometry> {
        const response = await fetch(new URL(this.path + url, globalThis.document?.baseURI ?? url), {
            headers: this.requestHeader,
            credentials: this.withCredentials ? "include" : "same-origin",
        });
        if (!response.ok || !response.body) throw new Error(`${url}: ${response.status} ${response.statusText}`);
        const total = Number(response.headers.get("content-length") ?? 0);
        const filler = new GeometryFiller(await this.kernels, progress);
        const reader = response.body.getReader();
        let loaded = 0;
        for (let piece; !(piece = await reader.read()).done; ) {
            loaded += piece.value.length;
            filler.receiveData(piece.value);
            onProgress?.(new ProgressEvent("progress", { lengthComputable: total > 0, loaded, total }));
        }
        return filler.finish();
    }
}
