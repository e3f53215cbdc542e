/** A stream to a mesh, block by block, while it arrives. */
import { begun } from "./begun";
import type { Attribute } from "./attributes";
import { Allowance } from "./chain";
import { BsmError, CorruptError, errorLike } from "./errors";
import type { Event, FrameEvent, Mesh, Wishes } from "./events";
import type { Header } from "./header";
import type { SharedBlock } from "./helper";
import type { Kernels, Memory } from "./kernels";
import { DEFAULT_LIMITS, type Limits } from "./limits";
import { END_OF_STREAM, NEED_DATA, Reader, type Metadata, type Signal } from "./reader";
import { Runs, type Course } from "./runs";
import { Stages, type AwaitedBlock, type Item } from "./stages";
import { TolerantReader } from "./tolerant";

export type * from "./events";

/** The next block is one that a helper has to send first. */
export const NEED_BLOCK = "need block";

/**
 * Takes the bytes of a stream as they come, and gives events as soon as they can be known.
 *
 * The events do not depend on how the bytes are cut up, nor on helpers; limits of work and memory hold for each helper as
 * they do for the decoder. An error is thrown by `nextEvent` after the events before it, and by every later call.
 */
export class Decoder {
    private readonly limits: Limits;
    private readonly reader: Reader;
    private readonly memory: Memory;
    private readonly allowance: Allowance;
    private readonly queue: Item[] = [];
    private error?: BsmError;
    private stages?: Stages;
    private runs?: Runs;
    private readonly kept: { attributes: Attribute[]; first?: Mesh } = { attributes: [] };
    /** What helpers have sent before it was its turn. */
    private readonly shared = new Map<number, SharedBlock>();

    constructor(
        private readonly kernels: Kernels,
        limits: Partial<Limits> = {},
        private readonly wishes: Wishes = {},
    ) {
        this.limits = { ...DEFAULT_LIMITS, ...limits };
        this.memory = kernels.instantiate(this.limits.memory);
        this.allowance = new Allowance(this.limits);
        const spend = this.allowance.spend.bind(this.allowance);
        this.reader = wishes.tolerant ? new TolerantReader(this.limits, spend) : new Reader(this.limits, spend);
    }

    /** Take more bytes of the stream. */
    receiveData(data: Uint8Array): void {
        this.reader.receiveData(data);
    }

    /** Take note that no more bytes will come. */
    receiveEof(): void {
        this.reader.receiveEof();
    }

    /** Take what a helper has decoded. */
    receiveBlock(shared: SharedBlock): void {
        this.shared.set(shared.index, shared);
    }

    /** Bytes of the stream that the events so far are made of. */
    get position(): number {
        return this.reader.position;
    }

    /** What has been charged, in nanoseconds of a processor core (specification, M 14.3). */
    get work(): number {
        return this.allowance.work;
    }

    /** Vertices that the faces so far really have. */
    get vertices(): number {
        return this.allowance.counted.vertices;
    }

    /** The next event, or `NEED_DATA`; with helpers `NEED_BLOCK`; `END_OF_STREAM` after the end and `receiveEof`. */
    nextEvent(): Event | Signal | typeof NEED_BLOCK {
        for (;;) {
            const item = this.nextItem();
            if (typeof item === "string") return item;
            if ("make" in item) return this.guarded((stages) => stages.framed(item));
            if (!this.wishes.whole) return "type" in item ? item : this.guarded((stages) => stages.changed(item), item.index);
            if (!("type" in item)) this.guarded((stages) => stages.add(item), item.index);
            else if (item.type === "end") return { ...item, positions: this.guarded((stages) => stages.atEnd()) };
            else if (item.type !== "block" && item.type !== "refinement") return item;
        }
    }

    /** Leave the memory to the next decoder; this one is not to be asked for anything more. */
    release(): void {
        this.kernels.take(this.memory);
    }

    /** Decode the rest of a complete stream; faster than asking for events. Without helpers it is there at once. */
    finish(): Mesh {
        return this.advance() as Mesh;
    }

