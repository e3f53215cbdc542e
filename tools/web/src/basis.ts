/** Dictionaries of blocks: orthogonal iterations, and solutions (specification, M 7.4, M 8). */
import type { Block } from "./blocks";
import type { Allowance } from "./chain";
import { NumericError } from "./errors";
import type { Doubles, Memory } from "./kernels";
import { areFinite } from "./numbers";

/** Independence of the columns from which one pass of Cholesky QR is enough, and from which two are. */
const ONCE = 1e-5;
const TWICE = 1e-13;
/** From which pivot on columns are completed (M 8.7). */
const LEAST_PIVOT = 2 ** -20;
/** What makes a basis exact (M 8.5). */
export const EXACT: Schedule = [2, 128];
const EXACT_SHIFT = 2 ** -5;
/** The share of hash columns in a start that might lack something, of cosines and of a predecessor's columns (M 8.3). */
const START_NOISE = 0.25;
const FOLLOWING_NOISE = 2 ** -8;
/** Doubles more than a kernel uses of an array that it begins where a cache line does. */
const PADDING = 7;

/** z and t of an orthogonal iteration. */
export type Schedule = readonly [power: number, iterations: number];

/** C and D^-1 of L + diagonal = P^T C D C^T P. */
export interface Factor {
    values: Doubles;
    inverse: Doubles;
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
    return { values: memory.doubles(block.fronts.size + PADDING), inverse: memory.doubles(block.size) };
}

function weightsOf(memory: Memory, block: Block): Doubles {
    const weights = block.weights ?? memory.doubles(block.neighbours.length);
    if (!block.weights) weights.view.fill(1);
    return weights;
}

function solvingSpace(rows: number, columns: number): number {
    return (rows + 4) * (columns + 8) + PADDING;
}

/** C and D^-1 of L with `shift` on its diagonal. */
export function factorize(memory: Memory, block: Block, shift: Float64Array): Factor {
    const n = block.size;
    const factor = factorRoom(memory, block);
    memory.scratch(() => {
        const diagonal = memory.copy(diagonalOf(block).map((sum, row) => sum + shift[row]));
        const weights = weightsOf(memory, block);
        const column = memory.words(n + 1);
        const scratch = memory.doubles(2 * (n + 16) + PADDING);
        const { offsets, neighbours, fronts } = block;
        memory.run("factorize_fronts", offsets, neighbours, weights, diagonal, fronts.parts, column, scratch, factor.values, factor.inverse);
    });
    return factor;
}

export function solve(memory: Memory, block: Block, factor: Factor, columns: Doubles): Doubles {
    const width = columns.width;
    const solution = memory.doubles(columns.length, width);
    memory.scratch(() => {
        const scratch = memory.doubles(solvingSpace(block.size, width));
        memory.run("solve_columns", block.fronts.parts, factor.values, factor.inverse, columns, 1n, scratch, solution);
    });
    return solution;
}

/** A block on springs: the factor of L + S + delta, and positions that continue what the springs hang on (M 7.4). */
export function suspend(memory: Memory, block: Block, springs: Doubles, pulls: Doubles, delta: number): { factor: Factor; continued: Doubles } {
    const n = block.size;
    const factor = factorRoom(memory, block);
    const continued = memory.doubles(3 * n, 3);
    memory.scratch(() => {
        const { offsets, neighbours, fronts } = block;
        const diagonal = memory.copy(diagonalOf(block));
        const scratch = memory.doubles(2 * n + 4 + solvingSpace(n, 3));
        memory.call(
            "suspend", offsets, neighbours, weightsOf(memory, block), diagonal, fronts.parts, springs, pulls, delta, scratch, factor.values,
            factor.inverse, continued,
        );
    });
    return { factor, continued };
}

/** The first cosine columns (M 8.2). */
export function cosineColumns(memory: Memory, rows: number, columns: number): Doubles {
    return resized(memory, memory.doubles(0, 0), rows, columns);
}

/** The start of a block that follows: the predecessor's columns, and noise where the block is in pieces (M 8.3). */
export function followColumns(memory: Memory, block: Block, previous: Doubles, width: number): Doubles {
    if (inPieces(block)) return withNoise(memory, resized(memory, previous, block.size, width), FOLLOWING_NOISE);
    return previous.width >= width ? previous : resized(memory, previous, block.size, width);
}

/** The start of a block that follows none: cosines, and noise where the block is in pieces or the basis exact (M 8.3). */
export function firstColumns(memory: Memory, block: Block, width: number, exact: boolean): Doubles {
    const start = cosineColumns(memory, block.size, width);
    return exact || inPieces(block) ? withNoise(memory, start, START_NOISE) : start;
}

