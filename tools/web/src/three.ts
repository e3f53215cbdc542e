/** BSM streams in three.js: a geometry that fills while the bytes arrive, and a loader. */
import { BufferAttribute, BufferGeometry, Loader, type LoadingManager } from "three";
import {
    checkLimit, DecoderThread, DEFAULT_LIMITS, type Attribute, type BlockEvent, type ConnectivityEvent, type DrawnEvent, type Event, type Header,
    type Kernels, type Limits, type LossEvent, type Metadata, type RefinementEvent,
} from "./index";

/** What happens to a geometry while it is filled. */
export interface Progress {
    /** Faces are there, all or those of one more section; those whose corners have no position yet are not drawn. */
    onConnectivity?: (geometry: BSMGeometry) => void;
    /** A block, a chunk of a grid, or levels of a layer are in the geometry: what they moved, and the geometry. */
    onBlock?: (block: BlockEvent | RefinementEvent, geometry: BSMGeometry) => void;
    /** A frame of a sequence is there to be shown: its number, and the geometry. */
    onFrame?: (index: number, geometry: BSMGeometry) => void;
}

/**
 * A geometry made of the events of a stream.
 *
 * Attributes are drawn once the mesh is whole: texture coordinates are `uv`, colours `color`, normals `normal`, others have
 * their names, and second ones of a kind a number behind it. The index has room for all faces that have come; those whose corners are
 * known come first, and the draw range ends behind them: a block makes its faces visible. Each section of a mesh makes the
 * arrays larger, and takes with it what is there.
 */
export class BSMGeometry extends BufferGeometry {
    /** What the stream says of itself, as soon as that is there. */
    header?: Header;
    /** The block that each vertex came with, -1 as long as it is not there. */
    origin = new Int32Array(0);
    /** How many quality layers have moved each vertex. */
    depth = new Uint8Array(0);
    /** Quality layers that are there for every vertex. */
    layers = 0;
    /** Blocks, or chunks of a grid, that are there. */
    blocks = 0;
    /** Sections whose faces are there. */
    sections = 0;
    /** Attributes that are there, as the stream has them; the geometry has those that it can draw once it is whole. */
    readonly carried: Attribute[] = [];
    /** Positions of the vertices, shape (n, 3). */
    points = new Float32Array(0);
    /** The vertex that each drawn one is, where attributes of corners or faces have parted them. */
    parted?: Int32Array;
    /** Positions of the frames of a sequence that are there, for `showFrame`. */
    readonly frames: Float32Array[] = [];
    private readonly limits: Limits;
    private faces: Int32Array = new Int32Array(0);
    private waiting = new Uint8Array(0);
    private metadata: Metadata = {};
    private facesAround: { starts: Int32Array; members: Int32Array } = { starts: new Int32Array(1), members: new Int32Array(0) };
    private touched = new Uint8Array(0);
    private normals = new Float32Array(0);
    private drawn = 0;

    constructor(
        private readonly progress: Progress = {},
        limits: Partial<Limits> = {},
    ) {
        super();
        this.limits = { ...DEFAULT_LIMITS, ...limits };
    }

    /** Frames per second; 0: the stream is no sequence, or does not say. */
    get frameRate(): number {
        const { frame_rate: rate } = this.metadata;
        return typeof rate === "number" && rate > 0 && rate < Infinity ? rate : 0;
    }

    /** Bring the geometry up to an event. */
    accept(event: Event | DrawnEvent): void {
        if (event.type === "header") this.header = event.header;
        if (event.type === "metadata") this.metadata = event.entries;
        if (event.type === "connectivity") this.acceptFaces(event);
        if (event.type === "block" || event.type === "refinement") this.acceptBlock(event);
        if (event.type === "frame") this.acceptFrame(event.index, event.positions);
        if (event.type === "loss") this.acceptLoss(event);
        if (event.type === "attribute") this.carried.push(event);
        if (event.type === "end") this.finish();
    }

    /** Take the positions of a frame that is there. */
    showFrame(index: number): void {
        this.points.set(this.frames[index]);
        this.renewNormals();
        this.redraw();
    }

