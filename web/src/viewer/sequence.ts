/** The controls of a sequence: play, pause, seek, speed and loop, and a plot of the errors. */
import type { BSMGeometry } from "../geometry";
import { BSMSequence } from "../sequences";
import { percent, type Content } from "./facts";
import type { Form } from "./form";

export class SequenceBar {
    private sequence?: BSMSequence;
    private readonly frame: HTMLInputElement;
    private before = 0;
    private shown = -1;
    private errors: number[] = [];

    constructor(private readonly form: Form) {
        this.frame = form.control("frame");
        form.on("play", "click", () => (this.sequence?.playing ? this.sequence.pause() : this.sequence?.play()));
        form.on("frame", "input", ({ value }) => this.sequence?.seek(Number(value)));
        form.on("earlier", "click", () => this.go(-1));
        form.on("later", "click", () => this.go(1));
        form.on("loop", "change", ({ checked }) => this.sequence && (this.sequence.loop = checked));
    }

    open(facts: Content["facts"]): void {
        [this.sequence, this.shown] = [undefined, -1];
        this.plot(facts);
    }

    /** Plot the largest error of each frame, if it is known. */
    plot({ errors = [], farthest }: Content["facts"]): void {
        this.errors = errors;
        const points = errors.map((error, i) => `L${i / (errors.length - 1)},${1 - error / (farthest || 1)}`);
        const plot = this.form.part("errors");
        plot.toggleAttribute("hidden", points.length < 2);
        plot.querySelector("path")!.setAttribute("d", `M0,1${points.join("")}L1,1z`);
    }

    /** Play the frames of a geometry, unless the reader prefers reduced motion. */
    begin(geometry: BSMGeometry): void {
        this.sequence ??= new BSMSequence(geometry, !matchMedia("(prefers-reduced-motion: reduce)").matches);
        this.sequence.loop = this.form.control("loop").checked;
    }

    /** Show the frame that is due; return whether it differs from the last one. */
    step(now: number, over: boolean, missed: number): boolean {
        const { sequence, form } = this;
        form.part("sequence").hidden = !sequence;
        if (!sequence) return false;
        sequence.complete = over;
        sequence.speed = Number(form.control<HTMLSelectElement>("speed").value);
        sequence.update((now - this.before) / 1000);
        this.before = now;
        this.report(sequence, missed);
        const isAnother = sequence.frame !== this.shown;
        this.shown = sequence.frame;
        return isAnother;
    }

    /** Hold still, some frames on. */
    private go(step: number): void {
        const { sequence } = this;
        if (!sequence) return;
        const length = sequence.geometry.frames.length;
        sequence.pause();
        sequence.seek((sequence.frame + step + length) % length);
    }

    private report({ frame: shown, geometry, playing, rate }: BSMSequence, missed: number): void {
        const { form, frame } = this;
        const there = geometry.frames.length;
        const total = Math.max(geometry.header!.frames - missed, there);
        form.root.dataset.frame = String(shown);
        form.root.dataset.there = String(there);
        frame.max = String(total - 1);
        frame.value = String(shown);
        form.control("play").textContent = playing ? "Pause" : "Play";
        const ahead = there < total ? `, ${there} are there` : "";
        const place = `${missed + shown + 1} of ${missed + total}`;
        const error = this.errors[shown];
        const off = error === undefined ? "" : `; error ${percent(error)}`;
        form.say("time", `${place}${ahead}; ${((missed + shown) / rate).toFixed(2)} s${off}`);
        frame.setAttribute("aria-valuetext", `frame ${place}`);
    }
}
