/** The first bytes of a stream, as far as they tell which decoder it needs. */
import { HEADER_KEYS, PREAMBLE } from "./constants.json";
import { BsmError } from "./errors";
import { parseMap } from "./maps";
import { parseVarint } from "./varint";

/**
 * The decoders that there are: of light grids, of those with congruent parts, of all grids, of blocks, of sequences, of
 * static meshes, of all.
 */
export type Build = "quick" | "parts" | "grid" | "blocks" | "moving" | "small" | "whole";

/** The files of threads: one with the decoder of everything, one with all others. */
export type Thread = Extract<Build, "small" | "whole">;

export const threadOf = (build: Build): Thread => (build === "whole" ? build : "small");

/** Whether a decoder knows light grids alone, which one thread decodes. */
export const isLight = (build: Build): boolean => build === "quick" || build === "parts";

/**
 * Which decoder a stream needs, unless that finds that it does not, and how many vertices, or cells of vertices, its
 * blocks say to have: helpers share these.
 */
export interface Need {
    build: Build;
    members: number;
}

/**
 * What the stream needs; undefined where the header is not there yet. What is wrong with a stream the decoder of
 * everything says best.
 */
export function needOf(data: Uint8Array): Need | undefined {
    try {
        const tag = parseVarint(data, PREAMBLE.length, data.length);
        if (!tag) return undefined;
        const end = tag.end + Math.floor(tag.value / 16);
        if (end > data.length)
            return data[0] === PREAMBLE[0] && tag.value % 16 === 1 ? undefined : { build: "whole", members: 0 };
        const header = new Map(
            parseMap(data.subarray(tag.end, end)).map(([key, value]) => [
                Number(key.value),
                value.type === "array" ? value.value[0] : value,
            ]),
        );
        const first = (key: number): number => Number(header.get(key)?.value ?? 0);
        const { blocks, blockSize, paper, sequence, attributes, light, congruence } = HEADER_KEYS;
        const build =
            first(paper) > 0 || header.has(attributes)
                ? "whole"
                : header.has(sequence)
                  ? "moving"
                  : first(light) !== 1
                    ? header.has(blocks)
                        ? "blocks"
                        : "grid" // also of brief streams, whose header is one field
                    : header.has(congruence)
                      ? "parts"
                      : "quick";
        return { build, members: first(blocks) * first(blockSize) };
    } catch (error) {
        if (!(error instanceof BsmError)) throw error;
        return { build: "whole", members: 0 };
    }
}
