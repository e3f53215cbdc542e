/**
 * Threads that decode, kept warm: streams are shared among them, and large ones are decoded by several.
 *
 * A stream goes in as bytes; its header tells which build of the decoder it needs (`peek.ts`), the smallest that knows
 * it. A thread starts before that, because it takes longer than the first bytes: threads know all builds but the whole
 * one, which has threads of its own. Builds are fetched once, so streams that begin together wait a moment for each other's
 * headers and take one build that reads all of them: three small decoders would cost more than the large one. A stream
 * has one thread, and idle ones help with its chains. A small stream that is the only one is decoded in the calling thread,
 * piece by piece, if none has begun yet: the one that starts beside it takes what follows. All bytes are kept until the end, because a
 * small build that meets something unknown or wrong leaves the stream to the whole one, which begins again and reports
 * only what was not reported yet; so only that one needs the texts of errors. A thread that never began takes its
 * streams back to the line; after two of those the pool decodes in the calling thread, piece by piece, so that a page
 * without threads still draws. Order matters in `hands`: threads that worked last come last, and the first idle one
 * makes room for one of the other kind.
 */
import type { Reply, StreamWorker, DrawnEvent, Message, Report, Start } from "./worker";
import type { Picture } from "./drawing";
import { errorLike, type BsmError } from "./errors";
import type { Limits } from "./limits";
import { isLight, needOf, threadOf, type Build, type Need, type Thread } from "./peek";
import { isPage, PAGE, resolved } from "./fetched";
import { here, placeOf, type Source } from "./source";
import { processors, sayAlone, WORTHWHILE } from "./threads";

export { here, placeOf, type Source } from "./source";
export type { Build } from "./peek";

/** What is to be done with what is decoded: events, or pictures where these are wished for. */
export interface Listener {
    onEvent?: (event: DrawnEvent) => void;
    onPicture?: (picture: Picture) => void;
    /** The stream is decoded to its end; nothing follows. */
    onEnd?: () => void;
    /** Nothing follows it. */
    onError: (error: BsmError | Error) => void;
    /** The first `bytes` bytes are decoded. */
    onTaken?: (bytes: number) => void;
}

export type StreamWishes = Pick<Start, "tolerant" | "drawing" | "crease" | "worthwhile"> & {
    limits?: Partial<Limits>;
    /** What the stream is thought to need: a thread for that starts before the first bytes come. */
    guess?: Build;
};

/** A stream whose bytes are given as they come; what they say is heard later, in its order. */
export type StreamDecoding = Pick<PooledStream, "receiveData" | "receiveEof" | "close">;

/** What threads are told of an angle in degrees at which edges are sharp; undefined: the usual one, where a mesh has some. */
export const creaseOf = (angle?: number): number =>
    angle === undefined ? -2 : Math.cos((Math.min(angle, 180) * Math.PI) / 180);

const LIMIT = 4;
const SMALL = 20_000; // vertices that are decoded here sooner than a thread begins
const PIECE = 2 ** 14; // bytes that are decoded here at a time
const IDLE = 5000; // milliseconds after which threads without work end
const MOST_FAILED = 1; // threads that may fail to start before the page does without
const MOMENT = 100; // milliseconds that a stream waits for the headers of others, to have one decoder with them
/** Which streams each build reads, the smallest first. */
const READS: Record<Build, Build[]> = {
    quick: ["quick"],
    parts: ["quick", "parts"],
    grid: ["quick", "parts", "grid"],
    blocks: ["blocks"],
    moving: ["moving"],
    small: ["quick", "parts", "grid", "blocks", "small"],
    whole: ["quick", "parts", "grid", "blocks", "moving", "small", "whole"],
};
const BUILDS = Object.keys(READS) as Build[];

/** A thread, and the streams that it works on, as their decoder or as a helper. */
interface Hand {
    thread: Thread;
    worker: Worker;
    ready: boolean;
    streams: Set<PooledStream>;
    parked: [Message, Transferable[]][];
}

/** Firefox may lose a line that is handed to a thread that has not begun, so such messages, and later ones, wait. */
function post(hand: Hand, message: Message, moved: Transferable[]): void {
    if (!hand.ready && moved.length + hand.parked.length > 0) hand.parked.push([message, moved]);
    else hand.worker.postMessage(message, moved);
}

/**
 * At most `limit` threads, started when they are needed. Where a page may have none, the decoder runs in the one
 * that there is, a piece at a time.
 */
