/** Putting decoded blocks together: which vertices have moved, and which are final (specification, M 12). */
import { edgesOf, membersOf, type Blocks } from "./blocks";
import { Blend, type Allowance, type DecodedBlock } from "./chain";
import { NumericError } from "./errors";
import type { Header } from "./header";
import type { Doubles, Ints, Memory } from "./kernels";
import { areFinite, rowsOf, upTo } from "./numbers";

const DEGREE = 5;
const NODES = [0.4, 0.9, 1.4, 1.8];
/** Nanoseconds for looking at an edge while rings are found, for finding them at all, and for telling of a vertex. */
const [LOOK, CALL, COPY] = [18, 2e4, 90];

/** What a block changed: vertices, their positions in the unit of the mesh, and which of them are final. */
export interface Changes {
    vertices: Int32Array;
    positions: Float64Array;
    final: Uint8Array;
}

/** p_2 to p_5 (M 12.3), by divided differences. */
export function filterPolynomial(amount: number): Float64Array {
    const table = NODES.map((x) => -amount / (1 + amount * x * x));
    for (let level = 1; level < NODES.length; level++) {
        for (let i = NODES.length - 1; i >= level; i--) table[i] = (table[i] - table[i - 1]) / (NODES[i] - NODES[i - level]);
    }
    let powers = NODES.map(() => 0);
    for (let i = NODES.length - 1; i >= 0; i--) powers = powers.map((power, k) => (k ? powers[k - 1] : table[i]) - NODES[i] * power);
    return Float64Array.from(powers);
}

export const NOT_FINITE = "positions are not finite in the unit of the mesh";

/** Positions in BSM units as the mesh has them (M 12.5), in place. */
export function inMeshUnits(positions: Float64Array, header: Header): Float64Array {
    const { scale, center } = header;
    for (let i = 0; i < positions.length; i++) positions[i] = positions[i] * scale + center[i % 3];
    if (!areFinite(positions)) throw new NumericError(NOT_FINITE);
    return positions;
}

