/** What those that share the chains of a stream have in common. */
import type { Described } from "./errors";

/** A block's own reconstruction, before it is blended with others; positions in BSM units. */
export interface DecodedBlock {
    vertices: Int32Array;
    positions: Float64Array;
    weights: Float64Array;
}

/** A block that a helper has decoded, or what is wrong with it. */
export interface SharedBlock {
    index: number;
    block?: DecodedBlock;
    problem?: Described;
}

/** Which of those that share the chains of a stream has which: chain c is that of number c % `among`; 0 is the decoder. */
export interface Share {
    number: number;
    among: number;
}
