/** The workers of the whole decoder: one decodes and has helpers where that is worthwhile, the other helps. */
import { Decoder, END_OF_STREAM, NEED_BLOCK, NEED_DATA } from "./decoder";
import { deskOf, Reporter, type Guard, type Open, type Say, type Start } from "./worker";
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

    constructor(
        private readonly start: Start,
        kernels: Kernels,
        say: Say,
        private readonly guarded: Guard,
    ) {
        const { limits, tolerant, drawing } = start;
        const whole = drawing === "whole" && !tolerant;
        this.decoder = new Decoder(kernels, limits, { tolerant, whole, helpers: (header) => this.findHelpers(header) });
        this.reporter = new Reporter(this.decoder, start, say);
    }

    take(data: Uint8Array | null): void {
        this.pieces?.push(data);
        this.team?.take(data);
        this.reporter.take(data);
        this.report();
    }

    close(): void {
        this.team?.close();
        this.reporter.close();
    }

    private findHelpers(header: Header): number {
        const { kernels, build, limits, tolerant, helpers = [], worthwhile } = this.start;
        const pieces = this.pieces ?? [];
        const found = helpers.slice(0, helpersFor(header, worthwhile));
        this.pieces = undefined;
        if (found.length === 0) return 0;
        const heard = (act: () => void): void => this.guarded(() => (act(), this.report()));
        const onBlock = (shared: SharedBlock): void => heard(() => this.decoder.receiveBlock(shared));
        this.team = new Team(
            found,
            { kernels, build, limits, tolerant },
            { onBlock, onOver: (why) => heard(() => (this.over = why)) },
        );
        for (const piece of pieces) this.team.take(piece);
        return found.length;
    }

    private report(): void {
        const wait = this.reporter.report();
        if (wait === NEED_BLOCK && this.over !== undefined) throw new Error(this.over);
    }
}

class HelpingWorker implements Taking {
    private readonly helper: Helper;

    constructor(
        { limits, tolerant }: Start,
        kernels: Kernels,
        share: Share,
        private readonly say: Say,
    ) {
        this.helper = new Helper(kernels, share, limits, tolerant);
    }

    take(data: Uint8Array | null): void {
        const { helper } = this;
        if (data) helper.receiveData(data);
        else helper.receiveEof();
        for (let shared; (shared = helper.nextBlock()) !== NEED_DATA;) {
            if (shared === END_OF_STREAM) return this.say({ through: true });
            const { block } = shared;
            this.say({ shared }, block && [block.vertices.buffer, block.positions.buffer, block.weights.buffer]);
        }
    }

    close(): void {
        this.helper.release();
    }
}

export const openFull: Open = (start, kernels, say, guarded) =>
    start.share
        ? new HelpingWorker(start, kernels, start.share, say)
        : new DecodingWorker(start, kernels, say, guarded);

// Not taken apart in one step: bundlers would lose what `serve` does.
const desk = deskOf(openFull);
export const openDesk = desk.openDesk;
export const serve = desk.serve;
