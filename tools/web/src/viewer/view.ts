/** A stream as it arrives, cut at any byte, over a link of any speed; sequences play. */
import { BufferAttribute } from "three";
import { BSMGeometry } from "../geometry";
import { imagesOf, materialsOf, turnOf } from "../materials";
import { errorLike, type Header, type LossEvent } from "../index";
import type { Pool, StreamDecoding } from "../pool";
import { coloursOf, errorsOf, LEGENDS, type Errors, type Scheme } from "./colours";
import { Playback } from "../playback";
import { Stage } from "./stage";
import { TileSet } from "./tiles";
import template from "./view.html";

/** Draco's file of a mesh that keeps the normals as well as the stream. */
export interface Rival {
    bytes: number;
    bits: number;
    theta: number;
}

/** A stream, and what it is compared with: the original's positions as the stream numbers them. */
export interface Content {
    name: string;
    /** Whether it is still being written, so that what was before one came is not missed. */
    live?: boolean;
    original?: Float32Array;
    draco?: Rival;
}

const SECOND = 1000;
/** Of materials, the most that mirrors. */
const PALE = 0.3;

/** Middle and diagonal of the box that a mesh fills, about, in its own unit. */
function extentOf({ center, scale, grid, lattice }: Header): { center: number[]; diagonal: number } {
    if (grid.length === 0) return { center, diagonal: scale };
    const cell = lattice.length > 0 ? (scale * lattice[0]) / lattice[1] : scale;
    return { center: center.map((origin, d) => origin + (cell * grid[d]) / 2), diagonal: cell * Math.max(Math.hypot(...grid), 1) };
}

function counted(count: number): string {
    return count.toLocaleString("en");
}

function spent(milliseconds: number): string {
    return `${(milliseconds / SECOND).toFixed(2)} s`;
}

/** The controls and the canvas, in any element of a page; it says how far it is in `data-state`. */
export class View {
    private readonly streams: HTMLSelectElement;
    private readonly stage: Stage;
    private readonly cut: HTMLInputElement;
    private readonly rate: HTMLInputElement;
    private readonly frame: HTMLInputElement;
    private readonly colour: HTMLSelectElement;
    private readonly play: HTMLButtonElement;
    private content: Content = { name: "" };
    /** What has come of the stream, with room for more; how many bytes that is, and whether it is all. */
    private stream = new Uint8Array(0);
    private length = 0;
    private whole = false;
    /** Frames that had gone by when a live stream was entered. */
    private missed = 0;
    private geometry = new BSMGeometry();
    private decoding?: StreamDecoding;
    private playback?: Playback;
    private errors?: Errors;
    private dressed = false;
    private fed = 0;
    private started = 0;
    private firstDrawn?: number;
    private completed?: number;
    private losses: LossEvent[] = [];
    private over = true;
    /** Whether the decoder knows that no more bytes come. */
    private ended = false;
    private shown = true;
    private stale = false;
    private frameShown = -1;
    private closed = false;
    private tiles?: TileSet;
    /** From where tiles were chosen; undefined before the first time. */
    private looked?: string;

    constructor(
        private readonly root: HTMLElement,
        private readonly pool: Pool,
        licences: string,
    ) {
        root.classList.add("bsm");
        root.innerHTML = template;
        this.streams = this.control("stream");
        [this.cut, this.rate, this.frame] = [this.control("cut"), this.control("rate"), this.control("frame")];
        [this.colour, this.play] = [this.control("colour"), this.control("play")];
        const [wireframe, flat, loop] = ["wireframe", "flat", "loop"].map((name) => this.control<HTMLInputElement>(name));
        this.part("licences").textContent = licences;
        try {
            this.stage = new Stage(root.querySelector("canvas")!);
        } catch (error) {
            this.fail(`This browser does not draw in three dimensions. ${error instanceof Error ? error.message : error}`);
            throw error;
        }
        wireframe.addEventListener("change", () => (this.stage.wireframe = wireframe.checked));
        flat.addEventListener("change", () => (this.stage.flat = flat.checked));
        this.colour.addEventListener("change", () => (this.stale = true));
        this.control("again").addEventListener("click", () => this.restart());
        this.play.addEventListener("click", () => this.toggle());
        this.frame.addEventListener("input", () => this.seek(Number(this.frame.value)));
        loop.addEventListener("change", () => this.playback && (this.playback.loop = loop.checked));
        root.querySelector("form")!.addEventListener("submit", (event) => event.preventDefault());
        const go = (now: number): void => {
            if (this.closed) return;
            this.step(now);
            requestAnimationFrame(go);
        };
        requestAnimationFrame(go);
    }

