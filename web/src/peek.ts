/** The first bytes of a stream, as far as they tell which decoder it needs. */
import { HEADER_KEYS, PREAMBLE } from "./constants.json";
import { BsmError } from "./errors";
import { parseMap } from "./maps";
import { parseVarint } from "./varint";

/** Decoders: of light grids, of those with congruent parts, of grids, of blocks, of sequences, of static meshes, of all. */
export type Build = "quick" | "parts" | "grid" | "blocks" | "moving" | "small" | "whole";

/** The files of threads: one with the decoder of everything, one with all others. */
export type Thread = Extract<Build, "small" | "whole">;

export const threadOf = (build: Build): Thread => (build === "whole" ? build : "small");

/** Whether a decoder knows light grids alone, which one thread decodes. */
export const isLight = (build: Build): boolean => build === "quick" || build === "parts";

/** Which decoder a stream needs, and how many vertices, or cells of them, its blocks say to have for helpers to share. */
export interface Need {
    build: Build;
    members: number;
    vertices?: number;
}

/** What a stream needs; undefined before the header is there. What is wrong, the decoder of everything says best. */
export function needOf(data: Uint8Array): Need | undefined {
    try {
        const tag = parseVarint(data, PREAMBLE.length, data.length);
        if (!tag) return undefined;
        const end = tag.end + Math.floor(tag.value / 16);
        if (end > data.length)
            return data[0] === PREAMBLE[0] && tag.value % 16 === 1 ? undefined : { build: "whole", members: 0 };
        const header = new Map(parseMap(data.subarray(tag.end, end)).map(([{ value: key }, value]) => [key, value]));
        const first = (key: number): number => {
            const value = header.get(key);
            return Number((value?.type === "array" ? value.value[0] : value)?.value ?? 0);
        };
        const { blocks, blockSize, paper, sequence, attributes, light, congruence, repeats, vertices } = HEADER_KEYS;
        const buildOf = (): Build => {
            if (first(paper) > 0 || header.has(attributes)) return "whole";
            if (header.has(sequence)) return "moving";
            if (first(light) === 1 && !header.has(repeats)) return header.has(congruence) ? "parts" : "quick";
            return header.has(blocks) ? "blocks" : "grid"; // also of brief streams, whose header is one field
        };
        return { build: buildOf(), members: first(blocks) * first(blockSize), vertices: first(vertices) };
    } catch (error) {
        if (!(error instanceof BsmError)) throw error;
        return { build: "whole", members: 0 };
    }
}
