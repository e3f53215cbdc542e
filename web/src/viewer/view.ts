/**
 * A stream as it arrives, beside its original and Draco; sequences play, tiles come as they are looked at.
 *
 * A `View` fills an element with the template and owns what the page shows: one content at a time, of which one layer is
 * the stream that arrives (`arrival.ts`) and the others are compared with it (`comparison.ts`). The bytes are kept, so
 * that the reader may cut or slow the stream: then it is decoded again from the first byte, and the old mesh stays on
 * the stage until the new one can be drawn. Everything that is drawn or said is renewed once a picture, in `step`; what
 * changes in between only marks itself as stale, so a fast stream cannot make the page draw more often than the screen.
 * Callbacks of streams and files may come late: each asks whether its task is still the latest (`begin`) or whether the
 * content is still the same. States are attributes of the element (`data-state`), which tests and styles read.
 */
import type { BufferAttribute } from "three";
import { errorLike, type Header, type EventOf } from "../index";
import { messageOf } from "../fetched";
import { BSMGeometry } from "../geometry";
import { turnOf } from "../materials";
import type { Pool, StreamDecoding } from "../pool";
import type { Policies } from "../threads";
import { Arrival } from "./arrival";
import { pictureOf } from "./capture";
import { Comparison } from "./comparison";
import { counted, element, factsOf, sized, type Content, type Row } from "./facts";
import { Form } from "./form";
import { crease } from "./inlined";
import { Inspector } from "./inspector";
import { listenToKeys } from "./keys";
import { joinNormals } from "./seams";
import { SequenceBar } from "./sequence";
import { Stage } from "./stage";
import { TileSet } from "./tiles";
import { takeFiles, type Encode } from "./upload";
import template from "./view.html";

const RULER = 120; // pixels of the longest bar
const LOST = "The graphics card has dropped the picture (WebGL context lost). Load the page again.";
const NARROW = 480; // pixels of a page that has no room for it

/** The template as pages take it that demand trusted types: it is a part of this file, and no text of others. */
const { trustedTypes } = globalThis as { trustedTypes?: Policies };
const trusted =
    trustedTypes?.createPolicy("bsm", { createHTML: (text: string) => text }).createHTML(template) ?? template;

const stemOf = (name: string): string => name.replace(/\.\w+$/, "");

/** Middle and diagonal of the box that a mesh fills, about, in its own unit. */
function extentOf(header?: Header): [center: number[], diagonal: number] {
    if (!header) return [[0, 0, 0], 1];
    const { center, scale, grid, lattice } = header;
    if (grid.length === 0) return [center, scale];
    const cell = lattice.length > 0 ? (scale * lattice[0]) / lattice[1] : scale;
    return [center.map((origin, d) => origin + (cell * grid[d]) / 2), cell * Math.max(Math.hypot(...grid), 1)];
}

/** The controls and the canvas, in any element of a page; it says how far it is in `data-state`. */
export class View {
    private readonly form: Form;
    private readonly stage: Stage;
    private readonly arrival: Arrival;
    private readonly meshes: Comparison;
    private readonly sequence: SequenceBar;
    private readonly inspector: Inspector;
    /** The view that the address of the page names, until something is shown. */
    private linked = location.hash.slice(1);
    private readonly cancel: () => void;
    private content: Content = { name: "", main: 0, layers: [], facts: {} };
    private geometry = new BSMGeometry();
    private decoding?: StreamDecoding;
    private losses: EventOf<"loss">[] = [];
    /** Frames before the one at which a stream was entered. */
    private missed = 0;
    private over = true;
    private closed = false;
    private tiles?: TileSet;
    private looked?: string;
    private choose: (index: number) => void = () => this.restart();
    private begun = 0;
    /** Frames that the camera has made room for. */
    private fitted = 1;
    private readonly watch = new ResizeObserver(() => this.meshes.place());

    constructor(
        private readonly root: HTMLElement,
        private readonly pool: Pool,
        licenses: string,
        encode?: Encode,
        presets: string[] = [],
    ) {
        root.classList.add("bsm");
        root.innerHTML = trusted;
        this.form = new Form(root);
        this.form.say("licenses", licenses);
        this.form.part("encodes").hidden = !encode;
        if (presets.length > 0) this.form.control("preset").replaceChildren(...presets.map((name) => new Option(name)));
        try {
            this.stage = new Stage(root.querySelector("canvas")!);
        } catch (error) {
            this.fail(`WebGL is not available. ${messageOf(error)}`);
            throw error;
        }
        this.arrival = new Arrival(this.form);
        this.meshes = new Comparison(this.form, this.stage);
        this.sequence = new SequenceBar(this.form);
        this.inspector = new Inspector(this.form, this.stage, this.meshes, (blob, suffix) => this.save(blob, suffix));
        this.cancel = takeFiles(this.form, (content, bytes) => (this.begin(), this.showAll(content, bytes)), encode);
        this.listen();
        for (const part of [root, ...root.querySelectorAll(".bsm-side > *, .bsm-dock")]) this.watch.observe(part);
        this.stage.renderer.setAnimationLoop((now) => this.step(now)); // until it is disposed of
    }