    /** Let the reader choose among streams of these names. */
    offer(names: string[], choose: (index: number) => void): void {
        names.forEach((name, i) => this.streams.add(new Option(name, String(i))));
        this.streams.addEventListener("change", () => choose(Number(this.streams.value)));
    }

    /** Show another stream, whose bytes will come. */
    open(content: Content): void {
        if (this.streams.length === 0) this.offer([content.name], () => this.restart());
        this.content = content;
        [this.stream, this.length, this.whole] = [new Uint8Array(0), 0, false];
        this.cut.max = this.cut.value = "0";
        this.allow("error", content.original !== undefined);
        this.restart();
    }

    /** Show tiles of a folder, as far as they are worth it. */
    async openTiles(name: string, url: string): Promise<void> {
        this.open({ name });
        this.over = true;
        const tiles = await TileSet.open(url, this.pool, () => (this.looked = ""));
        if (this.closed || this.content.name !== name || this.tiles) return tiles.close();
        this.tiles = tiles;
    }

    /** Look for the tiles that are to be seen, when the camera has moved or some have come. */
    private walk(tiles: TileSet): void {
        const { center, diagonal } = tiles.extent;
        const { place, pixels } = this.stage.eye;
        const looked = [...place, pixels].join();
        if (looked === this.looked) return;
        const first = this.looked === undefined;
        this.looked = looked;
        if (first) this.stage.together([], center, diagonal);
        else tiles.look(place, pixels);
        const shown = tiles.shown;
        this.stage.together(shown, center, diagonal);
        const faces = shown.reduce((sum, geometry) => sum + geometry.getIndex()!.count / 3, 0);
        this.say("status", `${shown.length} tiles, ${counted(faces)} faces`);
        this.part("problem").textContent = tiles.problem;
        this.root.dataset.tiles = String(shown.length);
        this.root.dataset.faces = String(faces);
        this.root.dataset.state = !tiles.complete ? "loading" : tiles.problem ? "damaged" : "complete";
        if (first) this.looked = "";
    }

    /** Take bytes of the stream. */
    receive(bytes: Uint8Array): void {
        const length = this.length + bytes.length;
        if (length > this.stream.length) {
            const stream = new Uint8Array(Math.max(length, 2 * this.stream.length));
            stream.set(this.stream.subarray(0, this.length));
            this.stream = stream;
        }
        this.stream.set(bytes, this.length);
        const all = this.cut.value === this.cut.max;
        this.length = length;
        this.cut.max = String(length);
        if (all) this.cut.value = this.cut.max;
    }

    /** Take note that all bytes have come. */
    finish(): void {
        this.whole = true;
    }

    /** Offer a way to colour, or not. */
    private allow(scheme: Scheme, allowed: boolean): void {
        const option = this.colour.querySelector<HTMLOptionElement>(`[value=${scheme}]`)!;
        option.hidden = option.disabled = !allowed;
        if (option.selected && !allowed) this.colour.value = "plain";
    }

    /** Say that there is nothing to show. */
    fail(problem: string): void {
        this.over = true;
        this.part("problem").textContent = problem;
        this.root.dataset.state = "failed";
    }

    /** Stop, and give back what it holds. */
    close(): void {
        this.closed = true;
        this.decoding?.close();
        this.tiles?.close();
        this.stage.dispose();
    }

    private control<Kind extends HTMLElement>(name: string): Kind {
        return this.root.querySelector<Kind>(`[name=${name}]`)!;
    }

    private part(name: string): HTMLElement {
        return this.root.querySelector<HTMLElement>(`[data-part=${name}]`)!;
    }

