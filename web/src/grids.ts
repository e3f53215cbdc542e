/**
 * Decodes a stream of a static mesh on a light grid while it arrives, as `decoder.ts` does, and nothing else: with
 * quick.wasm grids without congruent parts, with parts.wasm those of parts, too. Each frame is checked against all that
 * came before it, then C gets its payload (specification, F 2, F 3, F 5). Errors have no texts: see `demand`.
 */
import { KINDS, PREAMBLE } from "./constants.json";
import type { Mesh, EventOf, Metadata } from "./events";
import { END_OF_STREAM, NEED_DATA, type Signal } from "./signals";
import { BsmError, errorLike, FormatError, TruncatedError, UnsupportedError } from "./errors";
import { parseHeader, type Header } from "./header";
import type { Kernels } from "./kernels";
import { checkLimit, DEFAULT_LIMITS, type Limits } from "./limits";
import { parseMap } from "./maps";
import { errorName, Memory } from "./memory";
import { demand, frameOf, parseVarint } from "./varint";

export type GridEvent = EventOf<"header" | "metadata" | "connectivity" | "block" | "end">;

/** Nanoseconds of a processor core for reading a frame, whatever it is, and for each of its bytes (M 14.3). */
const FRAME = 8e3;
const BYTE = 8;
const METADATA = 2e4;
const ENTRY = 8e3;
const MAGIC_SIZE = 4;
/** A version that differs only in these bits is another minor one. */
const MINORS = 15;
const kinds: Record<number, string> = KINDS;
/** What may come before a frame of each kind, metadata aside. */
const BEFORE: Record<string, string[]> = {
    header: ["start"],
    connectivity: ["header"],
    grid: ["connectivity", "grid"],
    end: ["connectivity", "grid"],
};

/** The functions of library/wasm/light.c, which decode what the reader gives them. */
class Light extends Memory {
    constructor(kernels: Kernels, limits: Limits) {
        super(kernels, limits, "light_open");
    }

    /** CRC-32 of zlib; `before` is that of the bytes in front. */
    crc32(data: Uint8Array, before = 0): number {
        return this.held([data], (at) => this.invoke("light_sum", at, data.length, before));
    }

    /** CRC-16 called XMODEM. */
    crc16(data: Uint8Array): number {
        return this.held([data], (at) => this.invoke("light_short_sum", at, data.length));
    }

    /** CRC-32 of the positions, in which -0 is 0 (F 5.10). */
    get sum(): number {
        return this.invoke("light_sum_of_positions");
    }

    /** Charge work, and the bytes that ask for it (M 14.3). */
    charge(work: number, received: number): void {
        this.check(this.invoke("light_charge", work, received));
    }

    begin({ vertices, faces, grid, lattice, corner, center, scale, congruence }: Header): void {
        const [three, two] = [corner.length ? corner : [0, 0, 0], lattice.length ? lattice : [0, 0]];
        const numbers = [vertices, faces, scale, ...grid, ...center, ...three, ...two, congruence];
        this.held([new Float64Array(numbers)], (at) => this.check(this.invoke("light_begin", at)));
    }

    faces(payload: Uint8Array, count: number): Int32Array {
        return this.copied(Int32Array, this.given("light_faces", payload), 3 * count);
    }

    /** Where the positions are, once those of `count` vertices from `first` on are there. */
    placesOf(payload: Uint8Array, first: number, count: number): number {
        return this.given("light_positions", payload, first, count);
    }

    /** Leave the memory to the next decoder. */
    release(): void {
        this.end("light_close");
    }

    private given(name: string, payload: Uint8Array, ...more: number[]): number {
        return this.held([payload], (at) => this.check(this.invoke(name, at, payload.length, ...more)));
    }

    private check(result: number): number {
        if (!result) throw errorLike({ name: errorName(this.invoke("light_error")), problem: "", place: {} });
        return result;
    }
}

/** The varint at a place of a payload. */
function varintIn(payload: Uint8Array, at = 0): { value: number; end: number } {
    const found = parseVarint(payload, at, payload.length);
    demand(found !== undefined);
    return found;
}

