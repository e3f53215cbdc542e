/**
 * Decodes a stream of a static mesh on a light grid while it arrives, as `decoder.ts` does, and nothing else: with
 * quick.wasm grids without congruent parts, with parts.wasm those of parts, too.
 */
import type { Mesh, EventOf } from "./events";
import { BsmError, CorruptError, errorLike } from "./errors";
import type { Header } from "./header";
import type { Kernels } from "./kernels";
import { DEFAULT_LIMITS, type Limits } from "./limits";
import { errorName, Memory } from "./memory";
import type { Packet } from "./packets";
import { Reader } from "./reader";
import { END_OF_STREAM, NEED_DATA, type Signal } from "./signals";

export type GridEvent = EventOf<"header" | "metadata" | "connectivity" | "block" | "end">;

/** The functions of library/wasm/light.c, which decode what the reader gives them. */
class Light extends Memory {
    constructor(kernels: Kernels, limits: Limits) {
        super(kernels, limits, "light_open");
    }

    /** CRC-32 of zlib; `before` is that of the bytes in front. */
    crc32(data: Uint8Array, before = 0): number {
        return this.held([data], (at) => this.call("light_sum", at, data.length, before));
    }

    /** CRC-16 called XMODEM. */
    crc16(data: Uint8Array): number {
        return this.held([data], (at) => this.call("light_short_sum", at, data.length));
    }

    /** CRC-32 of the positions, in which -0 is 0 (F 5.10). */
    get sum(): number {
        return this.call("light_sum_of_positions");
    }

    /** Charge work, and the bytes that ask for it (M 14.3). */
    charge(work: number, received: number): void {
        this.check(this.call("light_charge", work, received));
    }

    begin({ vertices, faces, grid, lattice, corner, center, scale, congruence }: Header): void {
        const numbers = [
            vertices,
            faces,
            scale,
            ...grid,
            ...center,
            ...(corner.length ? corner : [0, 0, 0]),
            ...(lattice.length ? lattice : [0, 0]),
            congruence,
        ];
        this.held([new Float64Array(numbers)], (at) => this.check(this.call("light_begin", at)));
    }

    faces(payload: Uint8Array, count: number): Int32Array {
        return this.copied(Int32Array, this.given("light_faces", payload), 3 * count);
    }

    /** Where the positions are, once those of `count` vertices from `first` on are there. */
    decode(payload: Uint8Array, first: number, count: number): number {
        return this.given("light_positions", payload, first, count);
    }

    /** Leave the memory to the next decoder. */
    release(): void {
        this.end("light_close");
    }

    private given(name: string, payload: Uint8Array, ...more: number[]): number {
        return this.held([payload], (at) => this.check(this.call(name, at, payload.length, ...more)));
    }

    private check(result: number): number {
        if (!result) throw errorLike({ name: errorName(this.call("light_error")), problem: "", place: {} });
        return result;
    }
}

/** Takes the bytes of a stream as they come, and gives events as soon as they can be known. */
export class GridDecoder {
    private readonly reader: Reader;
    /** @internal */
    readonly engine: Light;
    private readonly queue: GridEvent[] = [];
    private error?: BsmError;
    private header?: Header;
    private faces?: Int32Array;
    private places = 0;
    private chunks = 0;

    constructor(kernels: Kernels, given: Partial<Limits> = {}) {
        const limits = { ...DEFAULT_LIMITS, ...given };
        this.engine = new Light(kernels, limits);
        this.reader = new Reader(limits, this.engine);
    }

    /** Take more bytes of the stream. */
    receiveData(data: Uint8Array): void {
        if (!this.error) this.reader.receiveData(data);
    }

    /** Take note that no more bytes will come. */
    receiveEof(): void {
        this.reader.receiveEof();
    }

    /** The next event, or `NEED_DATA`; `END_OF_STREAM` after the end and `receiveEof`. */
    nextEvent(): GridEvent | Signal {
        for (;;) {
            const event = this.queue.shift();
            if (event) return event;
            if (this.error) throw this.error;
            try {
                const packet = this.reader.nextPacket();
                if (typeof packet === "string") return packet;
                this.accept(packet);
            } catch (error) {
                if (!(error instanceof BsmError)) throw error;
                this.error = error.located({ offset: this.reader.position });
            }
        }
    }

    /** Leave the memory to the next decoder; this one is not to be asked for anything more. */
    release(): void {
        this.engine.release();
    }

    /** Decode the rest of a complete stream. */
    finish(): Mesh {
        this.receiveEof();
        while (this.nextEvent() !== END_OF_STREAM);
        return { positions: this.positions, faces: this.faces!, attributes: [] };
    }

    private get positions(): Float64Array {
        return this.engine.doubles(this.places, 3 * this.header!.vertices);
    }

    private accept(packet: Packet): void {
        switch (packet.type) {
            case "header":
                this.header = packet.header;
                this.engine.begin(packet.header);
                return void this.queue.push(packet);
            case "metadata":
                return void this.queue.push(packet);
            case "connectivity":
                return void (this.faces = this.engine.faces(packet.data, this.header!.faces));
            case "grid":
                return this.acceptGrid(packet.first, packet.count, packet.data);
            case "end":
                if (packet.positions !== undefined && packet.positions !== this.engine.sum)
                    throw new CorruptError(
                        "the checksum of decoded positions is wrong: they are not those that the encoder saw",
                    );
                this.queue.push({ type: "end", missing: new Int32Array(0), degraded: new Int32Array(0) });
        }
    }

    private acceptGrid(first: number, count: number, data: Uint8Array): void {
        if (first === 0) {
            const loose = { vertices: new Int32Array(0), positions: new Float64Array(0) };
            this.queue.push({ type: "connectivity", faces: this.faces!, vertices: this.header!.vertices, loose });
        }
        this.places = this.engine.decode(data, first, count);
        const positions = this.engine.doubles(this.places + 24 * first, 3 * count);
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
    return decoder.finish();
}

export { END_OF_STREAM, NEED_DATA };