    /** Numbers of vertices, `width` for each, as those of the drawn ones. */
    spread(numbers: Float32Array, width: number): Float32Array {
        const { parted } = this;
        if (!parted) return numbers;
        const spread = new Float32Array(width * parted.length);
        parted.forEach((vertex, i) => spread.set(numbers.subarray(width * vertex, width * vertex + width), width * i));
        return spread;
    }

    private acceptFaces({ faces: added, vertices: size, loose, section }: ConnectivityEvent): void {
        this.sections = section + 1;
        const [known, before, index] = [this.faces.length, this.origin.length, this.getIndex()];
        const faces = grown(this.faces, known + added.length);
        faces.set(added, known);
        this.faces = faces;
        this.origin = grown(this.origin, size).fill(-1, before);
        this.depth = grown(this.depth, size);
        this.touched = grown(this.touched, size);
        this.waiting = grown(this.waiting, faces.length / 3);
        this.facesAround = aroundVertices(faces, size);
        this.points = grown(this.points, 3 * size);
        this.normals = grown(this.normals, 3 * size);
        loose.vertices.forEach((vertex, i) => this.points.set(loose.positions.subarray(3 * i, 3 * i + 3), 3 * vertex));
        if (index) this.dispose(); // what is drawn has no room for more
        this.deleteAttribute("color");
        this.setAttribute("position", new BufferAttribute(this.points, 3));
        this.setAttribute("normal", new BufferAttribute(this.normals, 3));
        this.setIndex(new BufferAttribute(grown((index?.array ?? new Uint32Array(0)) as Uint32Array, faces.length), 1));
        for (let corner = known; corner < faces.length; corner += 3) this.drawOrWait(corner / 3);
        this.updateNormals();
        this.setDrawRange(0, this.drawn);
        this.progress.onConnectivity?.(this);
    }

    /** Draw a face that has come if all of its corners are there; wait for the others. */
    private drawOrWait(face: number): void {
        const corners = this.faces.subarray(3 * face, 3 * face + 3);
        this.waiting[face] = corners.filter((vertex) => this.origin[vertex] < 0).length;
        if (this.waiting[face] > 0) return;
        this.draw(face, this.getIndex()!);
        for (const vertex of corners) this.touched[vertex] = 1;
    }

    private acceptBlock(block: BlockEvent | RefinementEvent): void {
        const { starts, members } = this.facesAround;
        const { points } = this;
        const index = this.getIndex()!;
        block.vertices.forEach((vertex, i) => {
            for (let d = 0; d < 3; d++) points[3 * vertex + d] = block.positions[3 * i + d];
            for (let k = starts[vertex]; k < starts[vertex + 1]; k++) for (let c = 0; c < 3; c++) this.touched[this.faces[3 * members[k] + c]] = 1;
            if (this.origin[vertex] >= 0) return;
            this.origin[vertex] = this.blocks;
            for (let k = starts[vertex]; k < starts[vertex + 1]; k++) if (--this.waiting[members[k]] === 0) this.draw(members[k], index);
        });
        this.updateNormals();
        this.redraw();
        index.needsUpdate = true;
        this.setDrawRange(0, this.drawn);
        if (block.type === "block") this.blocks++;
        else this.deepen(block);
        this.progress.onBlock?.(block, this);
    }

    private deepen({ layer, vertices }: RefinementEvent): void {
        for (const vertex of vertices) this.depth[vertex] = layer + 1;
        if (this.depth.every((depth) => depth > layer)) this.layers = layer + 1;
    }

    private acceptFrame(index: number, positions: ArrayLike<number>): void {
        checkLimit(this.limits, "keptBytes", 4 * positions.length * (this.frames.length + 1));
        this.frames.push(positions instanceof Float32Array ? positions : Float32Array.from(positions));
        this.progress.onFrame?.(index, this);
    }