    /** Decode from the first byte on; what is shown stays until there is something else. */
    private restart(): void {
        this.decoding?.close();
        this.tiles?.close();
        this.tiles = this.looked = undefined;
        const geometry = new BSMGeometry({ onConnectivity: () => (this.stale = true), onBlock: () => this.drawn(), onFrame: () => this.begin(geometry) });
        this.geometry = geometry;
        this.playback = undefined;
        this.fed = 0;
        this.frameShown = -1;
        this.firstDrawn = this.completed = undefined;
        this.errors = undefined;
        this.dressed = false;
        this.allow("own", false);
        this.losses = [];
        this.missed = 0;
        this.shown = this.over = this.ended = false;
        this.started = performance.now();
        this.part("problem").textContent = "";
        this.root.dataset.state = "loading";
        this.decoding = this.pool.open(
            {
                onPicture: (picture) => {
                    geometry.accept(picture);
                    if (picture.type === "loss") this.lose(picture);
                    if (picture.type === "end") this.end();
                },
                onError: (error) => this.fail(`This stream cannot be decoded further. ${error.name}: ${error.message}`),
                onTaken: (bytes) => {
                    this.root.dataset.taken = String(bytes);
                    if (bytes === this.fed) this.show();
                },
            },
            { tolerant: true, drawing: "growing" },
        );
    }

    /** Go on for one picture. */
    private step(now: number): void {
        if (this.tiles) return this.walk(this.tiles);
        if (Number(this.cut.value) < this.fed) this.restart();
        const allowed = this.allowed();
        if (!this.over && this.fed < allowed) {
            this.decoding?.receiveData(this.stream.subarray(this.fed, allowed));
            this.fed = allowed;
        }
        if (this.whole && !this.ended && this.fed === this.length) {
            this.ended = true;
            this.decoding?.receiveEof();
        }
        this.playOn(now);
        if (this.stale && this.shown) this.paint();
        this.report();
    }

    private allowed(): number {
        const rate = Number(this.rate.value);
        const link = rate > 0 ? (rate * (performance.now() - this.started)) / 8e-3 : Infinity;
        return Math.floor(Math.min(Number(this.cut.value), link));
    }

    /** Put the geometry on the stage, if it is not there. */
    private show(): void {
        const { header } = this.geometry;
        if (this.shown || this.closed) return;
        this.shown = this.stale = true;
        const { center, diagonal } = header ? extentOf(header) : { center: [0, 0, 0], diagonal: 1 };
        this.stage.show(this.geometry, center, diagonal, turnOf(this.geometry.metadata));
    }

    /** Say what is lost; what could be decoded stays to be seen. */
    private lose(loss: LossEvent): void {
        if (this.content.live && loss.frames?.first === 0) {
            this.missed = loss.frames.count;
            return;
        }
        this.losses.push(loss);
        const blocks = this.losses.flatMap(({ block }) => (block === undefined ? [] : [block]));
        const frames = this.losses.reduce((sum, { frames }) => sum + (frames?.count ?? 0), 0);
        const lost = [blocks.length > 0 ? `block${blocks.length > 1 ? "s" : ""} ${blocks.join(", ")}` : "", frames > 0 ? `${frames} frames` : ""];
        const { name, message } = errorLike(this.losses[0].error);
        const what = lost.filter(Boolean).join(" and ") || "some bytes";
        this.part("problem").textContent = `This stream is damaged: ${what} cannot be decoded, the rest is shown. First, ${name}: ${message}`;
    }

    private drawn(): void {
        this.firstDrawn ??= performance.now() - this.started;
        this.show();
        this.stale = true;
    }

    private end(): void {
        this.over = true;
        this.stale = true;
        if (this.geometry.colour) this.wear();
        void this.dress(this.geometry);
        this.completed = performance.now() - this.started;
        this.root.dataset.state = this.losses.length > 0 ? "damaged" : "complete";
    }

    /** Offer what the stream has of colours and materials, and show it. */
    private wear(): void {
        this.allow("own", true);
        if (this.colour.value === "plain") this.colour.value = "own";
        this.stale = true;
    }

    /** Make materials of what the metadata say, once images are there. */
    private async dress(geometry: BSMGeometry): Promise<void> {
        const named = [...geometry.metadata.keys()].some((key) => key.startsWith("material."));
        if (!named) return;
        const images = await imagesOf(geometry.metadata);
        if (geometry !== this.geometry || this.closed) return;
        const materials = materialsOf(geometry.metadata, images, 1 + Math.max(0, ...geometry.pieces.map(({ material }) => material)));
        for (const material of materials) {
            material.vertexColors = this.geometry.colour !== undefined;
            material.metalness = Math.min(material.metalness, PALE); // there is nothing here that metal could mirror
        }
        this.stage.dress(materials);
        this.dressed = true;
        this.wear();
    }

    /** Frames are there: begin to play them, unless the page's reader wants less motion. */
    private begin(geometry: BSMGeometry): void {
        this.playback ??= new Playback(geometry.frameRate, !matchMedia("(prefers-reduced-motion: reduce)").matches);
        this.playback.loop = this.control<HTMLInputElement>("loop").checked;
    }

