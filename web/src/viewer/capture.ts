/** Save a picture of the stage, or a film of one turn around it, with captions. */
import type { Stage } from "./stage";

const FILM = 5000; // milliseconds of a turntable
const RATE = 30;

/** Draw the stage as the page shows it. */
export function pictureOf(stage: Stage, labels: string[], canvas = document.createElement("canvas")): HTMLCanvasElement {
    stage.draw();
    const [drawn, ratio] = [stage.canvas, stage.renderer.getPixelRatio()];
    const { width, height } = drawn;
    [canvas.width, canvas.height] = [width, height];
    const { color, borderTopColor } = getComputedStyle(drawn.parentElement!); // of the background
    const pen = canvas.getContext("2d")!;
    const back = pen.createRadialGradient(width / 2, 0.42 * height, 0, width / 2, 0.42 * height, 0.6 * Math.hypot(width, height));
    back.addColorStop(0, color);
    back.addColorStop(0.85, borderTopColor);
    pen.fillStyle = back;
    pen.fillRect(0, 0, width, height);
    pen.drawImage(drawn, 0, 0);
    const seam = (stage.mode === "one" ? 0 : stage.seam) * ratio;
    [pen.fillStyle, pen.textAlign] = [getComputedStyle(drawn.closest(".bsm")!).color, "center"];
    pen.font = `600 ${15 * ratio}px system-ui, sans-serif`;
    if (seam > 0) pen.fillRect(seam - 1, 0, 2, height);
    const sides = [[0, seam], [seam, width]];
    sides.forEach(([from, to], side) => to > from && pen.fillText(labels[side], (from + to) / 2, height - 18 * ratio));
    return canvas;
}

/** Record a film of one turn; `report` is called with the share done. */
export async function filmOf(stage: Stage, labels: string[], report: (share: number) => void): Promise<Blob> {
    const canvas = pictureOf(stage, labels);
    const type = ["video/mp4", "video/webm"].find((name) => MediaRecorder.isTypeSupported(name));
    const recorder = new MediaRecorder(canvas.captureStream(RATE), { mimeType: type, videoBitsPerSecond: 12e6 });
    const parts: Blob[] = [];
    recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
    const over = new Promise((keep) => recorder.addEventListener("stop", keep));
    const { place } = stage.camera;
    const { theta } = place;
    recorder.start();
    for (let begin = performance.now(), share = 0; share < 1; ) {
        share = Math.min((performance.now() - begin) / FILM, 1);
        place.theta = theta + 2 * Math.PI * share;
        stage.camera.place = place;
        pictureOf(stage, labels, canvas);
        report(share);
        await new Promise(requestAnimationFrame);
    }
    recorder.stop();
    await over;
    return new Blob(parts, { type });
}
