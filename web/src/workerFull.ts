/** The workers of the whole decoder: one decodes and has helpers where that is worthwhile, the other helps. */
import { Decoder, END_OF_STREAM, NEED_BLOCK, NEED_DATA } from "./decoder";
import { openDesk as opened, serveWith, Reporter, type StreamWorker, type Guard, type Open, type Say, type Start } from "./worker";
import type { Header } from "./header";
import { Helper } from "./helper";
import type { Share, SharedBlock } from "./share";
import type { Kernels } from "./kernels";
import { helpersFor, Team } from "./team";

type Taking = ReturnType<Open>;

class DecodingWorker implements Taking {
    private readonly reporter: Reporter;
    private readonly decoder: Decoder;
    /** All pieces, until the header tells whether there will be helpers. */
    private pieces?: (Uint8Array | null)[] = [];
    private team?: Team;
    private over?: string;

    constructor(private readonly start: Start, kernels: Kernels, say: Say, private readonly guarded: Guard) {
        const { limits, tolerant, drawing } = start;
        const whole = drawing === "whole" && !tolerant;
        this.decoder = new Decoder(kernels, limits, { tolerant, whole, helpers: (header) => this.findHelpers(header) });
        this.reporter = new Reporter(this.decoder, start, say);
    }

    take(data: Uint8Array | null): void {
        this.pieces?.push(data);
        this.pass(data);
        this.reporter.take(data);
        this.report();
    }

    close(): void {
        this.team?.close();
        this.reporter.close();
    }

    private findHelpers(header: Header): number {
        const { helpers, worthwhile } = this.start;
        const pieces = this.pieces ?? [];
        const count = Math.min(helpers?.length ?? 0, helpersFor(header, worthwhile));
        this.pieces = undefined;
        if (count === 0 || !helpers) return 0;
        this.team = new Team(helpers);
        const onBlock = (shared: SharedBlock): void =>
            this.guarded(() => {
                this.decoder.receiveBlock(shared);
                this.report();
            });
        const onOver = (why: string): void =>
            this.guarded(() => {
                this.over = why;
                this.report();
            });
        const { kernels, limits, tolerant } = this.start;
        const found = this.team.begin({ kernels, limits, tolerant }, count, { onBlock, onOver });
        for (const piece of pieces) this.pass(piece);
        return found;
    }

    private pass(data: Uint8Array | null): void {
        if (data) this.team?.receiveData(data);
        else this.team?.receiveEof();
    }

    private report(): void {
        const wait = this.reporter.report();
        if (wait === NEED_BLOCK && this.over !== undefined) throw new Error(`a block does not come: ${this.over}`);
    }
}

class HelpingWorker implements Taking {
    private readonly helper: Helper;

    constructor({ limits, tolerant }: Start, kernels: Kernels, share: Share, private readonly say: Say) {
        this.helper = new Helper(kernels, share, limits, tolerant);
    }

    take(data: Uint8Array | null): void {
        const { helper } = this;
        if (data) helper.receiveData(data);
        else helper.receiveEof();
        for (let shared; (shared = helper.nextBlock()) !== NEED_DATA; ) {
            if (shared === END_OF_STREAM) return this.say({ through: true });
            const { block } = shared;
            this.say({ shared }, block && [block.vertices.buffer, block.positions.buffer, block.weights.buffer]);
        }
    }

    close(): void {
        this.helper.release();
    }
}

function open(start: Start, kernels: Kernels, say: Say, guarded: Guard): Taking {
    return start.share ? new HelpingWorker(start, kernels, start.share, say) : new DecodingWorker(start, kernels, say, guarded);
}

/** Decode a stream in this thread, as another one would. */
export function openDesk(start: Start, say: Say): StreamWorker {
    return opened(open, start, say);
}

/** Be a thread that decodes, or helps. */
export function serve(): void {
    serveWith(open);
}
