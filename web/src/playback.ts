/** When which frame of a sequence is shown. */

const UNKNOWN_RATE = 24; // as where `bsm` writes glTF and USD
/** Seconds of frames that must be there before playing goes on behind a wait. */
const RESERVE = 0.5;
/** The part of its time by which a frame is early, so that clocks that tremble skip none where screens are in step. */
const EARLY = 0.1;

/** Goes through the frames that are there; where they end too early, it waits for half a second of them. */
export class Playback {
    playing: boolean;
    loop = true;
    private at = EARLY;
    /** Whether it waits for frames. */
    waiting = true;
    /** How often it has begun again. */
    loops = 0;

    /** Frames per second; 0: unknown. */
    constructor(
        private readonly given: number,
        playing: boolean,
    ) {
        this.playing = playing;
    }

    get rate(): number {
        return this.given > 0 ? this.given : UNKNOWN_RATE;
    }

    /** The frame to be shown now. */
    get frame(): number {
        return Math.floor(this.at);
    }

    seek(frame: number): void {
        this.at = frame + EARLY;
    }

    /** Go on by some seconds; `there` frames have come, and if `all`, no more will. */
    step(seconds: number, there: number, all: boolean): void {
        if (there === 0) return;
        if (this.waiting) this.waiting = !all && there - this.at < RESERVE * this.rate;
        else if (this.playing) this.at += Math.max(0, seconds) * this.rate || 0; // a NaN speed must not stop the clock for good
        if (this.at < there) return;
        if (all && this.playing && this.loop) {
            this.loops += Math.floor(this.at / there);
            this.at %= there; // what is over counts: clocks go on
        } else {
            this.at = there - 1;
            this.playing &&= !all;
            this.waiting = !all;
        }
    }
}
