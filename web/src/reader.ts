/**
 * Bytes to packets of meshes on light grids, without input or output of its own (specification, F 2, F 3, F 5). Errors
 * have no texts: see `demand`.
 */
import { KINDS, PREAMBLE, SHORT } from "./constants.json";
import { BsmError, FormatError, TruncatedError, UnsupportedError } from "./errors";
import type { Header } from "./header";
import { checkLimit, type Limits } from "./limits";
import { Cursor, littleEndian, PARSERS, type Kind, type Packet } from "./packets";
import { END_OF_STREAM, NEED_DATA, type Signal } from "./signals";
import { demand, parseVarint } from "./varint";

/** Nanoseconds of a processor core for reading a frame, whatever it is, and for each of its bytes (M 14.3). */
const [FRAME, BYTE, METADATA, ENTRY] = [8e3, 8, 2e4, 8e3];

/** Takes work, and the bytes that ask for it, and may refuse it; and sums bytes up (F 1.3, F 1.4). */
export interface Clerk {
    charge(work: number, received: number): void;
    crc32(data: Uint8Array, before?: number): number;
    crc16(data: Uint8Array): number;
}

const MAGIC_SIZE = 4;
/** A version that differs only in these bits is another minor one. */
const MINORS = 15;
const BLOCK_TAG = 6;

const kinds: Record<number, string> = KINDS;

/** What may follow a packet of each kind, metadata aside. */
const FOLLOWERS: Partial<Record<Kind | "start", readonly Kind[]>> = {
    start: ["header"],
    header: ["connectivity"],
    connectivity: ["grid", "end"],
    grid: ["grid", "end"],
};

/** What a tag says, and where the frame's payload and the frame end. */
export function frameOf(tag: { value: number; end: number }): Record<"type" | "length" | "sum" | "end", number> {
    const type = tag.value % 16;
    const length = Math.floor(tag.value / 16);
    const sum = tag.end + length;
    return { type, length, sum, end: sum + (type === BLOCK_TAG || length < SHORT ? 2 : 4) };
}

/** Strict: the first thing wrong is thrown; nothing may be asked for afterwards. */
export class Reader {
    private begin = 0;
    private end = 0;
    private eof = false;
    private buffer = new Uint8Array(0);
    private offset = 0;
    private frames = 0;
    private crc = 0;
    private started = false;
    /** The kind of the packet before, metadata aside. */
    private last: Kind | "start" = "start";
    private header?: Header;
    private nextVertex = 0;
    /** Names and bytes of metadata. */
    private readonly entryNames = new Set<string>();
    private metadataRead = 0;

    constructor(
        private readonly limits: Limits,
        private readonly clerk: Clerk,
    ) {}

    /** Take more bytes of the stream, any number of them. */
    receiveData(data: Uint8Array): void {
        if (this.eof) throw new Error("bytes were given to a reader after receiveEof");
        if (data.length === 0) return;
        if (this.end + data.length > this.buffer.length) this.makeRoom(data.length);
        this.buffer.set(data, this.end);
        this.end += data.length;
    }

    /** Take note that no more bytes will come. */
    receiveEof(): void {
        this.eof = true;
    }

    /** Where the packet given last ended, in bytes of the stream. */
    get position(): number {
        return this.offset;
    }

    /** The next packet, `NEED_DATA`, or `END_OF_STREAM` after END and `receiveEof`. */
    nextPacket(): Packet | Signal {
        try {
            return this.next();
        } catch (error) {
            const place = { offset: this.offset, frame: this.started ? this.frames : undefined };
            throw error instanceof BsmError ? error.located(place) : error;
        }
    }

    private makeRoom(count: number): void {
        const size = this.end - this.begin;
        const grown = size + count > this.buffer.length / 2 ? new Uint8Array(2 * (size + count) + 1024) : this.buffer;
        grown.set(this.buffer.subarray(this.begin, this.end));
        [this.buffer, this.begin, this.end] = [grown, 0, size];
    }

