/** Camera, light, and meshes on a canvas: one alone, two behind a wipe, or two side by side. */
import {
    BufferAttribute, type BufferGeometry, type DataTexture, DirectionalLight, DoubleSide, Group, type Material, MathUtils, Matrix4, Mesh, MeshBasicMaterial,
    MeshStandardMaterial, NeutralToneMapping, PerspectiveCamera, PlaneGeometry, PMREMGenerator, Scene, Spherical, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { GROUND, shadowOf, studio } from "./light";

const TURN = Math.PI / 24;
const ZOOM = 1.1;
const FIELD = (30 / 180) * Math.PI; // that is seen of the shorter side
const AROUND = 1.06 / Math.sin(FIELD / 2); // distance from which a ball of radius 1 is seen whole
const FILLED = 0.94; // of the picture
const DOCK = 70; // pixels of the controls at the bottom
const CLAY = 0xcdc6ba;
const WHITE = 0xffffff;
const VIEW = new Spherical(1, 72 * MathUtils.DEG2RAD, 35 * MathUtils.DEG2RAD); // from where one looks first
const OPEN = 0.35; // length of the mean normal of a mesh that has a front
const THUMB = 44; // pixels of the handle of the wipe
const [QUIET, SMOOTH] = [400, 2]; // milliseconds, and by how much pixels are finer then
const FILM = 5000; // milliseconds of a turntable
const RATE = 30;

export type Mode = "one" | "wipe" | "split";
export type Shading = "smooth" | "flat" | "wire";

/** A mesh, plain or in materials of its own. */
class Drawn {
    readonly holder = new Group();
    readonly clay = new MeshStandardMaterial({ color: CLAY, roughness: 0.6, side: DoubleSide });
    clothes: MeshStandardMaterial[] = [];
    mesh?: Mesh<BufferGeometry, Material | Material[]>;

    put(geometry: BufferGeometry): void {
        this.clear();
        this.mesh = new Mesh<BufferGeometry, Material | Material[]>(geometry, this.clay);
        this.mesh.frustumCulled = false;
        this.holder.add(this.mesh);
    }

    clear(): void {
        this.holder.clear();
        this.mesh?.geometry.dispose();
        for (const material of this.clothes) material.dispose();
        [this.clothes, this.mesh] = [[], undefined];
    }

    get materials(): MeshStandardMaterial[] {
        return [this.clay, ...this.clothes];
    }
}

/** Whether something draws that was made for it, and no program. */
function isFast(): boolean {
    const context = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
    const named = context?.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? context?.RENDERER;
    const name = named ? String(context!.getParameter(named)) : "software";
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return !/software|swiftshader|llvmpipe|basic render/i.test(name);
}

export class Stage {
    mode: Mode = "one";
    /** The meshes on the left and on the right, by their numbers; one alone is the right one. */
    sides: [number, number] = [0, 0];
    wipe = 0.5;
    private readonly renderer: WebGLRenderer;
    private readonly camera = new PerspectiveCamera(30, 1, 0.01, 100);
    private readonly scene = new Scene();
    private readonly controls: OrbitControls;
    private readonly fast = isFast();
    private readonly key = new DirectionalLight(WHITE, 1.5);
    private readonly ground = new Mesh(new PlaneGeometry(GROUND, GROUND), new MeshBasicMaterial({ color: 0, transparent: true, depthWrite: false, toneMapped: false }));
    private readonly wires = new MeshBasicMaterial({ wireframe: true, color: 0x101418, transparent: true, opacity: 0.35 });
    /** What turns the axis that a mesh calls up to the top. */
    private readonly turned = new Group();
    private readonly drawn = [new Drawn(), new Drawn(), new Drawn()];
    private readonly tiles = new Group();
    private shading: Shading = "smooth";
    private stale = true;
    private moved = 0;
    private touched = false;
    private size = [1, 1];

    constructor(private readonly canvas: HTMLCanvasElement) {
        this.renderer = new WebGLRenderer({ canvas, antialias: this.fast, alpha: true });
        this.renderer.setPixelRatio(devicePixelRatio);
        this.renderer.autoClear = false;
        this.renderer.toneMapping = NeutralToneMapping;
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.enableDamping = true;
        this.controls.autoRotateSpeed = 4;
        this.controls.addEventListener("change", () => this.redraw());
        this.controls.addEventListener("start", () => (this.touched = true));
        this.camera.position.setFromSpherical(VIEW).setLength(AROUND / 2);
        const { texture, probe } = studio();
        // A program that draws would need seconds for reflections.
        if (this.fast) this.scene.environment = new PMREMGenerator(this.renderer).fromEquirectangular(texture).texture;
        else this.scene.add(probe);
        this.light = 0;
        this.ground.rotation.x = -Math.PI / 2;
        this.ground.visible = false;
        this.scene.add(this.key, this.ground, this.turned);
        this.turned.add(this.tiles, ...this.drawn.map(({ holder }) => holder));
        canvas.addEventListener("keydown", (event) => this.turn(event));
    }

    show(index: number, geometry: BufferGeometry): void {
        this.drawn[index].put(geometry);
        this.shade(this.shading);
    }

    /** Lay the box of all meshes around the middle, and turn it by these angles. */
    place(center: number[], diagonal: number, turn: [number, number, number] = [0, 0, 0]): void {
        const { turned } = this;
        turned.rotation.set(...turn);
        turned.scale.setScalar(1 / diagonal);
        turned.position.set(-center[0] / diagonal, -center[1] / diagonal, -center[2] / diagonal).applyEuler(turned.rotation);
        turned.updateWorldMatrix(true, false);
        this.redraw();
    }

    /** Have points of meshes in the middle, and fill the picture from a place before the front, unless the reader chose another one. */
    fill(samples: ArrayLike<number>[], turn?: [number, number, number], normals?: BufferAttribute): void {
        const [low, high] = [new Vector3(Infinity, Infinity, Infinity), new Vector3(-Infinity, -Infinity, -Infinity)];
        const point = new Vector3();
        const each = (act: () => void): void => {
            for (const points of samples) for (let i = 0; i < points.length; i += 3) if (points[i] === points[i]) {
                point.set(points[i], points[i + 1], points[i + 2]);
                act();
            }
        };
        each(() => (low.min(point), high.max(point)));
        if (this.touched || !(low.x <= high.x)) return;
        this.place(low.clone().add(high).divideScalar(2).toArray(), low.distanceTo(high) || 1, turn);
        const front = new Vector3();
        for (let i = 0; i < (normals?.count ?? 0); i++) front.add(point.fromBufferAttribute(normals!, i));
        front.divideScalar(normals?.count || 1).applyEuler(this.turned.rotation);
        const begin = VIEW.clone();
        if (Math.hypot(front.x, front.z) > OPEN) begin.theta += Math.atan2(front.x, front.z);
        this.camera.position.setFromSpherical(begin);
        this.controls.update();
        const [width, height] = this.size;
        const towards = this.turned.matrixWorld.clone().premultiply(new Matrix4().makeRotationFromQuaternion(this.camera.quaternion.clone().invert()));
        const seen = FILLED * Math.tan(this.camera.fov / 2 / MathUtils.RAD2DEG);
        const [wide, tall] = [seen * (width / height), Math.max(seen * (1 - (2 * DOCK) / height), seen / 2)];
        let far = 0.1;
        const placed = new Vector3();
        this.ground.position.y = Infinity;
        each(() => {
            this.ground.position.y = Math.min(this.ground.position.y, placed.copy(point).applyMatrix4(this.turned.matrixWorld).y);
            point.applyMatrix4(towards);
            far = Math.max(far, point.z + Math.abs(point.x) / wide, point.z + Math.abs(point.y) / tall);
        });
        this.camera.position.setLength(far);
        this.redraw();
    }

    shadow(geometry: BufferGeometry): void {
        const { ground, turned } = this;
        if (ground.position.y === Infinity) return;
        ground.material.alphaMap = shadowOf(geometry, turned.matrixWorld, ground.position.y, (ground.material.alphaMap as DataTexture | null) ?? undefined);
        ground.material.needsUpdate ||= !ground.visible;
        ground.visible = true;
        this.redraw();
    }

    clear(): void {
        for (const shown of this.drawn) shown.clear();
        this.ground.visible = false;
        this.tiles.clear();
        this.touched = false;
        this.camera.position.setFromSpherical(VIEW).setLength(AROUND / 2);
        this.controls.target.set(0, 0, 0);
        this.redraw();
    }

    together(geometries: BufferGeometry[]): void {
        const { clay } = this.drawn[0];
        const fresh = new Set(geometries);
        for (const mesh of [...this.tiles.children] as Mesh[]) if (!fresh.delete(mesh.geometry)) this.tiles.remove(mesh);
        for (const geometry of fresh) {
            const mesh = new Mesh(geometry, clay);
            this.tiles.add(mesh);
            this.edge(mesh);
        }
        this.whiten(clay, geometries.some((geometry) => geometry.hasAttribute("color")));
        this.redraw();
    }

    /** From where one looks, in the unit of the meshes, and how many pixels a unit has at a distance of 1. */
    get eye(): { place: Vector3; pixels: number } {
        this.turned.updateWorldMatrix(true, false);
        const place = this.turned.worldToLocal(this.camera.position.clone());
        return { place, pixels: (this.size[1] * devicePixelRatio) / (2 * Math.tan(this.camera.fov / 2 / MathUtils.RAD2DEG)) };
    }

    dress(index: number, clothes: MeshStandardMaterial[]): void {
        this.drawn[index].clothes = clothes;
        this.shade(this.shading);
    }

    shade(shading: Shading): void {
        this.shading = shading;
        for (const shown of this.drawn) {
            for (const material of shown.materials) {
                material.flatShading = shading !== "smooth";
                material.polygonOffset = shading === "wire";
                material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
                material.needsUpdate = true;
            }
            if (shown.mesh) this.edge(shown.mesh);
        }
        for (const mesh of this.tiles.children as Mesh[]) this.edge(mesh);
        this.redraw();
    }

    /** Color the drawn vertices of a mesh; or none of them; or draw the materials that it has. */
    color(index: number, colors?: BufferAttribute, dressed = false): void {
        const { mesh, clay, clothes } = this.drawn[index];
        if (!mesh) return;
        mesh.material = dressed && clothes.length > 0 ? (clothes.length > 1 ? clothes : clothes[0]) : clay;
        if (colors) mesh.geometry.setAttribute("color", colors);
        this.whiten(clay, colors !== undefined);
        this.redraw();
    }

    set light(angle: number) {
        const turn = angle * MathUtils.DEG2RAD;
        this.scene.environmentRotation.y = turn;
        this.key.position.set(-1.2, 1.9, 1.5).applyAxisAngle(this.scene.up, turn);
        this.redraw();
    }

    get spin(): boolean {
        return this.controls.autoRotate;
    }

    set spin(on: boolean) {
        this.controls.autoRotate = on;
    }

    get seam(): number {
        return this.mode === "split" ? this.size[0] / 2 : THUMB / 2 + this.wipe * (this.size[0] - THUMB);
    }

    redraw(): void {
        this.stale = true;
    }

    /** Draw, if there is anything new; where a program draws, edges are smooth once nothing moves. */
    step(): void {
        this.controls.update();
        const now = performance.now();
        if (this.stale) this.renew(1, now);
        else if (!this.fast && now - this.moved > QUIET && this.renderer.getPixelRatio() === devicePixelRatio) this.renew(SMOOTH, this.moved);
    }

    /** The picture as it is seen, with what stands below each side. */
    picture(labels: string[], [ink, near, far]: string[], canvas = document.createElement("canvas")): HTMLCanvasElement {
        this.draw();
        const ratio = this.renderer.getPixelRatio();
        const { width, height } = this.canvas;
        [canvas.width, canvas.height] = [width, height];
        const pen = canvas.getContext("2d")!;
        const back = pen.createRadialGradient(width / 2, 0.42 * height, 0, width / 2, 0.42 * height, 0.6 * Math.hypot(width, height));
        back.addColorStop(0, near);
        back.addColorStop(0.85, far);
        pen.fillStyle = back;
        pen.fillRect(0, 0, width, height);
        pen.drawImage(this.canvas, 0, 0);
        const seam = (this.mode === "one" ? 0 : this.seam) * ratio;
        [pen.fillStyle, pen.textAlign] = [ink, "center"];
        pen.font = `600 ${15 * ratio}px system-ui, sans-serif`;
        if (seam > 0) pen.fillRect(seam - 1, 0, 2, height);
        [[0, seam], [seam, width]].forEach(([from, to], side) => to > from && pen.fillText(labels[side], (from + to) / 2, height - 18 * ratio));
        return canvas;
    }

    async film(labels: string[], colors: string[], report: (share: number) => void): Promise<Blob> {
        const canvas = this.picture(labels, colors);
        const type = ["video/mp4", "video/webm"].find((name) => MediaRecorder.isTypeSupported(name));
        const recorder = new MediaRecorder(canvas.captureStream(RATE), { mimeType: type, videoBitsPerSecond: 12e6 });
        const parts: Blob[] = [];
        recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
        const over = new Promise((keep) => recorder.addEventListener("stop", keep));
        const place = new Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
        const { theta } = place;
        recorder.start();
        for (let begin = performance.now(), share = 0; share < 1; ) {
            share = Math.min((performance.now() - begin) / FILM, 1);
            place.theta = theta + 2 * Math.PI * share;
            this.from(place);
            this.picture(labels, colors, canvas);
            report(share);
            await new Promise(requestAnimationFrame);
        }
        recorder.stop();
        await over;
        return new Blob(parts, { type });
    }

    dispose(): void {
        this.controls.dispose();
        this.clear();
        this.renderer.dispose();
        this.renderer.forceContextLoss(); // a page may have few contexts, and forgets none by itself
    }

    private renew(finer: number, moved: number): void {
        this.moved = moved;
        const ratio = finer * devicePixelRatio;
        if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
        this.draw();
    }

    private draw(): void {
        this.stale = false;
        const [width, height] = this.size;
        const { renderer, sides } = this;
        renderer.setScissorTest(false);
        renderer.setViewport(0, 0, width, height);
        renderer.clear();
        if (this.mode === "one") return this.render(sides[1]);
        const { seam } = this;
        renderer.setScissorTest(true);
        for (const [side, from, to] of [[0, 0, seam], [1, seam, width]]) {
            renderer.setScissor(from, 0, to - from, height);
            if (this.mode === "split") renderer.setViewport(from, 0, to - from, height);
            this.render(sides[side]);
        }
    }

    private render(index: number): void {
        this.drawn.forEach((shown, number) => (shown.holder.visible = number === index));
        this.renderer.render(this.scene, this.camera);
    }

    private edge(mesh: Mesh<BufferGeometry, Material | Material[]>): void {
        mesh.clear();
        if (this.shading !== "wire") return;
        const edges = new Mesh(mesh.geometry, this.wires);
        edges.frustumCulled = mesh.frustumCulled;
        mesh.add(edges);
    }

    private whiten(clay: MeshStandardMaterial, on: boolean): void {
        if (clay.vertexColors === on) return;
        clay.vertexColors = on;
        clay.color.set(on ? WHITE : CLAY);
        clay.needsUpdate = true;
    }

    fit(): void {
        const { clientWidth, clientHeight } = this.canvas.parentElement!;
        if (clientWidth !== this.size[0] || clientHeight !== this.size[1]) this.renderer.setSize(clientWidth, clientHeight, false);
        this.size = [clientWidth, clientHeight];
        this.camera.aspect = clientWidth / (this.mode === "split" ? 2 : 1) / Math.max(clientHeight, 1);
        this.camera.fov = 2 * MathUtils.RAD2DEG * Math.atan(Math.tan(FIELD / 2) / Math.min(this.camera.aspect, 1));
        this.camera.updateProjectionMatrix();
        this.draw();
    }

    private from(place: Spherical): void {
        this.camera.position.setFromSpherical(place.makeSafe()).add(this.controls.target);
        this.controls.update();
        this.redraw();
    }

    private turn(event: KeyboardEvent): void {
        const place = new Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
        if (event.key === "ArrowLeft") place.theta -= TURN;
        else if (event.key === "ArrowRight") place.theta += TURN;
        else if (event.key === "ArrowUp") place.phi -= TURN;
        else if (event.key === "ArrowDown") place.phi += TURN;
        else if (event.key === "+") place.radius /= ZOOM;
        else if (event.key === "-") place.radius *= ZOOM;
        else return;
        event.preventDefault();
        this.touched = true;
        this.from(place);
    }
}
