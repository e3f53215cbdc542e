/** What is decoded one after the other behind a header: faces, blocks or grids, refinements, attributes, frames. */
import { begun } from "./begun";
import { Attributes, type Attribute, type Solid } from "./attributes";
import { Assembly, inMeshUnits } from "./assembly";
import type { Blocks } from "./blocks";
import type { Allowance, DecodedBlock } from "./chain";
import type { Declaration } from "./declaration";
import { BsmError, CorruptError, UnsupportedError } from "./errors";
import type { BlockEvent, Event, FrameEvent, Wishes } from "./events";
import { gridKernel, Refinement } from "./fields";
import { Grid, lightKernel } from "./grid";
import { EXACT, type Header } from "./header";
import { isMine } from "./helper";
import type { Memory } from "./kernels";
import { checkLimit, type Limits } from "./limits";
import { Numbering } from "./numbering";
import { decodeOrder } from "./order";
import { type Damaged, type Packet } from "./reader";
import type { Course } from "./runs";
import { Sequence, type Fields, type Moving } from "./sequence";
import { Structure, type Chains } from "./structure";
import { chunkCost, exactCost, fieldCost, GRID_COST, LIGHT_COST, orderCost, type GridCost } from "./work";


/** What may come behind the first frame of a sequence. */
const BEHIND_FIRST: readonly string[] = ["gop", "end", "metadata", "damaged"];
/** What makes the positions that levels and values refer to. */
const BEFORE_LEVELS: readonly string[] = ["connectivity", "partition", "order", "block"];

/** A frame that is made when it is its turn. */
export interface ComingFrame {
    frame: number;
    make: () => Fields;
    moving: Moving[];
}

/** A block that a helper decodes. */
export interface AwaitedBlock {
    awaited: number;
}

export type Item = Event | DecodedBlock | ComingFrame | AwaitedBlock;

