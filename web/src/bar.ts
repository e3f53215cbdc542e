/** The controls of `<bsm-player controls>`: play and pause, the time, and the full screen, for mice, fingers and keys. */
import type { BSMPlayer } from "./player";

export class Bar {
    private readonly button: HTMLButtonElement;
    private readonly range: HTMLInputElement;
    private readonly time: HTMLOutputElement;

    constructor(
        readonly element: HTMLElement,
        private readonly player: BSMPlayer,
    ) {
        const [button, full] = element.querySelectorAll("button");
        this.button = button;
        this.range = element.querySelector("input")!;
        this.time = element.querySelector("output")!;
        full.hidden = !document.fullscreenEnabled;
        full.onclick = () =>
            void (document.fullscreenElement ? document.exitFullscreen() : player.requestFullscreen?.());
        button.onclick = () => this.toggle();
        this.range.oninput = () => ((player.currentTime = Number(this.range.value)), this.show());
        this.show();
    }

    toggle(): void {
        if (this.player.paused) this.player.play();
        else this.player.pause();
        this.show();
    }

    show(): void {
        const { button, element, range, time } = this;
        const { currentTime, duration, paused } = this.player;
        element.classList.toggle("still", !(duration > 0));
        element.classList.toggle("paused", paused);
        button.setAttribute("aria-label", paused ? "Play" : "Pause");
        [range.max, range.value] = [String(duration), String(currentTime)];
        time.textContent = `${currentTime.toFixed(1)} s of ${duration.toFixed(1)} s`;
        range.setAttribute("aria-valuetext", time.textContent);
    }
}
