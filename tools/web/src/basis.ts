/** Dictionaries of blocks: orthogonal iterations and exact eigenvectors (specification, M 7.4, M 8). */
import type { Block } from "./blocks";
import { canonicalEigenvectors, householder } from "./dense";
import type { Doubles, Memory } from "./kernels";

/** Independence of the columns from which one pass of Cholesky QR is enough, and from which two are. */
const ONCE = 1e-3;
const TWICE = 1e-11;
/** Doubles more than a kernel uses of an array that it begins where a cache line does. */
const PADDING = 7;

/** A matrix outside of the kernels' memory, row after row. */
export interface Matrix {
    rows: number;
    columns: number;
    values: Float64Array;
}

/** C and D^-1 of L + diagonal = P^T C D C^T P. */
interface Factor {
    values: Doubles;
    inverse: Doubles;
}

/** Degree of each row inside its block. */
export function degreesOf(block: Block): Float64Array {
    const offsets = block.offsets.view;
    return Float64Array.from({ length: block.size }, (_, row) => offsets[row + 1] - offsets[row]);
}

function factorize(memory: Memory, block: Block, shift: Float64Array): Factor {
    const n = block.size;
    const factor = { values: memory.doubles(block.fronts.size + PADDING), inverse: memory.doubles(n) };
    memory.scratch(() => {
        const diagonal = memory.copy(degreesOf(block).map((degree, row) => degree + shift[row]));
        const column = memory.words(n + 1);
        const scratch = memory.doubles(2 * (n + 16) + PADDING);
        const { offsets, neighbours, fronts } = block;
        memory.run("factorize_fronts", offsets, neighbours, diagonal, fronts.parts, column, scratch, factor.values, factor.inverse);
    });
    return factor;
}

function solve(memory: Memory, block: Block, factor: Factor, columns: Doubles): Doubles {
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
export function cosineColumns(memory: Memory, rows: number, first: number, last: number): Matrix {
    const columns = last - first;
    const values = memory.scratch(() => {
        const place = memory.doubles(rows * columns, columns);
        memory.run("cosines", BigInt(first), memory.doubles(rows + 8), place);
        return place.view.slice();
    });
    return { rows, columns, values };
}

/** The start for `width` columns: the predecessor's, and cosines where it has fewer (M 8.3). */
export function resized(memory: Memory, previous: Matrix, width: number): Matrix {
    if (previous.columns === width) return previous;
    const { rows } = previous;
    const kept = Math.min(previous.columns, width);
    const values = new Float64Array(rows * width);
    for (let r = 0; r < rows; r++) values.set(previous.values.subarray(r * previous.columns, r * previous.columns + kept), r * width);
    if (kept < width) {
        const more = cosineColumns(memory, rows, kept, width);
        for (let r = 0; r < rows; r++) values.set(more.values.subarray(r * more.columns, (r + 1) * more.columns), r * width + kept);
    }
    return { rows, columns: width, values };
}

/** U(t) = Onorm(R^power U(t - 1)), `iterations` times (M 8.4). */
export function orthogonalIteration(
    memory: Memory,
    block: Block,
    start: Matrix,
    shift: Float64Array,
    power: number,
    iterations: number,
): Matrix {
    const { rows, columns } = start;
    return memory.scratch(() => {
        const factor = factorize(memory, block, shift);
        const given = memory.copy(start.values, columns);
        const subspace = memory.doubles(rows * columns, columns);
        const scratch = iterationScratch(memory, rows, columns);
        const { values, inverse } = factor;
        const fronts = block.fronts.parts;
        const independence = memory.run(
            "iterate", fronts, values, inverse, given, BigInt(power), BigInt(iterations), ONCE, scratch, subspace,
        );
        if (independence >= TWICE) return { rows, columns, values: subspace.view.slice() };
        // R^power has all but lost the higher columns: orthonormalised after every R they stay (M 8.4).
        let current = start;
        for (let k = 0; k < iterations * power; k++) current = solvedOnorm(memory, block, factor, current);
        return current;
    });
}

function iterationScratch(memory: Memory, rows: number, columns: number): Doubles {
    return memory.doubles(memory.call("iteration_space", BigInt(rows), BigInt(columns)));
}

function solvedOnorm(memory: Memory, block: Block, factor: Factor, start: Matrix): Matrix {
    const { rows, columns } = start;
    return memory.scratch(() => {
        const solved = solve(memory, block, factor, memory.copy(start.values, columns));
        const subspace = memory.doubles(rows * columns, columns);
        const independence = memory.run("cholesky_onorm", solved, ONCE, iterationScratch(memory, rows, columns), subspace);
        const values = independence >= TWICE ? subspace.view.slice() : householder(solved.view, rows, columns);
        return { rows, columns, values };
    });
}

/** The `width` lowest eigenvectors of L + diagonal (M 8.5). */
export function exactBasis(block: Block, springs: Float64Array, width: number): Matrix {
    const n = block.size;
    const laplacian = new Float64Array(n * n);
    const [offsets, neighbours] = [block.offsets.view, block.neighbours.view];
    for (let row = 0; row < n; row++) {
        for (let i = offsets[row]; i < offsets[row + 1]; i++) laplacian[row * n + neighbours[i]] = -1;
        laplacian[row * n + row] = offsets[row + 1] - offsets[row] + springs[row];
    }
    return { rows: n, columns: width, values: canonicalEigenvectors(laplacian, n, width) };
}

/** U E, shape (rows, width), for coefficients E of so many columns (M 10.2). */
export function reconstruct(memory: Memory, subspace: Matrix, coefficients: Float64Array, width: number): Float64Array {
    return memory.scratch(() => {
        const columns = memory.copy(subspace.values, subspace.columns);
        const values = memory.doubles(subspace.rows * width, width);
        memory.run("reconstruct", columns, memory.copy(coefficients, width), values);
        return values.view.slice();
    });
}