/** The stages of one mesh. What they find goes into the queue. */
export class Stages {
    /** Whether the end was there. */
    over = false;
    private readonly structure: Structure;
    private readonly among: number;
    private numbering?: Numbering;
    private assembly?: Assembly;
    private chains?: Chains;
    private nextIndex = 0;
    private grid?: Grid;
    private chunks = 0;
    private attributes?: Attributes;
    private attributesBegun = false;
    private refinementLossy = false;
    private gridBroken = false;
    private refinement?: Refinement;
    private sequence?: Sequence;
    /** Attributes of a run, for later ones of its mesh. */
    private readonly carried: Attribute[] = [];
    /** The header of the present run. */
    private last: Header;

    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
        private readonly limits: Limits,
        private readonly allowance: Allowance,
        private readonly wishes: Wishes,
        private readonly queue: Item[],
        private readonly position: () => number,
        private readonly course?: Course,
    ) {
        if (header.gopFrames > 0 && header.smoothing > 0) throw new UnsupportedError("smoothing of sequences is unknown to this decoder");
        this.last = header;
        if (header.gopFrames > 0) checkLimit(limits, "sequenceBytes", 8 * header.vertices * header.coefficients);
        this.structure = new Structure(memory, header, limits, allowance);
        this.among = 1 + (wishes.helpers?.(header) ?? 0);
        queue.push({ type: "header", header });
    }

    /** Keep only what a later run of this mesh cannot do without; false if there can be none. */
    suspend(): boolean {
        this.sequence?.suspend();
        return this.sequence !== undefined;
    }

    /** Another run of this mesh begins. */
    resume(header: Header): void {
        begun(this.sequence).resume(header);
        this.last = header;
        this.queue.push({ type: "header", header });
        this.tellConnectivity();
        this.carried.forEach((attribute) => this.queue.push({ type: "attribute", ...attribute }));
    }

    /** How the user of the mesh numbers it. */
    get numbers(): Numbering {
        return begun(this.numbering);
    }

    /** Blend a block in, without looking at what it changes. */
    add(block: DecodedBlock): void {
        this.assembled.add(block);
    }

    /** What a block changes. */
    changed(block: DecodedBlock): BlockEvent {
        return { type: "block", index: block.index, ...this.numbers.spread(this.assembled.changes(block)) };
    }

    /** A frame: positions in the unit of the mesh, and the attributes that move. */
    framed({ frame, make, moving }: ComingFrame): FrameEvent {
        const [positions, ...changes] = make();
        const attributes = moving.flatMap(({ number }, k) => begun(this.attributes).moved(number, changes[k], this.numbers));
        return { type: "frame", index: frame, positions: this.numbers.arranged(inMeshUnits(positions, this.header)), attributes };
    }

    /** Where the vertices of the user are. */
    whole(): Float64Array {
        return this.numbers.arranged(this.wholePositions());
    }

    /** The same of a static mesh; frames of a sequence have been told. */
    atEnd(): Float64Array | undefined {
        return this.header.gopFrames > 0 ? undefined : this.whole();
    }

    private get assembled(): Assembly {
        return begun(this.assembly);
    }

    private get linked(): Chains {
        return begun(this.chains);
    }

    /** Take a packet behind the header. */
    accept(packet: Packet | Damaged): void {
        if (this.sequence && !BEHIND_FIRST.includes(packet.type)) {
            const error = new CorruptError(`${packet.type} may not come here`);
            if (!this.wishes.tolerant) throw error;
            return this.loseFrames(this.sequence, error);
        }
        // Behind a loss the grammar does not know what came before it.
        if ((this.refinement || this.attributesBegun) && BEFORE_LEVELS.includes(packet.type)) throw new CorruptError(`${packet.type} may not come here`);
        switch (packet.type) {
            case "header":
                return;
            case "metadata":
                return void this.queue.push(packet);
            case "connectivity":
                return this.structure.accept(packet.data);
            case "partition":
                return this.structure.acceptPartition(packet.data);
            case "order":
                return this.acceptOrder(packet.data);
            case "block":
                return this.acceptBlock(packet.index, packet.coefficients, packet.data);
            case "gop":
                return this.acceptGop(packet.index, packet.data);
            case "grid":
                return this.acceptGrid(packet.first, packet.count, packet.data);
            case "refinement":
                return this.acceptRefinement(packet.first, packet.count, packet.data);
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
    tolerating(work: () => void, block?: number, anywhere = this.header.gopFrames === 0): boolean {
        try {
            work();
            return true;
        } catch (error) {
            // The first frame of a sequence must be whole.
            if (!this.wishes.tolerant || !anywhere || !(error instanceof BsmError)) throw error;
            this.lose(error.located({ offset: this.position(), block }), block);
            return false;
        }
    }

    private lose(error: BsmError, block?: number): void {
        this.refinementLossy ||= this.refinement !== undefined && !this.attributesBegun;
        if (block !== undefined) this.assembled.lose(block);
        this.queue.push({ type: "loss", block, error: error.described });
    }

    private acceptDamage({ kind, offset, length, reason }: Damaged): void {
        const error = new CorruptError(`${length} bytes cannot be read: ${reason}`, { offset });
        const started = this.chains ?? this.grid;
        if (this.header.gopFrames > 0 && started) {
            if (this.nextIndex < this.header.blocks) throw error;
            if (kind === "values" && !this.sequence) return this.lose(error);
            const sequence = this.begunSequence();
            if (kind !== "end" || !begun(this.course).lossy) this.loseFrames(sequence, error);
            return;
        }
        const bearable = started || (this.structure.begun && (kind === "block" || kind === "attribute"));
        if (!bearable) throw error;
        if (this.grid) this.gridBroken = true;
        this.lose(error);
    }

    private acceptOrder(data: Uint8Array): void {
        const { memory, structure, header, limits } = this;
        this.allowance.spend(orderCost(header.vertices, header.faces, data.length), data.length);
        this.numbering = decodeOrder(memory, data, structure.faces, header, limits);
    }

    private acceptAttribute(index: number, declaration: Declaration, seams: Uint8Array): void {
        this.attributes ??= new Attributes(this.memory, this.header, this.structure.faces, this.limits, this.allowance);
        const { attributes } = this;
        this.tolerating(() => attributes.declare(index, declaration, seams), undefined, true);
    }

    private acceptValues(index: number, first: number, count: number, data: Uint8Array): void {
        const attributes = this.begunAttributes();
        this.tolerating(() => {
            if (first === 0) this.allowance.spend(attributes.costOf(index));
            this.allowance.keep(0, data.length);
            this.allowance.spend(chunkCost(data.length, attributes.valuesOf(index)), data.length);
            const attribute = attributes.decode(index, first, count, data, this.numbers, () => this.solid());
            if (!attribute) return;
            if (this.course) this.carried.push(attribute);
            this.queue.push({ type: "attribute", ...attribute });
        });
    }

    /** The attributes, once all positions are there. */
    private begunAttributes(): Attributes {
        const attributes = begun(this.attributes);
        if (this.attributesBegun) return attributes;
        this.attributesBegun = true;
        if (this.header.grid.length > 0) this.begunGrid();
        else {
            this.built();
            this.skipTo(this.header.blocks);
            if (!this.refinement) this.linked.release();
        }
        attributes.begin(this.numbers);
        return attributes;
    }

    /** All positions, if they are as the encoder had them. */
    private solid(): Solid | undefined {
        const { header, grid, refinement } = this;
        if (header.grid.length > 0) return grid && grid.missing.length === 0 ? { positions: grid.positions, places: grid.coordinates } : undefined;
        if (this.nextIndex < header.blocks || this.assembled.losses().degraded.length > 0 || this.assembled.losses().missing.length > 0) return undefined;
        if (this.refinementLossy) return undefined;
        return { positions: refinement?.current ?? this.assembled.base() };
    }

    private acceptBlock(index: number, coefficients: number, data: Uint8Array): void {
        this.built();
        this.skipTo(index);
        this.nextIndex++;
        if (!isMine(this.header, index, { number: 0, among: this.among })) this.queue.push({ awaited: index });
        else this.tolerating(() => this.queue.push(this.linked.decode(index, coefficients, data)), index);
    }

    private acceptGrid(first: number, count: number, data: Uint8Array): void {
        const grid = this.begunGrid();
        if (this.gridBroken) return;
        this.allowance.spend(this.gridCost.frame(data.length), data.length);
        this.gridBroken = !this.tolerating(() => {
            const changes = grid.decode(first, count, data);
            this.queue.push({ type: "block", index: this.chunks++, ...this.numbers.spread(changes) });
        });
    }

    private get gridCost(): GridCost {
        const { light, grid } = this.header;
        return light === 1 ? LIGHT_COST : light === EXACT ? exactCost(Math.max(...grid)) : GRID_COST;
    }

    private begunGrid(): Grid {
        if (this.grid) return this.grid;
        this.announce();
        this.allowance.spend(this.gridCost.whole(this.header.vertices, this.header.faces));
        return (this.grid = new Grid(this.memory, this.structure.faces, this.header, this.header.light === 1 ? lightKernel : gridKernel));
    }

    private acceptGop(index: number, data: Uint8Array): void {
        const sequence = this.begunSequence();
        this.tellLostFrames(index);
        try {
            sequence.decode(index, data).forEach((make, t) => this.queue.push({ frame: index + t, make, moving: sequence.moving }));
        } catch (error) {
            if (!this.wishes.tolerant || !(error instanceof BsmError)) throw error;
            this.loseFrames(sequence, error.located({ offset: this.position() }));
        }
    }

    /** Take note that frames are lost; how many is known when the next ones come. */
    private loseFrames(sequence: Sequence, error: BsmError): void {
        sequence.forget();
        begun(this.course).lose(error);
    }

    private begunSequence(): Sequence {
        const blocks = this.built();
        if (this.sequence) return this.sequence;
        this.expect(this.header.blocks);
        this.linked.release();
        const base = this.assembled.base();
        const { memory, header, limits, structure, allowance, attributes, course } = this;
        const tolerant = this.wishes.tolerant ?? false;
        if (!tolerant && attributes && !attributes.canMove) throw new CorruptError("first values of an attribute that moves are missing");
        const moving = attributes?.moving() ?? [];
        return (this.sequence = new Sequence(memory, header, begun(course), blocks, limits, structure.faces, base, begun(this.numbering).size, moving, allowance, tolerant));
    }

    /** Report frames that were lost before frame `index`. */
    private tellLostFrames(index: number, ended = false): void {
        if (begun(this.course).tellLost(index, ended, this.queue)) begun(this.sequence).forget();
    }

    private acceptRefinement(first: number, count: number, data: Uint8Array): void {
        const refinement = this.begunRefinement();
        const { vertices, faces } = this.header;
        this.tolerating(() => {
            if (first === 0) this.allowance.spend(fieldCost(vertices, faces, 3));
            this.allowance.spend(chunkCost(data.length), data.length);
            const changes = refinement.decode(first, count, data);
            this.queue.push({ type: "refinement", ...this.numbers.spread(changes) });
        });
    }

    private begunRefinement(): Refinement {
        this.built();
        if (this.refinement) return this.refinement;
        this.skipTo(this.header.blocks);
        this.linked.release();
        const { memory, structure, header } = this;
        return (this.refinement = new Refinement(memory, structure.faces, header, this.assembled.base(), this.assembled.spoilt()));
    }

    /** All positions in the unit of the mesh, as vertices are numbered in the decoded faces. */
    private wholePositions(): Float64Array {
        return this.grid?.positions ?? this.refinement?.whole() ?? inMeshUnits(this.assembled.base(), this.header);
    }

    /** Take note that nothing follows. */
    acceptEnd(): void {
        if (!this.structure.begun) throw new CorruptError("the stream ends before its first block");
        this.over = true;
        if (this.attributes) {
            const recomputed = this.begunAttributes().recomputed(this.numbers, () => this.solid());
            recomputed.forEach((attribute) => this.queue.push({ type: "attribute", ...attribute }));
        }
        this.queue.push({ type: "end", ...this.losses() });
    }

    /** What is missing or less good at the end, in numbers of the user's vertices; strict decoders find that nothing is. */
    private losses(): { missing: Int32Array; degraded: Int32Array } {
        const { header } = this;
        const none = new Int32Array(0);
        const numbered = (vertices: Int32Array): Int32Array =>
            this.numbers.spread({ vertices, positions: new Float64Array(3 * vertices.length), final: new Uint8Array(vertices.length) }).vertices;
        if (header.grid.length > 0) return { missing: numbered(this.begunGrid().missing), degraded: none };
        this.built();
        if (header.gopFrames > 0) {
            this.begunSequence();
            this.tellLostFrames(this.last.frames, true);
            return { missing: none, degraded: none };
        }
        this.skipTo(header.blocks);
        if (!this.wishes.tolerant) return { missing: none, degraded: none };
        const { missing, degraded } = this.assembled.losses();
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
        for (; this.nextIndex < index; this.nextIndex++) {
            this.tolerating(() => this.expect(index), this.nextIndex);
        }
    }

    private announce(): void {
        this.numbering ??= new Numbering(this.structure.faces.view.slice(), this.header.vertices);
        if (!this.wishes.tolerant) this.attributes?.check(this.numbering);
        this.tellConnectivity();
    }

    private tellConnectivity(): void {
        const { faces, size, loose } = this.numbers;
        this.queue.push({ type: "connectivity", faces: faces.slice(), vertices: size, loose });
    }

    /** The blocks, built when the first of them is needed. */
    private built(): Blocks {
        const { blocks } = this.structure;
        if (this.chains) return blocks;
        this.assembly = new Assembly(this.memory, this.header, blocks, this.allowance);
        this.chains = this.structure.chains;
        this.announce();
        return blocks;
    }
}
