/** Decodes some of the chains of a stream beside a decoder, which has the others: chains know nothing of each other. */
import { Engine, Raw } from "./engine";
import type { Kernels } from "./kernels";
import type { Limits } from "./limits";
import type { Share, SharedBlock } from "./share";
import { END_OF_STREAM, NEED_DATA, type Signal } from "./signals";

/** Takes the whole stream, as the decoder does, and gives the blocks of its share. */
export class Helper {
    private readonly engine: Engine;
    private started = false;
    private over = false;

    constructor(kernels: Kernels, share: Share, limits: Partial<Limits> = {}, tolerant = false) {
        this.engine = new Engine(kernels, limits, tolerant, share);
    }

    receiveData(data: Uint8Array): void {
        if (!this.over) this.engine.push(data);
    }

    receiveEof(): void {
        if (!this.over) this.engine.finish();
    }

    /** Leave the memory to the next decoder; this one is not to be asked for anything more. */
    release(): void {
        this.engine.release();
    }

    /** The next block of the share, `NEED_DATA`, or `END_OF_STREAM` if no more will come. */
    nextBlock(): SharedBlock | Signal {
        const { engine } = this;
        while (!this.over) {
            const { type, index } = engine.next();
            if (type === Raw.NEED) return NEED_DATA;
            if (type === Raw.BLOCK) return engine.handed(index);
            if (type === Raw.LOSS && index >= 0) return { index, problem: engine.error(true).described };
            if (type === Raw.HEADER) {
                this.over = this.started; // of later runs the decoder has all chains
                this.started = true;
            }
            if (type === Raw.OVER || type === Raw.FAILED) this.over = true;
            // What is wrong with more than a block is found by the decoder as well.
            if (type === Raw.FAILED) {
                const problem = engine.error().described;
                if (problem.place.block !== undefined) return { index: problem.place.block, problem };
            }
        }
        return END_OF_STREAM;
    }
}