export class Pool {
    private readonly hands: Hand[] = [];
    /** All that were opened and are not over, and those of them that wait for a thread. */
    private readonly streams = new Set<PooledStream>();
    private readonly waiting: PooledStream[] = [];
    private task = 0;
    /** Threads that never began, one after the other: a server may fail once. */
    private failed = 0;
    private alone = false;
    private rest?: ReturnType<typeof setTimeout>;
    /** Loaders that share it; with the last one, its threads end. */
    private users = 0;
    /** Builds whose kernels were asked for. */
    private readonly asked = new Set<Build>();

    constructor(
        private readonly source: Source = here,
        private limit = LIMIT,
    ) {}

    /** The threads of the decoder's files in a folder, or of those beside this one, for one more user. */
    static at(path?: string): Pool {
        const key = path === undefined ? "" : resolved(path.replace(/\/?$/, "/")).href;
        const pool = shared.get(key) ?? new Pool(path === undefined ? here : placeOf(path));
        shared.set(key, pool);
        pool.users++;
        return pool;
    }

    /** One user needs it no longer. */
    leave(): void {
        if (--this.users === 0) this.dispose();
    }

    setLimit(limit: number): void {
        this.limit = Math.max(1, limit);
    }

    async preload(build: Build = "small"): Promise<void> {
        this.asked.add(build);
        if (!this.alone && !this.hands.some(({ thread }) => thread === threadOf(build))) this.start(build);
        await this.source.kernels(build);
    }

    open(listener: Listener, wishes: StreamWishes = {}): StreamDecoding {
        const stream: PooledStream = new PooledStream(
            listener,
            wishes,
            (need) => void this.begin(stream, need),
            () => this.end(stream),
        );
        this.streams.add(stream);
        clearTimeout(this.rest);
        queueMicrotask(() => stream.known || stream.closed || this.expect(wishes));
        return stream;
    }

    /** Stop all threads; streams that are not whole fail. */
    dispose(): void {
        clearTimeout(this.rest);
        for (const { worker } of this.hands.splice(0)) worker.terminate();
        this.waiting.length = 0;
        for (const stream of [...this.streams]) stream.fail(new Error("the decoder's threads were stopped"));
    }

    private async begin(stream: PooledStream, named: Need): Promise<void> {
        stream.need = named;
        const isNear = this.isNear(stream);
        if (!isNear && !this.asked.has(named.build))
            await Promise.race([
                Promise.all([...this.streams].map(({ said }) => said)),
                new Promise((go) => setTimeout(go, MOMENT)),
            ]);
        if (stream.closed) return;
        const need = { ...named, build: this.buildFor(named.build) };
        if (!this.alone && !isNear) this.free(need.build); // so that a thread starts while the kernels come
        const kernels = await this.source
            .kernels(need.build)
            .catch((error: unknown) => stream.fail(error instanceof Error ? error : new Error(`${error}`)));
        if (!kernels || stream.closed) return;
        [stream.kernels, stream.need] = [kernels, need];
        if (isNear) void this.stay(stream);
        else this.place(stream);
    }

    /** Whether a stream is decoded here: it is small and the only one, nobody wants helpers, and no thread waits for it. */
    private isNear({ need: { build, members, vertices = 0 }, wishes }: PooledStream): boolean {
        const isSmall = vertices > 0 && vertices <= SMALL && members < (wishes.worthwhile ?? Infinity);
        if (wishes.tolerant || build === "moving" || build === "whole" || !isSmall) return false;
        const isServed = this.hands.some(
            ({ thread, ready, streams }) => ready && streams.size === 0 && thread === threadOf(build),
        );
        return build === this.source.embedded || (this.streams.size === 1 && !isServed);
    }

    /**
     * A build that was asked for and reads a stream, or the smallest that also reads all streams which no such build
     * reads.
     */
    private buildFor(build: Build): Build {
        const there = (wanted: Build): Build | undefined =>
            BUILDS.find((each) => this.asked.has(each) && READS[each].includes(wanted));
        const wanted = [...this.streams]
            .filter((stream) => stream.known && !there(stream.need.build))
            .map(({ need }) => need.build);
        const found =
            there(build) ?? BUILDS.find((each) => [build, ...wanted].every((one) => READS[each].includes(one)))!;
        this.asked.add(found);
        return found;
    }

    /** Have a thread without work, if there may be one more, before a stream says what it needs. */
    private expect({ tolerant, guess = "small" }: StreamWishes): void {
        if (this.source.embedded && guess !== "whole") return; // the header tells whether a thread is needed
        if (this.alone || this.hands.length >= this.limit || this.hands.some(({ streams }) => streams.size === 0))
            return;
        this.start(tolerant ? "whole" : guess);
    }