    private toggle(): void {
        const { playback, geometry, over } = this;
        if (!playback) return;
        playback.playing = !playback.playing;
        if (playback.playing && over && playback.frame === geometry.frames.length - 1) playback.seek(0);
        this.label(playback);
    }

    private label({ playing }: Playback): void {
        this.play.textContent = playing ? "Pause" : "Play";
    }

    private seek(frame: number): void {
        this.playback?.seek(Math.min(frame, this.geometry.frames.length - 1));
    }

    private playOn(now: number): void {
        const { playback, geometry, missed } = this;
        const part = this.part("sequence");
        part.hidden = !playback;
        if (!playback) return;
        const there = geometry.frames.length;
        playback.step(now, there, this.over);
        if (playback.frame !== this.frameShown) {
            this.frameShown = playback.frame;
            geometry.showFrame(this.frameShown);
            this.stale = true;
        }
        const total = Math.max(geometry.header!.frames - missed, there);
        this.root.dataset.frame = String(this.frameShown);
        this.root.dataset.there = String(there);
        this.frame.max = String(total - 1);
        this.frame.value = String(this.frameShown);
        this.label(playback);
        const ahead = there < total ? `, ${there} are there` : "";
        const place = `${missed + this.frameShown + 1} of ${missed + total}`;
        this.say("time", `${place}${ahead}; ${spent(((missed + this.frameShown) / playback.rate) * SECOND)}`);
        this.frame.setAttribute("aria-valuetext", `frame ${place}`);
    }

    /** Colours and errors of what is there. */
    private paint(): void {
        const { original } = this.content;
        const scheme = this.colour.value as Scheme;
        this.stale = false;
        this.errors = original && this.geometry.origin.length > 0 ? errorsOf(this.geometry, original) : undefined;
        this.part("legend").textContent = LEGENDS[scheme];
        const colours = coloursOf(this.geometry, scheme, this.errors?.distances);
        this.stage.colour(scheme === "own" ? this.geometry.colour : colours && new BufferAttribute(colours, 3), scheme === "own" && this.dressed);
    }

    private report(): void {
        const { fed, geometry, length, errors, root } = this;
        const share = length ? Math.round((100 * fed) / length) : 0;
        this.say("bytes", `${counted(fed)} of ${counted(length)} bytes (${share} %)${this.whole ? "" : ", more are to come"}`);
        this.say("status", this.statusText());
        const times = [["first faces", this.firstDrawn], ["complete", this.completed]] as const;
        this.say("times", times.flatMap(([name, time]) => (time === undefined ? [] : [`${name} after ${spent(time)}`])).join("; "));
        this.say("draco", this.rivalText());
        const percent = (value: number): string => `${(100 * value).toPrecision(3)} %`;
        this.say("error", errors ? `Off the original: ${percent(errors.rms)} of the diagonal (rms), at most ${percent(errors.farthest)}; normals ${errors.angle.toFixed(2)} degrees` : "");
        root.dataset.blocks = String(geometry.blocks);
    }

    private statusText(): string {
        const { header, blocks, refinedVertices } = this.geometry;
        if (!header) return "";
        const parts = header.blocks ? `${blocks} of ${header.blocks} blocks` : `${blocks} chunks of a grid`;
        const quality = header.refinement.length > 0 ? `, ${Math.floor((100 * refinedVertices) / header.vertices)} % refined` : "";
        const entered = this.missed > 0 ? `, entered at frame ${this.missed + 1}` : "";
        const frames = header.gopFrames > 0 ? `, ${header.frames || "any number of"} frames${entered}` : "";
        const attributes = header.attributes > 0 ? `, ${this.geometry.carried.length} of ${header.attributes} attributes` : "";
        return `${parts}${quality}, ${counted(header.vertices)} vertices${frames}${attributes}`;
    }

    private rivalText(): string {
        const { draco } = this.content;
        if (!draco) return "";
        const rate = Number(this.rate.value);
        const time = rate > 0 ? `: there after ${spent((8 * draco.bytes) / rate / 1e3)}` : "";
        return `Draco's file, ${draco.bits} bits, ${draco.theta.toFixed(2)} degrees, has ${counted(draco.bytes)} bytes${time}`;
    }

    private say(part: string, text: string): void {
        const element = this.part(part);
        if (element.textContent !== text) element.textContent = text;
    }
}