    /** The same with helpers: to be called again where it has come to a block that is not there yet. */
    advance(): Mesh | typeof NEED_BLOCK {
        const { kept } = this;
        this.receiveEof();
        for (let item; (item = this.nextItem()) !== END_OF_STREAM; ) {
            if (item === NEED_BLOCK) return item;
            if (typeof item === "string") continue;
            if ("type" in item) {
                if (item.type === "attribute" && !kept.first) kept.attributes.push(item);
            } else if ("make" in item) kept.first ??= this.firstOf(this.guarded((stages) => stages.framed(item)));
            else begun(this.stages).add(item);
        }
        return kept.first ?? this.meshOf(this.guarded((stages) => stages.whole()));
    }

    private meshOf(positions: Float64Array): Mesh {
        return { positions, faces: begun(this.stages).numbers.faces, attributes: this.kept.attributes };
    }

    private firstOf({ positions, attributes: moved }: FrameEvent): Mesh {
        const mesh = this.meshOf(positions);
        return { ...mesh, attributes: mesh.attributes.map((one) => moved.find(({ name }) => name === one.name) ?? one) };
    }

    private nextItem(): Exclude<Item, AwaitedBlock> | Signal | typeof NEED_BLOCK {
        for (;;) {
            const item = this.queue[0];
            if (item && "awaited" in item) {
                const shared = this.shared.get(item.awaited);
                if (!shared) return NEED_BLOCK;
                this.shared.delete(item.awaited);
                this.queue.shift();
                this.acceptShared(shared);
            } else if (item) {
                this.queue.shift();
                return item;
            } else {
                if (this.error) throw this.error;
                const signal = this.takePacket();
                if (signal) return signal;
            }
        }
    }

    /** Turn the next packet into items, or into the error that follows them. */
    private takePacket(): Signal | undefined {
        let block: number | undefined;
        try {
            const packet = this.reader.nextPacket();
            if (packet === END_OF_STREAM && !this.stages?.over) {
                this.acceptEnd(); // a tolerant reader may find no END
                return undefined;
            }
            if (typeof packet === "string") return packet;
            if (packet.type === "block") block = packet.index;
            if (packet.type === "header") this.begin(packet.header);
            else if (!this.runs?.isLost) this.begunStages().accept(packet);
            else if (packet.type === "end") this.acceptEnd();
        } catch (error) {
            if (this.stages && this.runs && !this.runs.isLost && this.runs.bears(error)) this.stages.over = false;
            else this.keep(error, block);
        }
        return undefined;
    }

    private acceptEnd(): void {
        const stages = this.begunStages();
        if (!this.runs?.isLost) return stages.acceptEnd();
        stages.over = true;
        this.runs.end(this.queue);
    }

    /** Take note of an error of the stream, with its place; others are passed on. */
    private keep(error: unknown, block?: number): BsmError {
        if (!(error instanceof BsmError)) throw error;
        this.error = error.located({ offset: this.reader.position, block });
        return this.error;
    }

    /** What `work` returns; its error is kept for all later calls. */
    private guarded<Result>(work: (stages: Stages) => Result, block?: number): Result {
        try {
            return work(begun(this.stages));
        } catch (error) {
            this.queue.length = 0;
            throw this.keep(error, block);
        }
    }

    private begin(header: Header): void {
        const { memory, limits, allowance, queue, reader } = this;
        const open = (course?: Course): Stages => {
            const wishes = header.run > 0 ? { ...this.wishes, helpers: undefined } : this.wishes;
            return new Stages(memory, header, limits, allowance, wishes, queue, () => reader.position, course);
        };
        if (header.gopFrames === 0) return void (this.stages = open());
        this.runs ??= new Runs(memory, allowance, this.wishes.tolerant ?? false);
        this.stages = this.runs.begin(header, open);
    }

    private begunStages(): Stages {
        if (!this.stages) throw new CorruptError("the stream ends before its first block");
        return this.stages;
    }

    private acceptShared({ index, block, problem }: SharedBlock): void {
        const refuse = (): never => {
            throw errorLike(begun(problem));
        };
        if (block) this.queue.unshift(block);
        else this.guarded((stages) => stages.tolerating(refuse, index), index);
    }
}

/** Decode a complete stream. */
export function decode(kernels: Kernels, data: Uint8Array, limits: Partial<Limits> = {}): Mesh {
    const decoder = new Decoder(kernels, limits);
    decoder.receiveData(data);
    return decoder.finish();
}

export { END_OF_STREAM, NEED_DATA, type Metadata };