function withNoise(memory: Memory, start: Doubles, share: number): Doubles {
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
function resized(memory: Memory, previous: Doubles, rows: number, width: number): Doubles {
    const columns = memory.doubles(rows * width, width);
    memory.scratch(() => memory.run("resize_columns", previous, memory.doubles(rows + 8), columns));
    return columns;
}

/** Nanoseconds that a solution takes, and an orthonormalisation (M 14.3). */
export function solutionCost(block: Block, columns: number): number {
    return block.fronts.entries * (0.6 * Math.ceil(columns / 32) + 0.035 * whole(columns));
}

export function roundingCost(rows: number, columns: number): number {
    return rows * (3 + 0.5 * whole(columns) + whole(columns) ** 2 / 29);
}

/** Columns as they are computed: in vectors of eight. */
export function whole(columns: number): number {
    return 8 * Math.ceil(columns / 8);
}

/** U(t) = Onorm(R^power U(t - 1)), `iterations` times, of the first `columns` of a start (M 8.4). */
export function orthogonalIteration(
    memory: Memory,
    block: Block,
    factor: Factor,
    start: Doubles,
    columns: number,
    [power, iterations]: Schedule,
    allowance: Allowance,
): Doubles {
    const { rows } = start;
    const subspace = memory.doubles(rows * columns, columns);
    memory.scratch(() => {
        const scratch = iterationScratch(memory, rows, columns);
        const { values, inverse } = factor;
        const fronts = block.fronts.parts;
        const independence = memory.run(
            "iterate", fronts, values, inverse, start, BigInt(power), BigInt(iterations), ONCE, scratch, subspace,
        );
        if (independence >= TWICE) return;
        // R^power has all but lost the higher columns: orthonormalised after every R they stay (M 8.4).
        allowance.spend(iterations * power * (solutionCost(block, columns) + 1.1 * roundingCost(rows, columns)));
        const given = start.columns === columns ? start : resized(memory, start, rows, columns); // which may move all views
        subspace.view.set(given.view);
        for (let k = 0; k < iterations * power; k++) solveOnorm(memory, block, factor, subspace, allowance);
    });
    return subspace;
}

function iterationScratch(memory: Memory, rows: number, columns: number): Doubles {
    return memory.doubles(memory.call("iteration_space", BigInt(rows), BigInt(columns)));
}

/** Overwrite U by Onorm(R U). */
function solveOnorm(memory: Memory, block: Block, factor: Factor, subspace: Doubles, allowance: Allowance): void {
    const { rows } = subspace;
    const columns = subspace.width;
    memory.scratch(() => {
        const solved = solve(memory, block, factor, subspace);
        const independence = memory.run("cholesky_onorm", solved, ONCE, iterationScratch(memory, rows, columns), subspace);
        if (independence >= TWICE) return;
        allowance.spend(0.35 * rows * columns ** 2);
        householder(memory, solved, subspace);
    });
}

/** Q of the QR factorisation with positive diagonal of columns close to dependent (M 8.1); they are overwritten. */
function householder(memory: Memory, columns: Doubles, q: Doubles): void {
    if (!areFinite(columns.view)) throw new NumericError("the subspace iteration produced a value that is not finite");
    memory.scratch(() => memory.run("householder", columns, memory.doubles(3 * columns.width), q));
}

/** Columns, and any that are at right angles to them (M 8.7); `width` of them. */
export function completed(memory: Memory, first: Doubles, width: number): Doubles {
    if (first.width === width) return first;
    const columns = memory.doubles(first.rows * width, width);
    const scratch = memory.doubles(memory.call("completion_space", BigInt(first.width)));
    if (memory.call("complete_columns", first, LEAST_PIVOT, scratch, columns) === 0) throw new NumericError("the columns of a dictionary cannot be completed");
    return columns;
}

/** Nanoseconds that completing so many first columns takes (M 14.3). */
export function completionCost(rows: number, first: number, columns: number): number {
    return columns > first ? (first ** 3 / 3 + (columns - first) * first * (first + rows)) / 15 + 2 * rows * columns : 0;
}

/** The exact basis of L + springs (M 8.5). */
export function exactBasis(memory: Memory, block: Block, springs: Float64Array, width: number, allowance: Allowance): Doubles {
    const factor = factorize(memory, block, springs.map((spring) => spring + EXACT_SHIFT));
    const start = firstColumns(memory, block, width, true);
    return orthogonalIteration(memory, block, factor, start, width, EXACT, allowance);
}

/** U E, shape (rows, width), for coefficients E of so many columns (M 10.2). */
export function reconstruct(memory: Memory, subspace: Doubles, coefficients: Float64Array, width: number): Float64Array {
    return memory.scratch(() => {
        const values = memory.doubles(subspace.rows * width, width);
        memory.run("reconstruct", subspace, memory.copy(coefficients, width), values);
        return values.view.slice();
    });
}
