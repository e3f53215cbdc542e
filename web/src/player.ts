/** `<bsm-player src="horse.bsm">`: a mesh, a scene or a sequence on a page of plain HTML, drawn by three.js. */
import { Box3, DirectionalLight, type Group, HemisphereLight, type Material, Mesh, PerspectiveCamera, Scene, Sphere, Texture, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { BSMGeometry } from "./geometry";
import { BSMLoader, BSMSequence, sceneOf } from "./three";

/** Pages may style the element as they like; the text lies in front of the picture. */
const STYLE = `
:host { display: block; position: relative; background: radial-gradient(circle at 50% 40%, #eef0f3, #aeb6c2); }
canvas { display: block; width: 100%; height: 100%; }
p { position: absolute; inset: auto 0 45% 0; margin: 0; padding: 0 1em; text-align: center; font: 14px system-ui, sans-serif; color: #222; }`;
/** What a sequence says, and the element says again. */
const PASSED = ["play", "pause", "frame", "loop", "ended", "waiting"] as const;
/** Where there are no pages the class can be named, too. */
const Base = (globalThis.HTMLElement ?? Object) as typeof HTMLElement;

/**
 * Attributes `src`, `autoplay`, `loop` and `rate` (times as fast). Events: `loadeddata` once something is drawn, `load` once all is
 * there, an `ErrorEvent`, and `play`, `pause`, `frame`, `loop`, `ended`, `waiting` of a sequence.
 */
export class BSMPlayer extends Base {
    static readonly observedAttributes = ["src", "loop", "rate"];
    readonly loader = new BSMLoader();
    readonly scene = new Scene();
    readonly camera = new PerspectiveCamera(35);
    /** What is played, once its first frame is there. */
    sequence?: BSMSequence;
    private content?: Group;
    private renderer?: WebGLRenderer;
    private controls?: OrbitControls;
    private watch?: ResizeObserver;
    /** What is loading, or wrong. */
    private readonly note = globalThis.document?.createElement("p");
    /** Stops the load; what has been stopped is not shown. */
    private loading = new AbortController();

    get src(): string {
        return this.getAttribute("src") ?? "";
    }

    set src(url: string) {
        this.setAttribute("src", url);
    }

    get loop(): boolean {
        return this.hasAttribute("loop");
    }

    set loop(loop: boolean) {
        this.toggleAttribute("loop", loop);
    }

    /** 1 where the attribute says nothing that it can be. */
    get rate(): number {
        const rate = Number(this.getAttribute("rate") ?? 1);
        return rate >= 0 && rate < Infinity ? rate : 1;
    }

    set rate(rate: number) {
        this.setAttribute("rate", `${rate}`);
    }

    get paused(): boolean {
        return !this.sequence?.playing;
    }

    /** Seconds; 0 of what does not move. */
    get duration(): number {
        return this.sequence?.duration ?? 0;
    }

    get currentTime(): number {
        return this.sequence ? this.sequence.frame / this.sequence.rate : 0;
    }

    set currentTime(seconds: number) {
        this.sequence?.seek(seconds * this.sequence.rate);
    }

    play(): void {
        this.sequence?.play();
    }

    pause(): void {
        this.sequence?.pause();
    }

    connectedCallback(): void {
        const renderer = (this.renderer = new WebGLRenderer({ antialias: true, alpha: true }));
        const canvas = renderer.domElement;
        const style = Object.assign(document.createElement("style"), { textContent: STYLE });
        (this.shadowRoot ?? this.attachShadow({ mode: "open" })).replaceChildren(style, canvas, this.note);
        this.controls = new OrbitControls(this.camera, canvas);
        const sun = new DirectionalLight(0xffffff, 2);
        sun.position.set(1, 1, 1);
        this.camera.clear().add(sun);
        this.scene.clear().add(new HemisphereLight(0xffffff, 0x888888, 1.5), this.camera);
        this.watch = new ResizeObserver(() => this.fit());
        this.watch.observe(this);
        this.fit();
        let before = performance.now();
        renderer.setAnimationLoop((now) => {
            this.sequence?.update(Math.max(0, now - before) / 1000);
            before = now;
            this.controls?.update();
            renderer.render(this.scene, this.camera);
        });
        this.open();
    }

    disconnectedCallback(): void {
        this.empty();
        this.watch?.disconnect();
        this.controls?.dispose();
        this.renderer?.setAnimationLoop(null);
        this.renderer?.dispose();
        this.renderer?.forceContextLoss(); // a page may have few contexts, and forgets none by itself
        this.renderer = undefined;
    }

    attributeChangedCallback(name: string): void {
        if (name === "src") this.open();
        if (this.sequence) [this.sequence.loop, this.sequence.speed] = [this.loop, this.rate];
    }

    private open(): void {
        if (!this.renderer || !this.src) return;
        this.empty();
        const { signal } = (this.loading = new AbortController());
        const mine = (): boolean => !signal.aborted;
        const failed = (error: unknown): void => {
            if (!mine()) return;
            this.note.textContent = error instanceof Error ? error.message : `${error}`;
            this.dispatchEvent(new ErrorEvent("error", { error, message: `${error}` }));
        };
        this.note.setAttribute("role", "status");
        this.note.textContent = "Loading";
        const onProgress = ({ lengthComputable, loaded, total }: ProgressEvent): void => {
            if (mine() && !this.content && lengthComputable) this.note.textContent = `Loading, ${Math.floor((100 * loaded) / total)} %`;
        };
        let first: Promise<void> | undefined;
        let moving: BSMSequence | undefined;
        const onFrame = (index: number, geometry: BSMGeometry): void => {
            if (index > 0 || !mine()) return;
            first = this.show(geometry, mine, (moving = new BSMSequence(geometry, false))).catch(failed);
        };
        const onLoad = (geometry: BSMGeometry): void => {
            if (moving) moving.complete = true;
            (first ?? this.show(geometry, mine)).then(() => mine() && this.say("load"), failed);
        };
        const onError = (error: unknown): void => {
            if (moving) moving.complete = true;
            void Promise.resolve(first).then(() => failed(error));
        };
        this.loader.load(this.src, onLoad, onProgress, onError, { onFrame, signal });
    }

    private async show(geometry: BSMGeometry, mine: () => boolean, sequence?: BSMSequence): Promise<void> {
        const content = await sceneOf(geometry);
        if (!mine()) return;
        content.traverse((mesh) => (mesh.frustumCulled = !sequence)); // bounds are those of the first frame
        this.scene.add((this.content = content));
        this.look(content);
        this.note.textContent = "";
        this.say("loadeddata");
        if (!sequence) return;
        this.sequence = sequence;
        [sequence.loop, sequence.speed] = [this.loop, this.rate];
        for (const type of PASSED) sequence.addEventListener(type, (event) => this.say(type, event));
        if (this.hasAttribute("autoplay")) sequence.play();
    }

    /** Look at all of it, from in front and a little above. */
    private look(content: Group): void {
        const { center, radius } = new Box3().setFromObject(content).getBoundingSphere(new Sphere());
        const far = radius / Math.sin((Math.PI / 360) * this.camera.fov) || 1;
        [this.camera.near, this.camera.far] = [far / 100, 10 * far];
        this.camera.position.set(0.4, 0.3, 1).normalize().multiplyScalar(far).add(center);
        this.controls?.target.copy(center);
        this.fit();
    }

    private fit(): void {
        const [width, height] = [this.clientWidth || 300, this.clientHeight || 150];
        this.renderer?.setPixelRatio(devicePixelRatio);
        this.renderer?.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
    }

    private empty(): void {
        this.loading.abort();
        this.content?.removeFromParent();
        this.sequence?.dispose();
        this.content?.traverse((mesh) => {
            if (!(mesh instanceof Mesh)) return;
            mesh.geometry.dispose();
            for (const material of [mesh.material].flat() as Material[]) {
                for (const texture of Object.values(material)) if (texture instanceof Texture) texture.dispose();
                material.dispose();
            }
        });
        [this.content, this.sequence] = [undefined, undefined];
    }

    private say(type: string, detail?: unknown): void {
        this.dispatchEvent(new CustomEvent(type, { detail }));
    }
}

if (globalThis.customElements && !customElements.get("bsm-player")) customElements.define("bsm-player", BSMPlayer);
