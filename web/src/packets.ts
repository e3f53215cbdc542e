/** Packets, and how payloads become those that every decoder knows (specification, F 5). */
import type { Metadata } from "./events";
import { parseHeader, type Header } from "./header";
import { checkLimit, type Limits } from "./limits";
import { parseMap } from "./maps";
import { demand, parseVarint } from "./varint";

export type Packet =
    | { type: "header"; header: Header }
    | { type: "metadata"; entries: Metadata }
    | { type: "connectivity"; data: Uint8Array }
    | { type: "grid"; first: number; count: number; data: Uint8Array }
    | { type: "end"; frames: number; crc: number; positions?: number };

export type Kind = Packet["type"];

/** Reads a payload from front to back; what it lacks or has too much is a `CorruptError`. */
export class Cursor {
    private at = 0;

    constructor(private readonly payload: Uint8Array) {}

    varint(): number {
        const parsed = parseVarint(this.payload, this.at, this.payload.length);
        demand(parsed !== undefined);
        this.at = parsed.end;
        return parsed.value;
    }

    take(count: number): Uint8Array {
        demand(count <= this.payload.length - this.at);
        this.at += count;
        return this.payload.subarray(this.at - count, this.at);
    }

    rest(): Uint8Array {
        return this.take(this.payload.length - this.at);
    }
}

/** What becomes of a payload of each kind. */
export const PARSERS: Record<Kind, (payload: Cursor, limits: Limits) => Packet> = {
    header: (payload, limits) => ({ type: "header", header: parseHeader(payload.rest(), limits) }),
    metadata: (payload, limits) => {
        const data = payload.rest();
        checkLimit(limits, "metadataBytes", data.length);
        const entries: Metadata = new Map();
        for (const [key, value] of parseMap(data)) {
            demand(key.type === "string" && value.type !== "array");
            entries.set(key.value, value.value);
        }
        return { type: "metadata", entries };
    },
    connectivity: (payload) => ({ type: "connectivity", data: payload.rest() }),
    grid: (payload) => ({ type: "grid", first: payload.varint(), count: payload.varint(), data: payload.rest() }),
    end: (payload) => {
        const [frames, crc, rest] = [payload.varint(), littleEndian(payload.take(4)), payload.rest()];
        demand(rest.length === 0 || rest.length === 4);
        return { type: "end", frames, crc, positions: rest.length > 0 ? littleEndian(rest) : undefined };
    },
};

export function littleEndian(bytes: Uint8Array): number {
    return bytes.reduceRight((value, byte) => value * 256 + byte, 0);
}
