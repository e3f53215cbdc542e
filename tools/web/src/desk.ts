/** What runs in a thread: a decoder, or a helper of one. */
import { END_OF_STREAM, NEED_DATA, type Event, type FrameEvent } from "./decoder";
import { BsmError, type Described } from "./errors";
import { Helper, type Share, type SharedBlock } from "./helper";
import { Kernels } from "./kernels";
import type { Limits } from "./limits";
import { DecodersDesk } from "./station";

/** What a thread says of a stream; frames come in single precision, as they are drawn. */
export type DrawnEvent = Exclude<Event, FrameEvent> | FrameEvent<Float32Array>;

/** How to begin; with a share, as a helper. */
export interface Start {
    kernels: WebAssembly.Module;
    limits: Partial<Limits>;
    tolerant?: boolean;
    /** Vertices from which on a decoder has helpers. */
    worthwhile?: number;
    share?: Share;
    /** Comes back with every block. */
    task?: number;
}

/** What is said to a thread: first how to begin, then pieces of the stream, then null for its end. */
export type Order = Start | Uint8Array | null;

/**
 * What it says: that it runs, an event, a block, that no more of them come, what is wrong, or that all
 * bytes so far are decoded.
 */
export type Answer =
    | { ready: true }
    | { event: DrawnEvent }
    | { shared: SharedBlock; task?: number }
    | { through: true; task?: number }
    | { problem: Described }
    | { taken: number }
    | { fault: string };

export type Say = (answer: Answer, moved?: Transferable[]) => void;

/** Takes the bytes of a stream, and null for their end. */
export interface Desk {
    take: (data: Uint8Array | null) => void;
}

/** Someone to take the bytes of a stream; after a fault nothing more is said. */
export function openDesk(start: Start, say: Say): Desk {
    let over = false;
    const guarded = (work: () => void): void => {
        if (over) return;
        try {
            work();
        } catch (error) {
            over = true;
            say(error instanceof BsmError ? { problem: error.described } : { fault: `${error}` });
        }
    };
    const desk = start.share ? new HelpersDesk(start, start.share, say) : new DecodersDesk(start, say, guarded);
    return { take: (data) => guarded(() => desk.take(data)) };
}

class HelpersDesk implements Desk {
    private readonly helper: Helper;

    constructor(
        private readonly start: Start,
        share: Share,
        private readonly say: Say,
    ) {
        this.helper = new Helper(new Kernels(start.kernels), share, start.limits, start.tolerant);
    }

    take(data: Uint8Array | null): void {
        const { helper } = this;
        if (data) helper.receiveData(data);
        else helper.receiveEof();
        const { task } = this.start;
        for (let shared; (shared = helper.nextBlock()) !== NEED_DATA; ) {
            if (shared === END_OF_STREAM) return this.say({ through: true, task });
            const { block } = shared;
            this.say({ shared, task }, block && [block.vertices.buffer, block.positions.buffer, block.weights.buffer]);
        }
    }
}

/** Be a thread: take orders, and answer them. */
export function serve(): void {
    const say: Say = (answer, moved = []) => self.postMessage(answer, { transfer: moved });
    let desk: Desk | undefined;
    self.onmessage = ({ data }: MessageEvent<Order>) => {
        if (data === null || data instanceof Uint8Array) desk?.take(data);
        else desk = openDesk(data, say);
    };
    say({ ready: true });
}