function littleEndian(bytes: Uint8Array): number {
    return bytes.reduceRight((value, byte) => value * 256 + byte, 0);
}

/** Takes the bytes of a stream as they come, and gives events as soon as they can be known. */
export class GridDecoder {
    private readonly limits: Limits;
    /** @internal */
    readonly engine: Light;
    private readonly queue: GridEvent[] = [];
    private error?: BsmError;
    /** The bytes from `begin` to `end` are those of the stream from `offset` on. */
    private buffer = new Uint8Array(0);
    private begin = 0;
    private end = 0;
    private offset = 0;
    private eof = false;
    private started = false;
    private frames = 0;
    private crc = 0;
    /** The kind of the frame before, metadata aside. */
    private last = "start";
    private header?: Header;
    private faces?: Int32Array;
    private nextVertex = 0;
    private chunks = 0;
    /** Names and bytes of metadata. */
    private readonly entryNames = new Set<string>();
    private metadataRead = 0;

    constructor(kernels: Kernels, given: Partial<Limits> = {}) {
        this.limits = { ...DEFAULT_LIMITS, ...given };
        this.engine = new Light(kernels, this.limits);
    }

    /** Take more bytes of the stream. */
    receiveData(data: Uint8Array): void {
        if (this.error) return;
        if (this.eof) throw new Error("bytes were given to a decoder after receiveEof");
        if (this.end + data.length > this.buffer.length) this.makeRoom(data.length);
        this.buffer.set(data, this.end);
        this.end += data.length;
    }

    /** Take note that no more bytes will come. */
    receiveEof(): void {
        this.eof = true;
    }

    /** The next event, or `NEED_DATA`; `END_OF_STREAM` after the end and `receiveEof`. */
    nextEvent(): GridEvent | Signal {
        for (;;) {
            const event = this.queue.shift();
            if (event) return event;
            if (this.error) throw this.error;
            let isRead = false;
            try {
                const act = this.nextFrame();
                if (typeof act === "string") return act;
                isRead = true; // what C finds in a payload has the place of its end
                act();
            } catch (error) {
                if (!(error instanceof BsmError)) throw error;
                const frame = this.started && !isRead ? this.frames : undefined;
                this.error = error.located({ offset: this.offset, frame });
            }
        }
    }

    /** Leave the memory to the next decoder; this one is not to be asked for anything more. */
    release(): void {
        this.engine.release();
    }

    private makeRoom(count: number): void {
        const size = this.end - this.begin;
        const grown = size + count > this.buffer.length / 2 ? new Uint8Array(2 * (size + count) + 1024) : this.buffer;
        grown.set(this.buffer.subarray(this.begin, this.end));
        [this.buffer, this.begin, this.end] = [grown, 0, size];
    }

    private drop(count: number): void {
        this.begin += count;
        this.offset += count;
    }

