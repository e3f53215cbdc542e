/** A stream to a mesh, block by block, while it arrives. */
import { Attributes, type Attribute, type Solid } from "./attributes";
import { Assembly, inMeshUnits, type Changes } from "./assembly";
import type { Blocks } from "./blocks";
import { Allowance, type DecodedBlock } from "./chain";
import type { Declaration } from "./declaration";
import { BsmError, CorruptError, errorLike, UnsupportedError, type Described } from "./errors";
import { gridKernel, Refinement } from "./fields";
import { Grid, lightKernel } from "./grid";
import { EXACT, type Header } from "./header";
import { isMine, type SharedBlock } from "./helper";
import type { Kernels, Memory } from "./kernels";
import { checkLimit, DEFAULT_LIMITS, type Limits } from "./limits";
import { Numbering, type Loose } from "./numbering";
import { decodeOrder } from "./order";
import { END_OF_STREAM, NEED_DATA, Reader, type Damaged, type Metadata, type Packet, type Signal } from "./reader";

export type { Metadata };
import { Sequence } from "./sequence";
import { Structure, type Chains } from "./structure";
import { TolerantReader } from "./tolerant";
import { chunkCost, exactCost, GRID_COST, layerCost, LIGHT_COST, orderCost, type GridCost } from "./work";

/** The next block is one that a helper has to send first. */
export const NEED_BLOCK = "need block";

/** The header has arrived. */
export interface HeaderEvent {
    type: "header";
    header: Header;
}

/**
 * The faces have arrived, three vertices each, in the order that the mesh had if the stream stores that; how many
 * vertices there are, and where those are that no face uses. Of a mesh in sections, the faces of one: they come behind those
 * of the sections before it.
 */
export interface ConnectivityEvent {
    type: "connectivity";
    faces: Int32Array;
    vertices: number;
    loose: Loose;
    /** Which section, from 0, and how many there are in all. */
    section: number;
    sections: number;
}

/** A block, or a chunk of a grid, has been decoded: which vertices it moved or finished, and where they are now. */
export interface BlockEvent extends Changes {
    type: "block";
    index: number;
}

/** Levels of a layer, counted from 0, have moved vertices. */
export interface RefinementEvent extends Changes {
    type: "refinement";
    layer: number;
}

/** Something could not be decoded, and a tolerant decoder goes on: a block, frames, or bytes of neither. */
export interface LossEvent {
    type: "loss";
    block?: number;
    frames?: { first: number; count: number };
    error: Described;
}

/** The stream has come to its end: its checksum is right, or a tolerant decoder has lost something. */
export interface EndEvent {
    type: "end";
    /** Vertices without any position. */
    missing: Int32Array;
    /** Vertices that are less good than they were encoded. */
    degraded: Int32Array;
}

/** What the author says of the stream. */
export type MetadataEvent = Extract<Packet, { type: "metadata" }>;

export type Event = HeaderEvent | MetadataEvent | ConnectivityEvent | BlockEvent | RefinementEvent | AttributeEvent | FrameEvent | LossEvent | EndEvent;

/** What a decoder is asked for beside the mesh. */
export interface Wishes {
    /** Report damage behind the faces as `LossEvent`, and go on with everything that does not depend on what is lost. */
    tolerant?: boolean;
    /** Asked once the header is there: how many helpers share the work on chains of blocks. */
    helpers?: (header: Header) => number;
}

/** An attribute is there, whole. */
export interface AttributeEvent extends Attribute {
    type: "attribute";
}

/** A whole mesh, or the first frame of a sequence: positions, shape (n, 3), faces, shape (m, 3), and attributes. */
export interface Mesh {
    positions: Float64Array;
    faces: Int32Array;
    attributes: Attribute[];
}

/** A frame of a sequence: its number from 0, and its positions, shape (n, 3). */
export interface FrameEvent<Positions = Float64Array> {
    type: "frame";
    index: number;
    positions: Positions;
}

/** A frame that is made when it is its turn. */
interface ComingFrame {
    frame: number;
    make: () => Float64Array;
}

/** A block that a helper decodes. */
interface AwaitedBlock {
    awaited: number;
}

type Item = Event | DecodedBlock | ComingFrame | AwaitedBlock;

/**
 * Takes the bytes of a stream as they come, and gives events as soon as they can be known.
 *
 * The events do not depend on how the bytes are cut up, nor on helpers; limits of work and memory hold for each helper as
 * they do for the decoder. An error is thrown by `nextEvent` after the events before it, and by every later call.
 */
