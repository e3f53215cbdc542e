/** A decoder in a thread of its own: the page stays free while it works. */
import type { Event, FrameEvent, Wishes } from "./decoder";
import { errorLike, type BsmError, type Described } from "./errors";
import type { Kernels } from "./kernels";
import type { Limits } from "./limits";
import script from "worker:./worker.ts";

/** What a thread says of a stream; frames come in single precision, as they are drawn. */
export type DrawnEvent = Exclude<Event, FrameEvent> | FrameEvent<Float32Array>;

/** What is said to the worker: first how to begin, then pieces of the stream, then null for its end. */
export type Order = { kernels: WebAssembly.Module; limits: Partial<Limits>; wishes: Wishes } | Uint8Array | null;

/** What the worker says: an event, what is wrong, or that all bytes so far are decoded. */
export type Answer = { event: DrawnEvent } | { problem: Described } | { taken: number } | { fault: string };

/** What is to be done with what is decoded. */
export interface Listener {
    onEvent: (event: DrawnEvent) => void;
    /** Nothing follows it. */
    onError: (error: BsmError | Error) => void;
    /** All of the first so many bytes are decoded. */
    onTaken?: (bytes: number) => void;
}

/** Takes the bytes of a stream as they come; what they say is heard later, in its order. */
export class DecoderThread {
    private readonly worker: Worker;

    constructor(kernels: Kernels, listener: Listener, limits: Partial<Limits> = {}, wishes: Wishes = {}) {
        const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
        this.worker = new Worker(url, { name: "BSM decoder" });
        URL.revokeObjectURL(url);
        this.worker.onmessage = ({ data }: MessageEvent<Answer>) => {
            if ("event" in data) listener.onEvent(data.event);
            else if ("taken" in data) listener.onTaken?.(data.taken);
            else listener.onError("problem" in data ? errorLike(data.problem) : new Error(data.fault));
        };
        this.worker.onerror = ({ message }) => listener.onError(new Error(`the decoder's thread does not run: ${message ?? "it could not be started"}`));
        this.say({ kernels: kernels.module, limits, wishes });
    }

    receiveData(data: Uint8Array): void {
        this.say(data);
    }

    receiveEof(): void {
        this.say(null);
    }

    /** Stop at once; nothing more is heard. */
    close(): void {
        this.worker.onmessage = null;
        this.worker.terminate();
    }

    private say(order: Order): void {
        this.worker.postMessage(order);
    }
}
