import { LIMITS } from "./constants.json";
import { LimitError } from "./errors";

type OfMeshes = "vertices" | "faces" | "blocks" | "blockSize" | "coefficients" | "attributes" | "attributeValues";
type OfSequences = "frames" | "gopFrames" | "sequenceBytes" | "keptBytes";
type OfStreams = "frameBytes" | "metadataBytes" | "memory" | "memoryPerByte" | "blockMemory" | "blockMemoryPerVertex";
type Work = "work" | "workPerVertex" | "workPerByte";

/**
 * Upper bounds that a decoder checks before it allocates or works (specification, M 14.1). Bytes are those of a section,
 * of all metadata, of the dictionaries of a sequence and of one of its GOPs, of frames that a geometry keeps, of a block's
 * dictionary while it is made (M 14.2), and of the whole decoder. Work is in nanoseconds of a processor core (M 14.3).
 */
export type Limits = Record<OfMeshes | OfSequences | OfStreams | Work, number>;

export const DEFAULT_LIMITS: Readonly<Limits> = { ...LIMITS, keptBytes: 2 ** 30, memory: 2 ** 31 };

export function checkLimit(limits: Limits, name: keyof Limits, value: number): void {
    if (value > limits[name])
        throw new LimitError(
            `${name} = ${value} is over the limit of ${limits[name]}; raise it if you trust the source`,
        );
}
