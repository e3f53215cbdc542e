/** Columns at right angles, told by what is free in them (specification, S 5.3 and S 5.4). */
import { reconstruct } from "./basis";
import type { Doubles, Memory } from "./kernels";

/** X = Y - V S^-1 R of rows of so many columns. */
export function columnsOf(memory: Memory, free: Float64Array, width: number): Float64Array {
    return memory.scratch(() => {
        const given = memory.copy(free, width);
        const vectors = memory.copy(free, width);
        const { view } = vectors;
        for (let k = 0; k < width; k++) {
            let square = 0;
            for (let i = k; i < free.length; i += width) square += free[i] * free[i];
            const place = k * width + k;
            view[place] += free[place] < 0 ? -Math.sqrt(square) : Math.sqrt(square);
        }
        const turned = products(memory, vectors, vectors);
        const solution = products(memory, vectors, given);
        for (let j = width - 1; j >= 0; j--) {
            const row = solution.subarray(j * width, (j + 1) * width).fill(0, 0, j + 1);
            for (let e = j + 1; e < width; e++) {
                const factor = turned[j * width + e];
                for (let k = e + 1, from = e * width; k < width; k++) row[k] -= factor * solution[from + k];
            }
            const half = turned[j * width + j] / 2 || 1;
            for (let k = j + 1; k < width; k++) row[k] /= half;
        }
        return reconstruct(memory, vectors, solution, width).map((value, i) => free[i] - value);
    });
}

/** U^T X, row by row. */
function products(memory: Memory, left: Doubles, right: Doubles): Float64Array {
    return memory.scratch(() => {
        const found = memory.doubles(left.width * right.width, right.width);
        memory.run("project", left, right, found);
        return found.view.slice();
    });
}