/** Blends the blocks of one mesh. */
export class Assembly {
    private readonly blend: Blend;
    /** Copies of each vertex that have not come yet. */
    private readonly missing: Int32Array;
    private readonly final: Uint8Array;
    /** Which vertices the filter cannot be used on yet; zero between calls. */
    private readonly waits: Uint8Array;
    private readonly blended: Doubles;
    private readonly number: Ints;
    private readonly rows: Ints;
    /** Vertices of blocks that were lost. */
    private readonly lost = new Set<number>();

    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
        private readonly blocks: Blocks,
        private readonly allowance: Allowance,
    ) {
        const { size } = blocks.graph;
        this.blend = new Blend(memory, size);
        this.blended = memory.doubles(3 * size, 3);
        this.number = memory.ints(size);
        this.rows = memory.ints(size);
        this.number.view.fill(-1);
        this.final = new Uint8Array(size);
        this.waits = new Uint8Array(size);
        this.missing = new Int32Array(size);
        for (const vertex of blocks.members.view) this.missing[vertex]++;
        this.settle(upTo(size));
    }

    /** Blend one block in. */
    add(block: DecodedBlock): void {
        this.blend.add(block, block.weights);
    }

    /** Take note that a block will not come. */
    lose(index: number): void {
        for (const vertex of membersOf(this.blocks, index).view) this.lost.add(vertex);
    }

    /** Vertices without any copy, and those that lack one or lie in the filter's reach of one that is missing. */
    losses(): { missing: Int32Array; degraded: Int32Array } {
        const touched = Int32Array.from(this.lost);
        const weights = this.blend.weights.view;
        const missing = touched.filter((vertex) => weights[vertex] === 0);
        const around = touched.length > 0 ? this.around(touched, this.reach) : touched;
        const known = this.blend.weights.view;
        return { missing, degraded: around.filter((vertex) => known[vertex] > 0) };
    }

    /** Vertices whose positions, or those beside them, are not as the encoder had them. */
    spoilt(): Int32Array {
        const touched = Int32Array.from(this.lost);
        return touched.length > 0 ? this.around(touched, this.reach + 1) : touched;
    }

    /** Edges from which the filter sees a vertex. */
    private get reach(): number {
        return this.header.smoothing > 0 ? DEGREE : 0;
    }

    /** All positions in BSM units, once every block is in. */
    base(): Float64Array {
        this.settle(upTo(this.blocks.graph.size));
        return this.smoothEverything();
    }

    /** Blend one block in and say what it changed. */
    changes(block: DecodedBlock): Changes {
        this.add(block);
        const weights = this.blend.weights.view;
        const seen = block.vertices.filter((vertex) => weights[vertex] > 0);
        this.settle(seen);
        for (const vertex of block.vertices) this.missing[vertex]--;
        const finished = this.finished(block.vertices.filter((vertex) => this.missing[vertex] === 0));
        for (const vertex of finished) this.final[vertex] = 1;
        const moved = seen.filter((vertex) => !this.final[vertex]);
        const vertices = new Int32Array(moved.length + finished.length);
        vertices.set(moved);
        vertices.set(finished, moved.length);
        const positions = new Float64Array(3 * vertices.length);
        positions.set(rowsOf(this.blended.view, moved));
        positions.set(this.smoothed(finished), 3 * moved.length);
        // What levels or frames move later is not final.
        const final = new Uint8Array(vertices.length);
        if (this.header.refinement.length === 0 && this.header.gopFrames === 0) final.fill(1, moved.length);
        this.allowance.spend(COPY * vertices.length);
        return { vertices, positions: inMeshUnits(positions, this.header), final };
    }

    /** Weighted means of the copies of some vertices. */
    private settle(vertices: Int32Array): void {
        const [sums, weights, blended] = [this.blend.sums.view, this.blend.weights.view, this.blended.view];
        for (const vertex of vertices) {
            for (let i = 3 * vertex; i < 3 * vertex + 3; i++) blended[i] = weights[vertex] > 0 ? sums[i] / weights[vertex] : 0;
        }
    }

    /** Vertices that become final where all copies of `complete` have come (M 12.4). */
    private finished(complete: Int32Array): Int32Array {
        if (this.header.smoothing === 0) return complete;
        const around = this.around(complete, 2 * DEGREE);
        const waiting = this.around(around.filter((vertex) => this.missing[vertex] > 0), DEGREE);
        const { waits, final } = this;
        for (const vertex of waiting) waits[vertex] = 1;
        const finished = this.around(complete, DEGREE).filter((vertex) => !final[vertex] && !waits[vertex]);
        for (const vertex of waiting) waits[vertex] = 0;
        return finished;
    }

    /** `vertices` and all others at most `rings` edges away. */
    private around(vertices: Int32Array, rings: number): Int32Array {
        return this.memory.scratch(() => this.rings(vertices, rings).rows.view.slice());
    }

    private rings(vertices: Int32Array, rings: number): { rows: Ints; starts: Float64Array } {
        const { memory, number, rows } = this;
        const { offsets, neighbours } = this.blocks.graph;
        const given = memory.ints(vertices.length);
        given.view.set(vertices);
        const starts = memory.longs(rings + 1);
        const count = memory.call("find_rings", offsets, neighbours, number, given, rows, starts);
        const found = rows.part(0, count);
        this.forget(found);
        this.allowance.spend(CALL + LOOK * edgesOf(this.blocks.graph, found));
        return { rows: found, starts: Float64Array.from(starts.view, Number) };
    }

    private forget(rows: Ints): void {
        const number = this.number.view;
        for (const vertex of rows.view) number[vertex] = -1;
    }

    /** Filtered positions of some vertices, in BSM units (M 12.2). */
    private smoothed(vertices: Int32Array): Float64Array {
        const { memory, number, header } = this;
        if (header.smoothing === 0) return rowsOf(this.blended.view, vertices);
        return memory.scratch(() => {
            const { offsets, neighbours } = this.blocks.graph;
            const { rows, starts } = this.rings(vertices, DEGREE);
            const [places, list] = [number.view, rows.view];
            list.forEach((vertex, place) => (places[vertex] = place));
            const ends = memory.longs(starts.length);
            ends.view.set(Array.from(starts, BigInt));
            const weights = memory.copy(filterPolynomial(header.smoothing));
            const current = memory.doubles(3 * rows.length, 3);
            const following = memory.doubles(3 * starts[DEGREE - 1], 3);
            const smoothed = memory.doubles(3 * vertices.length, 3);
            memory.run("filter_rows", offsets, neighbours, number, this.blended, weights, rows, ends, current, following, smoothed);
            this.forget(rows);
            return smoothed.view.slice();
        });
    }

    private smoothEverything(): Float64Array {
        const { memory, header, blended } = this;
        if (header.smoothing === 0) return blended.view.slice();
        return memory.scratch(() => {
            const { offsets, neighbours } = this.blocks.graph;
            const smoothed = memory.doubles(blended.length, 3);
            const scratch = memory.doubles(2 * blended.length + 2);
            memory.call("smooth_all", offsets, neighbours, blended, memory.copy(filterPolynomial(header.smoothing)), scratch, smoothed);
            return smoothed.view.slice();
        });
    }
}
