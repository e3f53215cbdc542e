/** One chain of blocks: what its blocks know of those before them (specification, M 7 to M 10). */
import {
    completed, completionCost, degreesOf, EXACT, exactBasis, factorize, firstColumns, followColumns, iterationCost, orthogonalIteration, reconstruct, suspend, whole,
    type Factor, type Schedule,
} from "./basis";
import { edgesOf, makeBlock, membersOf, type Block, type Blocks } from "./blocks";
import { CoefficientModel, unpackLevels } from "./coefficients";
import { Coder } from "./entropy";
import { CorruptError, NumericError } from "./errors";
import type { Header } from "./header";
import type { Bytes, Doubles, Memory, Singles } from "./kernels";
import { checkLimit, checkMemory, type Limits } from "./limits";
import { blockCost, FRAME } from "./work";
import { areFinite } from "./numbers";

export const TETHER = 2 ** -16;
/** Of springs between blocks (M 7.3). */
const STIFFNESS = 8;

/** A block's own reconstruction, before it is blended with others; positions in BSM units. */
export interface DecodedBlock {
    index: number;
    vertices: Int32Array;
    positions: Float64Array;
    weights: Float64Array;
}

/** Power and iterations of a block that follows another, or of one that does not. */
function scheduleOf(header: Header, follows: boolean): Schedule {
    const { power, iterations, keyIterations } = header.paper;
    return isExact(header, follows) ? EXACT : [power, follows ? iterations : keyIterations];
}

/** Columns of a dictionary, at most, that iterations give; others complete these (M 8.7). */
function iterated(header: Header, rows: number): number {
    return header.gopFrames > 0 && rows <= header.coefficients ? Math.ceil(rows / 3) : rows;
}

/** Take the work and the memory of a dictionary of so many columns from what is allowed (M 14.2 to M 14.4). */
export function spendOn(allowance: Allowance, header: Header, block: Block, columns: number, follows: boolean): void {
    const [power, iterations] = scheduleOf(header, follows);
    const rows = block.size;
    allowance.hold(8 * (6 * rows * whole(columns) + 2 * whole(columns) ** 2));
    const first = Math.min(columns, iterated(header, rows));
    allowance.spend(block.fronts.work / 3 + iterationCost(block, first, power * iterations) + completionCost(rows, first, columns));
}

/** U of a block that follows none (M 8.3 to M 8.5); `held` is the factor of L + springs + delta, where there is one. */
export function keyDictionary(
    memory: Memory,
    header: Header,
    block: Block,
    springs: Float64Array,
    width: number,
    allowance: Allowance,
    held?: Factor,
): Singles {
    const first = Math.min(width, iterated(header, block.size));
    if (isExact(header, false)) return completed(memory, exactBasis(memory, block, springs, first, allowance), width);
    const factor = held ?? factorize(memory, block, springs.map((spring) => spring + header.paper.shift));
    const start = firstColumns(memory, block, first, false);
    return completed(memory, orthogonalIteration(memory, block, factor, start, first, scheduleOf(header, false), allowance), width);
}

function isExact(header: Header, follows: boolean): boolean {
    return header.paper.exact === 1 && !follows;
}

export function chainLength(header: Header): number {
    return header.keyInterval || header.blocks;
}

/** Bytes, and vertices that stand for them. */
export interface Counted {
    memory: number;
    vertices: number;
}

/** How much work a decoder may still do, and how much memory it may take. */
export class Allowance {
    private owed = 0;
    private spent = 0;
    private vertices = 0;
    private shown = 0;
    private kept = 0;
    private received = 0;
    private gone = 0;

    constructor(private readonly limits: Limits) {}

    /** All work so far. */
    get work(): number {
        return this.spent;
    }

    /** What is kept now, and the vertices that have come. */
    get counted(): Counted {
        return { memory: this.kept, vertices: this.vertices };
    }

    /** Take note of memory that was kept, and of vertices that are not there any more: they count for work alone. */
    giveBack({ memory, vertices }: Counted): void {
        this.kept -= memory;
        this.gone += vertices;
    }

    /** Take note of vertices that the stream really has. */
    grant(vertices: number): void {
        this.vertices += vertices;
    }

    /** Take note of vertices of frames that are shown; fewer than none are not, after all. */
    show(vertices: number): void {
        this.shown += vertices;
    }

    /** Take note of work to come, and of the bytes that ask for it. */
    spend(work: number, received = 0): void {
        this.spent += work;
        this.owed += Math.max(0, work - this.limits.workPerByte * received);
        const { limits, vertices, shown } = this;
        checkLimit({ ...limits, work: limits.work + limits.workPerVertex * (vertices + shown) }, "work", this.owed);
    }

    /** Take note of memory for a while. */
    hold(memory: number): void {
        checkMemory(this.limits, this.kept + memory, this.vertices - this.gone, this.received);
    }

    /** Take note of memory that is kept to the end, and of bytes that stand for it. */
    keep(memory: number, received = 0): void {
        this.kept += memory;
        this.received += received;
        this.hold(0);
    }
}