export class Decoder {
    private readonly limits: Limits;
    private readonly reader: Reader;
    private readonly memory: Memory;
    private readonly allowance: Allowance;
    private readonly queue: Item[] = [];
    private error?: BsmError;
    private header?: Header;
    private structure?: Structure;
    private numbering?: Numbering;
    private assembly?: Assembly;
    private chains?: Chains;
    private nextIndex = 0;
    private among = 1;
    private readonly whole: { attributes: Attribute[]; first?: Float64Array } = { attributes: [] };
    /** What helpers have sent before it was its turn. */
    private readonly shared = new Map<number, SharedBlock>();
    private grid?: Grid;
    private chunks = 0;
    private attributes?: Attributes;
    private attributesBegun = false;
    private refinementLossy = false;
    private gridBroken = false;
    private over = false;
    private refinement?: Refinement;
    private sequence?: Sequence;

    constructor(
        kernels: Kernels,
        limits: Partial<Limits> = {},
        private readonly wishes: Wishes = {},
    ) {
        this.limits = { ...DEFAULT_LIMITS, ...limits };
        this.memory = kernels.instantiate(this.limits.memory);
        this.allowance = new Allowance(this.limits);
        const spend = this.allowance.spend.bind(this.allowance);
        this.reader = wishes.tolerant ? new TolerantReader(this.limits, spend) : new Reader(this.limits, spend);
    }

    /** Take more bytes of the stream. */
    receiveData(data: Uint8Array): void {
        this.reader.receiveData(data);
    }

    /** Take note that no more bytes will come. */
    receiveEof(): void {
        this.reader.receiveEof();
    }

    /** Take what a helper has decoded. */
    receiveBlock(shared: SharedBlock): void {
        this.shared.set(shared.index, shared);
    }

    /** Bytes of the stream that the events so far are made of. */
    get position(): number {
        return this.reader.position;
    }

    /** The next event, or `NEED_DATA`; with helpers `NEED_BLOCK`; `END_OF_STREAM` after the end and `receiveEof`. */
    nextEvent(): Event | Signal | typeof NEED_BLOCK {
        const item = this.nextItem();
        if (typeof item === "string" || "type" in item) return item;
        if ("make" in item) return { type: "frame", index: item.frame, positions: this.made(item) };
        return this.guarded(() => ({ type: "block", index: item.index, ...this.numbering!.spread(this.assembly!.changes(item)) }), item.index);
    }

    /** Decode the rest of a complete stream; faster than asking for events. Without helpers it is there at once. */
    finish(): Mesh {
        return this.advance() as Mesh;
    }

    /** The same with helpers: to be called again where it has come to a block that is not there yet. */
    advance(): Mesh | typeof NEED_BLOCK {
        const { whole } = this;
        this.receiveEof();
        for (let item; (item = this.nextItem()) !== END_OF_STREAM; ) {
            if (item === NEED_BLOCK) return item;
            if (typeof item === "string") continue;
            if ("type" in item) {
                if (item.type === "attribute") whole.attributes.push(item);
            } else if ("make" in item) whole.first ??= this.made(item);
            else this.assembly!.add(item);
        }
        const { numbering } = this;
        const positions = whole.first ?? this.guarded(() => numbering!.arranged(this.wholePositions()));
        return { positions, faces: numbering!.faces, attributes: whole.attributes };
    }

    /** A frame's positions in the unit of the mesh. */
    private made(frame: ComingFrame): Float64Array {
        return this.guarded(() => this.numbering!.arranged(inMeshUnits(frame.make(), this.header!)));
    }

    private nextItem(): Exclude<Item, AwaitedBlock> | Signal | typeof NEED_BLOCK {
        for (;;) {
            const item = this.queue[0];
            if (item && "awaited" in item) {
                const shared = this.shared.get(item.awaited);
                if (!shared) return NEED_BLOCK;
                this.shared.delete(item.awaited);
                this.queue.shift();
                this.acceptShared(shared);
            } else if (item) {
                this.queue.shift();
                return item;
            } else {
                if (this.error) throw this.error;
                const signal = this.takePacket();
                if (signal) return signal;
            }
        }
    }

    /** Turn the next packet into items, or into the error that follows them. */
    private takePacket(): Signal | undefined {
        let block: number | undefined;
        try {
            const packet = this.reader.nextPacket();
            if (packet === END_OF_STREAM && !this.over) {
                this.acceptEnd(); // a tolerant reader may find no END
                return undefined;
            }
            if (typeof packet === "string") return packet;
            if (packet.type === "block") block = packet.index;
            this.accept(packet);
        } catch (error) {
            this.keep(error, block);
        }
        return undefined;
    }

