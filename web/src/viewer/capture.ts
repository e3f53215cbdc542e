/** A picture of the stage as the page shows it, with captions. */
import type { Stage } from "./stage";

export function pictureOf(stage: Stage, labels: string[]): HTMLCanvasElement {
    stage.draw();
    const [drawn, ratio] = [stage.canvas, stage.renderer.getPixelRatio()];
    const { width, height } = drawn;
    const canvas = Object.assign(document.createElement("canvas"), { width, height });
    const { color, borderTopColor } = getComputedStyle(drawn.parentElement!); // of the background
    const pen = canvas.getContext("2d")!;
    const [x, y] = [width / 2, 0.42 * height];
    const back = pen.createRadialGradient(x, y, 0, x, y, 0.6 * Math.hypot(width, height));
    back.addColorStop(0, color);
    back.addColorStop(0.85, borderTopColor);
    pen.fillStyle = back;
    pen.fillRect(0, 0, width, height);
    pen.drawImage(drawn, 0, 0);
    const seam = (stage.mode === "one" ? 0 : stage.seam) * ratio;
    [pen.fillStyle, pen.textAlign] = [getComputedStyle(drawn.closest(".bsm")!).color, "center"];
    pen.font = `600 ${15 * ratio}px system-ui, sans-serif`;
    if (seam > 0) pen.fillRect(seam - 1, 0, 2, height);
    const places = [0, seam, width];
    labels.forEach((label, side) => {
        const [from, to] = [places[side], places[side + 1]];
        if (to > from) pen.fillText(label, (from + to) / 2, height - 18 * ratio);
    });
    return canvas;
}
