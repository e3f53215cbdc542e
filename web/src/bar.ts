/** The controls of `<bsm-player controls>`: play and pause, the time, and the full screen, for mice, fingers and keys. */

/** What the controls show and steer, as an `HTMLMediaElement` has it. */
export interface Playable {
    readonly paused: boolean;
    readonly duration: number;
    currentTime: number;
    play(): void;
    pause(): void;
    requestFullscreen?(): Promise<void>;
}

export const BAR_STYLE = `
.bar { position: absolute; inset: auto 0 0 0; display: flex; align-items: center; gap: 4px; padding: 4px;
    color: #fff; background: linear-gradient(#0000, #000a); font: 13px system-ui, sans-serif; }
.bar[hidden], .bar [hidden] { display: none; }
.bar button { flex: none; width: 44px; height: 44px; padding: 10px; border: 0; border-radius: 8px;
    background: none; color: inherit; cursor: pointer; }
.bar button:hover, .bar button:focus-visible { background: #fff3; }
.bar svg { display: block; width: 24px; height: 24px; fill: currentColor; }
.bar input { flex: 1; min-width: 0; height: 44px; margin: 0; accent-color: #fff; }
.bar output { flex: none; min-width: 7em; text-align: right; font-variant-numeric: tabular-nums; }
.bar .gap { flex: 1; }`;
const SHAPES = {
    play: "M7 4v16l13-8z",
    pause: "M6 4h4v16H6zm8 0h4v16h-4z",
    full: "M4 4h6v2H6v4H4zm10 0h6v6h-2V6h-4zM4 14h2v4h4v2H4zm14 0h2v6h-6v-2h4z",
};

function drawing(shape: keyof typeof SHAPES): string {
    return `<svg viewBox="0 0 24 24" aria-hidden="true"><path d="${SHAPES[shape]}"/></svg>`;
}

export class Bar {
    readonly element = document.createElement("div");
    private readonly button = document.createElement("button");
    private readonly full = document.createElement("button");
    private readonly range = document.createElement("input");
    private readonly time = document.createElement("output");
    private isPaused?: boolean;

    constructor(private readonly player: Playable) {
        const { button, element, full, range, time } = this;
        const gap = Object.assign(document.createElement("span"), { className: "gap" });
        Object.assign(element, { className: "bar" }).setAttribute("part", "controls");
        for (const each of [button, full]) each.type = "button";
        Object.assign(range, { type: "range", min: "0", step: "any", value: "0" }).setAttribute("aria-label", "Time");
        full.setAttribute("aria-label", "Full screen");
        full.innerHTML = drawing("full");
        full.hidden = !document.fullscreenEnabled;
        time.setAttribute("aria-hidden", "true"); // the range says it
        button.onclick = () => this.toggle();
        range.oninput = () => ((this.player.currentTime = Number(range.value)), this.show());
        full.onclick = () =>
            void (document.fullscreenElement ? document.exitFullscreen() : this.player.requestFullscreen?.());
        element.append(button, range, gap, time, full);
        this.show();
    }

    /** Play, or pause. */
    toggle(): void {
        if (this.player.paused) this.player.play();
        else this.player.pause();
        this.show();
    }

    /** Show where it is. */
    show(): void {
        const { button, range, time } = this;
        const { currentTime, duration, paused } = this.player;
        const moves = duration > 0;
        (this.element.querySelector(".gap") as HTMLElement).hidden = moves;
        for (const each of [button, range, time]) each.hidden = !moves;
        if (this.isPaused !== paused) {
            button.innerHTML = drawing(paused ? "play" : "pause");
            button.setAttribute("aria-label", paused ? "Play" : "Pause");
            this.isPaused = paused;
        }
        range.max = String(duration);
        range.value = String(currentTime);
        const [place, length] = [currentTime, duration].map((seconds) => `${seconds.toFixed(1)} s`);
        time.textContent = `${place} of ${length}`;
        range.setAttribute("aria-valuetext", time.textContent);
    }
}
