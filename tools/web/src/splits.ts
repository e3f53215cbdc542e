/** The mesh as it was given, vertices at one position and loose ones included (specification, F 9). */
import type { Arrangement } from "./connectivity";
import { CorruptError } from "./errors";
import { inflate } from "./inflate";
import { checkLimit, type Limits } from "./limits";
import { inverse, Numbering } from "./numbering";
import { Cursor } from "./reader";

const FIRST = 0;
const COPY = 1;
const LOOSE = 2;

/** The given vertices (F 9.1 to F 9.6), of vertices and faces that have the numbers and corners of method 1. */
export function split(payload: Uint8Array, { faces, numbers, corners }: Arrangement, limits: Limits): Numbering {
    const vertices = numbers.length;
    const cursor = new Cursor(payload);
    const [size, copies, loose] = [cursor.varint(), cursor.varint(), cursor.varint()];
    checkLimit(limits, "vertices", size);
    if (size !== vertices + copies + loose || vertices + copies > faces.length || 24 * loose > payload.length) {
        throw new CorruptError(`${size} given vertices cannot be ${vertices}, ${copies} copies and ${loose} in no face`);
    }
    const piece = (bytes: number): Uint8Array => inflate(cursor.take(cursor.varint()), bytes);
    const kinds = piece(size);
    const counted = [0, 0, 0];
    for (const kind of kinds) if (kind <= LOOSE) counted[kind]++;
    if (counted[FIRST] !== vertices || counted[COPY] !== copies || counted[LOOSE] !== loose) {
        throw new CorruptError("the kinds of given vertices are not as many as was said");
    }
    const back = numbersOf(piece(4 * copies));
    const met = new Int32Array(size).fill(-1); // the vertex that each given one is, as method 1 numbers them
    let [known, copied] = [0, 0];
    kinds.forEach((kind, given) => {
        if (kind === FIRST) met[given] = known++;
        if (kind !== COPY) return;
        met[given] = known - 1 - back[copied++];
        if (met[given] < 0) throw new CorruptError("a given vertex is a copy of one that does not come before it");
    });
    const { starts, members } = inverse(met, vertices);
    const given = copies > 0 ? cornersOf(numbersOf(piece(4 * faces.length)), faces, starts, members) : faces.map((vertex) => members[starts[vertex]]);
    const rest = cursor.rest();
    if (rest.length !== 24 * loose) throw new CorruptError(`${rest.length} bytes for the positions of ${loose} vertices`);
    const view = new DataView(rest.buffer, rest.byteOffset, rest.length);
    const positions = Float64Array.from({ length: 3 * loose }, (_, i) => view.getFloat64(8 * i, true));
    if (!positions.every(Number.isFinite)) throw new CorruptError("a vertex that no face uses has a coordinate that is not finite");
    const coded = inverse(numbers, vertices).members;
    const free = Int32Array.from(kinds.keys()).filter((vertex) => kinds[vertex] === LOOSE);
    return new Numbering(given, vertices, met.map((vertex) => (vertex < 0 ? -1 : coded[vertex])), corners, true, { vertices: free, positions });
}

/** The given vertex of each corner (F 9.5). */
function cornersOf(steps: Float64Array, faces: Int32Array, starts: Int32Array, members: Int32Array): Int32Array {
    const visits = new Int32Array(starts.length - 1);
    return faces.map((vertex, i) => {
        const count = starts[vertex + 1] - starts[vertex];
        if (steps[i] >= count) throw new CorruptError("a corner names a copy that there is not");
        return members[starts[vertex] + ((visits[vertex]++ + steps[i]) % count)];
    });
}

/** Numbers of 32 bits, least bytes first, plane by plane (F 9.2). */
function numbersOf(planes: Uint8Array): Float64Array {
    const count = planes.length / 4;
    return Float64Array.from({ length: count }, (_, i) => [3, 2, 1, 0].reduce((value, k) => 256 * value + planes[k * count + i], 0));
}