    private next(): Packet | Signal {
        if (!this.started && !this.start()) return NEED_DATA;
        while (this.last !== "end") {
            const frame = this.frame();
            if (!frame) return this.incomplete();
            this.clerk.charge(FRAME + BYTE * frame.size, frame.size);
            const packet = this.parse(frame.type, frame.payload);
            if (packet?.type === "metadata") this.clerk.charge(METADATA + ENTRY * packet.entries.size, 0);
            this.crc = this.clerk.crc32(this.buffer.subarray(this.begin, this.begin + frame.size), this.crc);
            this.frames++;
            this.drop(frame.size);
            if (packet) return packet;
        }
        demand(this.end === this.begin);
        return this.eof ? END_OF_STREAM : NEED_DATA;
    }

    private start(): boolean {
        const present = this.buffer.subarray(this.begin, Math.min(this.end, this.begin + PREAMBLE.length));
        for (let i = 0; i < present.length; i++) {
            if ((present[i] ^ PREAMBLE[i]) <= (i < MAGIC_SIZE ? 0 : MINORS)) continue;
            throw i < MAGIC_SIZE ? new FormatError("", { offset: 0 }) : new UnsupportedError("", { offset: i });
        }
        this.started = present.length === PREAMBLE.length;
        if (!this.started) this.incomplete();
        else {
            this.crc = this.clerk.crc32(present);
            this.drop(PREAMBLE.length);
        }
        return this.started;
    }

    private incomplete(): Signal {
        if (!this.eof) return NEED_DATA;
        throw new TruncatedError("", { offset: this.offset + this.end - this.begin });
    }

    /** The frame that is next; undefined if it is not complete. */
    private frame(): { type: number; payload: Uint8Array; size: number } | undefined {
        const start = this.begin;
        const tag = parseVarint(this.buffer, start, this.end);
        if (!tag) return undefined;
        const { type, length, sum, end } = frameOf(tag);
        checkLimit(this.limits, "frameBytes", length);
        if (end > this.end) return undefined;
        const body = this.buffer.subarray(start, sum);
        const expected = end - sum === 2 ? this.clerk.crc16(body) : this.clerk.crc32(body);
        demand(littleEndian(this.buffer.subarray(sum, end)) === expected);
        return { type, payload: this.buffer.slice(tag.end, sum), size: end - start };
    }

    /** The packet in a frame, checked against everything before it; undefined for one to be skipped. */
    private parse(type: number, payload: Uint8Array): Packet | undefined {
        if (type >= 8 && type <= 11) {
            demand(this.header !== undefined);
            return undefined;
        }
        const parse = PARSERS[kinds[type] as Kind];
        if (!parse) throw new UnsupportedError("");
        const packet = parse(new Cursor(payload), this.limits);
        if (packet.type === "metadata") this.acceptMetadata(packet, payload.length);
        else this.accept(packet);
        return packet;
    }

    private acceptMetadata({ entries }: Extract<Packet, { type: "metadata" }>, size: number): void {
        demand(this.header !== undefined);
        for (const name of entries.keys()) {
            demand(!this.entryNames.has(name));
            this.entryNames.add(name);
        }
        checkLimit(this.limits, "metadataBytes", (this.metadataRead += size));
    }

    /** Take note of a packet that may come here, and agrees with the header. */
    private accept(packet: Packet): void {
        const isNext = FOLLOWERS[this.last]?.includes(packet.type) === true;
        demand(isNext);
        this.last = packet.type;
        if (packet.type === "header") this.header = packet.header;
        const { vertices } = this.header!;
        if (packet.type === "grid") {
            const { first, count } = packet;
            demand(first === this.nextVertex && count > 0 && count <= vertices - first);
            this.nextVertex = first + count;
        }
        if (packet.type === "end")
            demand(this.nextVertex >= vertices && packet.frames === this.frames && packet.crc === this.crc);
    }

    private drop(count: number): void {
        this.begin += count;
        this.offset += count;
    }
}