    /** Give a stream to a thread that has none, or to a new one; or let it wait for the next that is free. */
    private place(stream: PooledStream): void {
        const { build } = stream.need;
        const hand = this.alone ? undefined : this.free(build);
        if (this.alone) return void this.stay(stream);
        if (!hand) return void this.waiting.push(stream);
        hand.streams.add(stream);
        const helpers = this.helpersFor(stream, hand);
        stream.task = this.task++;
        const ports = helpers.map((helper) => {
            const { port1, port2 } = new MessageChannel();
            post(helper, { help: port2 }, [port2]);
            return port1;
        });
        stream.work((message, moved) => post(hand, message, moved), ports);
    }

    /**
     * A thread for a build without work, started if there may be one more, in the place of another that has none if
     * there may not.
     */
    private free(build: Build): Hand | undefined {
        const idle = this.hands.filter((hand) => hand.streams.size === 0);
        const found = idle.find(({ thread }) => thread === threadOf(build));
        if (found) return found;
        if (this.hands.length >= this.limit) {
            if (idle.length === 0) return undefined;
            this.hands.splice(this.hands.indexOf(idle[0]), 1);
            idle[0].worker.terminate();
        }
        return this.start(build);
    }

    private helpersFor(stream: PooledStream, hand: Hand): Hand[] {
        const { need, wishes } = stream;
        const most = Math.min(processors(), this.limit) - 1;
        if (isLight(need.build) || need.members < (wishes.worthwhile ?? WORTHWHILE) || this.waiting.length > 0)
            return [];
        const busy = this.hands.filter((other) => other !== hand && other.streams.size > 0).length;
        const found: Hand[] = [];
        for (let helper; found.length < most - busy && (helper = this.free(need.build));) {
            helper.streams.add(stream);
            found.push(helper);
        }
        return found;
    }

    private start(build: Build): Hand | undefined {
        const thread = threadOf(build);
        const worker = this.source.worker(thread);
        if (!worker) return void this.settle();
        const hand: Hand = { thread, worker, ready: false, streams: new Set(), parked: [] };
        worker.onmessage = ({ data }: MessageEvent<Reply>) => {
            if ("ready" in data) {
                [hand.ready, this.failed] = [true, 0];
                for (const [message, moved] of hand.parked.splice(0)) worker.postMessage(message, moved);
            } else for (const stream of hand.streams) if (stream.task === data.task) stream.hear(data);
        };
        worker.onerror = (event) => {
            event.preventDefault?.();
            this.lose(hand, new Error(`the decoder's thread does not run: ${event.message ?? "it was stopped"}`));
        };
        this.hands.push(hand);
        return hand;
    }

    private settle(): void {
        sayAlone();
        this.alone = true;
    }

    /** A thread is gone: what it worked on fails, unless it never began. */
    private lose(hand: Hand, error: Error): void {
        const streams = [...hand.streams];
        hand.worker.terminate();
        hand.streams.clear();
        if (this.hands.includes(hand)) this.hands.splice(this.hands.indexOf(hand), 1);
        for (const other of this.hands) for (const stream of streams) other.streams.delete(stream);
        if (!hand.ready && ++this.failed > MOST_FAILED) this.settle();
        for (const stream of streams) if (hand.ready || stream.begun) stream.fail(error);
        if (!hand.ready)
            for (const stream of [...streams, ...this.waiting.splice(0)]) if (!stream.closed) this.place(stream);
    }

    private async stay(stream: PooledStream): Promise<void> {
        const task = (stream.task = this.task++);
        const local = await this.source
            .local(stream.need.build)
            .catch((error: unknown) => stream.fail(new Error(`${error}`)));
        let worker: StreamWorker | undefined;
        const hear = (report: Report): void => (stream.task === task ? stream.hear(report) : undefined);
        const act = (message: Message): void => {
            if (stream.closed || "stop" in message) worker?.stop();
            else if ("start" in message) worker = local?.openDesk({ ...message.start, helpers: [] }, hear);
            else if ("data" in message) worker?.take(message.data);
        };
        stream.work((message) => {
            for (const part of partsOf(message)) setTimeout(() => act(part)); // the page may draw in between
        }, []);
    }

    private end(stream: PooledStream): void {
        if (stream.closed) this.streams.delete(stream);
        // Those that worked last come last, so that it is the others that make room for another build.
        const worked = this.hands.filter((hand) => hand.streams.delete(stream));
        this.hands.push(...this.hands.splice(0).filter((hand) => !worked.includes(hand)), ...worked);
        const at = this.waiting.indexOf(stream);
        if (at >= 0) this.waiting.splice(at, 1);
        const isRoom = (): boolean =>
            this.hands.length < this.limit || this.hands.some(({ streams }) => streams.size === 0);
        for (let next; isRoom() && (next = this.waiting.shift());) this.place(next);
        clearTimeout(this.rest);
        if (this.streams.size > 0 || this.hands.length === 0) return;
        const end = (): unknown => this.streams.size > 0 || this.dispose();
        this.rest = setTimeout(end, IDLE);
        (this.rest as { unref?: () => void } | undefined)?.unref?.(); // Node may end before
    }
}

