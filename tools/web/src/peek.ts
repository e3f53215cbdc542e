/** The first bytes of a stream, as far as they tell which decoder it needs. */
import { BsmError } from "./errors";
import { parseMap } from "./maps";
import { parseVarint } from "./varint";

/** The decoders that there are: of light grids, of static meshes, of everything. */
export type Build = "quick" | "small" | "whole";

/** Which decoder a stream needs, unless that finds that it does not, and how many vertices it says to have. */
export interface Need {
    build: Build;
    vertices: number;
}

const MAGIC = 5;
/** Keys of the header (specification, F 4.4) whose values tell. */
const KEYS = { vertices: 1, coding: 14, gopFrames: 23, attributes: 33, light: 42 };

/** What the stream needs; undefined where the header is not there yet. What is wrong with a stream the decoder of everything says best. */
export function needOf(data: Uint8Array): Need | undefined {
    try {
        const tag = parseVarint(data, MAGIC, data.length);
        if (!tag) return undefined;
        const end = tag.end + Math.floor(tag.value / 16);
        if (end > data.length) return data[0] === 0x89 && tag.value % 16 === 1 ? undefined : { build: "whole", vertices: 0 };
        const header = new Map(parseMap(data.subarray(tag.end, end)).map(([key, { value }]) => [Number(key.value), Number(value)]));
        const { vertices, coding, gopFrames, attributes, light } = KEYS;
        const isWhole = header.has(gopFrames) || header.has(attributes) || header.get(coding) === 0;
        return { build: isWhole ? "whole" : header.get(light) === 1 ? "quick" : "small", vertices: header.get(vertices) ?? 0 };
    } catch (error) {
        if (!(error instanceof BsmError)) throw error;
        return { build: "whole", vertices: 0 };
    }
}
