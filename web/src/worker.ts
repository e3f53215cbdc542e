/** The work of a thread: it decodes streams, or helps others that do, as messages ask. */
import type { Decoder } from "./decoder";
import type { Event, FrameEvent } from "./events";
import { Drawing, type Picture } from "./drawing";
import { BsmError, type Described } from "./errors";
import type { Share, SharedBlock } from "./share";
import { Kernels } from "./kernels";
import type { Limits } from "./limits";
import type { Memory } from "./memory";
import type { Build } from "./peek";
import { END_OF_STREAM, NEED_BLOCK, NEED_DATA, type Signal } from "./signals";

/** What a thread reports of a stream; frames come in single precision, as they are drawn. */
export type DrawnEvent = Exclude<Event, FrameEvent> | FrameEvent<Float32Array>;

/** How to begin; with a share, as a helper. */
export interface Start {
    kernels: WebAssembly.Module;
    /** Of which the kernels are; the decoder of everything without one. */
    build?: Build;
    limits: Partial<Limits>;
    tolerant?: boolean;
    /** Report pictures, not events: only the whole one, or each that can be drawn. */
    drawing?: "whole" | "growing";
    /**
     * The cosine of the angle at which faces of pictures have vertices of their own, and pieces as well; below -1 of the usual
     * angle, where the mesh has clearly sharp edges. Undefined: vertices are those of the stream.
     */
    crease?: number;
    /** Events that another decoder has reported of this stream, which are not to be reported again. */
    reported?: number;
    /** Threads that help this one, and vertices of blocks from which on that is worthwhile. */
    helpers?: MessagePort[];
    worthwhile?: number;
    share?: Share;
}

/** A message to a thread about one of its tasks: how to begin, a piece of the stream, null for its end, or to stop. */
export type Order = { task: number } & ({ start: Start } | { data: Uint8Array | null } | { stop: true });
export type Message = Order | { help: MessagePort };

/**
 * Of a task: an event or a picture, a block, the end of blocks, events before an error, the error, bytes taken, or the
 * end.
 */
export type Report =
    | { event: DrawnEvent }
    | { picture: Picture }
    | { shared: SharedBlock }
    | { through: true }
    | { reported: number }
    | { problem: Described }
    | { fault: string }
    | { taken: number }
    | { over: true };

export type Reply = { ready: true } | ({ task: number } & Report);

export type Say = (report: Report, moved?: Transferable[]) => void;

type Endpoint = Pick<MessagePort, "onmessage"> & { postMessage(message: unknown, transfer: Transferable[]): void };

/** Takes the bytes of a stream, and null for their end. */
export interface StreamWorker {
    take(data: Uint8Array | null): void;
    stop(): void;
}

export type Guard = (work: () => void) => void;
/** `close` is called once, at the end or after an error: everything is released there. */
export type Open = (
    start: Start,
    kernels: Kernels,
    say: Say,
    guarded: Guard,
) => Pick<StreamWorker, "take"> & { close: () => void };

/** Return a worker that takes the bytes of a stream; after its end or a fault it takes and reports nothing more. */
function opened(open: Open, start: Start, say: Say, kernels = new Kernels(start.kernels)): StreamWorker {
    let over = false;
    let worker: ReturnType<Open> | undefined;
    const stop = (): void => {
        if (!over) worker?.close();
        over = true;
    };
    const guarded: Guard = (work) => {
        if (over) return;
        try {
            work();
        } catch (error) {
            stop();
            say(error instanceof BsmError ? { problem: error.described } : { fault: `${error}` });
        }
    };
    const tell: Say = (report, moved) => {
        if (over) return;
        if ("over" in report || "through" in report) stop();
        say(report, moved);
    };
    guarded(() => (worker = open(start, kernels, tell, guarded)));
    return { take: (data) => guarded(() => worker?.take(data)), stop };
}

/** Take orders from one end of a line. A thread has the kernels of a stream for the next ones of the same build. */
function attend(end: Endpoint, open: Open, own: Partial<Pick<Start, "build"> & { kernels: Kernels }> = {}): void {
    const workers = new Map<number, StreamWorker>();
    end.onmessage = ({ data: order }: MessageEvent<Message>) => {
        if ("help" in order) return attend(order.help, open, own);
        const { task } = order;
        if ("start" in order) {
            const { build, kernels } = order.start;
            if (!own.kernels || own.build !== build) Object.assign(own, { build, kernels: new Kernels(kernels) });
            workers.set(
                task,
                opened(
                    open,
                    order.start,
                    (report, moved = []) => end.postMessage({ task, ...report }, moved),
                    own.kernels,
                ),
            );
        } else if ("stop" in order) {
            workers.get(task)?.stop();
            workers.delete(task);
        } else workers.get(task)?.take(order.data);
    };
}

/** What decodes a stream in this thread, as another one would, and what makes this a thread that decodes, or helps. */
export function deskOf(open: Open): { openDesk: (start: Start, say: Say) => StreamWorker; serve: () => void } {
    return {
        openDesk: (start, say) => opened(open, start, say),
        serve() {
            const end = self as unknown as Endpoint;
            attend(end, open);
            end.postMessage({ ready: true } satisfies Reply, []);
        },
    };
}

type Decoding = Pick<Decoder, "receiveData" | "receiveEof" | "nextEvent" | "release"> & { readonly engine: Memory };

export class Reporter {
    private readonly drawing?: Drawing;
    private taken = 0;
    /** Events that were reported; below 0 are those that another decoder has reported. */
    private reported: number;

    constructor(
        private readonly decoder: Decoding,
        private readonly start: Start,
        private readonly out: Say,
    ) {
        const { crease, drawing, limits, reported = 0 } = start;
        this.reported = -reported;
        if (drawing)
            this.drawing = new Drawing(
                drawing === "growing",
                limits,
                decoder.engine,
                (picture, moved) => this.say({ picture }, moved),
                crease,
            );
    }

    take(data: Uint8Array | null): void {
        if (data) this.decoder.receiveData(data);
        else this.decoder.receiveEof();
        this.taken += data?.length ?? 0;
    }

    close(): void {
        this.drawing?.close();
        this.decoder.release();
    }

    /** Report everything that is known now, be it that an error follows; return what the decoder waits for then. */
    report(): Signal | typeof NEED_BLOCK {
        try {
            return this.pass();
        } catch (error) {
            this.drawing?.flush();
            this.out({ reported: this.reported });
            throw error;
        }
    }

    private pass(): Signal | typeof NEED_BLOCK {
        for (;;) {
            const event = this.decoder.nextEvent();
            if (typeof event === "string") {
                this.drawing?.pause();
                if (event === NEED_DATA) this.say({ taken: this.taken });
                if (event === END_OF_STREAM) this.say({ over: true });
                return event;
            }
            if (this.drawing) this.drawing.accept(event);
            else if (event.type === "frame") {
                const positions = Float32Array.from(event.positions);
                this.say({ event: { ...event, positions } }, [positions.buffer]);
            } else this.say({ event });
            if (this.reported === -1) this.drawing?.flush(); // what another decoder has shown is not shown again
            // Not every decoder tells blocks where the whole mesh alone is drawn.
            if (event.type !== "block" || this.start.drawing !== "whole") this.reported++;
        }
    }

    private say(report: Report, moved?: Transferable[]): void {
        if (this.reported >= 0) this.out(report, moved);
    }
}
