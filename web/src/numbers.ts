/** Which places of `values` have each number below `count`. */
export function inverse(values: Int32Array, count: number): { starts: Int32Array; members: Int32Array } {
    const starts = new Int32Array(count + 1);
    for (const value of values) if (value >= 0) starts[value + 1]++;
    for (let k = 0; k < count; k++) starts[k + 1] += starts[k];
    const members = new Int32Array(starts[count]);
    const filled = starts.slice();
    values.forEach((value, place) => value >= 0 && (members[filled[value]++] = place));
    return { starts, members };
}
