/** Vertices at one position, and loose ones, as they were given (specification, F 9). */
import { readTurns, type Arrangement } from "./connectivity";
import type { Coder } from "./entropy";
import { CorruptError } from "./errors";
import type { Memory } from "./kernels";
import { inverse, Numbering } from "./numbering";
import { makeLevelBank } from "./sequence";

const FIRST = 0;
const COPY = 1;
const LOOSE = 2;

/** The `size` given vertices (F 9.2 to F 9.5), of vertices and faces that have the numbers and corners of C 9. */
export function split(
    memory: Memory,
    coder: Coder,
    { faces, numbers, corners }: Arrangement,
    size: number,
    copies: number,
    positions: Float64Array,
): Numbering {
    const vertices = numbers.length;
    const kinds = readTurns(memory, coder, size);
    const counted = [0, 0, 0];
    for (const kind of kinds) counted[kind]++;
    if (counted[FIRST] !== vertices || counted[COPY] !== copies) {
        throw new CorruptError("the kinds of given vertices are not as many as was said");
    }
    const back = readColumn(memory, coder, copies);
    const met = new Int32Array(size).fill(-1); // the vertex that each given one is, as C 9 numbers them
    let [known, copied] = [0, 0];
    kinds.forEach((kind, given) => {
        if (kind === FIRST) met[given] = known++;
        if (kind !== COPY) return;
        met[given] = known - 1 - back[copied++];
        if (met[given] < 0 || met[given] >= known) throw new CorruptError("a given vertex is a copy of one that does not come before it");
    });
    const { starts, members } = inverse(met, vertices);
    const given = copies > 0 ? cornersOf(readColumn(memory, coder, faces.length), faces, starts, members) : faces.map((vertex) => members[starts[vertex]]);
    const coded = inverse(numbers, vertices).members;
    const free = Int32Array.from(kinds.keys()).filter((vertex) => kinds[vertex] === LOOSE);
    return new Numbering(given, vertices, met.map((vertex) => (vertex < 0 ? -1 : coded[vertex])), corners, true, { vertices: free, positions });
}

/** The given vertex of each corner (F 9.4). */
function cornersOf(steps: Int32Array, faces: Int32Array, starts: Int32Array, members: Int32Array): Int32Array {
    const visits = new Int32Array(starts.length - 1);
    return faces.map((vertex, i) => {
        const count = starts[vertex + 1] - starts[vertex];
        if (steps[i] < 0 || steps[i] >= count) throw new CorruptError("a corner names a copy that there is not");
        return members[starts[vertex] + ((visits[vertex]++ + steps[i]) % count)];
    });
}

/** Whole numbers, as a matrix of one column (F 9.3). */
function readColumn(memory: Memory, coder: Coder, count: number): Int32Array {
    return memory.scratch(() => {
        const values = memory.ints(count, 1);
        values.view.fill(0);
        memory.call("code_matrix", coder.parts, makeLevelBank(memory), values, memory.ints(0, 1), 0n, 1n, 0n, BigInt(count), 0n, memory.longs(1));
        if (coder.overran) coder.finish();
        return values.view.slice();
    });
}
