/** Dictionaries of blocks: orthogonal iterations, and solutions (specification, M 7.4, M 8). */
import type { Block } from "./blocks";
import type { Allowance } from "./chain";
import { NumericError } from "./errors";
import type { Doubles, Memory, Singles } from "./kernels";

/** What `iterate` returns where columns have to be made orthonormal one by one, and where they cannot be (M 8.8). */
const [NEEDS_CARE, LOST] = [1, 2];
/** Columns, at first, that may be made so. */
const FIRST_CARE = 16;
/** From which pivot on columns are completed (M 8.7). */
const LEAST_PIVOT = 2 ** -20;
/** What makes a basis exact (M 8.5). */
export const EXACT: Schedule = [2, 128];
const EXACT_SHIFT = 2 ** -5;
/** The share of hash columns in a start that might lack something, of cosines and of a predecessor's columns (M 8.3). */
const START_NOISE = 0.25;
const FOLLOWING_NOISE = 2 ** -8;
/** Floats more than a kernel uses of an array that it begins where a cache line does. */
const PADDING = 15;

/** z and t of an orthogonal iteration. */
export type Schedule = readonly [power: number, iterations: number];

/** C and D^-1 of L + diagonal = P^T C D C^T P. */
export interface Factor {
    values: Singles;
    inverse: Singles;
}

/** Degree of each row inside its block. */
export function degreesOf(block: Block): Float64Array {
    const offsets = block.offsets.view;
    const degrees = new Float64Array(block.size);
    for (let row = 0; row < degrees.length; row++) degrees[row] = offsets[row + 1] - offsets[row];
    return degrees;
}

/** Sum of the weights of each row. */
function diagonalOf(block: Block): Float64Array {
    if (!block.weights) return degreesOf(block);
    const [offsets, weights] = [block.offsets.view, block.weights.view];
    const sums = new Float64Array(block.size);
    for (let row = 0; row < sums.length; row++) for (let k = offsets[row]; k < offsets[row + 1]; k++) sums[row] += weights[k];
    return sums;
}

function factorRoom(memory: Memory, block: Block): Factor {
    return { values: memory.singles(block.fronts.size + PADDING), inverse: memory.singles(block.size) };
}

function weightsOf(memory: Memory, block: Block): Doubles {
    const weights = block.weights ?? memory.doubles(block.neighbours.length);
    if (!block.weights) weights.view.fill(1);
    return weights;
}

function solvingRoom(memory: Memory, rows: number, columns: number): Singles {
    return memory.singles((rows + 4) * (columns + 16) + PADDING);
}

/** C and D^-1 of L with `shift` on its diagonal. */
export function factorize(memory: Memory, block: Block, shift: Float64Array): Factor {
    const n = block.size;
    const factor = factorRoom(memory, block);
    memory.scratch(() => {
        const diagonal = memory.copy(diagonalOf(block).map((sum, row) => sum + shift[row]));
        const weights = weightsOf(memory, block);
        const column = memory.words(n + 1);
        const scratch = memory.singles(2 * (n + 32) + PADDING);
        const { offsets, neighbours, fronts } = block;
        memory.run("factorize_fronts", offsets, neighbours, weights, diagonal, fronts.parts, column, scratch, factor.values, factor.inverse);
    });
    return factor;
}

/** Rows that continue a field into a block from what springs pull to (M 7.4). */
export function continued(memory: Memory, block: Block, factor: Factor, springs: Doubles, pulls: Doubles): Doubles {
    const width = pulls.width;
    const values = memory.doubles(pulls.length, width);
    memory.scratch(() => {
        const scratch = solvingRoom(memory, block.size, width);
        memory.call("continue_known", block.fronts.parts, factor.values, factor.inverse, springs, pulls, scratch, values);
    });
    return values;
}

/** A block on springs: the factor of L + S + delta, and positions that continue what the springs hang on (M 7.4). */
export function suspend(memory: Memory, block: Block, springs: Doubles, pulls: Doubles, delta: number): { factor: Factor; continued: Doubles } {
    const n = block.size;
    const factor = factorRoom(memory, block);
    const values = memory.doubles(3 * n, 3);
    memory.scratch(() => {
        const { offsets, neighbours, fronts } = block;
        const diagonal = memory.copy(diagonalOf(block));
        memory.call(
            "suspend", offsets, neighbours, weightsOf(memory, block), diagonal, fronts.parts, springs, pulls, delta, memory.doubles(n),
            memory.words(n + 1), solvingRoom(memory, n, 3), factor.values, factor.inverse, values,
        );
    });
    return { factor, continued: values };
}

/** The start of a block that follows: the predecessor's columns, and noise where the block is in pieces (M 8.3). */
export function followColumns(memory: Memory, block: Block, previous: Singles, width: number): Singles {
    if (inPieces(block)) return withNoise(memory, resized(memory, previous, block.size, width), FOLLOWING_NOISE);
    return previous.width >= width ? previous : resized(memory, previous, block.size, width);
}

