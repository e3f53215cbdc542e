/** What is said of many numbers at once. */

/** Whether none of them is infinite or no number. */
export function areFinite(values: Float64Array): boolean {
    let probe = 0;
    for (let i = 0; i < values.length; i++) probe += 0 * values[i];
    return probe === 0;
}

/** 0, 1, ... to `count` - 1. */
export function upTo(count: number): Int32Array {
    const numbers = new Int32Array(count);
    for (let i = 0; i < count; i++) numbers[i] = i;
    return numbers;
}

/** The rows of `values`, three numbers each, that `rows` names. */
export function rowsOf(values: Float64Array, rows: Int32Array): Float64Array {
    const chosen = new Float64Array(3 * rows.length);
    for (let i = 0; i < chosen.length; i += 3) {
        const from = 3 * rows[i / 3];
        chosen[i] = values[from];
        chosen[i + 1] = values[from + 1];
        chosen[i + 2] = values[from + 2];
    }
    return chosen;
}