    /** Read frames until one has news; return what to do with it, or what the stream waits for. */
    private nextFrame(): (() => void) | Signal {
        if (!this.started && !this.start()) return this.incomplete();
        while (this.last !== "end") {
            const { begin, buffer, end, engine } = this;
            const tag = parseVarint(buffer, begin, end);
            const frame = tag && frameOf(tag);
            if (frame) checkLimit(this.limits, "frameBytes", frame.length);
            if (!frame || frame.end > end) return this.incomplete();
            const body = buffer.subarray(begin, frame.sum);
            const expected = frame.end - frame.sum === 2 ? engine.crc16(body) : engine.crc32(body);
            demand(littleEndian(buffer.subarray(frame.sum, frame.end)) === expected);
            const size = frame.end - begin;
            engine.charge(FRAME + BYTE * size, size);
            const act = this.accept(frame.type, buffer.slice(tag.end, frame.sum));
            this.crc = engine.crc32(buffer.subarray(begin, frame.end), this.crc);
            this.frames++;
            this.drop(size);
            if (act) return act;
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
        if (present.length < PREAMBLE.length) return false;
        this.crc = this.engine.crc32(present);
        this.drop(PREAMBLE.length);
        return (this.started = true);
    }

    private incomplete(): Signal {
        if (!this.eof) return NEED_DATA;
        throw new TruncatedError("", { offset: this.offset + this.end - this.begin });
    }

    /** Check a frame against all before it; returns what is to be done with it, undefined for one to be skipped. */
    private accept(type: number, payload: Uint8Array): (() => void) | undefined {
        if (type >= 8 && type <= 11) return void demand(this.header !== undefined);
        const kind = kinds[type];
        if (kind === "metadata") return this.acceptMetadata(payload);
        if (!BEFORE[kind]) throw new UnsupportedError("");
        const header = kind === "header" ? parseHeader(payload, this.limits) : this.header!;
        demand(BEFORE[kind].includes(this.last));
        [this.last, this.header] = [kind, header];
        if (kind === "header") return () => (this.engine.begin(header), this.queue.push({ type: kind, header }));
        if (kind === "connectivity") return () => (this.faces = this.engine.faces(payload, header.faces));
        const { value: first, end } = varintIn(payload);
        if (kind === "grid") {
            const { value: count, end: start } = varintIn(payload, end);
            demand(first === this.nextVertex && count > 0 && count <= header.vertices - first);
            this.nextVertex += count;
            return () => this.decodeChunk(first, count, payload.subarray(start));
        }
        const [crc, sum] = [payload.subarray(end, end + 4), payload.subarray(end + 4)];
        demand(crc.length === 4 && (sum.length === 0 || sum.length === 4));
        const isWhole = this.nextVertex >= header.vertices && first === this.frames;
        demand(isWhole && littleEndian(crc) === this.crc);
        return () => {
            demand(sum.length === 0 || littleEndian(sum) === this.engine.sum); // or the encoder saw other positions
            this.queue.push({ type: "end", missing: new Int32Array(0), degraded: new Int32Array(0) });
        };
    }

    private acceptMetadata(payload: Uint8Array): () => void {
        checkLimit(this.limits, "metadataBytes", payload.length);
        demand(this.header !== undefined);
        const entries: Metadata = new Map();
        for (const [key, value] of parseMap(payload)) {
            demand(key.type === "string" && value.type !== "array" && !this.entryNames.has(key.value));
            this.entryNames.add(key.value);
            entries.set(key.value, value.value);
        }
        checkLimit(this.limits, "metadataBytes", (this.metadataRead += payload.length));
        this.engine.charge(METADATA + ENTRY * entries.size, 0);
        return () => this.queue.push({ type: "metadata", entries });
    }

    private decodeChunk(first: number, count: number, data: Uint8Array): void {
        if (first === 0) {
            const loose = { vertices: new Int32Array(0), positions: new Float64Array(0) };
            this.queue.push({ type: "connectivity", faces: this.faces!, vertices: this.header!.vertices, loose });
        }
        const places = this.engine.placesOf(data, first, count);
        const positions = this.engine.doubles(places + 24 * first, 3 * count);
        this.queue.push({
            type: "block",
            index: this.chunks++,
            first,
            positions,
            // Made for those who ask: loops are slow before they are compiled.
            get vertices() {
                return Int32Array.from({ length: count }, (_, i) => first + i);
            },
            get final() {
                return new Uint8Array(count).fill(1);
            },
        });
    }
}

/** Decode a complete stream. */
export function decode(kernels: Kernels, data: Uint8Array, limits: Partial<Limits> = {}): Mesh {
    const decoder = new GridDecoder(kernels, limits);
    decoder.receiveData(data);
    decoder.receiveEof();
    let [faces, positions]: [Int32Array, Float64Array] = [new Int32Array(0), new Float64Array(0)];
    for (let event; (event = decoder.nextEvent()) !== END_OF_STREAM;) {
        if (typeof event === "string") continue;
        if (event.type === "connectivity") [faces, positions] = [event.faces, new Float64Array(3 * event.vertices)];
        if (event.type === "block") positions.set(event.positions, 3 * event.first!);
    }
    return { positions, faces, attributes: [] };
}

export { END_OF_STREAM, NEED_DATA };
