/** What those that share the chains of a stream have in common. */
import type { Described } from "./errors";

/** A block that a helper has decoded, before it is blended with others, in BSM units; or its error. */
export interface SharedBlock {
    index: number;
    block?: Record<"positions" | "weights", Float64Array> & { vertices: Int32Array };
    problem?: Described;
}

/** Who has which chains of a stream: chain c is that of number c % `among`; 0 is the decoder. */
export type Share = Record<"number" | "among", number>;
