/** A decoder in a thread of its own: the page stays free while it works. */
import { openDesk, type Answer, type Desk, type DrawnEvent, type Order, type Start } from "./desk";
import { errorLike, type BsmError } from "./errors";
import type { Kernels } from "./kernels";
import type { Limits } from "./limits";
import { startWorker } from "./workers";

export type { DrawnEvent };

/** What is to be done with what is decoded. */
export interface Listener {
    onEvent: (event: DrawnEvent) => void;
    /** Nothing follows it. */
    onError: (error: BsmError | Error) => void;
    /** All of the first so many bytes are decoded. */
    onTaken?: (bytes: number) => void;
}

/**
 * Takes the bytes of a stream as they come; what they say is heard later, in its order.
 *
 * Where the page may have no threads the decoder runs in the one that there is, a piece at a time.
 */
export class DecoderThread {
    private worker?: Worker;
    private desk?: Desk;
    /** What was said before the thread was known to run. */
    private unheard?: Order[] = [];
    private closed = false;

    constructor(
        kernels: Kernels,
        private readonly listener: Listener,
        limits: Partial<Limits> = {},
        wishes: Pick<Start, "tolerant" | "worthwhile"> = {},
    ) {
        this.worker = startWorker("BSM decoder");
        if (this.worker) {
            this.worker.onmessage = ({ data }: MessageEvent<Answer>) => this.hear(data);
            this.worker.onerror = ({ message }) => {
                if (this.unheard) this.stay();
                else listener.onError(new Error(`the decoder's thread does not run: ${message ?? "it was stopped"}`));
            };
        } else this.stay();
        this.say({ ...wishes, kernels: kernels.module, limits });
    }

    receiveData(data: Uint8Array): void {
        this.say(data.slice());
    }

    receiveEof(): void {
        this.say(null);
    }

    /** Stop at once; nothing more is heard. */
    close(): void {
        this.closed = true;
        this.worker?.terminate();
    }

    /** Have no thread: do what was asked for so far, and what will be, in this one. */
    private stay(): void {
        const orders = this.unheard!;
        this.worker = this.unheard = undefined;
        for (const order of orders) this.say(order);
    }

    private say(order: Order): void {
        this.unheard?.push(order);
        if (this.worker) this.worker.postMessage(order);
        else setTimeout(() => this.obey(order));
    }

    private obey(order: Order): void {
        if (this.closed) return;
        if (order === null || order instanceof Uint8Array) this.desk!.take(order);
        else this.desk = openDesk({ ...order, worthwhile: Infinity }, (answer) => this.hear(answer));
    }

    private hear(answer: Answer): void {
        const { listener } = this;
        if (this.closed) return;
        if ("ready" in answer) this.unheard = undefined;
        else if ("event" in answer) listener.onEvent(answer.event);
        else if ("taken" in answer) listener.onTaken?.(answer.taken);
        else if ("problem" in answer) listener.onError(errorLike(answer.problem));
        else if ("fault" in answer) listener.onError(new Error(answer.fault));
    }
}
