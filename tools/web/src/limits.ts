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

export const DEFAULT_LIMITS: Readonly<Limits> = {
    vertices: 2 ** 24,
    faces: 2 ** 25,
    blocks: 2 ** 17,
    blockSize: 8192,
    coefficients: 4096,
    frames: 2 ** 20,
    gopFrames: 1024,
    frameBytes: 2 ** 28,
    metadataBytes: 2 ** 23,
    attributes: 255,
    attributeValues: 2 ** 28,
    sequenceBytes: 2 ** 31,
    keptBytes: 2 ** 30,
    work: 8e8,
    workPerVertex: 3.2e4,
    workPerByte: 1.6e4,
    blockMemory: 2 ** 26,
    blockMemoryPerVertex: 2 ** 10,
    memoryPerByte: 64,
    memory: 2 ** 31,
};

/** Throw `LimitError` if `value` exceeds the limit called `name`. */
export function checkLimit(limits: Limits, name: keyof Limits, value: number): void {
    if (value > limits[name]) {
        throw new LimitError(`${name} = ${value} is over the limit of ${limits[name]}; raise it if you trust the source`);
    }
}