/** By the addresses of the decoder's files. */
const shared = new Map<string, Pool>();

/** A stream of a pool. All that came is kept until its end, for a build that knows more. */
class PooledStream {
    closed = false;
    begun = false;
    task = -1;
    need: Need = { build: "whole", members: 0 };
    kernels?: WebAssembly.Module;
    /** Whether its need is known; `said` waits for that, or for its end. */
    known = false;
    private tell = (): void => {};
    readonly said = new Promise<void>((go) => (this.tell = go));
    private readonly pieces: (Uint8Array | null)[] = [];
    private reported = 0;
    private say?: (message: Message, moved: Transferable[]) => void;

    constructor(
        private readonly listener: Listener,
        readonly wishes: StreamWishes,
        private readonly begin: (need: Need) => void,
        private readonly end: () => void,
    ) {}

    /** Take a piece, which must not change afterwards; null: the data has ended. */
    receiveData(data: Uint8Array | null): void {
        if (this.closed) return;
        this.pieces.push(data);
        if (this.say) this.say({ task: this.task, data }, []);
        else if (!this.known) {
            const need = this.wishes.tolerant ? { build: "whole" as const, members: 0 } : needOf(joined(this.pieces));
            this.known = need !== undefined || data === null;
            if (!this.known) return;
            this.tell();
            this.begin(need ?? this.need);
        }
    }

    receiveEof(): void {
        this.receiveData(null);
    }

    /** Stop at once; nothing more is heard. */
    close(): void {
        if (this.closed) return;
        this.closed = true;
        this.tell();
        this.say?.({ task: this.task, stop: true }, []);
        this.pieces.length = 0;
        this.end();
    }

    fail(error: BsmError | Error): void {
        if (this.closed) return;
        this.close();
        this.listener.onError(error);
    }

    work(say: (message: Message, moved: Transferable[]) => void, helpers: MessagePort[]): void {
        const { limits = {}, guess: _, ...wishes } = this.wishes;
        const { kernels, reported, need } = this;
        if (!kernels || this.closed) return;
        this.say = say;
        const start = { ...wishes, kernels, build: need.build, limits, reported, helpers };
        say({ task: this.task, start }, helpers);
        for (const data of this.pieces) say({ task: this.task, data }, []);
    }

    hear(report: Report): void {
        if (this.closed) return;
        this.begun = true;
        try {
            this.pass(report);
        } catch (error) {
            this.close();
            this.listener.onError(error as Error); // it is the listener's
        }
    }

    private pass(report: Report): void {
        const { listener } = this;
        if ("picture" in report) listener.onPicture?.(report.picture);
        else if ("event" in report) listener.onEvent?.(report.event);
        else if ("taken" in report) listener.onTaken?.(report.taken);
        else if ("reported" in report) this.reported = report.reported;
        else if ("problem" in report) {
            // Lesser builds do not know everything, nor what to say of it.
            if (this.need.build !== "whole") this.restart();
            else
                this.fail(
                    errorLike(
                        isPage(joined(this.pieces.slice(0, 64)))
                            ? { ...report.problem, problem: PAGE, place: {} }
                            : report.problem,
                    ),
                );
        } else if ("fault" in report) this.fail(new Error(report.fault));
        else if ("over" in report) {
            this.close();
            listener.onEnd?.();
        }
    }

    /** Begin again with the decoder of everything, which reports what has not been reported yet. */
    private restart(): void {
        this.say?.({ task: this.task, stop: true }, []);
        [this.say, this.task, this.begun] = [undefined, -1, false];
        this.end();
        this.begin({ ...this.need, build: "whole" });
    }
}

/** A message, its bytes in small pieces. */
function partsOf(message: Message): Message[] {
    if (!("data" in message) || !message.data) return [message];
    const { data, task } = message;
    const count = Math.max(1, Math.ceil(data.length / PIECE));
    return Array.from({ length: count }, (_, i) => ({ task, data: data.subarray(i * PIECE, (i + 1) * PIECE) }));
}

function joined(pieces: (Uint8Array | null)[]): Uint8Array {
    const there = pieces.flatMap((piece) => piece ?? []);
    const whole = new Uint8Array(there.reduce((sum, { length }) => sum + length, 0));
    there.reduce((at, piece) => (whole.set(piece, at), at + piece.length), 0);
    return whole;
}
