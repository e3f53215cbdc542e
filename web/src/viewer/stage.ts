/** Camera, light, and meshes on a canvas: one alone, two behind a wipe, or two side by side. */
import { BufferAttribute, type BufferGeometry, DirectionalLight, DoubleSide, Group, HemisphereLight, type Material, MathUtils, Matrix4, Mesh, MeshBasicMaterial, MeshPhongMaterial, MeshStandardMaterial, NeutralToneMapping, PerspectiveCamera, PMREMGenerator, Scene, Spherical, type Texture, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { RoomEnvironment } from "three/examples/jsm/environments/RoomEnvironment.js";

const TURN = Math.PI / 24;
const ZOOM = 1.1;
const FIELD = (30 / 180) * Math.PI; // that is seen of the shorter side
const AROUND = 1.06 / Math.sin(FIELD / 2); // distance from which a ball of radius 1 is seen whole
const FILLED = 0.94; // of the picture
const DOCK = 70; // pixels of the controls at the bottom
const CLAY = 0xcfc9bf;
const WHITE = 0xffffff;
const PALE = 0.3; // of materials, the most that mirrors where there is nothing to mirror
const THUMB = 44; // pixels of the handle of the wipe
const FILM = 5000; // milliseconds of a turntable
const RATE = 30;

export type Mode = "one" | "wipe" | "split";
export type Shading = "smooth" | "flat" | "wire";

/** A mesh, plain or in materials of its own. */
class Drawn {
    readonly holder = new Group();
    readonly clay = new MeshPhongMaterial({ color: CLAY, specular: 0x2c2c2c, shininess: 16, side: DoubleSide });
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

    get materials(): (MeshPhongMaterial | MeshStandardMaterial)[] {
        return [this.clay, ...this.clothes];
    }
}

export class Stage {
    mode: Mode = "one";
    /** The meshes on the left and on the right, by their numbers; one alone is the right one. */
    sides: [number, number] = [0, 0];
    /** Where the wipe is, from 0 to 1. */
    wipe = 0.5;
    private readonly renderer: WebGLRenderer;
    private readonly camera = new PerspectiveCamera(30, 1, 0.01, 100);
    private readonly scene = new Scene();
    private readonly controls: OrbitControls;
    private readonly lights = new Group();
    private readonly wires = new MeshBasicMaterial({ wireframe: true, color: 0x101418, transparent: true, opacity: 0.35 });
    /** What turns the axis that a mesh calls up to the top. */
    private readonly turned = new Group();
    private readonly drawn = [new Drawn(), new Drawn(), new Drawn()];
    private readonly tiles = new Group();
    private readonly fast = isFast();
    private room?: Texture;
    private shading: Shading = "smooth";
    private stale = true;
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
        this.camera.position.set(0.85, 0.5, 1.7).setLength(AROUND / 2);
        for (const [color, strength, ...place] of [[0xfff6ea, 2.1, -1.7, 2, 2.1], [0xd6e4ff, 0.55, 3, 0.2, 1.2], [WHITE, 1.2, 0.5, 2, -3]]) {
            const light = new DirectionalLight(color, strength);
            light.position.set(place[0], place[1], place[2]);
            this.lights.add(light, light.target);
        }
        this.camera.add(this.lights);
        this.scene.add(this.camera, new HemisphereLight(WHITE, 0x8d8478, 0.7), this.turned);
        this.turned.add(this.tiles, ...this.drawn.map(({ holder }) => holder));
        canvas.addEventListener("keydown", (event) => this.turn(event));
    }

    /** Show a geometry as the mesh of a number. */
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

    /** Have points of meshes in the middle, and fill the picture, unless somebody chose another place. */
    fill(samples: ArrayLike<number>[], turn?: [number, number, number]): void {
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
        const [width, height] = this.size;
        const towards = this.turned.matrixWorld.clone().premultiply(new Matrix4().makeRotationFromQuaternion(this.camera.quaternion.clone().invert()));
        const seen = FILLED * Math.tan(this.camera.fov / 2 / MathUtils.RAD2DEG);
        const [wide, tall] = [seen * (width / height), Math.max(seen * (1 - (2 * DOCK) / height), seen / 2)];
        let far = 0.1;
        each(() => {
            point.applyMatrix4(towards);
            far = Math.max(far, point.z + Math.abs(point.x) / wide, point.z + Math.abs(point.y) / tall);
        });
        this.camera.position.setLength(far);
        this.redraw();
    }

    /** Take all meshes away. */
    clear(): void {
        for (const shown of this.drawn) shown.clear();
        this.tiles.clear();
        this.touched = false;
        this.camera.position.setLength(AROUND / 2);
        this.controls.target.set(0, 0, 0);
        this.redraw();
    }

    /** Show these geometries together; those that are not among them go. */
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
        return { place, pixels: this.canvas.height / (2 * Math.tan(this.camera.fov / 2 / MathUtils.RAD2DEG)) };
    }

    /** Give a mesh materials of its own, which mirror a bright room where that is quick. */
    dress(index: number, clothes: MeshStandardMaterial[]): void {
        // A program that draws would need seconds for the room.
        if (this.fast) this.room ??= new PMREMGenerator(this.renderer).fromScene(new RoomEnvironment(), 0.04).texture;
        for (const material of clothes) {
            if (this.room) [material.envMap, material.envMapIntensity] = [this.room, 0.3];
            else material.metalness = Math.min(material.metalness, PALE); // there is nothing that metal could mirror
        }
        this.drawn[index].clothes = clothes;
        this.shade(this.shading);
    }

    /** Shade smoothly, each face by itself, or with its edges. */
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

    /** Let light come from another side, in degrees. */
    set light(angle: number) {
        this.lights.rotation.y = angle * MathUtils.DEG2RAD;
        this.redraw();
    }

    get spin(): boolean {
        return this.controls.autoRotate;
    }

    set spin(on: boolean) {
        this.controls.autoRotate = on;
    }

    /** How many pixels from the left the wipe is. */
    get seam(): number {
        return this.mode === "split" ? this.size[0] / 2 : THUMB / 2 + this.wipe * (this.size[0] - THUMB);
    }

    redraw(): void {
        this.stale = true;
    }

    /** Draw, if there is anything new. */
    step(): void {
        this.controls.update();
        if (this.stale) this.draw();
    }

    /** The picture as it is seen, with what stands below each side. */
    picture(labels: string[], [ink, near, far]: string[], canvas = document.createElement("canvas")): HTMLCanvasElement {
        this.draw();
        const { width, height } = this.canvas;
        [canvas.width, canvas.height] = [width, height];
        const pen = canvas.getContext("2d")!;
        const back = pen.createRadialGradient(width / 2, 0.42 * height, 0, width / 2, 0.42 * height, 0.6 * Math.hypot(width, height));
        back.addColorStop(0, near);
        back.addColorStop(0.85, far);
        pen.fillStyle = back;
        pen.fillRect(0, 0, width, height);
        pen.drawImage(this.canvas, 0, 0);
        const seam = (this.mode === "one" ? 0 : this.seam) * devicePixelRatio;
        [pen.fillStyle, pen.textAlign] = [ink, "center"];
        pen.font = `600 ${15 * devicePixelRatio}px system-ui, sans-serif`;
        if (seam > 0) pen.fillRect(seam - 1, 0, 2, height);
        [[0, seam], [seam, width]].forEach(([from, to], side) => to > from && pen.fillText(labels[side], (from + to) / 2, height - 18 * devicePixelRatio));
        return canvas;
    }

    /** A film of one turn. */
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

    /** Give back what the machine's graphics hold. */
    dispose(): void {
        this.controls.dispose();
        this.clear();
        this.renderer.dispose();
        this.renderer.forceContextLoss(); // a page may have few contexts, and forgets none by itself
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

    /** Give a mesh its edges if they are wished for, or take them away. */
    private edge(mesh: Mesh<BufferGeometry, Material | Material[]>): void {
        mesh.clear();
        if (this.shading !== "wire") return;
        const edges = new Mesh(mesh.geometry, this.wires);
        edges.frustumCulled = mesh.frustumCulled;
        mesh.add(edges);
    }

    /** Let vertices have colors, or not. */
    private whiten(clay: MeshPhongMaterial, on: boolean): void {
        if (clay.vertexColors === on) return;
        clay.vertexColors = on;
        clay.color.set(on ? WHITE : CLAY);
        clay.needsUpdate = true;
    }

    /** Fit the camera to the canvas and the mode. */
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

/** Whether something draws that was made for it; where programs do, smooth edges would take most of the time. */
function isFast(): boolean {
    const context = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
}
