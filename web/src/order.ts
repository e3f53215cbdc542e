/** The order that a mesh had, from ORDER (specification, C 9 and F 9). */
import { readArrangement } from "./connectivity";
import { Coder } from "./entropy";
import { UnsupportedError } from "./errors";
import type { Header } from "./header";
import type { Ints, Memory } from "./memory";
import { inverse, Numbering } from "./numbering";
import { Cursor } from "./packets";

/** The mesh as it was given: decoded `faces`, and the data of ORDER. */
export function decodeOrder(memory: Memory, data: Uint8Array, faces: Ints, { vertices }: Header): Numbering {
    const cursor = new Cursor(data);
    if (cursor.varint() + cursor.varint() > 0) throw new UnsupportedError("this build decodes no split vertices; bsm.js does");
    return memory.scratch(() => {
        const coder = new Coder(memory, cursor.rest());
        const { faces: given, numbers } = readArrangement(memory, coder, faces, vertices);
        coder.finish();
        return new Numbering(given, vertices, inverse(numbers, vertices).members);
    });
}
