/** Fields of integers on a mesh: positions on a grid, and levels that refine what blocks decoded to (specification, V, M 17). */
import { inMeshUnits, type Changes } from "./assembly";
import { makeBank } from "./entropy";
import { CorruptError, NumericError } from "./errors";
import { decodeChunk, linkCorners, zeros, type Gridded, type GridKernel } from "./grid";
import type { Header } from "./header";
import type { Argument, Doubles, Ints, Memory } from "./kernels";
import { areFinite, rowsOf, upTo } from "./numbers";

const PREDICTIONS = 7;
const TERMS = 7;
const CONTEXTS = 6;
const NODES = 66;
const WEIGHT_ROWS = NODES + 3 * CONTEXTS;
const INPUTS = PREDICTIONS + CONTEXTS + 1;
const SLOTS = CONTEXTS * 512 * NODES;
const HITS = PREDICTIONS * 32;
const SCALES = PREDICTIONS * 512;
const LEARNER = TERMS * (TERMS + 1) + 2 * TERMS;
const SUM_LEARNERS = 48;
const LEVELS = { slots: 2 * 5 * 512 * 32, selectors: 2 * 32, inputs: 5, rate: 16 };

/** What has been learnt about integers; the structure ValueModel of the kernels (V 3). */
export function makeModel(memory: Memory): Argument {
    memory.run("make_value_tables");
    const [slots, hits] = [memory.words(SLOTS), memory.words(HITS)];
    const weights = memory.ints(WEIGHT_ROWS * INPUTS, INPUTS);
    const scales = memory.ints(2 * SCALES, 2);
    slots.view.fill(2 ** 31);
    hits.view.fill(2 ** 28);
    scales.view.fill(0);
    const numbers = weights.view.fill(0);
    for (let row = 0; row < NODES; row++) {
        numbers.fill(Math.floor((65536 * 9) / (8 * PREDICTIONS)), row * INPUTS, row * INPUTS + PREDICTIONS);
        numbers.fill(6000, row * INPUTS + PREDICTIONS, (row + 1) * INPUTS - 1);
    }
    return [slots, hits, weights, scales];
}

/** Learners that start from, and are drawn to, the weights that `start` tells of each (V 2). */
export function makeLearners(memory: Memory, count: number, start: (learner: number) => number[]): Argument {
    const learners = memory.longs(count * LEARNER, LEARNER);
    const numbers = learners.view.fill(0n);
    for (let k = 0; k < count; k++) {
        start(k).forEach((weight, term) => {
            const at = k * LEARNER + TERMS * (TERMS + 1) + term;
            numbers[at] = numbers[at + TERMS] = BigInt(weight);
        });
    }
    return learners;
}

/** The kernel of grids that are not light, and all that it learns (V 7 to V 9). */
export function gridKernel(memory: Memory, { vertices, grid }: Header, faces: Ints, [largest, values, gaps]: Gridded): GridKernel {
    const corners = linkCorners(memory, faces, vertices, memory.ints(vertices));
    const order = memory.ints(vertices);
    memory.scratch(() => memory.call("order_vertices", corners, order, memory.ints(3 * vertices, vertices)));
    const words = Math.floor(Math.max(...grid) / 64) + 1;
    const [sums, seen] = [memory.longs(4 * vertices, 4), memory.longs(3 * words, words)];
    sums.view.fill(0n);
    seen.view.fill(0n);
    const learners = makeLearners(memory, SUM_LEARNERS + 12, (k) => (k < SUM_LEARNERS ? [49152] : [49152, 8192]));
    return { name: "code_grid", state: [makeModel(memory), corners, [largest, order, values, gaps, sums, seen, learners]], order };
}

/** A mesh refined by levels in the frames of the base (M 17). */
export class Refinement {
    private readonly positions: Doubles;
    private readonly frames: Doubles;
    private readonly levels: Ints;
    private readonly state: Argument[];
    private coded = 0;
    /** Vertices that have got what their levels say. */
    private readonly reached: Uint8Array;
    private readonly spoilt: Uint8Array;

