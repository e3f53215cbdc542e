/** Dictionaries of blocks: orthogonal iterations, and solutions (specification, M 7.4, M 8). */
import type { Block } from "./blocks";
import type { Allowance } from "./chain";
import { NumericError } from "./errors";
import type { Doubles, Memory } from "./kernels";
import { areFinite } from "./numbers";

/** Independence of the columns from which one pass of Cholesky QR is enough, and from which two are. */
const ONCE = 1e-5;
const TWICE = 1e-13;
/** What makes a basis exact (M 8.5). */
export const EXACT_POWER = 2;
export const EXACT_ITERATIONS = 128;
const EXACT_SHIFT = 2 ** -5;
/** The share of hash columns in a start that might lack something, of cosines and of a predecessor's columns (M 8.3). */
const START_NOISE = 0.25;
const FOLLOWING_NOISE = 2 ** -8;
/** Doubles more than a kernel uses of an array that it begins where a cache line does. */
const PADDING = 7;

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

/** C and D^-1 of L with `shift` on its diagonal. */
export function factorize(memory: Memory, block: Block, shift: Float64Array): Factor {
    const n = block.size;
    const factor = { values: memory.doubles(block.fronts.size + PADDING), inverse: memory.doubles(n) };
    memory.scratch(() => {
        const diagonal = memory.copy(diagonalOf(block).map((sum, row) => sum + shift[row]));
        const weights = block.weights ?? memory.doubles(block.neighbours.length);
        if (!block.weights) weights.view.fill(1);
        const column = memory.words(n + 1);
        const scratch = memory.doubles(2 * (n + 16) + PADDING);
        const { offsets, neighbours, fronts } = block;
        memory.run("factorize_fronts", offsets, neighbours, weights, diagonal, fronts.parts, column, scratch, factor.values, factor.inverse);
    });
    return factor;
}

export function solve(memory: Memory, block: Block, factor: Factor, columns: Doubles): Doubles {
    const width = columns.columns!;
    const solution = memory.doubles(columns.length, width);
    memory.scratch(() => {
        const scratch = memory.doubles((block.size + 4) * (width + 8) + PADDING);
        memory.run("solve_columns", block.fronts.parts, factor.values, factor.inverse, columns, 1n, scratch, solution);
    });
    return solution;
}

/** (L + diagonal)^-1 of columns outside of memory. */
export function solveColumns(memory: Memory, block: Block, shift: Float64Array, columns: Float64Array, width: number): Float64Array {
    return memory.scratch(() =>
        solve(memory, block, factorize(memory, block, shift), memory.copy(columns, width)).view.slice(),
    );
}

/** Cosine columns `first` to `last` - 1 (M 8.2). */
export function cosineColumns(memory: Memory, rows: number, first: number, last: number): Doubles {
    const values = memory.doubles(rows * (last - first), last - first);
    memory.scratch(() => memory.run("cosines", BigInt(first), memory.doubles(rows + 8), values));
    return values;
}

/** The start of a block that follows: the predecessor's columns, and noise where the block is in pieces (M 8.3). */
export function followColumns(memory: Memory, block: Block, previous: Doubles, width: number): Doubles {
    const start = resized(memory, previous, width);
    return inPieces(block) ? withNoise(memory, start, FOLLOWING_NOISE) : start;
}

/** The start of a block that follows none: cosines, and noise where the block is in pieces or the basis exact (M 8.3). */
export function firstColumns(memory: Memory, block: Block, width: number, exact: boolean): Doubles {
    const start = cosineColumns(memory, block.size, 0, width);
    return exact || inPieces(block) ? withNoise(memory, start, START_NOISE) : start;
}

