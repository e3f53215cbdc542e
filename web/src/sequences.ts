/** Plays the frames of a geometry, as they are there. */
import { EventDispatcher, Mesh, type Material } from "three";
import type { BSMGeometry } from "./geometry";
import { Playback } from "./playback";

const ROUNDED = 1e-6; // frames by which a time in seconds may be off

/**
 * `frame`: another one is shown; `loop`: it begins again; `ended`: the last frame was shown, and it does not begin again;
 * `waiting`: frames come more slowly than they are shown; `error`: the rest of the stream cannot be decoded, the frames before
 * it are available; `dispose`: the sequence was disposed, and its load stops.
 */
export type SequenceEvents = Record<"play" | "pause" | "loop" | "ended" | "waiting" | "dispose", object> & {
    frame: { index: number };
    error: { error: unknown };
};

/** A sequence that plays: `update` is to be called for every picture, as that of an AnimationMixer. */
export class BSMSequence extends EventDispatcher<SequenceEvents> {
    /** Whether all frames are there. */
    complete = false;
    /** How many times faster than it was encoded to be; below 0 it holds still. */
    speed = 1;
    private readonly playback: Playback;
    private wasWaiting = false;

    constructor(
        readonly geometry: BSMGeometry,
        playing = true,
    ) {
        super();
        this.playback = new Playback(geometry.frameRate, playing);
    }

    /** Frames per second. */
    get rate(): number {
        return this.playback.rate;
    }

    /** Frames that there are; as long as not all have come, those that the stream announces. */
    get length(): number {
        const { frames, header } = this.geometry;
        return this.complete ? frames.length : Math.max(header?.frames ?? 0, frames.length);
    }

    /** Seconds from the first frame to the end of the last. */
    get duration(): number {
        return this.length / this.rate;
    }

    get frame(): number {
        return Math.max(0, this.geometry.shown);
    }

    get playing(): boolean {
        return this.playback.playing;
    }

    get loop(): boolean {
        return this.playback.loop;
    }

    set loop(loop: boolean) {
        this.playback.loop = loop;
    }

    play(): this {
        if (this.complete && !this.loop && this.frame >= this.length - 1) this.playback.seek(0);
        this.playback.playing = true;
        this.dispatchEvent({ type: "play" });
        return this;
    }

    pause(): this {
        this.playback.playing = false;
        this.dispatchEvent({ type: "pause" });
        return this;
    }

    /** Show a frame, or the last of those that are there; `rate` times its time may be a little less than its number. */
    seek(frame: number): this {
        const whole = Math.floor(frame + ROUNDED) || 0;
        this.playback.seek(Math.min(Math.max(0, whole), this.geometry.frames.length - 1));
        this.show(this.playback.frame);
        return this;
    }

    update(seconds: number): void {
        const { playback, geometry } = this;
        const { loops, playing: wasPlaying } = playback;
        playback.step(seconds * this.speed, geometry.frames.length, this.complete);
        if (playback.waiting && !this.wasWaiting) this.dispatchEvent({ type: "waiting" });
        this.wasWaiting = playback.waiting;
        if (playback.loops > loops) this.dispatchEvent({ type: "loop" });
        this.show(playback.frame);
        if (wasPlaying && !playback.playing) this.dispatchEvent({ type: "ended" });
    }

    mesh(material?: Material): Mesh {
        return new Mesh(this.geometry, material);
    }

    /** No more frames will come. */
    fail(error: unknown): void {
        if (this.complete) return;
        this.complete = true;
        this.dispatchEvent({ type: "error", error });
    }

    dispose(): void {
        this.playback.playing = false;
        this.complete = true;
        this.dispatchEvent({ type: "dispose" });
        this.geometry.frames.length = 0;
        this.geometry.dispose();
    }

    private show(index: number): void {
        if (index === this.geometry.shown || index >= this.geometry.frames.length) return;
        this.geometry.showFrame(index);
        this.dispatchEvent({ type: "frame", index });
    }
}
