/** A stream as it arrives, beside its original and Draco; sequences play, tiles come as they are looked at. */
import { BufferAttribute } from "three";
import { BSMGeometry } from "../geometry";
import { imagesOf, materialsOf, turnOf } from "../materials";
import { errorLike, type Header, type LossEvent } from "../index";
import type { Pool, StreamDecoding } from "../pool";
import { colorsOf, LEGENDS, RAMP, topOf, type Scheme } from "./colors";
import { counted, element, factsOf, percent, sized, spent, type Content, type Row } from "./facts";
import { bytesOf } from "./inlined";
import { Playback } from "../playback";
import { Stage, type Mode, type Shading } from "./stage";
import { TileSet, wholeOf } from "./tiles";
import template from "./view.html";

/** Encodes a file: lines of what is done, and the share of it; then what there is to be shown. */
export type Encode = (file: File, preset: string, report: (stage: string, share: number) => void, signal: AbortSignal) => Promise<Content>;

const SECOND = 1000;
const SAMPLED = 12; // frames that the camera makes room for
const DIGITS = ["1", "2", "3"];

/** Middle and diagonal of the box that a mesh fills, about, in its own unit. */
function extentOf({ center, scale, grid, lattice }: Header): { center: number[]; diagonal: number } {
    if (grid.length === 0) return { center, diagonal: scale };
    const cell = lattice.length > 0 ? (scale * lattice[0]) / lattice[1] : scale;
    return { center: center.map((origin, d) => origin + (cell * grid[d]) / 2), diagonal: cell * Math.max(Math.hypot(...grid), 1) };
}

/** The controls and the canvas, in any element of a page; it says how far it is in `data-state`. */
export class View {
    private readonly stage: Stage;
    private readonly cut: HTMLInputElement;
    private readonly rate: HTMLInputElement;
    private readonly frame: HTMLInputElement;
    private readonly scheme: HTMLSelectElement;
    private readonly play: HTMLButtonElement;
    private content: Content = { name: "", main: 0, layers: [], facts: {} };
    /** What has come of the stream, with room for more; how many bytes that is, and whether it is all. */
    private stream = new Uint8Array(0);
    private length = 0;
    private whole = false;
    private missed = 0;
    private geometry = new BSMGeometry();
    private geometries: (BSMGeometry | undefined)[] = [];
    private offs: (Float32Array | undefined)[] = [];
    private readonly dressed = new Set<number>();
    private decoding?: StreamDecoding;
    private playback?: Playback;
    private fed = 0;
    private started = 0;
    private firstDrawn?: number;
    private completed?: number;
    private alone?: number;
    /** Whether the layers beside the stream are there, or on their way. */
    private accompanied = false;
    private losses: LossEvent[] = [];
    private over = true;
    private ended = false;
    private shown = true;
    private stale = false;
    private frameShown = -1;
    /** Milliseconds that a sequence has played, and when that was. */
    private clock = 0;
    private before = 0;
    private closed = false;
    private tiles?: TileSet;
    private looked?: string;
    private choose: (index: number) => void = () => this.restart();
    private working?: AbortController;
    private turns = 0;
    private readonly watch = new ResizeObserver(() => this.place());

    constructor(
        private readonly root: HTMLElement,
        private readonly pool: Pool,
        licenses: string,
        private readonly encode?: Encode,
    ) {
        root.classList.add("bsm");
        root.innerHTML = template;
        [this.cut, this.rate, this.frame] = [this.control("cut"), this.control("rate"), this.control("frame")];
        [this.scheme, this.play] = [this.control("color"), this.control("play")];
        this.part("licenses").textContent = licenses;
        this.part("scale").querySelector("div")!.style.background = RAMP;
        try {
            this.stage = new Stage(root.querySelector("canvas")!);
        } catch (error) {
            this.fail(`WebGL is not available. ${error instanceof Error ? error.message : error}`);
            throw error;
        }
        this.listen();
        this.watch.observe(root);
        const go = (now: number): void => {
            if (this.closed) return;
            this.step(now);
            requestAnimationFrame(go);
        };
        requestAnimationFrame(go);
    }

    /** Let the reader choose among streams of these names; ask for a file where there are none. */
    offer(names: string[], choose: (index: number) => void): void {
        const streams = this.control<HTMLSelectElement>("stream");
        this.choose = choose;
        names.forEach((name, i) => streams.add(new Option(name, String(i))));
        this.part("name").hidden = names.length > 1;
        streams.hidden = names.length < 2;
        this.part("invite").hidden = names.length > 0;
        if (names.length === 0) this.root.dataset.state = "empty";
    }

