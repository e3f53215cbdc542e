/** One WebGL context for all players, since a page may have few: it draws them in turn, and each keeps a copy. */
import { type Camera, type Scene, WebGLRenderer } from "three";

/** A scene with a canvas of its own. */
export interface Pictured {
    readonly canvas: HTMLCanvasElement;
    readonly scene: Scene;
    readonly camera: Camera;
    readonly inView: boolean;
    /** Hear that the context is lost, or there again. */
    lose(isLost: boolean): void;
    /** Move on by some seconds; returns whether the picture is another one then. */
    step(seconds: number): boolean;
}

const MOST = 12; // milliseconds of drawing at a time: what is not drawn comes first next time

const pictured = new Set<Pictured>();
const stale = new Set<Pictured>();
let renderer: WebGLRenderer | undefined;
let before = 0;

/** Draw a scene whenever it changes; throws where there is no WebGL. */
export function hang(picture: Pictured): void {
    if (!renderer) {
        renderer = new WebGLRenderer({ antialias: true, alpha: true });
        renderer.setScissorTest(true);
        const { domElement } = renderer;
        const tell = (isLost: boolean): void => {
            if (renderer?.domElement === domElement) pictured.forEach((each) => each.lose(isLost)); // not that of players before
        };
        domElement.addEventListener("webglcontextlost", () => tell(true));
        domElement.addEventListener("webglcontextrestored", () => tell(false));
        before = performance.now();
        renderer.setAnimationLoop(drawAll);
    }
    pictured.add(picture);
    stale.add(picture);
}

/** Draw it no longer; the last one takes the context along. */
export function takeDown(picture: Pictured): void {
    pictured.delete(picture);
    stale.delete(picture);
    if (pictured.size > 0 || !renderer) return;
    renderer.setAnimationLoop(null);
    renderer.dispose();
    renderer.forceContextLoss(); // a page may have few contexts, and forgets none by itself
    renderer = undefined;
}

/** Draw it again, though nothing that it steps through has changed. */
export function redraw(picture: Pictured): void {
    if (pictured.has(picture)) stale.add(picture);
}

function drawAll(now: number): void {
    const seconds = Math.max(0, now - before) / 1000;
    before = now;
    for (const picture of pictured) if (picture.step(seconds)) stale.add(picture);
    const begin = performance.now();
    for (const picture of stale) {
        if (!picture.inView) continue;
        if (renderer?.getContext().isContextLost() !== false || performance.now() - begin > MOST) return;
        stale.delete(picture);
        draw(renderer, picture);
    }
}

function draw(renderer: WebGLRenderer, { canvas, scene, camera }: Pictured): void {
    const { width, height } = canvas;
    const { domElement } = renderer;
    // It only grows: another size makes another buffer.
    if (width > domElement.width || height > domElement.height)
        renderer.setSize(Math.max(width, domElement.width), Math.max(height, domElement.height), false);
    renderer.setViewport(0, 0, width, height);
    renderer.setScissor(0, 0, width, height);
    renderer.render(scene, camera);
    const context = canvas.getContext("2d")!;
    context.globalCompositeOperation = "copy";
    context.drawImage(domElement, 0, domElement.height - height, width, height, 0, 0, width, height);
}