    /** Take note of an error of the stream, with its place; others are passed on. */
    private keep(error: unknown, block?: number): BsmError {
        if (!(error instanceof BsmError)) throw error;
        this.error = error.located({ offset: this.reader.position, block });
        return this.error;
    }

    /** What `work` returns; its error is kept for all later calls. */
    private guarded<Result>(work: () => Result, block?: number): Result {
        try {
            return work();
        } catch (error) {
            this.queue.length = 0;
            throw this.keep(error, block);
        }
    }

    private accept(packet: Packet | Damaged): void {
        switch (packet.type) {
            case "header":
                return this.acceptHeader(packet.header);
            case "metadata":
                this.queue.push(packet);
                return;
            case "connectivity":
                return this.acceptConnectivity(packet.data);
            case "partition":
                return this.structure!.acceptPartition(packet.data);
            case "order":
                return this.acceptOrder(packet.data);
            case "block":
                return this.acceptBlock(packet.index, packet.coefficients, packet.data);
            case "gop":
                return this.acceptGop(packet.index, packet.data);
            case "grid":
                return this.acceptGrid(packet.first, packet.count, packet.data);
            case "refinement":
                return this.acceptRefinement(packet.layer, packet.first, packet.count, packet.data);
            case "attribute":
                return this.acceptAttribute(packet.index, packet.declaration, packet.seams);
            case "values":
                return this.acceptValues(packet.attribute, packet.first, packet.count, packet.data);
            case "end":
                return this.acceptEnd();
            case "damaged":
                return this.acceptDamage(packet);
        }
    }

    /** What `work` does; its error, where that is allowed, is a loss of `block` or of what follows it. */
    private tolerating(work: () => void, block?: number, anywhere = this.header!.gopFrames === 0): boolean {
        try {
            work();
            return true;
        } catch (error) {
            // The first frame of a sequence must be whole.
            if (!this.wishes.tolerant || !anywhere || !(error instanceof BsmError)) throw error;
            this.lose(error.located({ offset: this.reader.position, block }), block);
            return false;
        }
    }

    private lose(error: BsmError, block?: number): void {
        this.refinementLossy ||= this.refinement !== undefined && !this.attributesBegun;
        if (block !== undefined) this.assembly!.lose(block);
        this.queue.push({ type: "loss", block, error: error.described });
    }

    private acceptDamage({ kind, offset, length, reason }: Damaged): void {
        const error = new CorruptError(`${length} bytes cannot be read: ${reason}`, { offset });
        const begun = this.chains ?? this.grid;
        if (this.header!.gopFrames > 0 && begun) {
            if (this.nextIndex < this.header!.blocks) throw error;
            const sequence = this.begunSequence();
            if (kind !== "end" || !sequence.lossy) sequence.lose(error);
            return;
        }
        const { section, whole } = this.structure!.connectivity;
        const bearable = begun ? kind !== "connectivity" || whole : section > 0 && (kind === "block" || kind === "attribute");
        if (!bearable) throw error;
        if (this.grid) this.gridBroken = true;
        this.lose(error);
    }

    private acceptHeader(header: Header): void {
        if (header.gopFrames > 0 && (header.smoothing > 0 || header.details > 0)) {
            throw new UnsupportedError("smoothing and details of sequences are unknown to this decoder");
        }
        checkLimit(this.limits, "coefficients", header.details);
        if (header.gopFrames > 0) checkLimit(this.limits, "sequenceBytes", 8 * header.vertices * header.coefficients);
        this.header = header;
        this.structure = new Structure(this.memory, header, this.limits, this.allowance);
        this.among = 1 + (this.wishes.helpers?.(header) ?? 0);
        this.queue.push({ type: "header", header });
    }

    private acceptConnectivity(data: Uint8Array): void {
        const { connectivity } = this.structure!;
        if (connectivity.section > 0) {
            this.built();
            this.skipTo(connectivity.blocks);
            this.assembly!.leave();
        }
        this.structure!.accept(data);
        this.chains = undefined;
    }

    private acceptOrder(data: Uint8Array): void {
        const { memory, structure, header, limits } = this;
        this.allowance.spend(orderCost(header!.vertices, header!.faces, data.length), data.length);
        this.numbering = decodeOrder(memory, data, structure!.faces, header!, limits);
    }