    /** Begin to show something else; returns whether nothing else has been begun since. */
    turn(): () => boolean {
        const turn = ++this.turns;
        return () => turn === this.turns;
    }

    /** Show another stream, whose bytes will come; `index` if it is one of those that are offered. */
    open(content: Content, index = -1): void {
        const streams = this.control<HTMLSelectElement>("stream");
        streams.selectedIndex = index;
        this.part("name").hidden = index >= 0 && streams.length > 1;
        this.content = content;
        [this.stream, this.length, this.whole] = [new Uint8Array(0), 0, false];
        this.cut.max = this.cut.value = "0";
        [this.geometries, this.offs] = [[], []];
        [this.alone, this.accompanied] = [undefined, false];
        this.dressed.clear();
        this.stage.clear();
        this.part("name").textContent = content.name;
        this.part("invite").hidden = true;
        this.part("arrival").hidden = this.part("colors").hidden = content.tiles !== undefined;
        this.list();
        this.restart();
        this.headline();
    }

    async openTiles(content: Content, index: number): Promise<void> {
        this.open(content, index);
        this.over = true;
        const tiles = await TileSet.open(content.tiles!, this.pool, () => (this.looked = ""));
        if (this.closed || this.content !== content || this.tiles) return tiles.close();
        this.tiles = tiles;
    }

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

    finish(): void {
        this.whole = true;
    }

    fail(problem: string): void {
        this.over = true;
        this.complain(problem);
        this.root.dataset.state = "failed";
    }