    constructor(
        private readonly memory: Memory,
        private readonly faces: Ints,
        private readonly header: Header,
        private readonly base: Float64Array,
        spoilt: Int32Array,
    ) {
        const { vertices } = header;
        this.reached = new Uint8Array(vertices);
        this.spoilt = new Uint8Array(vertices);
        for (const vertex of spoilt) this.spoilt[vertex] = 1;
        this.positions = memory.copy(base, 3);
        this.frames = memory.doubles(9 * vertices, 9);
        memory.call("local_frames", this.positions, faces, this.frames);
        const field = (): Ints => zeros(memory.ints(3 * vertices, 3));
        this.levels = field();
        const learners = makeLearners(memory, 12, (k) => (k % 4 === 0 ? [52000] : [52000, 28000]));
        this.state = [makeBank(memory, LEVELS), linkCorners(memory, faces, vertices), [this.levels, field(), field(), learners]];
    }

    decode(first: number, count: number, payload: Uint8Array): Changes {
        const { header, memory } = this;
        if (first !== this.coded) throw new CorruptError(`the layer lacks the vertices before ${first}: the rest is lost`);
        decodeChunk(memory, "code_levels", this.state, payload, first, count);
        this.coded += count;
        const moved = this.positions.part(3 * first, 3 * count, 3);
        const [frames, levels] = [this.frames.part(9 * first, 9 * count, 9), this.levels.part(3 * first, 3 * count, 3)];
        const spoilt = this.spoilt.subarray(first, first + count);
        moveBut(spoilt, moved, () => memory.call("add_heights", moved, frames, levels, header.refinement[0]));
        if (this.coded === header.vertices) this.slide();
        const told = this.coded === header.vertices ? upTo(this.coded) : upTo(count).map((row) => first + row);
        const vertices = told.filter((vertex) => !this.spoilt[vertex]);
        return { vertices, positions: inMeshUnits(rowsOf(this.positions.view, vertices), header), final: new Uint8Array(vertices.length) };
    }

    /** Move vertices along the surface by steps that follow from all heights (M 17.4). */
    private slide(): void {
        const { memory, faces, header, frames, levels, spoilt } = this;
        const [step, ratio] = header.refinement;
        const upright = memory.copy(this.base, 3);
        memory.call("add_heights", upright, frames, levels, step);
        const steps = memory.doubles(header.vertices);
        memory.call("tangent_steps", upright, faces, step, ratio, memory.doubles(8 * header.vertices, 8), steps);
        const unknown = spoilt.includes(1) ? this.around(this.around(spoilt)) : spoilt;
        moveBut(unknown, this.positions, () => memory.call("add_slides", this.positions, frames, levels, steps));
        unknown.forEach((without, vertex) => (this.reached[vertex] = 1 - without));
    }

    /** Marked vertices, and all that have a face with one. */
    private around(marked: Uint8Array): Uint8Array {
        const found = marked.slice();
        const corners = this.faces.view;
        for (let i = 0; i < corners.length; i += 3) {
            const face = corners.subarray(i, i + 3);
            if (face.some((vertex) => marked[vertex])) for (const vertex of face) found[vertex] = 1;
        }
        return found;
    }

    /** Vertices that refinement, if it has begun, did not reach. */
    unrefined(): Int32Array {
        return upTo(this.coded > 0 ? this.header.vertices : 0).filter((vertex) => !this.reached[vertex]);
    }

    /** All positions in BSM units. */
    get current(): Float64Array {
        return this.positions.view.slice();
    }

    /** All positions in the unit of the mesh. */
    whole(): Float64Array {
        if (!areFinite(this.positions.view)) throw new NumericError("refined positions are not finite");
        return inMeshUnits(this.positions.view.slice(), this.header);
    }
}

/** Do `work` on positions, but for those of vertices that are marked. */
function moveBut(marked: Uint8Array, positions: Doubles, work: () => void): void {
    if (!marked.includes(1)) return work();
    const before = positions.view.slice();
    work();
    const after = positions.view;
    for (const [vertex, kept] of marked.entries()) if (kept) after.set(before.subarray(3 * vertex, 3 * vertex + 3), 3 * vertex);
}
