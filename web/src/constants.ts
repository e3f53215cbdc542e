/** Constants of the format, which `python -m tools.web_constants --write` makes of Python's. */

/** What a stream begins with: magic and version. */
export const PREAMBLE = [137, 66, 83, 77, 16] as const;
/** A payload of fewer bytes has a short checksum (F 3). */
export const SHORT = 128;
export const MAX_VARINT_BYTES = 5;

/** Types of frames of a light grid (F 3.4). */
export const KINDS = {
    1: "header",
    2: "metadata",
    3: "connectivity",
    12: "grid",
    15: "end",
} as const;

/** Keys of the fields that tell which decoder a stream needs (F 4.4). */
export const HEADER_KEYS = {
    vertices: 1,
    attributes: 12,
    light: 16,
    sequence: 17,
    paper: 19,
    congruence: 22,
} as const;

/** The header of a light grid (F 4.4, F 4.6). */
export const GRID_FIELDS = {
    vertices: { key: 1, type: "int", low: 1, high: 2147483647 },
    faces: { key: 2, type: "int", low: 1, high: 2147483647 },
    center: { key: 8, type: "float", low: -1e+300, high: 1e+300, default: [0, 0, 0], lengths: [3, 3] },
    scale: { key: 9, type: "float", low: 1e-300, high: 1e+300, default: 1 },
    grid: { key: 13, type: "int", low: 0, high: 1048575, default: [], lengths: [0, 3] },
    lattice: { key: 14, type: "int", low: 1, high: 2147483647, default: [], lengths: [0, 2] },
    corner: { key: 15, type: "int", low: -2147483648, high: 2147483647, default: [], lengths: [0, 3] },
    light: { key: 16, type: "int", low: 0, high: 2, default: 0 },
} as const;

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