/** The start of a block that follows none: cosines, and noise where the block is in pieces or the basis exact (M 8.3). */
export function firstColumns(memory: Memory, block: Block, width: number, exact: boolean): Singles {
    const start = resized(memory, memory.singles(0, 0), block.size, width);
    return exact || inPieces(block) ? withNoise(memory, start, START_NOISE) : start;
}

function withNoise(memory: Memory, start: Singles, share: number): Singles {
    memory.run("add_noise", start, share);
    return start;
}

/** Whether the graph of a block has several components. */
function inPieces({ size, offsets, neighbours }: Block): boolean {
    const [starts, beside] = [offsets.view, neighbours.view];
    const found = new Uint8Array(size);
    const waiting = new Int32Array(size);
    let count = 1;
    found[0] = 1;
    for (let next = 0; next < count; next++) {
        const row = waiting[next];
        for (let k = starts[row]; k < starts[row + 1]; k++) {
            if (found[beside[k]]++ === 0) waiting[count++] = beside[k];
        }
    }
    return count < size;
}

/** The first `width` columns of others, and cosines where there are fewer. */
function resized(memory: Memory, previous: Singles, rows: number, width: number): Singles {
    const columns = memory.singles(rows * width, width);
    memory.scratch(() => memory.run("resize_columns", previous, memory.doubles(rows + 8), columns));
    return columns;
}

/** Nanoseconds that a solution takes, and so many of them with an orthonormalisation after each and one more (M 14.3). */
export function solutionCost(block: Block, columns: number): number {
    return block.fronts.entries * (0.3 * Math.ceil(columns / 64) + 0.02 * whole(columns));
}

export function iterationCost(block: Block, columns: number, solutions: number): number {
    const rounding = block.size * (3 + 0.4 * whole(columns) + whole(columns) ** 2 / 80);
    return 5 * block.size * whole(columns) + solutions * solutionCost(block, columns) + (solutions + 1) * rounding;
}

/** Columns as they are computed: in vectors of sixteen. */
export function whole(columns: number): number {
    return 16 * Math.ceil(columns / 16);
}

/** U(t) = Onorm(R^power U(t - 1)), `iterations` times, of the first `columns` of a start (M 8.4). */
export function orthogonalIteration(
    memory: Memory,
    block: Block,
    factor: Factor,
    start: Singles,
    columns: number,
    [power, iterations]: Schedule,
    allowance: Allowance,
): Singles {
    const { rows } = start;
    const solutions = power * iterations;
    const subspace = memory.singles(rows * columns, columns);
    memory.scratch(() => {
        const scratch = memory.singles(memory.call("iteration_space", BigInt(rows), BigInt(columns)));
        const iterate = (care: number): number =>
            memory.call("iterate", block.fronts.parts, factor.values, factor.inverse, start, BigInt(solutions), BigInt(care), scratch, subspace);
        let found = iterate(0);
        for (let care = FIRST_CARE; found === NEEDS_CARE; care *= 4) {
            allowance.spend(iterationCost(block, columns, solutions) + 6 * rows * columns * care);
            found = iterate(care);
        }
        if (found === LOST) throw new NumericError("the columns of a dictionary cannot be made orthonormal");
    });
    return subspace;
}

/** Columns, and any that are at right angles to them (M 8.7); `width` of them. */
export function completed(memory: Memory, first: Singles, width: number): Singles {
    if (first.width === width) return first;
    const columns = memory.singles(first.rows * width, width);
    const scratch = memory.singles(memory.call("completion_space", BigInt(first.width)));
    if (memory.call("complete_columns", first, LEAST_PIVOT, scratch, columns) === 0) throw new NumericError("the columns of a dictionary cannot be completed");
    return columns;
}

/** Nanoseconds that completing so many first columns takes (M 14.3). */
export function completionCost(rows: number, first: number, columns: number): number {
    return columns > first ? (first ** 3 / 3 + (columns - first) * first * (first + rows)) / 15 + 2 * rows * columns : 0;
}

/** The exact basis of L + springs (M 8.5). */
export function exactBasis(memory: Memory, block: Block, springs: Float64Array, width: number, allowance: Allowance): Singles {
    const factor = factorize(memory, block, springs.map((spring) => spring + EXACT_SHIFT));
    const start = firstColumns(memory, block, width, true);
    return orthogonalIteration(memory, block, factor, start, width, EXACT, allowance);
}

/** U E, shape (rows, width), for coefficients E of so many columns (M 10.2). */
export function reconstruct(memory: Memory, subspace: Singles, coefficients: Float64Array, width: number): Float64Array {
    return memory.scratch(() => {
        const values = memory.doubles(subspace.rows * width, width);
        memory.run("reconstruct", subspace, memory.copy(coefficients, width), values);
        return values.view.slice();
    });
}
