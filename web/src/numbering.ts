/** How the user of a mesh numbers what was coded (specification, C 9, F 9). */
import type { Changes, Loose } from "./events";

/** The user's faces, and what each of the user's vertices was coded as, -1 for none; without it as what has its number. */
export class Numbering {
    private readonly copies?: { starts: Int32Array; members: Int32Array };

    constructor(
        readonly faces: Int32Array,
        private readonly coded: number,
        readonly source?: Int32Array,
        readonly loose: Loose = { vertices: new Int32Array(0), positions: new Float64Array(0) },
    ) {
        if (source) this.copies = inverse(source, coded);
    }

    /** How many vertices the user has. */
    get size(): number {
        return this.source?.length ?? this.coded;
    }

    /** Changes of coded vertices as those of all copies of each. */
    spread(changes: Changes): Changes {
        if (!this.copies) return changes;
        const { starts, members } = this.copies;
        const [vertices, rows]: [number[], number[]] = [[], []];
        changes.vertices.forEach((vertex, row) => {
            for (let k = starts[vertex]; k < starts[vertex + 1]; k++) {
                vertices.push(members[k]);
                rows.push(row);
            }
        });
        const positions = Float64Array.from({ length: 3 * rows.length }, (_, i) => changes.positions[3 * rows[Math.floor(i / 3)] + (i % 3)]);
        return { vertices: Int32Array.from(vertices), positions, final: Uint8Array.from(rows, (row) => changes.final[row]) };
    }

    /** Positions of all coded vertices, as the user numbers them. */
    arranged(positions: Float64Array): Float64Array {
        const { source } = this;
        if (!source) return positions;
        const arranged = new Float64Array(3 * source.length);
        for (let row = 0; row < source.length; row++) {
            const [to, from] = [3 * row, 3 * source[row]];
            for (let d = 0; from >= 0 && d < 3; d++) arranged[to + d] = positions[from + d];
        }
        this.loose.vertices.forEach((to, k) => arranged.set(this.loose.positions.subarray(3 * k, 3 * k + 3), 3 * to));
        return arranged;
    }
}

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
