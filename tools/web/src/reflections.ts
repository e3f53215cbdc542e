/** Columns at right angles, told by what is free in them (specification, S 5.3). */
import type { Memory } from "./kernels";

/** X of rows of so many columns. */
export function columnsOf(memory: Memory, free: Float64Array, width: number): Float64Array {
    return memory.scratch(() => {
        const columns = memory.copy(free, width);
        memory.call("turn_columns", columns, memory.doubles(columns.rows), memory.doubles(width));
        return columns.view.slice();
    });
}