    close(): void {
        this.closed = true;
        this.watch.disconnect();
        this.working?.abort();
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

    private complain(problem: string): void {
        this.part("problem").textContent = problem;
    }

    private listen(): void {
        const { root, stage } = this;
        const on = (name: string, type: string, act: (control: HTMLInputElement) => void): void => {
            for (const control of root.querySelectorAll<HTMLInputElement>(`[name=${name}]`)) control.addEventListener(type, () => act(control));
        };
        on("stream", "change", ({ value }) => this.choose(Number(value)));
        on("mode", "change", () => this.compare());
        on("shading", "change", ({ value }) => stage.shade(value as Shading));
        on("color", "change", () => (this.stale = true));
        on("wipe", "input", () => this.compare());
        on("light", "input", ({ value }) => (stage.light = Number(value)));
        on("spin", "change", ({ checked }) => (stage.spin = checked));
        on("back", "change", ({ value }) => (root.dataset.back = value));
        on("again", "click", () => this.restart());
        on("play", "click", () => this.toggle());
        on("frame", "input", ({ value }) => this.playback?.seek(Math.min(Number(value), this.geometry.frames.length - 1)));
        on("loop", "change", ({ checked }) => this.playback && (this.playback.loop = checked));
        on("theme", "click", () => (root.dataset.theme = this.isDark ? "light" : "dark"));
        for (const part of ["panel", "keys"]) on(part, "click", () => this.unfold(part));
        on("picture", "click", () => this.stage.picture(...this.captions).toBlob((blob) => blob && this.save(blob, "png")));
        on("film", "click", (button) => void this.film(button));
        on("cancel", "click", () => this.working?.abort());
        on("file", "change", (input) => input.files?.[0] && void this.take(input.files[0]));
        root.querySelector("form")!.addEventListener("submit", (event) => event.preventDefault());
        root.addEventListener("keydown", (event) => this.key(event));
        const drop = this.part("drop");
        root.addEventListener("dragover", (event) => {
            event.preventDefault();
            drop.hidden = false;
        });
        root.addEventListener("dragleave", (event) => (drop.hidden = !event.relatedTarget || !root.contains(event.relatedTarget as Node)));
        root.addEventListener("drop", (event) => {
            event.preventDefault();
            drop.hidden = true;
            const file = event.dataTransfer?.files[0];
            if (file) void this.take(file);
        });
        if (matchMedia("(min-width: 45rem)").matches) this.part("more").setAttribute("open", "");
    }

    private unfold(part: string): void {
        for (const each of ["panel", "keys"]) {
            const hidden = each !== part || !this.part(each).hidden;
            this.part(each).hidden = hidden;
            this.control(each).setAttribute("aria-expanded", String(!hidden));
        }
    }

    private key({ key: typed, target, ctrlKey, metaKey, altKey }: KeyboardEvent): void {
        if (ctrlKey || metaKey || altKey || (target as HTMLElement).matches("select, [type=number]")) return;
        const key = typed.toLowerCase();
        const pick = (name: string, value: string): void => this.root.querySelector<HTMLInputElement>(`[name=${name}][value="${value}"]:not(:disabled)`)?.click();
        const next = <Value>(values: Value[], now: Value): Value => values[(values.indexOf(now) + 1) % values.length];
        if (DIGITS.includes(key)) pick("layer", String(DIGITS.indexOf(key)));
        else if (key === "w" || key === "s") pick("mode", this.stage.mode === (key === "w" ? "wipe" : "split") ? "one" : key === "w" ? "wipe" : "split");
        else if (key === "f") pick("shading", next(["smooth", "flat", "wire"], this.picked("shading")));
        else if (key === "e") this.paint(this.scheme.value !== "error" ? "error" : this.dressed.size > 0 || this.geometry.color ? "own" : "plain");
        else if (key === "t") this.control<HTMLInputElement>("spin").click();
        else if (key === "l") {
            const light = this.control<HTMLInputElement>("light");
            light.value = String(((Number(light.value) + 210) % 360) - 180);
            this.stage.light = Number(light.value);
        } else if (key === "?") this.unfold("keys");
        else if (key === "escape") this.unfold("");
        else if (key === "h") this.root.toggleAttribute("data-bare");
    }

    private paint(scheme: Scheme): void {
        const option = this.scheme.querySelector<HTMLOptionElement>(`[value=${scheme}]`)!;
        if (!option.disabled) this.scheme.value = scheme;
        this.stale = true;
    }

    private picked(name: string): string {
        return this.root.querySelector<HTMLInputElement>(`[name=${name}]:checked`)?.value ?? "";
    }

    private get isDark(): boolean {
        return this.root.dataset.theme ? this.root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    }

    private allow(scheme: Scheme, allowed: boolean): void {
        const option = this.scheme.querySelector<HTMLOptionElement>(`[value=${scheme}]`)!;
        option.hidden = option.disabled = !allowed;
        if (option.selected && !allowed) this.scheme.value = "plain";
    }

    /** List the meshes that can be chosen; those that are not there yet cannot. */
    private list(): void {
        const { layers, main } = this.content;
        const part = this.part("layers");
        part.hidden = layers.length < 2;
        this.part("modes").hidden = layers.length < 2;
        part.replaceChildren(part.querySelector("legend")!);
        layers.forEach(({ title, detail, size }, i) => {
            const input = Object.assign(document.createElement("input"), { type: "radio", name: "layer", value: String(i), disabled: i !== main, checked: i === main });
            input.addEventListener("change", () => this.compare());
            part.append(element("label", "", input, new Text(title), element("small", `${sized(size)}${detail ? `, ${detail}` : ""}`)));
        });
        this.root.querySelector<HTMLInputElement>("[name=mode][value=one]")!.checked = true;
        this.allow("error", false);
        this.compare();
    }

    /** Fetch and decode the layers beside the stream, then wipe between the first and it. */
    private async beside(content: Content): Promise<void> {
        const { layers, main } = content;
        this.accompanied = true;
        if (layers.length > 1 && this.whole) {
            // Once more without drawing, to say how long decoding alone takes.
            const begin = performance.now();
            const geometry = await wholeOf(this.pool, this.stream.slice(0, this.length));
            this.alone = performance.now() - begin;
            geometry.dispose();
            if (this.content === content) this.headline();
        }
        await this.dress(this.geometry, main);
        for (const [i, layer] of layers.entries()) {
            const off = layer.off && new Float32Array((await bytesOf(layer.off)).buffer);
            const geometry = i === main ? undefined : await wholeOf(this.pool, await bytesOf(layer));
            if (this.content !== content || this.closed) return;
            this.offs[i] = off;
            if (off) this.allow("error", true);
            this.stale = true;
            if (!geometry) continue;
            this.geometries[i] = geometry;
            this.stage.show(i, geometry);
            await this.dress(geometry, i);
            this.recolor(); // it is seen only as it is to look
            this.root.querySelector<HTMLInputElement>(`[name=layer][value="${i}"]`)!.disabled = false;
            if (i === 0) this.root.querySelector<HTMLInputElement>("[name=mode][value=wipe]")!.click();
        }
        this.root.dataset.layers = String(layers.length);
    }

    /** Show what is chosen: one mesh, or the original on the left and another one on the right. */
    private compare(): void {
        const { stage, content } = this;
        const wipe = this.control<HTMLInputElement>("wipe");
        const chosen = Number(this.picked("layer") || content.main);
        const mode = (this.picked("mode") || "one") as Mode;
        // The original beside itself says nothing.
        (this.part("modes") as HTMLFieldSetElement).disabled = chosen === 0 && content.main > 0;
        stage.mode = chosen === 0 ? "one" : mode;
        stage.sides = [0, chosen];
        stage.wipe = Number(wipe.value) / Number(wipe.max);
        wipe.hidden = stage.mode !== "wipe";
        if (stage.mode === "split") this.part("more").removeAttribute("open");
        this.place();
        this.stale = true;
    }

    private place(): void {
        const { stage } = this;
        stage.fit();
        const [left, right] = this.captions[0];
        const [width, seam, split] = [this.root.clientWidth, stage.seam, stage.mode === "split"];
        for (const [part, text, at, shift] of [["left", left, split ? seam / 2 : seam - 14, "-100%"], ["right", right, split ? (seam + width) / 2 : seam + 14, "0%"]] as const) {
            this.say(part, stage.mode === "one" ? "" : text);
            this.part(part).style.left = `${at}px`;
            this.part(part).style.setProperty("--shift", split ? "-50%" : shift);
        }
    }

    private get captions(): [string[], string[]] {
        const { layers } = this.content;
        const style = getComputedStyle(this.root);
        const probe = document.createElement("i");
        const colors = ["--ink", "--near", "--far"].map((name) => {
            probe.style.color = `var(${name})`;
            this.root.append(probe);
            const { color } = getComputedStyle(probe);
            probe.remove();
            return color || style.color;
        });
        return [this.stage.sides.map((i) => (layers[i] ? `${layers[i].title}, ${sized(layers[i].size || this.length)}` : "")), colors];
    }

    private save(blob: Blob, suffix: string): void {
        const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: `${this.content.name.replace(/\.\w+$/, "") || "mesh"}.${suffix}` });
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 60 * SECOND);
    }

    private async film(button: HTMLButtonElement | HTMLInputElement): Promise<void> {
        button.disabled = true;
        try {
            const blob = await this.stage.film(...this.captions, (share) => button.setAttribute("aria-label", `Save a turntable, ${percent(share)}`));
            this.save(blob, blob.type.includes("mp4") ? "mp4" : "webm");
        } catch (error) {
            this.complain(`Recording is not supported. ${error instanceof Error ? error.message : error}`);
        }
        button.setAttribute("aria-label", "Save a turntable");
        button.disabled = false;
    }

    private async take(file: File): Promise<void> {
        this.working?.abort();
        const working = (this.working = new AbortController());
        this.complain("");
        try {
            if (/\.bsm$/i.test(file.name)) {
                const bytes = new Uint8Array(await file.arrayBuffer());
                this.turn();
                this.open({ name: file.name, main: 0, facts: {}, layers: [{ title: "BSM", detail: "", size: file.size }] });
                this.receive(bytes);
                return this.finish();
            }
            if (!this.encode) throw new Error(`This page has no encoder beside it, and shows .bsm alone. To see a mesh: bsm view ${file.name}`);
            [this.part("invite").hidden, this.part("work").hidden] = [true, false];
            const bar = this.root.querySelector("progress")!;
            const preset = this.control<HTMLSelectElement>("preset").value;
            const report = (stage: string, share: number): void => {
                this.say("stage", `${file.name}: ${stage}`);
                if (share > 0) bar.value = share;
                else bar.removeAttribute("value");
            };
            report("sending", 0);
            const content = await this.encode(file, preset, report, working.signal);
            const bytes = await bytesOf(content.layers[content.main]);
            if (this.working !== working || this.closed) return;
            this.turn();
            this.open(content);
            this.receive(bytes);
            this.finish();
        } catch (error) {
            if (!working.signal.aborted) this.complain(`${file.name} cannot be shown. ${error instanceof Error ? error.message : error}`);
        } finally {
            if (this.working === working) {
                this.part("work").hidden = true;
                this.part("invite").hidden = this.root.dataset.state !== "empty";
            }
        }
    }

    /** Look for the tiles that are to be seen, when the camera has moved or some have come. */
    private walk(tiles: TileSet): void {
        const { center, diagonal } = tiles.extent;
        const { place, pixels } = this.stage.eye;
        const looked = [...place, pixels].join();
        if (looked === this.looked) return;
        const first = this.looked === undefined;
        this.looked = looked;
        if (first) this.stage.place(center, diagonal);
        else tiles.look(place, pixels);
        const shown = tiles.shown;
        this.stage.together(shown);
        const faces = shown.reduce((sum, geometry) => sum + geometry.getIndex()!.count / 3, 0);
        const { shards, levels } = tiles.manifest;
        this.say("figures", `${sized(shards.reduce((sum, { size }) => sum + size, 0))} in ${levels.length} levels`);
        this.say("claim", `${sized(tiles.got)} fetched for this view`);
        this.listRows([["Shown", `${counted(faces)} triangles in ${shown.length} tiles`], ["Fetched", `${counted(tiles.there)} tiles`]]);
        this.complain(tiles.problem);
        this.root.dataset.tiles = String(shown.length);
        this.root.dataset.faces = String(faces);
        this.root.dataset.state = !tiles.complete ? "loading" : tiles.problem ? "damaged" : "complete";
        if (first) this.looked = "";
        else if (!this.shown && shown.length > 0) {
            this.shown = true;
            this.stage.fill(shown.map((geometry) => geometry.getAttribute("position").array));
        }
    }

    /** Decode from the first byte on; what is shown stays until there is something else. */
    private restart(): void {
        const { main } = this.content;
        this.decoding?.close();
        this.tiles?.close();
        this.tiles = this.looked = undefined;
        const geometry = new BSMGeometry({ onConnectivity: () => (this.stale = true), onBlock: () => this.drawn(), onFrame: () => this.begin(geometry) });
        this.geometry = this.geometries[main] = geometry;
        this.playback = undefined;
        this.fed = 0;
        this.frameShown = -1;
        this.firstDrawn = this.completed = undefined;
        this.dressed.delete(main);
        if (this.dressed.size === 0) this.allow("own", false);
        this.losses = [];
        this.missed = 0;
        this.shown = this.over = this.ended = false;
        this.started = performance.now();
        this.complain("");
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

    private step(now: number): void {
        this.stage.step();
        this.playOn(now);
        if (this.stale) this.recolor();
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
        this.report();
    }

    private allowed(): number {
        const rate = Number(this.rate.value);
        const link = rate > 0 ? (rate * (performance.now() - this.started)) / 8e-3 : Infinity;
        return Math.floor(Math.min(Number(this.cut.value), link));
    }

    private show(): void {
        const { header, metadata } = this.geometry;
        if (this.shown || this.closed) return;
        this.shown = this.stale = true;
        const { center, diagonal } = header ? extentOf(header) : { center: [0, 0, 0], diagonal: 1 };
        this.stage.show(this.content.main, this.geometry);
        this.stage.place(center, diagonal, turnOf(metadata));
    }

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
        this.complain(`This stream is damaged: ${what} cannot be decoded, the rest is shown. First, ${name}: ${message}`);
    }

    private drawn(): void {
        this.firstDrawn ??= performance.now() - this.started;
        this.show();
        this.stale = true;
    }

    private end(): void {
        const { geometry, content } = this;
        this.over = true;
        this.stale = true;
        this.completed = performance.now() - this.started;
        const { frames } = geometry;
        const every = Math.ceil(frames.length / SAMPLED);
        const samples = frames.length > 0 ? frames.filter((_, i) => i % every === 0).map(({ positions }) => positions) : [geometry.getAttribute("position")?.array ?? []];
        this.stage.fill(samples, turnOf(geometry.metadata), geometry.getAttribute("normal") as BufferAttribute);
        if (geometry.getIndex()) this.stage.shadow(geometry);
        this.headline();
        if (this.accompanied) void this.dress(geometry, content.main);
        else void this.beside(content).catch((error: unknown) => this.complain(`Only the stream is shown. ${error instanceof Error ? error.message : error}`));
        this.root.dataset.state = this.losses.length > 0 ? "damaged" : "complete";
    }

    /** Make materials of what the metadata say, once images are there; offer them and colors. */
    private async dress(geometry: BSMGeometry, index: number): Promise<void> {
        const named = [...geometry.metadata.keys()].some((key) => key.startsWith("material."));
        if (named) {
            const images = await imagesOf(geometry.metadata);
            if (geometry !== this.geometries[index] || this.closed) return;
            const materials = materialsOf(geometry.metadata, images, 1 + Math.max(0, ...geometry.pieces.map(({ material }) => material)));
            for (const material of materials) material.vertexColors = geometry.color !== undefined;
            this.stage.dress(index, materials);
            this.dressed.add(index);
        }
        if (!named && !geometry.color) return;
        this.allow("own", true);
        if (this.scheme.value === "plain") this.scheme.value = "own";
        this.stale = true;
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

    private playOn(now: number): void {
        const { playback, geometry, missed } = this;
        this.part("sequence").hidden = !playback;
        if (!playback) return;
        const there = geometry.frames.length;
        this.clock += (now - this.before) * Number(this.control<HTMLSelectElement>("speed").value);
        this.before = now;
        playback.step(this.clock, there, this.over);
        if (playback.frame !== this.frameShown) {
            this.frameShown = playback.frame;
            geometry.showFrame(this.frameShown);
            if (this.over) this.stage.shadow(geometry);
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
        const each = this.over && total > 0 ? `; ${sized(Math.round(this.length / total))} a frame` : "";
        this.say("time", `${place}${ahead}; ${(((missed + this.frameShown) / playback.rate)).toFixed(2)} s${each}`);
        this.frame.setAttribute("aria-valuetext", `frame ${place}`);
    }

    private recolor(): void {
        const { content, geometries, offs, stage } = this;
        const scheme = content.tiles === undefined ? (this.scheme.value as Scheme) : "plain";
        this.stale = false;
        const { diagonal = 1 } = content.facts;
        const top = diagonal * topOf(offs[content.main] ?? [0], diagonal);
        geometries.forEach((geometry, i) => {
            if (!geometry || (i === content.main && !this.shown)) return;
            const own = scheme === "own";
            const colors = colorsOf(geometry, scheme, offs[i], top);
            stage.color(i, own ? geometry.color : colors && new BufferAttribute(colors, 3), own && this.dressed.has(i));
        });
        this.part("scale").hidden = LEGENDS[scheme] === "";
        this.say("legend", LEGENDS[scheme]);
        const unit = this.geometry.metadata.get("unit");
        const ticks = scheme === "error" ? [0, 0.5, 1].map((share) => [`${percent((share * top) / diagonal)}`, `${Number((share * top).toPrecision(2))} ${typeof unit === "string" ? unit : ""}`]) : scheme === "blocks" ? [["first"], ["last"]] : [["not"], ["refined"]];
        this.part("scale").querySelector("ol")!.replaceChildren(...ticks.map(([text, small]) => element("li", text, ...(small ? [element("small", small)] : []))));
    }

    private headline(): void {
        const { content, geometry, length, alone, completed } = this;
        if (content.tiles) return;
        const { plain, size, claim, rows } = factsOf(content, length, geometry.frames.length, geometry.header, alone ?? completed);
        this.part("figures").replaceChildren(...(geometry.header || content.main > 0 ? [element("s", `${sized(plain)} → `)] : []), size > 0 ? sized(size) : "");
        this.say("claim", claim);
        this.listRows(rows);
    }

    private listRows(rows: Row[]): void {
        this.part("more").hidden = rows.length === 0;
        this.part("facts").replaceChildren(...rows.flatMap(([name, value, more]) => [element("dt", name), element("dd", value, ...(more ? [element("small", ` ${more}`)] : []))]));
    }

    private report(): void {
        const { fed, geometry, length, root } = this;
        const share = length ? Math.round((100 * fed) / length) : 0;
        this.say("bytes", `${counted(fed)} of ${counted(length)} bytes (${share} %)${this.whole ? "" : ", more are to come"}`);
        this.say("status", this.statusText());
        const moments = [["first faces", this.firstDrawn], ["complete", this.completed]] as const;
        this.say("times", moments.flatMap(([name, time]) => (time === undefined ? [] : [`${name} after ${spent(time)}`])).join("; "));
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

    private say(part: string, text: string): void {
        const element = this.part(part);
        if (element.textContent !== text) element.textContent = text;
    }
}