/** What a mesh is blended from: sums of weight times position, and weights. */
export class Blend {
    readonly sums: Doubles;
    readonly weights: Doubles;

    constructor(
        private readonly memory: Memory,
        size: number,
    ) {
        this.sums = memory.doubles(3 * size, 3);
        this.weights = memory.doubles(size);
        this.sums.view.fill(0);
        this.weights.view.fill(0);
    }

    add(block: DecodedBlock, weights: Float64Array): void {
        this.memory.scratch(() => {
            const vertices = this.memory.ints(block.vertices.length);
            vertices.view.set(block.vertices);
            const positions = this.memory.copy(block.positions, 3);
            this.memory.run("add_copies", this.sums, this.weights, vertices, positions, this.memory.copy(weights));
        });
    }
}

/** Decodes the blocks of one chain in their order; what it keeps lies in memory behind all that the mesh has. */
export class ChainDecoder {
    private readonly model: CoefficientModel;
    private readonly known?: Blend;
    private readonly inside?: Bytes;
    private readonly behind: number;
    /** The dictionary of the block before, behind what the chain has learnt. */
    private subspace?: Singles;

    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
        private readonly blocks: Blocks,
        private readonly allowance: Allowance,
    ) {
        this.model = new CoefficientModel(memory, header.coefficients);
        if (header.paper.springs > 0) {
            this.known = new Blend(memory, blocks.graph.size);
            this.inside = memory.bytes(blocks.graph.size);
            this.inside.view.fill(0);
        }
        this.behind = memory.mark();
    }

    /** Decode the chain's next block. */
    decode(index: number, width: number, payload: Uint8Array): DecodedBlock {
        let decoded!: DecodedBlock;
        this.subspace = this.memory.keep(() => {
            const { header, memory } = this;
            const members = membersOf(this.blocks, index);
            this.allowance.spend(blockCost(members.length, edgesOf(this.blocks.graph, members), 3 * width), payload.length + FRAME);
            const block = makeBlock(memory, this.blocks.graph, members);
            const points = this.readPoints(payload, width, block);
            const { springs, pulls } = this.lookAround(block);
            spendOn(this.allowance, this.header, block, width, this.predecessor(block) !== undefined);
            const { factor, continued } = suspend(memory, block, springs, pulls, header.paper.shift);
            const subspace = this.dictionary(block, springs, factor, width);
            const coefficients = points.map((point) => (point * header.step) / 2);
            const positions = reconstruct(memory, subspace, coefficients, 3);
            const { view } = continued;
            for (let i = 0; i < view.length; i++) positions[i] += view[i];
            if (!areFinite(positions)) throw new NumericError("the coefficients reconstruct to positions that are not finite");
            const vertices = block.vertices.view.slice();
            const degrees = degreesOf(block).map((degree) => Math.max(degree, 1));
            decoded = { index, vertices, positions, weights: degrees };
            this.known?.add(decoded, degrees);
            return subspace;
        }, this.behind);
        return decoded;
    }

    /** Coefficients of x, y and z in half steps. */
    private readPoints(payload: Uint8Array, width: number, block: Block): Float64Array {
        const { memory } = this;
        const { bits, coarser } = this.header.paper;
        if (width < 1 || width > block.size) throw new CorruptError(`${width} coefficients for a block of ${block.size} vertices`);
        if (bits > 0) return unpackLevels(payload, width, bits, coarser);
        return memory.scratch(() => {
            const coder = new Coder(memory, payload);
            const points = Float64Array.from(this.model.points(coder, width).view);
            coder.finish();
            return points;
        });
    }

    /** Springs at each row, and what they pull to (M 7.3). */
    private lookAround(block: Block): { springs: Doubles; pulls: Doubles } {
        const { memory, known, inside } = this;
        const springs = memory.doubles(block.size);
        const pulls = memory.doubles(3 * block.size, 3);
        if (known && inside) {
            const { offsets, neighbours } = this.blocks.graph;
            memory.run("look_around", offsets, neighbours, block.vertices, inside, known.sums, known.weights, STIFFNESS, springs, pulls);
        } else {
            springs.view.fill(0);
            pulls.view.fill(0);
        }
        return { springs, pulls };
    }

    /** The dictionary that a block starts from, if it follows another. */
    private predecessor(block: Block): Singles | undefined {
        return this.subspace?.rows === block.size ? this.subspace : undefined;
    }

    /** U of a block (M 8.3 to M 8.5). */
    private dictionary(block: Block, springs: Doubles, factor: Factor, width: number): Singles {
        const { header, memory, allowance } = this;
        const previous = this.predecessor(block);
        if (!previous) return keyDictionary(memory, header, block, springs.view.slice(), width, allowance, factor);
        const first = Math.min(width, iterated(header, block.size));
        const start = followColumns(memory, block, previous, first);
        return completed(memory, orthogonalIteration(memory, block, factor, start, first, scheduleOf(header, true), allowance), width);
    }
}