    /** Where frames are lost, the one before them stays. */
    private acceptLoss({ frames }: LossEvent): void {
        const before = this.frames.at(-1) ?? this.points.slice();
        for (let k = 0; k < (frames?.count ?? 0); k++) this.frames.push(before);
    }

    private draw(face: number, index: BufferAttribute): void {
        (index.array as Uint32Array).set(this.faces.subarray(3 * face, 3 * face + 3), this.drawn);
        this.drawn += 3;
    }

    /** Normals of the vertices that were touched, from the faces that are there. */
    private updateNormals(): void {
        const { faces, touched, waiting, normals, points: p } = this;
        const { starts, members } = this.facesAround;
        for (let vertex = 0; vertex < touched.length; vertex++) {
            if (!touched[vertex]) continue;
            touched[vertex] = 0;
            let [x, y, z] = [0, 0, 0];
            for (let k = starts[vertex]; k < starts[vertex + 1]; k++) {
                const face = members[k];
                if (waiting[face] > 0) continue;
                const a = 3 * faces[3 * face];
                const b = 3 * faces[3 * face + 1];
                const c = 3 * faces[3 * face + 2];
                const ux = p[b] - p[a];
                const uy = p[b + 1] - p[a + 1];
                const uz = p[b + 2] - p[a + 2];
                const vx = p[c] - p[a];
                const vy = p[c + 1] - p[a + 1];
                const vz = p[c + 2] - p[a + 2];
                x += uy * vz - uz * vy;
                y += uz * vx - ux * vz;
                z += ux * vy - uy * vx;
            }
            const length = Math.sqrt(x * x + y * y + z * z) || 1;
            normals[3 * vertex] = x / length;
            normals[3 * vertex + 1] = y / length;
            normals[3 * vertex + 2] = z / length;
        }
    }

