/** Constants of the format, which `python -m tools.web_constants --write` makes of Python's. */
import type { Field } from "./record";

/** What a stream begins with: magic and version. */
export const PREAMBLE = [137, 66, 83, 77, 16] as const;
/** A payload of fewer bytes has a short checksum (F 3). */
export const SHORT = 128;
export const MAX_VARINT_BYTES = 5;

/** Types of frames (F 3.4). */
export const KINDS = {
    0: "values",
    1: "header",
    2: "metadata",
    3: "connectivity",
    4: "partition",
    5: "order",
    6: "block",
    7: "gop",
    12: "grid",
    13: "refinement",
    14: "attribute",
    15: "end",
} as const;

/** Fields of the header (F 4.4). */
export const HEADER_FIELDS = {
    vertices: { key: 1, type: "int", low: 1, high: 2147483647 },
    faces: { key: 2, type: "int", low: 1, high: 2147483647 },
    blocks: { key: 3, type: "int", low: 0, high: 2147483647, default: 0 },
    blockSize: { key: 4, type: "int", low: 0, high: 2147483647, default: 0 },
    coefficients: { key: 5, type: "int", low: 0, high: 2147483647, default: 0 },
    keyInterval: { key: 6, type: "int", low: 0, high: 2147483647, default: 0 },
    step: { key: 7, type: "float", low: 9.094947017729282e-13, high: 1048576, default: 0.00390625 },
    center: { key: 8, type: "floats", low: -1e+300, high: 1e+300, default: [0, 0, 0], lengths: [3, 3] },
    scale: { key: 9, type: "float", low: 1e-300, high: 1e+300, default: 1 },
    smoothing: { key: 10, type: "float", low: 0, high: 1000000, default: 0 },
    refinement: { key: 11, type: "floats", low: 0, high: 64, default: [], lengths: [0, 2] },
    attributes: { key: 12, type: "int", low: 0, high: 255, default: 0 },
    grid: { key: 13, type: "ints", low: 0, high: 1048575, default: [], lengths: [0, 3] },
    lattice: { key: 14, type: "ints", low: 1, high: 2147483647, default: [], lengths: [0, 2] },
    corner: { key: 15, type: "ints", low: -2147483648, high: 2147483647, default: [], lengths: [0, 3] },
    light: { key: 16, type: "method", low: 0, high: 2, default: 0 },
    sequence: { key: 17, type: "ints", low: 0, high: 2147483647, default: [], lengths: [0, 2] },
    run: { key: 18, type: "ints", low: 0, high: 2147483647, default: [], lengths: [0, 2] },
    paper: { key: 19, type: "floats", low: 0, high: 1073741824, default: [], lengths: [0, 8] },
} satisfies Record<string, Field>;

/** Numbers of `paper`, by places, and the law's constants (F 4). */
export const PAPER_FIELDS = {
    bits: { key: 0, type: "int", low: 0, high: 32, default: 0 },
    coarser: { key: 1, type: "int", low: 0, high: 30, default: 0 },
    exact: { key: 2, type: "int", low: 0, high: 1, default: 0 },
    power: { key: 3, type: "int", low: 1, high: 64, default: 3 },
    iterations: { key: 4, type: "int", low: 1, high: 1024, default: 1 },
    keyIterations: { key: 5, type: "int", low: 1, high: 1024, default: 2 },
    shift: { key: 6, type: "float", low: 9.313225746154785e-10, high: 1073741824, default: 0.0078125 },
    springs: { key: 7, type: "int", low: 0, high: 1, default: 1 },
} satisfies Record<string, Field>;

/** Limits that are Python's (M 14.1). */
export const LIMITS = {
    vertices: 16777216,
    faces: 33554432,
    blocks: 131072,
    blockSize: 8192,
    coefficients: 4096,
    frames: 1048576,
    gopFrames: 1024,
    frameBytes: 268435456,
    metadataBytes: 8388608,
    attributes: 255,
    attributeValues: 268435456,
    sequenceBytes: 2147483648,
    work: 800000000,
    workPerVertex: 32000,
    workPerByte: 16000,
    memoryPerByte: 64,
    blockMemory: 67108864,
    blockMemoryPerVertex: 1024,
} as const;
