/** Decodes a stream of a static mesh on a light grid while it arrives, as `decoder.ts` does, and nothing else. */
import { required } from "./required";
import { crc32 } from "./checksums";
import { Budget, LIGHT_COST, meshCost } from "./budget";
import { decodeConnectivity } from "./connectivity";
import type { BlockEvent, ConnectivityEvent, EndEvent, HeaderEvent, Mesh, MetadataEvent } from "./events";
import { BsmError, CorruptError, UnsupportedError } from "./errors";
import { Grid } from "./grid";
import type { Header } from "./header";
import type { Kernels } from "./kernels";
import { DEFAULT_LIMITS, type Limits } from "./limits";
import { Memory, type Ints } from "./memory";
import type { Packet } from "./packets";
import { Reader } from "./reader";
import { END_OF_STREAM, NEED_DATA, type Signal } from "./signals";

export type Event = HeaderEvent | MetadataEvent | ConnectivityEvent | BlockEvent | EndEvent;

/** Takes the bytes of a stream as they come, and gives events as soon as they can be known. */
export class Decoder {
    private readonly limits: Limits;
    private readonly reader: Reader;
    private readonly memory: Memory;
    private readonly budget: Budget;
    private readonly queue: Event[] = [];
    private error?: BsmError;
    private header?: Header;
    private faces?: Ints;
    private grid?: Grid;
    private chunks = 0;

    constructor(private readonly kernels: Kernels, limits: Partial<Limits> = {}) {
        this.limits = { ...DEFAULT_LIMITS, ...limits };
        this.memory = new Memory(kernels.borrow(), this.limits.memory);
        this.budget = new Budget(this.limits);
        this.reader = new Reader(this.limits, this.budget.charge.bind(this.budget));
    }

    /** Take more bytes of the stream. */
    receiveData(data: Uint8Array): void {
        this.reader.receiveData(data);
    }

    /** Take note that no more bytes will come. */
    receiveEof(): void {
        this.reader.receiveEof();
    }

    /** Bytes of the stream that the events so far are made of. */
    get position(): number {
        return this.reader.position;
    }

    /** The next event, or `NEED_DATA`; `END_OF_STREAM` after the end and `receiveEof`. */
    nextEvent(): Event | Signal {
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
        this.kernels.take(this.memory.exports);
    }

    /** Decode the rest of a complete stream. */
    finish(): Mesh {
        this.receiveEof();
        while (this.nextEvent() !== END_OF_STREAM);
        return { positions: required(this.grid).positions, faces: required(this.faces).view.slice(), attributes: [] };
    }

    private accept(packet: Packet): void {
        switch (packet.type) {
            case "header": return this.acceptHeader(packet.header);
            case "metadata": return void this.queue.push(packet);
            case "connectivity": return this.acceptConnectivity(packet.data);
            case "order": throw new UnsupportedError("this build decodes no original order; bsm.js does");
            case "grid": return this.acceptGrid(packet.first, packet.count, packet.data);
            case "end":
                this.check(packet.positions);
                this.queue.push({ type: "end", missing: new Int32Array(0), degraded: new Int32Array(0) });
        }
    }

    /** Compare the checksum of positions, if the stream has one (F 5.10). */
    private check(expected?: number): void {
        if (expected === undefined) return;
        const places = required(this.grid).positions.map((place) => place + 0); // -0 counts as 0
        if (crc32(new Uint8Array(places.buffer)) !== expected) throw new CorruptError("the checksum of decoded positions is wrong: they are not those that the encoder saw");
    }

    private acceptHeader(header: Header): void {
        this.header = header;
        this.queue.push({ type: "header", header });
    }

    private acceptConnectivity(data: Uint8Array): void {
        const header = required(this.header);
        this.faces = decodeConnectivity(this.memory, data, header, this.limits);
        this.budget.grant(header.vertices);
        this.budget.charge(meshCost(header.vertices, header.faces, data.length), data.length);
    }

    private acceptGrid(first: number, count: number, data: Uint8Array): void {
        const grid = (this.grid ??= this.begunGrid());
        this.budget.charge(LIGHT_COST.frame(data.length), data.length);
        const changes = grid.decode(first, count, data);
        this.queue.push({ type: "block", index: this.chunks++, ...changes });
    }

    private begunGrid(): Grid {
        const { vertices, faces } = required(this.header);
        const loose = { vertices: new Int32Array(0), positions: new Float64Array(0) };
        this.queue.push({ type: "connectivity", faces: required(this.faces).view.slice(), vertices, loose });
        this.budget.charge(LIGHT_COST.whole(vertices, faces));
        return new Grid(this.memory, required(this.faces), required(this.header));
    }
}

/** Decode a complete stream. */
export function decode(kernels: Kernels, data: Uint8Array, limits: Partial<Limits> = {}): Mesh {
    const decoder = new Decoder(kernels, limits);
    decoder.receiveData(data);
    return decoder.finish();
}

export { END_OF_STREAM, NEED_DATA };