    /** Normals of all vertices: each face is looked at once, and not from each of its corners. */
    private renewNormals(): void {
        const { faces, waiting, normals: n, points: p } = this;
        n.fill(0);
        for (let face = 0, k = 0; face < waiting.length; face++, k += 3) {
            if (waiting[face] > 0) continue;
            const [a, b, c] = [3 * faces[k], 3 * faces[k + 1], 3 * faces[k + 2]];
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
    }

    /** Bring what is drawn up to points and normals. */
    private redraw(): void {
        const own = this.carried.some(({ semantic, domain }) => semantic === "normal" && domain !== "face");
        for (const [name, numbers] of [["position", this.points], ["normal", this.normals]] as const) {
            if (name === "normal" && own && this.parted) continue;
            const attribute = this.getAttribute(name) as BufferAttribute;
            if (this.parted) (attribute.array as Float32Array).set(this.spread(numbers, 3));
            attribute.needsUpdate = true;
        }
    }

    /** The mesh is whole: draw the attributes that came with it. */
    private finish(): void {
        if (this.carried.some(({ domain }) => domain !== "vertex")) this.part();
        const used = new Map<string, number>();
        for (const attribute of this.carried) {
            const base = { texcoord: "uv", color: "color", normal: "normal", generic: attribute.name }[attribute.semantic];
            const count = used.get(base) ?? 0;
            used.set(base, count + 1);
            this.setAttribute(count ? `${base}${count}` : base, new BufferAttribute(this.numbersOf(attribute), attribute.components));
        }
        this.computeBoundingSphere();
    }

    /** Give each corner of the drawn faces a vertex of its own. */
    private part(): void {
        this.parted = Int32Array.from(this.wholeFaces().flatMap((face) => [...this.faces.subarray(3 * face, 3 * face + 3)]));
        this.setAttribute("position", new BufferAttribute(this.spread(this.points, 3), 3));
        this.setAttribute("normal", new BufferAttribute(this.spread(this.normals, 3), 3));
        this.setIndex(null);
        this.setDrawRange(0, this.parted.length);
    }

    private wholeFaces(): number[] {
        return [...this.waiting.keys()].filter((face) => this.waiting[face] === 0);
    }

    /** Numbers of the drawn vertices; integers of colours are shares of their range. */
    private numbersOf({ domain, semantic, kind, components, values, indices }: Attribute): Float32Array {
        const most = semantic === "color" ? { uint8: 255, uint16: 65535 }[kind as string] ?? 1 : 1;
        const numbers = Float32Array.from(values, (value) => value / most);
        if (domain === "vertex") return this.spread(numbers, components);
        const drawn = this.wholeFaces().flatMap((face) => [0, 1, 2].map((k) => (domain === "face" ? face : indices![3 * face + k])));
        const spread = new Float32Array(components * drawn.length);
        drawn.forEach((row, i) => spread.set(numbers.subarray(components * row, components * row + components), components * i));
        return spread;
    }
}

/** Numbers with room for more behind them. */
function grown<Numbers extends Int32Array | Uint32Array | Uint8Array | Float32Array>(numbers: Numbers, length: number): Numbers {
    const more = new (numbers.constructor as new (length: number) => Numbers)(length);
    more.set(numbers);
    return more;
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

/**
 * Loads BSM streams, as DRACOLoader loads its own; `progress` hears of the geometry while it fills.
 *
 * Decoding is done in a thread of its own. The geometry of a sequence is that of its first frame; `frames` and
 * `showFrame` have the others.
 */
export class BSMLoader extends Loader<BSMGeometry> {
    constructor(
        private readonly kernels: Kernels | Promise<Kernels>,
        manager?: LoadingManager,
        private readonly limits: Partial<Limits> = {},
    ) {
        super(manager);
    }

    override load(
        url: string,
        onLoad: (geometry: BSMGeometry) => void,
        onProgress?: (event: ProgressEvent) => void,
        onError?: (error: unknown) => void,
        progress?: Progress,
    ): void {
        this.manager.itemStart(url);
        this.stream(url, onProgress, progress)
            .then(onLoad)
            .catch((error) => {
                if (onError) onError(error);
                else console.error(error);
                this.manager.itemError(url);
            })
            .finally(() => this.manager.itemEnd(url));
    }

    private async stream(url: string, onProgress?: (event: ProgressEvent) => void, progress?: Progress): Promise<BSMGeometry> {
        const response = await fetch(new URL(this.path + url, globalThis.document?.baseURI ?? url), {
            headers: this.requestHeader,
            credentials: this.withCredentials ? "include" : "same-origin",
        });
        if (!response.ok || !response.body) throw new Error(`${url}: ${response.status} ${response.statusText}`);
        const total = Number(response.headers.get("content-length") ?? 0);
        const geometry = new BSMGeometry(progress, this.limits);
        const decoding = new Decoding(await this.kernels, geometry, this.limits);
        try {
            const reader = response.body.getReader();
            let loaded = 0;
            for (let piece; !(piece = await Promise.race([reader.read(), decoding.failure])).done; ) {
                loaded += piece.value.length;
                decoding.thread.receiveData(piece.value);
                onProgress?.(new ProgressEvent("progress", { lengthComputable: total > 0, loaded, total }));
            }
            decoding.thread.receiveEof();
            await decoding.end;
            return geometry;
        } finally {
            decoding.thread.close();
        }
    }
}

/** A thread that fills a geometry, as promises. */
class Decoding {
    readonly thread: DecoderThread;
    /** Kept when the stream has come to its end; broken by what goes wrong before. */
    readonly end: Promise<void>;
    /** Never kept. */
    readonly failure: Promise<never>;

    constructor(kernels: Kernels, geometry: BSMGeometry, limits: Partial<Limits>) {
        let [ended, failed]: [() => void, (error: unknown) => void] = [() => {}, () => {}];
        this.end = new Promise((keep, fail) => ([ended, failed] = [keep, fail]));
        this.failure = new Promise((_, fail) => void this.end.catch(fail));
        this.failure.catch(() => {});
        const onEvent = (event: DrawnEvent): void => {
            try {
                geometry.accept(event);
            } catch (error) {
                return failed(error);
            }
            if (event.type === "end") ended();
        };
        this.thread = new DecoderThread(kernels, { onEvent, onError: failed }, limits);
    }
}