    private acceptAttribute(index: number, declaration: Declaration, seams: Uint8Array): void {
        this.structure!.expectFaces(this.header!.blocks);
        this.attributes ??= new Attributes(this.memory, this.header!, this.structure!.faces, this.limits, this.allowance);
        const { attributes } = this;
        this.tolerating(() => attributes.declare(index, declaration, seams), undefined, true);
    }

    private acceptValues(index: number, first: number, count: number, data: Uint8Array): void {
        const attributes = this.begunAttributes();
        this.tolerating(() => {
            if (first === 0) this.allowance.spend(attributes.costOf(index));
            this.allowance.keep(0, data.length);
            this.allowance.spend(chunkCost(data.length), data.length);
            const attribute = attributes.decode(index, first, count, data, this.numbering!, () => this.solid());
            if (attribute) this.queue.push({ type: "attribute", ...attribute });
        });
    }

    /** The attributes, once all positions are there. */
    private begunAttributes(): Attributes {
        const attributes = this.attributes!;
        if (this.attributesBegun) return attributes;
        this.attributesBegun = true;
        if (this.header!.grid.length > 0) this.begunGrid();
        else {
            this.built();
            this.skipTo(this.header!.blocks);
            if (!this.refinement) this.chains!.release();
        }
        attributes.begin(this.numbering!);
        return attributes;
    }

    /** All positions, if they are as the encoder had them. */
    private solid(): Solid | undefined {
        const { header, grid, refinement, assembly } = this;
        if (header!.grid.length > 0) return grid && grid.missing.length === 0 ? { positions: grid.positions, places: grid.coordinates } : undefined;
        if (this.nextIndex < header!.blocks || assembly!.losses().degraded.length > 0 || assembly!.losses().missing.length > 0) return undefined;
        if (this.refinementLossy) return undefined;
        return { positions: refinement?.current ?? assembly!.base() };
    }

    private acceptBlock(index: number, coefficients: number, data: Uint8Array): void {
        this.built();
        this.structure!.expectFaces(index + 1);
        this.skipTo(index);
        this.nextIndex++;
        if (!isMine(this.header!, index, { number: 0, among: this.among })) this.queue.push({ awaited: index });
        else this.tolerating(() => this.queue.push(this.chains!.decode(index, coefficients, data)), index);
    }

    private acceptShared({ index, block, problem }: SharedBlock): void {
        const refuse = (): never => {
            throw errorLike(problem!);
        };
        if (block) this.queue.unshift(block);
        else this.guarded(() => this.tolerating(refuse, index), index);
    }

    private acceptGrid(first: number, count: number, data: Uint8Array): void {
        this.begunGrid();
        if (this.gridBroken) return;
        this.allowance.spend(this.gridCost.frame(data.length), data.length);
        this.gridBroken = !this.tolerating(() => {
            const changes = this.grid!.decode(first, count, data);
            this.queue.push({ type: "block", index: this.chunks++, ...this.numbering!.spread(changes) });
        });
    }

    private get gridCost(): GridCost {
        const { light, grid } = this.header!;
        return light === 1 ? LIGHT_COST : light === EXACT ? exactCost(Math.max(...grid)) : GRID_COST;
    }

    private begunGrid(): Grid {
        if (this.grid) return this.grid;
        this.announce();
        this.allowance.spend(this.gridCost.whole(this.header!.vertices, this.header!.faces));
        return (this.grid = new Grid(this.memory, this.structure!.faces, this.header!, this.header!.light === 1 ? lightKernel : gridKernel));
    }

    private acceptGop(index: number, data: Uint8Array): void {
        const sequence = this.begunSequence();
        this.tellLostFrames(index);
        try {
            sequence.decode(index, data).forEach((make, t) => this.queue.push({ frame: index + t, make }));
        } catch (error) {
            if (!this.wishes.tolerant || !(error instanceof BsmError)) throw error;
            sequence.lose(error.located({ offset: this.reader.position }));
        }
    }

    private begunSequence(): Sequence {
        const blocks = this.built();
        if (this.sequence) return this.sequence;
        this.expect(this.header!.blocks);
        this.chains!.release();
        const base = this.assembly!.base();
        return (this.sequence = new Sequence(this.memory, this.header!, blocks, this.limits, this.structure!.faces, base, this.allowance));
    }

    /** Report frames that were lost before frame `index`. */
    private tellLostFrames(index: number, ended = false): void {
        const lost = this.sequence!.lostBefore(index, ended, this.wishes.tolerant ?? false);
        if (lost) this.queue.push({ type: "loss", frames: lost.frames, error: lost.error.described });
    }