    /** Let the reader choose among streams of these names; ask for a file where there are none. */
    offer(names: string[], choose: (index: number) => void): void {
        const streams = this.form.control<HTMLSelectElement>("stream");
        this.choose = choose;
        names.forEach((name, i) => streams.add(new Option(name, String(i))));
        this.form.part("name").hidden = names.length > 1;
        streams.hidden = names.length < 2;
        this.form.part("invite").hidden = names.length > 0;
        if (names.length === 0) this.root.dataset.state = "empty";
    }

    /** Begin to show something else; returns whether nothing else has been begun since. */
    begin(): () => boolean {
        const own = ++this.begun;
        return () => own === this.begun;
    }

    /** Show another stream, whose bytes will come; `index` if it is one of those that are offered. */
    open(content: Content, index = -1): void {
        const { form } = this;
        const streams = form.control<HTMLSelectElement>("stream");
        streams.selectedIndex = index;
        form.part("name").hidden = index >= 0 && streams.length > 1;
        form.say("name", content.name);
        const player = `<bsm-player src="${encodeURIComponent(stemOf(content.name))}.bsm" autoplay loop></bsm-player>`;
        form.say("embed", `<script type="module">import "bsm-decoder/player";</script>\n${player}`);
        form.part("invite").hidden = true;
        const isTiled = content.tiles !== undefined;
        for (const part of ["arrival", "colors", "files"]) form.part(part).hidden = isTiled;
        form.control("keep").hidden = content.facts.seconds === undefined; // there is a file of it already
        this.content = content;
        this.arrival.clear();
        this.meshes.open(content);
        this.restart();
        this.headline();
    }

    /** Show another stream, all of which is there. */
    showAll(content: Content, bytes: Uint8Array): void {
        this.open(content);
        this.receive(bytes);
        this.finish();
    }

    async openTiles(content: Content, index: number): Promise<void> {
        this.open(content, index);
        this.over = true;
        const tiles = await TileSet.open(content.tiles!, this.pool, () => (this.looked = ""));
        if (this.closed || this.content !== content || this.tiles) return tiles.close();
        this.tiles = tiles;
    }

    receive(bytes: Uint8Array): void {
        this.arrival.receive(bytes);
    }

    finish(): void {
        this.arrival.whole = true;
    }

    fail(problem: string): void {
        this.over = true;
        this.form.say("problem", problem);
        this.root.dataset.state = "failed";
    }

    close(): void {
        this.closed = true;
        this.watch.disconnect();
        this.cancel();
        this.decoding?.close();
        this.tiles?.close();
        this.stage.dispose();
    }

    private listen(): void {
        const { form, meshes, root, stage } = this;
        form.on("stream", "change", ({ value }) => this.choose(Number(value)));
        form.on("light", "input", ({ value }) => (stage.light = Number(value)));
        form.on("spin", "change", ({ checked }) => (stage.camera.controls.autoRotate = checked));
        form.on("back", "change", ({ value }) => (root.dataset.back = value));
        form.on("again", "click", () => this.restart());
        form.on("embed", "click", (button) => void this.copy(form.part("embed"), button));
        form.on("link", "click", (button) => {
            const address = `${location.href.replace(/#.*/, "")}#${this.inspector.state}`;
            form.say("address", address);
            void this.copy(form.part("address"), button);
        });
        form.on("theme", "click", () => {
            const system = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
            root.dataset.theme = (root.dataset.theme ?? system) === "dark" ? "light" : "dark";
        });
        for (const part of ["panel", "keys"]) form.on(part, "click", () => form.unfold(part));
        const full = (): unknown => (document.fullscreenElement ? document.exitFullscreen() : root.requestFullscreen());
        form.on("full", "click", full);
        const picture = (): HTMLCanvasElement => pictureOf(stage, meshes.captions);
        form.on("picture", "click", () => picture().toBlob((blob) => blob && this.save(blob, "png")));
        form.on("keep", "click", () => this.save(new Blob([this.arrival.bytes as BlobPart]), "bsm"));
        root.querySelector("form")!.addEventListener("submit", (event) => event.preventDefault());
        // Most lost contexts come back at once: only one that stays away is worth a sentence.
        let gone = 0;
        const complain = (): unknown => (gone = window.setTimeout(() => form.say("problem", LOST), 2000));
        stage.canvas.addEventListener("webglcontextlost", complain);
        stage.canvas.addEventListener("webglcontextrestored", () => {
            clearTimeout(gone);
            if (form.part("problem").textContent === LOST) form.say("problem", "");
        });
        listenToKeys(form, stage, meshes);
        if (matchMedia("(min-width: 45rem) and (min-height: 30rem)").matches)
            form.part("more").setAttribute("open", "");
    }

