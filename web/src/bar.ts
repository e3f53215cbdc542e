/** The controls of `<bsm-player controls>`: play and pause, the time, and the full screen, for mice, fingers and keys. */
import type { BSMPlayer } from "./player";

/** Have the elements of a bar steer a player; returns what shows there where the player is. */
export function steerBy(bar: HTMLElement, player: BSMPlayer): () => void {
    const [button, full] = bar.querySelectorAll("button");
    const [range, time] = [bar.querySelector("input")!, bar.querySelector("output")!];
    const show = (): void => {
        const { currentTime, duration, paused } = player;
        bar.classList.toggle("still", !(duration > 0));
        bar.classList.toggle("paused", paused);
        button.setAttribute("aria-label", paused ? "Play" : "Pause");
        [range.max, range.value] = [String(duration), String(currentTime)];
        time.textContent = `${currentTime.toFixed(1)} s of ${duration.toFixed(1)} s`;
        range.setAttribute("aria-valuetext", time.textContent);
    };
    full.hidden = !document.fullscreenEnabled;
    full.onclick = () => void (document.fullscreenElement ? document.exitFullscreen() : player.requestFullscreen?.());
    button.onclick = () => player.toggle();
    range.oninput = () => ((player.currentTime = Number(range.value)), show());
    return show;
}
