/** A stream to a mesh, block by block, while it arrives. */
import type { Attribute } from "./attributes";
import { Engine, Raw, type RawEvent } from "./engine";
import { BsmError, errorLike } from "./errors";
import type { Event, Mesh, Wishes } from "./events";
import type { Header } from "./header";
import type { SharedBlock } from "./share";
import type { Kernels } from "./kernels";
import type { Limits } from "./limits";
import { END_OF_STREAM, NEED_BLOCK, NEED_DATA, type Signal } from "./signals";

export type * from "./events";
export { END_OF_STREAM, NEED_BLOCK, NEED_DATA };

/**
 * Takes the bytes of a stream as they come, and gives events as soon as they can be known.
 *
 * The events do not depend on how the bytes are cut up, nor on helpers; limits of work and memory hold for each helper as
 * they do for the decoder. An error is thrown by `nextEvent` after the events before it, and by every later call.
 */
export class Decoder {
    /** @internal */
    readonly engine: Engine;
    private readonly queue: Event[] = [];
    private error?: BsmError;
    private header?: Header;
    private metadata = 0;
    /** Frames of a run that has the mesh of another follow the attributes that were reported for it. */
    private sameMesh = false;
    /** What helpers have sent before it was its turn; the block that is awaited. */
    private readonly shared = new Map<number, SharedBlock>();
    private awaited?: number;

    constructor(
        kernels: Kernels,
        limits: Partial<Limits> = {},
        private readonly wishes: Wishes = {},
    ) {
        this.engine = new Engine(kernels, limits, wishes.tolerant ?? false);
    }

    /** Take more bytes of the stream. */
    receiveData(data: Uint8Array): void {
        this.engine.push(data);
    }

    /** Take note that no more bytes will come. */
    receiveEof(): void {
        this.engine.finish();
    }

    /** Take what a helper has decoded. */
    receiveBlock(shared: SharedBlock): void {
        this.shared.set(shared.index, shared);
    }

    /** What has been charged, in nanoseconds of a processor core (specification, M 14.3). */
    get work(): number {
        return this.engine.state[1];
    }

    /** Vertices that the faces so far really have. */
    get vertices(): number {
        return this.engine.state[2];
    }

    /** The next event, or `NEED_DATA`; with helpers `NEED_BLOCK`; `END_OF_STREAM` after the end and `receiveEof`. */
    nextEvent(): Event | Signal | typeof NEED_BLOCK {
        if (this.error) throw this.error;
        try {
            for (;;) {
                const event =
                    this.queue.shift() ??
                    (this.awaited === undefined ? this.heard(this.engine.next()) : this.received(this.awaited));
                if (event) return event;
            }
        } catch (error) {
            if (error instanceof BsmError) this.error = error;
            throw error;
        }
    }

    /** Leave the memory to the next decoder; this one is not to be asked for anything more. */
    release(): void {
        this.engine.release();
    }

    /** Convert an event of the decoder in C; nothing if it is not reported. */
    private heard(raw: RawEvent): Event | Signal | undefined {
        const { engine, wishes } = this;
        const { type, index, count, vertices } = raw;
        if (type === Raw.NEED) return NEED_DATA;
        if (type === Raw.OVER) return END_OF_STREAM;
        if (type === Raw.FAILED) throw engine.error();
        if (type === Raw.AWAITED) this.awaited = index;
        if (type === Raw.HEADER) return this.beginMesh(engine.header());
        if (type === Raw.METADATA) {
            const entries = engine.metadata(this.metadata, index);
            this.metadata = index;
            return { type: "metadata", entries };
        }
        if (type === Raw.CONNECTIVITY) {
            const [faces, loose] = [engine.faces(raw), engine.loose()];
            if (this.sameMesh)
                this.queue.push(
                    ...engine.attributes().map((attribute): Event => ({ type: "attribute", ...attribute })),
                );
            return { type: "connectivity", faces, vertices, loose };
        }
        if (!wishes.whole && (type === Raw.BLOCK || type === Raw.REFINEMENT))
            return this.changed(type === Raw.BLOCK ? index : undefined);
        if (type === Raw.ATTRIBUTE) return { type: "attribute", ...engine.attribute(index)! };
        if (type === Raw.FRAME)
            return { type: "frame", index, positions: engine.positions(vertices), attributes: engine.attributes(true) };
        if (type === Raw.LOSS) {
            const isOfFrames = this.header!.gopFrames > 0 && index >= 0;
            return {
                type: "loss",
                block: isOfFrames || index < 0 ? undefined : index,
                ...(isOfFrames ? { frames: { first: index, count } } : {}),
                error: engine.error(true).described,
            };
        }
        if (type !== Raw.END) return undefined;
        const isMesh = this.header!.gopFrames === 0;
        const losses =
            wishes.tolerant && isMesh ? engine.losses() : { missing: new Int32Array(0), degraded: new Int32Array(0) };
        return { type: "end", ...losses, ...(wishes.whole && isMesh ? { positions: engine.positions(vertices) } : {}) };
    }

    private beginMesh(header: Header): Event {
        const { wishes, engine } = this;
        this.header = header;
        this.sameMesh = header.again !== undefined;
        const helpers = header.run > 0 ? 0 : (wishes.helpers?.(header) ?? 0);
        engine.share(helpers > 0 ? helpers + 1 : 0);
        return { type: "header", header };
    }

    private changed(block?: number): Event {
        const changes = this.engine.changes();
        return block === undefined ? { type: "refinement", ...changes } : { type: "block", index: block, ...changes };
    }

    /** What the block of a helper is, if it is there. */
    private received(index: number): Event | typeof NEED_BLOCK | undefined {
        const shared = this.shared.get(index);
        if (!shared) return NEED_BLOCK;
        this.shared.delete(index);
        this.awaited = undefined;
        const { problem } = shared;
        if (problem && (!this.wishes.tolerant || this.header!.gopFrames > 0)) throw errorLike(problem);
        this.engine.add(shared);
        if (problem) return { type: "loss", block: index, error: problem };
        return this.wishes.whole ? undefined : this.changed(index);
    }
}

/** Decode a complete stream: a mesh, or the first frame of a sequence. */
export function decode(kernels: Kernels, data: Uint8Array, limits: Partial<Limits> = {}): Mesh {
    const decoder = new Decoder(kernels, limits, { whole: true });
    const attributes: Attribute[] = [];
    let [faces, first]: [Int32Array, Mesh?] = [new Int32Array(0)];
    try {
        decoder.receiveData(data);
        decoder.receiveEof();
        for (let event; (event = decoder.nextEvent()) !== END_OF_STREAM;) {
            if (typeof event === "string" || first) continue;
            const { type: _, ...content } = event;
            if ("faces" in content) ({ faces } = content);
            if ("domain" in content) attributes.push(content);
            if (event.type === "frame")
                first = {
                    positions: event.positions,
                    faces,
                    attributes: attributes.map((old) => event.attributes.find(({ name }) => name === old.name) ?? old),
                };
            if (event.type === "end") first = { positions: event.positions ?? new Float64Array(0), faces, attributes };
        }
        return first!;
    } finally {
        decoder.release();
    }
}
