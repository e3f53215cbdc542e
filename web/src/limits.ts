import { LIMITS } from "./constants.json";
import { LimitError } from "./errors";

/** Upper bounds that a decoder checks before it allocates or works (specification, M 14.1). */
export interface Limits {
    vertices: number;
    faces: number;
    blocks: number;
    blockSize: number;
    coefficients: number;
    frames: number;
    gopFrames: number;
    frameBytes: number;
    metadataBytes: number;
    attributes: number;
    /** Numbers of all attributes: values times their components. */
    attributeValues: number;
    /** Bytes of the dictionaries of a sequence, and of one of its GOPs. */
    sequenceBytes: number;
    /** Bytes of the frames that a geometry keeps to show them again. */
    keptBytes: number;
    /** Nanoseconds of a processor core, by the estimates of the specification (M 14.3), and how many more for each vertex and byte. */
    work: number;
    workPerVertex: number;
    workPerByte: number;
    /** Bytes for the dictionary of a block while it is made (M 14.2), and for all attributes; how many more for each vertex and byte. */
    blockMemory: number;
    blockMemoryPerVertex: number;
    memoryPerByte: number;
    /** Bytes that the decoder's own memory may grow to. */
    memory: number;
}

export const DEFAULT_LIMITS: Readonly<Limits> = { ...LIMITS, keptBytes: 2 ** 30, memory: 2 ** 31 };

/** Throw `LimitError` if `value` exceeds the limit called `name`. */
export function checkLimit(limits: Limits, name: keyof Limits, value: number): void {
    if (value > limits[name]) {
        throw new LimitError(`${name} = ${value} is over the limit of ${limits[name]}; raise it if you trust the source`);
    }
}