    private acceptRefinement(layer: number, first: number, count: number, data: Uint8Array): void {
        const refinement = this.begunRefinement();
        const { vertices, faces, refinements } = this.header!;
        this.tolerating(() => {
            if (first === 0) this.allowance.spend(layerCost(vertices, faces, refinements[2 * layer + 1] === 0 ? 1 : 3));
            this.allowance.spend(chunkCost(data.length), data.length);
            const changes = refinement.decode(layer, first, count, data);
            this.queue.push({ type: "refinement", layer, ...this.numbering!.spread(changes) });
        });
    }

    private begunRefinement(): Refinement {
        this.built();
        if (this.refinement) return this.refinement;
        this.skipTo(this.header!.blocks);
        this.chains!.release();
        const { memory, structure, header, assembly } = this;
        return (this.refinement = new Refinement(memory, structure!.faces, header!, assembly!.base(), assembly!.spoilt()));
    }

    /** All positions in the unit of the mesh, as vertices are numbered in the decoded faces. */
    private wholePositions(): Float64Array {
        return this.grid?.positions ?? this.refinement?.whole() ?? inMeshUnits(this.assembly!.base(), this.header!);
    }

    private acceptEnd(): void {
        if (!this.structure?.connectivity.section) throw new CorruptError("the stream ends before its first block");
        this.over = true;
        if (this.attributes) {
            const recomputed = this.begunAttributes().recomputed(this.numbering!, () => this.solid());
            recomputed.forEach((attribute) => this.queue.push({ type: "attribute", ...attribute }));
        }
        this.queue.push({ type: "end", ...this.losses() });
    }

    /** What is missing or less good at the end, in numbers of the user's vertices; strict decoders find that nothing is. */
    private losses(): { missing: Int32Array; degraded: Int32Array } {
        const { header } = this;
        const none = new Int32Array(0);
        const numbered = (vertices: Int32Array): Int32Array =>
            this.numbering!.spread({ vertices, positions: new Float64Array(3 * vertices.length), final: new Uint8Array(vertices.length) }).vertices;
        if (header!.grid.length > 0) return { missing: numbered(this.begunGrid().missing), degraded: none };
        this.built();
        if (header!.gopFrames > 0) {
            this.begunSequence();
            this.tellLostFrames(header!.frames, true);
            return { missing: none, degraded: none };
        }
        this.skipTo(header!.blocks);
        if (!this.wishes.tolerant) return { missing: none, degraded: none };
        const { missing, degraded } = this.assembly!.losses();
        const unrefined = this.refinement?.unrefined() ?? none;
        const gone = new Set(missing);
        const worse = new Set([...degraded, ...unrefined.filter((vertex) => !gone.has(vertex))]);
        return { missing: numbered(missing), degraded: numbered(Int32Array.from(worse)) };
    }

    private expect(index: number): void {
        if (index !== this.nextIndex) throw new CorruptError("the frame of a block is missing", { block: this.nextIndex });
    }

    /** Give up the blocks before `index` that did not come. */
    private skipTo(index: number): void {
        this.structure!.expectFaces(index);
        for (; this.nextIndex < index; this.nextIndex++) {
            this.tolerating(() => this.expect(index), this.nextIndex);
        }
    }

    private announce(): void {
        const { connectivity, before } = this.structure!;
        const { section, sections, vertices, known } = connectivity;
        if (!this.numbering || section > 1) this.numbering = new Numbering(connectivity.faces.view.slice(0, 3 * known), vertices);
        if (!this.wishes.tolerant) this.attributes?.check(this.numbering);
        const { faces, size, loose } = this.numbering;
        this.queue.push({ type: "connectivity", faces: faces.slice(3 * before.faces), vertices: size, loose, section: section - 1, sections: sections.length });
    }

    /** The blocks, built when the first of them is needed. */
    private built(): Blocks {
        const { blocks, connectivity } = this.structure!;
        if (this.chains) return blocks;
        this.assembly ??= new Assembly(this.memory, this.header!);
        this.assembly.extend(blocks, connectivity.whole);
        this.chains = this.structure!.chains;
        this.announce();
        return blocks;
    }
}

/** Decode a complete stream. */
export function decode(kernels: Kernels, data: Uint8Array, limits: Partial<Limits> = {}): Mesh {
    const decoder = new Decoder(kernels, limits);
    decoder.receiveData(data);
    return decoder.finish();
}

export { END_OF_STREAM, NEED_DATA };