    /** Copy a text, and say so; where the page may not write, select it. */
    private async copy(text: HTMLElement, button: HTMLElement): Promise<void> {
        const label = (button.dataset.label ??= button.textContent!);
        const isCopied = await navigator.clipboard?.writeText(text.textContent!).then(
            () => true,
            () => false,
        );
        if (!isCopied) getSelection()?.selectAllChildren(text);
        button.textContent = isCopied ? "Copied" : "Press Ctrl+C to copy it";
        setTimeout(() => (button.textContent = label), 3000);
    }

    private save(blob: Blob, suffix: string): void {
        const download = `${stemOf(this.content.name) || "mesh"}.${suffix}`;
        const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download });
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
    }

    /** Look for the tiles that are to be seen, when the camera has moved or some have come. */
    private walk(tiles: TileSet): void {
        const { form, root, stage } = this;
        const [eye, { pixels }] = [stage.eye, stage.camera];
        const looked = [...eye, pixels].join();
        if (looked === this.looked) return;
        const first = this.looked === undefined;
        this.looked = looked;
        if (first) stage.place(tiles.extent.center, tiles.extent.diagonal);
        else tiles.look(eye, pixels);
        const shown = tiles.shown;
        joinNormals(shown);
        stage.show(0, ...shown);
        const faces = shown.reduce((sum, geometry) => sum + geometry.getIndex()!.count / 3, 0);
        const { shards, levels } = tiles.manifest;
        form.say("figures", `${sized(shards.reduce((sum, { size }) => sum + size, 0))} in ${levels.length} levels`);
        form.say("claim", `${sized(tiles.got)} fetched for this view`);
        const fetched: Row = ["Fetched", `${counted(tiles.there)} tiles`];
        const tilesShown = `${counted(faces)} triangles in ${shown.length} tile${shown.length === 1 ? "" : "s"}`;
        this.listRows([["Shown", tilesShown], fetched]);
        form.say("problem", tiles.problem);
        root.dataset.tiles = String(shown.length);
        root.dataset.faces = String(faces);
        root.dataset.state = !tiles.complete ? "loading" : tiles.problem ? "damaged" : "complete";
        if (first) this.looked = "";
        else if (!this.meshes.shown && shown.length > 0) {
            this.meshes.shown = true;
            stage.fill(shown.map((geometry) => geometry.getAttribute("position").array));
            stage.shadow(...shown);
        }
    }

    /** Decode from the first byte on; what is shown stays until there is something else. */
    private restart(): void {
        const { meshes, root } = this;
        this.decoding?.close();
        this.tiles?.close();
        this.tiles = this.looked = undefined;
        const geometry: BSMGeometry = new BSMGeometry({
            onConnectivity: () => (meshes.stale = true),
            onBlock: () => this.drawn(),
            onFrame: () => this.sequence.begin(geometry),
        });
        this.geometry = geometry;
        meshes.begin(geometry);
        this.sequence.open(this.content.facts);
        this.arrival.restart();
        [this.losses, this.missed, this.fitted, this.over] = [[], 0, 1, false];
        this.form.say("problem", "");
        root.dataset.state = "loading";
        this.decoding = this.pool.open(
            {
                onPicture: (picture) => {
                    geometry.accept(picture);
                    if (picture.type === "loss") this.lose(picture);
                    if (picture.type === "end") this.end();
                },
                onError: (error) => this.fail(`This stream cannot be decoded further. ${error.name}: ${error.message}`),
                onTaken: (bytes) => {
                    root.dataset.taken = String(bytes);
                    if (bytes === this.arrival.fed) this.show();
                },
            },
            { tolerant: true, drawing: "growing", crease },
        );
    }

    private step(now: number): void {
        const { arrival, geometry, meshes, over, stage } = this;
        stage.step();
        if (this.sequence.step(now, over, this.missed)) {
            if (!over && geometry.frames.length >= 2 * this.fitted) this.fill();
            meshes.seek(geometry.shown);
            stage.follow();
            if (over) stage.shadow(geometry);
            meshes.stale = true;
        }
        this.measure();
        if (meshes.stale) meshes.recolor();
        if (this.tiles) return this.walk(this.tiles);
        if (arrival.isCut) this.restart();
        arrival.feed(this.decoding, this.over);
        arrival.report(this.geometry, this.missed);
    }

    private show(): void {
        const { header } = this.geometry;
        if (!this.closed) this.meshes.show(this.geometry, ...extentOf(header));
    }

    private lose(loss: EventOf<"loss">): void {
        if (this.content.live && loss.frames?.first === 0) return void (this.missed = loss.frames.count);
        this.losses.push(loss);
        const blocks = this.losses.flatMap(({ block }) => block ?? []);
        const frames = this.losses.reduce((sum, { frames }) => sum + (frames?.count ?? 0), 0);
        const lost = blocks.length > 0 ? [`block${blocks.length > 1 ? "s" : ""} ${blocks.join(", ")}`] : [];
        if (frames > 0) lost.push(`${frames} frames`);
        const { name, message } = errorLike(this.losses[0].error);
        const what = lost.join(" and ") || "some bytes";
        const rest = `the rest is shown. First, ${name}: ${message}`;
        this.form.say("problem", `This stream is damaged: ${what} cannot be decoded, ${rest}`);
    }

    private drawn(): void {
        this.arrival.first ??= this.arrival.passed;
        this.show();
        this.meshes.stale = true;
    }

    private end(): void {
        const { arrival, geometry, meshes, stage } = this;
        this.over = meshes.stale = true;
        arrival.complete = arrival.passed;
        this.fill();
        if (geometry.getIndex()) stage.shadow(geometry);
        this.inspector.open(geometry);
        if (this.linked) this.inspector.state = this.linked;
        this.linked = "";
        this.headline();
        const rest = meshes.accompanied ? meshes.showMaterials().then(() => this.headline()) : this.accompany();
        rest.catch((error) => this.form.say("problem", `The original cannot be compared. ${messageOf(error)}`));
        this.root.dataset.state = this.losses.length > 0 ? "damaged" : "complete";
    }

    /** Make room for the mesh, in all frames that are there. */
    private fill(): void {
        const { geometry, stage } = this;
        const { frames } = geometry;
        this.fitted = Math.max(frames.length, 1);
        const still = geometry.getAttribute("position")?.array ?? [];
        const samples = frames.length > 0 ? frames.map(({ positions }) => positions) : [still];
        stage.fill(samples, turnOf(geometry.metadata), geometry.getAttribute("normal") as BufferAttribute);
    }

    /** Say how long a bar at the middle of the mesh is. */
    private measure(): void {
        const { form, geometry, meshes, root, stage } = this;
        const ruler = form.part("ruler");
        ruler.hidden = !meshes.shown || root.clientWidth < NARROW || root.clientHeight < NARROW;
        if (ruler.hidden) return;
        const wished = RULER * stage.pixel;
        const power = 10 ** Math.floor(Math.log10(wished));
        const length = power * [5, 2, 1].find((step) => step * power <= wished)!;
        const unit = geometry.metadata.get("unit");
        form.say("length", `${Number(length.toPrecision(1))} ${typeof unit === "string" ? unit : ""}`.trim());
        ruler.style.width = `${Math.round(length / stage.pixel)}px`;
    }

    /** Fetch the meshes to compare with. */
    private async accompany(): Promise<void> {
        const { content, meshes, pool } = this;
        const mine = (): boolean => this.content === content && !this.closed;
        meshes.accompanied = true;
        await meshes.accompany(pool, mine);
        if (!mine()) return;
        this.sequence.plot(content.facts);
        this.headline();
    }

    private headline(): void {
        const { arrival, content, form, geometry } = this;
        if (content.tiles) return;
        const facts = factsOf(content, arrival.length, geometry, arrival.complete);
        const before = facts.plain === undefined ? [] : [element("s", `${sized(facts.plain)} → `)];
        form.part("figures").replaceChildren(...before, facts.size > 0 ? sized(facts.size) : "");
        form.say("claim", facts.claim);
        form.part("claim").dataset.tone = facts.tone;
        this.listRows(facts.rows);
    }

    private listRows(rows: Row[]): void {
        const listed = rows.flatMap(([name, value, more]) => [
            element("dt", name),
            element("dd", value, ...(more ? [element("small", ` ${more}`)] : [])),
        ]);
        this.form.part("more").hidden = rows.length === 0;
        this.form.part("facts").replaceChildren(...listed);
    }
}