function withNoise(memory: Memory, { view, columns }: Doubles, share: number): Doubles {
    return memory.copy(view.map((value, i) => value + share * hashEntry(Math.floor(i / columns!), i % columns!)), columns);
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

/** The predecessor's columns, `width` of them, and cosines where it has fewer. */
function resized(memory: Memory, previous: Doubles, width: number): Doubles {
    if (previous.columns === width) return previous;
    const { rows } = previous;
    const columns = previous.columns!;
    const resized = memory.doubles(rows * width, width);
    memory.scratch(() => {
        const cosines = columns < width ? cosineColumns(memory, rows, columns, width) : undefined;
        const [from, more, to] = [previous.view, cosines?.view, resized.view];
        for (let r = 0, i = 0, k = 0; r < rows; r++, i += width) {
            for (let j = 0; j < Math.min(columns, width); j++) to[i + j] = from[r * columns + j];
            for (let j = columns; j < width; j++) to[i + j] = more![k++];
        }
    });
    return resized;
}

/** Nanoseconds that a solution takes, and an orthonormalisation (M 14.3). */
export function solutionCost(block: Block, columns: number): number {
    return block.fronts.entries * (0.6 * Math.ceil(columns / 32) + 0.035 * whole(columns));
}

export function roundingCost(rows: number, columns: number): number {
    return rows * (4 + whole(columns) ** 2 / 27) + whole(columns) ** 3 / 40;
}

/** Columns as they are computed: in vectors of eight. */
export function whole(columns: number): number {
    return 8 * Math.ceil(columns / 8);
}

/** U(t) = Onorm(R^power U(t - 1)), `iterations` times (M 8.4). */
export function orthogonalIteration(
    memory: Memory,
    block: Block,
    start: Doubles,
    shift: Float64Array,
    power: number,
    iterations: number,
    allowance: Allowance,
): Doubles {
    const { rows } = start;
    const columns = start.columns!;
    const subspace = memory.doubles(rows * columns, columns);
    memory.scratch(() => {
        const factor = factorize(memory, block, shift);
        const scratch = iterationScratch(memory, rows, columns);
        const { values, inverse } = factor;
        const fronts = block.fronts.parts;
        const independence = memory.run(
            "iterate", fronts, values, inverse, start, BigInt(power), BigInt(iterations), ONCE, scratch, subspace,
        );
        if (independence >= TWICE) return;
        // R^power has all but lost the higher columns: orthonormalised after every R they stay (M 8.4).
        allowance.spend(iterations * power * (solutionCost(block, columns) + 2 * roundingCost(rows, columns)));
        subspace.view.set(start.view);
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
    const columns = subspace.columns!;
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
    memory.scratch(() => memory.run("householder", columns, memory.doubles(3 * columns.columns!), q));
}

/** The exact basis of L + springs (M 8.5). */
export function exactBasis(memory: Memory, block: Block, springs: Float64Array, width: number, allowance: Allowance): Doubles {
    const start = firstColumns(memory, block, width, true);
    const shift = springs.map((spring) => spring + EXACT_SHIFT);
    return orthogonalIteration(memory, block, start, shift, EXACT_POWER, EXACT_ITERATIONS, allowance);
}

/** Fixed pseudo-random numbers in [-1, 1) (M 8.6). */
function hashEntry(row: number, column: number): number {
    let z = BigInt.asUintN(64, ((BigInt(row) << 32n) + BigInt(column) + 1n) * 0x9e3779b97f4a7c15n);
    z = BigInt.asUintN(64, (z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n);
    z = BigInt.asUintN(64, (z ^ (z >> 27n)) * 0x94d049bb133111ebn);
    z ^= z >> 31n;
    return Number(z >> 11n) * 2 ** -52 - 1;
}

/** U E, shape (rows, width), for coefficients E of so many columns (M 10.2). */
export function reconstruct(memory: Memory, subspace: Doubles, coefficients: Float64Array, width: number): Float64Array {
    return memory.scratch(() => {
        const values = memory.doubles(subspace.rows * width, width);
        memory.run("reconstruct", subspace, memory.copy(coefficients, width), values);
        return values.view.slice();
    });
}
