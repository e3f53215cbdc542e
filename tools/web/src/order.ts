/** The order that a mesh had, from ORDER (specification, C 9 and F 9). */
import { readArrangement } from "./connectivity";
import { Coder } from "./entropy";
import { CorruptError } from "./errors";
import type { Header } from "./header";
import type { Ints, Memory } from "./kernels";
import { checkLimit, type Limits } from "./limits";
import { permuted, type Numbering } from "./numbering";
import { Cursor } from "./packets";
import { split } from "./splits";

/** Given vertices, so that every number of one can be coded (F 9.1). */
const MOST_GIVEN = 2 ** 24;

/** The mesh as it was given: decoded `faces`, and the data of ORDER. */
export function decodeOrder(memory: Memory, data: Uint8Array, faces: Ints, header: Header, limits: Limits): Numbering {
    const { vertices, gopFrames } = header;
    const cursor = new Cursor(data);
    const [copies, loose] = [cursor.varint(), cursor.varint()];
    const size = vertices + copies + loose;
    checkLimit(limits, "vertices", size);
    if (vertices + copies > faces.length || size >= MOST_GIVEN) {
        throw new CorruptError(`${copies} copies of ${vertices} vertices, and ${loose} in no face`);
    }
    const bytes = cursor.take(24 * loose);
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
    const positions = Float64Array.from({ length: 3 * loose }, (_, i) => view.getFloat64(8 * i, true));
    if (!positions.every(Number.isFinite)) throw new CorruptError("a vertex that no face uses has a coordinate that is not finite");
    return memory.scratch(() => {
        const coder = new Coder(memory, cursor.rest());
        const arrangement = readArrangement(memory, coder, faces, vertices);
        const whole = copies + loose > 0 ? split(memory, coder, arrangement, size, copies, positions) : permuted(arrangement);
        coder.finish();
        if (loose > 0 && gopFrames > 0) throw new CorruptError("a sequence of frames with vertices in no face");
        return whole;
    });
}
