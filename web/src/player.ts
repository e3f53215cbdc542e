/** `<bsm-player src="horse.bsm">`: a mesh, a scene or a sequence on a page of plain HTML, drawn by three.js. */
import {
    Box3,
    DirectionalLight,
    type Group,
    HemisphereLight,
    type Mesh,
    PerspectiveCamera,
    Scene,
    Sphere,
    Vector3,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { hang, redraw, takeDown } from "./easel";
import type { BSMGeometry } from "./geometry";
import { disposeOf, materialsIn } from "./materials";
import page, { style, type Tree } from "./player.html";
import { sceneOf } from "./scene";
import { BSMLoader, BSMSequence } from "./three";
import { REACH, turnBy } from "./turning";

/** What a sequence says, and the element says again. */
const PASSED = ["play", "pause", "frame", "loop", "ended", "waiting"] as const;
const LABEL = "A mesh in three dimensions";
const KEYS = "Arrow keys turn it, plus and minus zoom, F or Home shows all of it.";
const PLAYS = " The space bar plays and pauses.";
const LOST = "The graphics card has dropped this picture (WebGL context lost).";
const TAP = 6; // pixels that a finger may move while it taps
/** How far outside of the window a player is drawn already. */
const NEAR = { rootMargin: "20%" };
/** From where it is looked at first, in front and a little above, and how much farther away than would do. */
const [FRONT, ROOM] = [new Vector3(0.4, 0.3, 1).normalize(), 1.02];
const REFLECTED = ["src", "alt", "poster", "loop", "controls", "autoplay"];
const SPACES = { svg: "http://www.w3.org/2000/svg", html: "http://www.w3.org/1999/xhtml" };
/** Without a document, the class can still be imported. */
const Base = (globalThis.HTMLElement ?? Object) as typeof HTMLElement;

/**
 * A mesh as `<video>` has films. Attributes `src`, `alt` (what screen readers say), `autoplay` (not where the reader prefers
 * reduced motion), `controls`, `loop`, `rate` (times as fast), `disable-zoom`, `crease-angle`, and `poster`, a picture until
 * something is drawn. Events: `loadeddata` once something is drawn, `load` once all is there, an `ErrorEvent`, and `play`, `pause`,
 * `frame`, `loop`, `ended`, `waiting` of a sequence. Arrow keys turn it, plus and minus zoom, F, Home and a double click show all
 * of it, the space bar plays and pauses. All players of a page draw with one context.
 */
export class BSMPlayer extends Base {
    static readonly observedAttributes = "src alt aria-label loop rate poster controls disable-zoom crease-angle".split(
        " ",
    );
    declare src: string;
    declare alt: string;
    declare poster: string;
    declare loop: boolean;
    declare controls: boolean;
    declare autoplay: boolean;
    /** What `<video>` calls `rate`. */
    declare playbackRate: number;
    readonly loader = new BSMLoader();
    readonly scene = new Scene();
    readonly camera = new PerspectiveCamera(35);
    private readonly shadow = furnished(this.attachShadow({ mode: "open" }));
    readonly canvas = this.shadow.querySelector("canvas")!;
    /** Whether it can be seen, or nearly. */
    inView = true;
    /** What is played, once its first frame is there. */
    sequence?: BSMSequence;
    private content?: Group;
    /** What the mesh fills, of a sequence in all of `fitted` frames. */
    private ball = new Sphere(new Vector3(), 1);
    private fitted = 0;
    /** Whether `play` or `pause` was called last; undefined: neither was. */
    private asked?: boolean;
    /** Hears that it plays, or that it will not. */
    private plays: [keep: () => void, fail: (error: DOMException) => void][] = [];
    /** Seconds that are to be shown as soon as they are there. */
    private due?: number;
    private ratio = 0;
    /** Whether the reader has moved the camera. */
    private touched = false;
    private orbit?: OrbitControls;
    private readonly bar = this.shadow.querySelector<HTMLElement>(".bar")!;
    private readonly showBar = steerBy(this.bar, this);
    private readonly resizes = new ResizeObserver(() => this.fit());
    private readonly scrolls = new IntersectionObserver((seen) => (this.inView = seen.at(-1)!.isIntersecting), NEAR);
    /** What is loading, or wrong. */
    private readonly note = this.shadow.querySelector("p")!;
    private readonly picture = this.shadow.querySelector("img")!;
    /** Stops the load; what has been stopped is not shown. */
    private loading = new AbortController();

    /** 1 where the attribute says nothing that it can be. */
    get rate(): number {
        const rate = Number(this.getAttribute("rate") ?? 1);
        return rate >= 0 && rate < Infinity ? rate : 1;
    }

    set rate(rate: number) {
        this.setAttribute("rate", `${rate}`);
    }

    get paused(): boolean {
        return this.sequence ? !this.sequence.playing : !this.asked || this.content !== undefined;
    }

    get ended(): boolean {
        const { sequence } = this;
        return !!sequence?.complete && !sequence.loop && this.paused && sequence.frame === sequence.length - 1;
    }

    /** Seconds; 0 of what does not move. */
    get duration(): number {
        return this.sequence?.duration ?? 0;
    }

    get currentTime(): number {
        return this.due ?? (this.sequence ? this.sequence.frame / this.sequence.rate : 0);
    }

    set currentTime(seconds: number) {
        this.due = seconds;
        this.reach();
    }

    /** Play, or as soon as the first frame is there; the promise fails if it is paused or changed before. */
    play(): Promise<void> {
        this.asked = true;
        this.sequence?.play();
        if (this.content) return Promise.resolve();
        const begun = new Promise<void>((keep, fail) => this.plays.push([keep, fail]));
        begun.catch(() => {}); // who does not wait for it need not hear
        return begun;
    }

    pause(): void {
        this.asked = false;
        this.sequence?.pause();
        this.forgo();
    }

    private forgo(why = new DOMException("it will not play", "AbortError")): void {
        for (const [, fail] of this.plays.splice(0)) fail(why);
    }

    /** Show the time that was asked for, once its frame is there or no more will come. */
    private reach(): void {
        const { due, sequence } = this;
        if (this.content && !sequence) this.due = undefined; // what does not move has no time
        if (due === undefined || !sequence) return;
        const isThere = due * sequence.rate < sequence.geometry.frames.length;
        if (!isThere && !sequence.complete) return;
        this.due = undefined;
        sequence.seek(due * sequence.rate);
    }

    /** Play, or pause. */
    toggle(): void {
        if (this.paused) void this.play();
        else this.pause();
    }

    connectedCallback(): void {
        const { camera, canvas, scene } = this;
        for (const name of [...REFLECTED, "rate", "playbackRate", "currentTime"] as "src"[]) {
            if (!Object.hasOwn(this, name)) continue; // a page set it before there was this class
            const value = this[name];
            Reflect.deleteProperty(this, name);
            this[name] = value;
        }
        const sheet = new (this.ownerDocument.defaultView as Window & typeof globalThis).CSSStyleSheet();
        sheet.replaceSync(style); // policies allow it, and it is of the document that the element is in now
        this.shadow.adoptedStyleSheets = [sheet];
        this.orbit = new OrbitControls(camera, canvas);
        this.orbit.addEventListener("change", () => this.redraw());
        this.orbit.addEventListener("start", () => (this.touched = true));
        canvas.style.touchAction = ""; // which the element has: a page scrolls over it
        canvas.onkeydown = (event) => this.act(event);
        canvas.ondblclick = () => this.home();
        this.describe();
        this.listenToTaps();
        this.steer();
        const sun = new DirectionalLight(0xffffff, 2);
        sun.position.set(1, 1, 1);
        camera.clear().add(sun);
        scene.clear().add(new HemisphereLight(0xffffff, 0x888888, 1.5), camera);
        this.resizes.observe(this);
        this.scrolls.observe(this);
        try {
            hang(this);
        } catch (error) {
            return this.fail(new Error(`WebGL is not available. ${error instanceof Error ? error.message : error}`));
        }
        this.fit();
        this.open();
    }

    disconnectedCallback(): void {
        takeDown(this);
        this.empty();
        this.resizes.disconnect();
        this.scrolls.disconnect();
        this.orbit?.dispose();
        this.orbit = undefined;
    }

    attributeChangedCallback(name: string): void {
        if (name === "src") this.asked = undefined;
        if (name === "src" || name === "crease-angle") this.open();
        if (name === "alt" || name === "aria-label") this.describe();
        if (name === "poster") this.hold();
        if (name === "controls" || name === "disable-zoom") this.steer();
        if (this.sequence) [this.sequence.loop, this.sequence.speed] = [this.loop, this.rate];
    }

    /** Draw again, after a change of `scene` or `camera`. */
    redraw(): void {
        redraw(this);
    }

    /** Say that nothing can be drawn for a while, or no longer that. */
    lose(isLost: boolean): void {
        if (isLost) return this.fail(new Error(LOST));
        if (this.note.textContent === LOST) this.note.textContent = "";
        this.redraw();
    }

    /** Move on by some seconds; returns whether the picture is another one then. */
    step(seconds: number): boolean {
        if (this.ratio !== devicePixelRatio) this.fit(); // on another screen
        const frame = this.sequence?.frame;
        this.sequence?.update(seconds);
        return this.sequence?.frame !== frame;
    }

    /** Show what a reader may do: without controls, where motion is not wished for, they start a sequence. */
    private steer(): void {
        if (!this.orbit) return;
        this.bar.hidden = !this.controls && !(this.autoplay && this.isCalm);
        this.orbit.enableZoom = !this.hasAttribute("disable-zoom");
        this.showBar();
    }

    /** Whether the reader prefers reduced motion. */
    private get isCalm(): boolean {
        return matchMedia("(prefers-reduced-motion: reduce)").matches;
    }

    /** A tap or click on the picture plays and pauses where there are controls, as in videos. */
    private listenToTaps(): void {
        const { canvas } = this;
        let from = [NaN, NaN];
        canvas.onpointerdown = ({ clientX, clientY }) => (from = [clientX, clientY]);
        canvas.onclick = ({ clientX, clientY }) => {
            const isTap = Math.hypot(clientX - from[0], clientY - from[1]) < TAP;
            if (isTap && !this.bar.hidden) this.toggle();
        };
    }

    /** Tell who does not see it what it is, and what keys do. */
    private describe(): void {
        const { canvas } = this;
        canvas.setAttribute("aria-label", this.getAttribute("aria-label") || this.getAttribute("alt") || LABEL);
        canvas.setAttribute("aria-description", this.sequence ? KEYS + PLAYS : KEYS);
    }

    /** Show all of it, from the front. */
    home(): void {
        this.touched = false;
        this.aim();
        this.redraw();
    }

    private act(event: KeyboardEvent): void {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        if (event.key === " " && this.sequence) this.toggle();
        else if (/^(f|home)$/i.test(event.key)) this.home();
        else if (!this.orbit || !turnBy(event.key, this.orbit)) return;
        else this.touched = true;
        event.preventDefault();
        this.orbit?.update();
        this.redraw();
    }

    /** Show the poster as long as there is nothing else. */
    private hold(): void {
        if (this.poster && !this.content) this.picture.src = this.poster;
        else this.picture.removeAttribute("src");
    }

    private fail(error: unknown): void {
        this.note.textContent = error instanceof Error ? error.message : `${error}`;
        this.forgo(new DOMException(this.note.textContent, "NotSupportedError"));
        this.dispatchEvent(new ErrorEvent("error", { error, message: `${error}` }));
    }

    private open(): void {
        if (!this.orbit) return;
        this.empty();
        this.hold();
        this.note.textContent = "";
        if (!this.src) return;
        const crease = Number(this.getAttribute("crease-angle") ?? NaN);
        this.loader.creaseAngle = crease >= 0 ? crease : undefined;
        const { signal } = (this.loading = new AbortController());
        const mine = (): boolean => !signal.aborted;
        const failed = (error: unknown): void => void (mine() && this.fail(error));
        this.note.textContent = "Loading";
        const onProgress = ({ lengthComputable, loaded, total }: ProgressEvent): void => {
            if (mine() && !this.content && lengthComputable)
                this.note.textContent = `Loading, ${Math.floor((100 * loaded) / total)} %`;
        };
        let first: Promise<void> | undefined;
        let moving: BSMSequence | undefined;
        const onFrame = (index: number, geometry: BSMGeometry): void => {
            if (mine() && this.content && geometry.frames.length >= 2 * this.fitted) this.measure(geometry);
            if (mine()) this.reach();
            if (index > 0 || !mine()) return;
            first = this.show(geometry, mine, (moving = new BSMSequence(geometry, false))).catch(failed);
        };
        /** No more frames will come. */
        const settle = (): void => {
            if (!moving) return;
            moving.complete = true;
            void first?.then(() => mine() && this.content && (this.measure(moving!.geometry), this.reach()));
        };
        const loading = this.loader.loadAsync(this.src, onProgress, { onFrame, signal }).finally(settle);
        loading
            .then((geometry) => first ?? this.show(geometry, mine))
            .then(() => mine() && this.say("load"))
            .catch((error) => Promise.resolve(first).then(() => failed(error)));
    }

    private async show(geometry: BSMGeometry, mine: () => boolean, sequence?: BSMSequence): Promise<void> {
        const content = await sceneOf(geometry);
        if (!mine()) return;
        this.scene.add((this.content = content));
        this.sequence = sequence;
        this.measure(geometry);
        this.hold();
        this.note.textContent = "";
        this.say("loadeddata");
        for (const [keep] of this.plays.splice(0)) keep();
        if (!sequence) return this.reach();
        this.describe();
        [sequence.loop, sequence.speed] = [this.loop, this.rate];
        for (const type of PASSED) sequence.addEventListener(type, (event) => this.say(type, event));
        sequence.addEventListener("frame", () => this.say("timeupdate"));
        if (this.asked ?? (this.autoplay && !this.isCalm)) sequence.play();
        this.steer();
        this.reach();
    }

    /** Look at all of it, in all frames that are there. */
    private measure({ frames, boundingSphere }: BSMGeometry): void {
        const [all, one] = [new Box3(), new Box3()];
        for (const { positions } of frames) all.union(one.setFromArray(positions));
        this.fitted = frames.length;
        this.ball = frames.length > 0 ? all.getBoundingSphere(new Sphere()) : boundingSphere!.clone();
        this.ball.center.applyEuler(this.content!.rotation);
        this.fit();
    }

    /** Have the ball fill the shorter side, until the reader chooses another place. */
    private aim(): void {
        const { ball, camera, orbit } = this;
        const half = Math.atan(Math.tan((Math.PI / 360) * camera.fov) * Math.min(camera.aspect, 1));
        const far = (ROOM * ball.radius) / Math.sin(half) || 1;
        [camera.near, camera.far] = [(REACH[0] * far) / 4, 2 * REACH[1] * far];
        if (orbit) [orbit.minDistance, orbit.maxDistance] = REACH.map((share) => share * far);
        camera.position.copy(FRONT).multiplyScalar(far).add(ball.center);
        orbit?.target.copy(ball.center);
        orbit?.update();
    }

    private fit(): void {
        const [width, height] = [this.clientWidth || 300, this.clientHeight || 150];
        this.ratio = devicePixelRatio;
        this.canvas.width = Math.max(1, Math.round(width * devicePixelRatio));
        this.canvas.height = Math.max(1, Math.round(height * devicePixelRatio));
        this.camera.aspect = width / height;
        if (!this.touched) this.aim();
        this.camera.updateProjectionMatrix();
        this.redraw();
    }

    private empty(): void {
        this.loading.abort();
        this.forgo();
        this.content?.removeFromParent();
        this.sequence?.dispose();
        this.content?.traverse((mesh) => (mesh as Partial<Mesh>).geometry?.dispose());
        if (this.content) disposeOf(materialsIn(this.content));
        if (this.content) this.due = undefined; // a time that was asked for before there was anything stays
        [this.content, this.sequence, this.touched] = [undefined, undefined, false];
        this.redraw();
    }

    private say(type: string, detail?: unknown): void {
        if (!this.bar.hidden) this.showBar();
        this.dispatchEvent(new CustomEvent(type, { detail }));
    }
}

/** A root with the elements of the player, which no policy of the page around it forbids. */
function furnished(root: ShadowRoot): ShadowRoot {
    root.append(...page.map(built));
    return root;
}

function built([tag, attributes, ...inside]: Tree): Element {
    const element = document.createElementNS(/svg|path/.test(tag) ? SPACES.svg : SPACES.html, tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.append(...inside.map(built));
    return element;
}

/** Have the elements of a bar steer a player; returns what shows there where the player is. */
function steerBy(bar: HTMLElement, player: BSMPlayer): () => void {
    const [button, full] = bar.querySelectorAll("button");
    const [range, time] = [bar.querySelector("input")!, bar.querySelector("output")!];
    const show = (): void => {
        const { currentTime, duration, paused } = player;
        bar.classList.toggle("still", !(duration > 0));
        bar.classList.toggle("paused", paused);
        button.setAttribute("aria-label", paused ? "Play" : "Pause");
        range.step = player.sequence ? `${1 / player.sequence.rate}` : "any"; // arrow keys go on by a frame
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

/** Properties that are attributes. */
for (const name of REFLECTED) {
    const isText = name === "src" || name === "alt" || name === "poster";
    Object.defineProperty(BSMPlayer.prototype, name, {
        get(this: BSMPlayer): unknown {
            return isText ? (this.getAttribute(name) ?? "") : this.hasAttribute(name);
        },
        set(this: BSMPlayer, value: unknown) {
            if (isText && value !== undefined && value !== null) this.setAttribute(name, `${value}`);
            else this.toggleAttribute(name, Boolean(value));
        },
    });
}

const { rate } = Object.getOwnPropertyDescriptors(BSMPlayer.prototype);
Object.defineProperty(BSMPlayer.prototype, "playbackRate", rate);

if (globalThis.customElements && !customElements.get("bsm-player")) customElements.define("bsm-player", BSMPlayer);

declare global {
    interface HTMLElementTagNameMap {
        "bsm-player": BSMPlayer;
    }
}
// @ts-ignore: only where React is
declare module "react" {
    namespace JSX {
        interface IntrinsicElements {
            "bsm-player": Record<string, unknown>;
        }
    }
}
