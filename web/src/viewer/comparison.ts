/** The compared meshes (original, stream, Draco's file): which are shown, how, and in which colors. */
import { BufferAttribute, Triangle, Vector3 } from "three";
import { BSMGeometry } from "../geometry";
import { materialsOf, turnOf } from "../materials";
import type { Pool } from "../pool";
import { colorsOf, fieldOf, LEGENDS, RAMP, topOf, type Scheme } from "./colors";
import { distancesOf } from "./distances";
import { element, percent, sized, type Content } from "./facts";
import type { Form } from "./form";
import { bytesOf, crease } from "./inlined";
import { listParts } from "./parts";
import type { Mode, Shading, Stage } from "./stage";
import { wholeOf } from "./tiles";

const EDGE = 4; // pixels between captions and the edge of the page

export class Comparison {
    /** Whether colors are to be computed again. */
    stale = false;
    /** Whether the stream's mesh is on the stage. */
    shown = false;
    /** Whether the other meshes are there, or on their way. */
    accompanied = false;
    private content: Content = { name: "", main: 0, layers: [], facts: {} };
    private geometries: (BSMGeometry | undefined)[] = [];
    private offs: (Float32Array | undefined)[] = [];
    /** The distance that has the last color, once it is known. */
    private top?: number;
    private readonly withMaterials = new Set<number>();
    private hidden: Parameters<BSMGeometry["hide"]>[0] = () => false;
    private readonly scheme: HTMLSelectElement;

    constructor(
        private readonly form: Form,
        private readonly stage: Stage,
    ) {
        this.scheme = form.control("color");
        form.part("scale").querySelector("div")!.style.background = RAMP;
        form.on("mode", "change", () => this.compare());
        form.on("wipe", "input", () => this.compare());
        form.on("shading", "change", ({ value }) => stage.shade(value as Shading));
        form.on("color", "change", () => (this.stale = true));
    }

    /** Start with other meshes; they can be chosen once they have arrived. */
    open(content: Content): void {
        const { form } = this;
        const { layers, main } = (this.content = content);
        [this.geometries, this.offs, this.accompanied, this.top, this.hidden] = [[], [], false, undefined, () => false];
        this.withMaterials.clear();
        delete form.root.dataset.layers;
        form.part("parts").hidden = true;
        this.stage.clear();
        const part = form.part("layers");
        part.hidden = form.part("modes").hidden = layers.length < 2;
        part.replaceChildren(part.querySelector("legend")!);
        layers.forEach(({ title, detail, size }, i) => {
            const own = { type: "radio", name: "layer", value: String(i), disabled: i !== main, checked: i === main };
            const input = Object.assign(document.createElement("input"), own);
            input.addEventListener("change", () => this.compare());
            const small = element("small", `${sized(size)}${detail ? `, ${detail}` : ""}`);
            part.append(element("label", "", input, new Text(title), small));
        });
        form.root.querySelector<HTMLInputElement>("[name=mode][value=one]")!.checked = true;
        this.allow("error", false);
        this.compare();
    }

    /** Start with a new mesh of the stream; the previous one stays on the stage until it can be drawn. */
    begin(geometry: BSMGeometry): void {
        const { main } = this.content;
        this.geometries[main] = geometry;
        geometry.hide(this.hidden);
        this.withMaterials.delete(main);
        if (this.withMaterials.size === 0) this.allow("own", false);
        this.shown = false;
    }

    show(geometry: BSMGeometry, center: number[], diagonal: number): void {
        if (this.shown) return;
        this.shown = this.stale = true;
        this.stage.show(this.content.main, geometry);
        this.stage.place(center, diagonal, turnOf(geometry.metadata));
    }

    /** Fetch and decode the other meshes as long as `mine` holds, then wipe between the original and the stream. */
    async accompany(pool: Pool, mine: () => boolean): Promise<void> {
        const { layers, main } = this.content;
        const { form, geometries, offs, stage } = this;
        await this.showMaterials(main);
        for (const [i, layer] of layers.entries()) {
            const off = layer.off && new Float32Array((await bytesOf(layer.off)).buffer);
            const made = async (): Promise<BSMGeometry> =>
                layer.pictures ? new BSMGeometry() : wholeOf(pool, await bytesOf(layer), crease);
            const geometry = i === main ? undefined : await made();
            for (const picture of layer.pictures ?? []) geometry?.accept(picture);
            if (!mine()) return;
            offs[i] = off;
            this.top = undefined;
            if (off) this.allow("error", true);
            this.stale = true;
            if (!geometry) continue;
            geometries[i] = geometry;
            stage.show(i, geometry);
            await this.showMaterials(i);
            this.recolor(); // before it is first drawn
            form.root.querySelector<HTMLInputElement>(`[name=layer][value="${i}"]`)!.disabled = false;
            if (i > 0) continue;
            const wipe = form.control("wipe");
            stage.halve();
            wipe.value = String(Math.round(stage.wipe * Number(wipe.max)));
            form.pick("mode", "wipe");
        }
        await this.measure(mine);
        if (!mine()) return;
        listParts(form, geometries[main]!, (hidden) => {
            for (const geometry of this.geometries) geometry?.hide(hidden);
            this.hidden = hidden;
            stage.shadow(this.geometries[main]!);
        });
        form.root.dataset.layers = String(layers.length);
    }

    seek(frame: number): void {
        for (const geometry of this.geometries)
            if (geometry?.frames.length) geometry.showFrame(Math.min(frame, geometry.frames.length - 1));
    }

    /** Compare a stream with its original, unless Python has measured them. */
    private async measure(mine: () => boolean): Promise<void> {
        const { geometries, offs } = this;
        const { facts, main } = this.content;
        const [original, stream] = [geometries[0], geometries[main]];
        if (main === 0 || facts.diagonal !== undefined || !original || !stream) return;
        const found = await distancesOf(stream, original, mine);
        if (!found) return;
        const { off, errors, mean } = found;
        facts.diagonal = original.boundingBox!.getSize(new Vector3()).length() || 1;
        const [most, ...more] = [Math.max(...errors), ...errors].map((far) => far / facts.diagonal!);
        Object.assign(facts, {
            farthest: most,
            errors: stream.frames.length > 0 ? more : [],
            apart: mean && mean / facts.diagonal,
            before: [original.header!.vertices, original.header!.faces],
        });
        offs[main] = off.length > 0 ? off : undefined;
        this.top = undefined;
        this.allow("error", off.length > 0);
        this.stale = true;
    }

    /** Make materials from the metadata and images; offer them and the colors. */
    async showMaterials(index = this.content.main): Promise<void> {
        const { geometries, scheme } = this;
        const geometry = geometries[index]!;
        const { attributes, metadata, color } = geometry;
        const names = Object.keys(attributes).filter((name) => !/^(position|normal|(uv|color)\d*)$/.test(name));
        const fields = names.map((name) => new Option(name, `of ${name}`));
        if (index === this.content.main) this.form.part("fields").replaceChildren(...fields);
        const named = [...metadata.keys()].some((key) => key.startsWith("material."));
        if (named) {
            const unshown: string[] = [];
            const materials = await materialsOf(geometry, (what) => unshown.push(what));
            if (geometry !== this.geometries[index]) return; // another mesh has taken its place
            if (unshown.length > 0) this.content.facts.unshown = unshown;
            this.stage.setMaterials(index, materials);
            this.withMaterials.add(index);
        }
        if (!named && !color) return;
        this.allow("own", true);
        if (scheme.value === "plain") scheme.value = "own";
        this.stale = true;
    }

    /** The error at a place between drawn vertices, and over the diagonal; undefined where it is not known. */
    errorAt(
        index: number,
        { frames, header, parted, shown, attributes: { position } }: BSMGeometry,
        corners: number[],
        place: Vector3,
    ): [off: number, share: number] | undefined {
        const off = this.offs[index];
        if (!off || !header) return undefined;
        const first = frames.length > 1 ? shown * header.vertices : 0;
        const [a, b, c] = corners.map((drawn) => new Vector3().fromBufferAttribute(position, drawn));
        const weights = Triangle.getBarycoord(place, a, b, c, new Vector3())?.toArray() ?? [1, 0, 0];
        const error = corners.reduce((sum, drawn, k) => sum + weights[k] * off[first + (parted?.[drawn] ?? drawn)], 0);
        return error >= 0 ? [error, error / (this.content.facts.diagonal ?? 1)] : undefined;
    }

    /** Show errors in colors, or no longer. */
    toggleErrors(): void {
        const own = this.withMaterials.size > 0 || this.geometries[this.content.main]?.color;
        const scheme = this.scheme.value !== "error" ? "error" : own ? "own" : "plain";
        if (!this.option(scheme).disabled) this.scheme.value = scheme;
        this.stale = true;
    }

    /** Fit all to the size of the page, and put captions below their sides. */
    place(): void {
        const { stage, form } = this;
        const dock = form.root.querySelector<HTMLElement>(".bsm-dock")!;
        form.root.style.setProperty("--dock", `${form.root.clientHeight - dock.offsetTop}px`);
        ["left", "right"].forEach((part, side) => form.say(part, stage.mode === "one" ? "" : this.captions[side]));
        stage.fit(); // beside captions
        const [split, seam, { clientWidth }] = [stage.mode === "split", stage.seam, form.root];
        const [left, right] = ["left", "right"].map((part) => form.part(part).offsetWidth + EDGE);
        const begin = Math.max(seam - 14, left);
        const places = split
            ? [seam / 2, (seam + clientWidth) / 2]
            : [begin, Math.max(begin + EDGE, Math.min(seam + 14, clientWidth - right))];
        ["left", "right"].forEach((part, side) => {
            form.part(part).style.left = `${places[side]}px`;
            form.part(part).style.setProperty("--shift", split ? "-50%" : side === 0 ? "-100%" : "0%");
        });
    }

    get captions(): string[] {
        const { layers } = this.content;
        return this.stage.sides.map((i) => (layers[i] ? `${layers[i].title}, ${sized(layers[i].size)}` : ""));
    }

    recolor(): void {
        const { content, form, geometries, offs, stage } = this;
        const scheme = content.tiles === undefined ? (this.scheme.value as Scheme) : "plain";
        const own = scheme === "own";
        const { diagonal = 1 } = content.facts;
        const field = fieldOf(geometries[content.main], scheme);
        const top = (this.top ??= diagonal * topOf(offs[content.main] ?? [0], diagonal));
        this.stale = false;
        geometries.forEach((geometry, i) => {
            if (!geometry || (i === content.main && !this.shown)) return;
            const vertices = geometry.header?.vertices ?? 0; // of each frame
            const first = geometry.frames.length > 1 ? geometry.shown * vertices : 0;
            const off = geometry.frames.length > 1 ? offs[i]?.subarray(first, first + vertices) : offs[i];
            const colors = colorsOf(geometry, scheme, off, top, field);
            const drawn = own ? geometry.color : colors && new BufferAttribute(colors, 3);
            stage.color(i, drawn, own && this.withMaterials.has(i));
        });
        const scale = form.part("scale");
        scale.hidden = !LEGENDS[scheme] && !field;
        const surface = scheme === "error" && content.facts.apart !== undefined ? "'s surface" : "";
        form.say("legend", `${LEGENDS[scheme] ?? scheme.slice(3)}${surface}`);
        const unit = geometries[content.main]?.metadata.get("unit");
        const tick = (share: number): HTMLElement => {
            const far = `${Number((share * top).toPrecision(2))} ${typeof unit === "string" ? unit : ""}`;
            return element("li", percent((share * top) / diagonal), element("small", far));
        };
        const words = field
            ? [field.low, (field.low + field.high) / 2, field.high].map((value) => `${Number(value.toPrecision(3))}`)
            : ["first", "last"];
        const ticks = scheme === "error" ? [0, 0.5, 1].map(tick) : words.map((text) => element("li", text));
        scale.querySelector("ol")!.replaceChildren(...ticks);
    }

    /** Show the chosen mesh, or the original on the left and the chosen mesh on the right. */
    private compare(): void {
        const { content, form, stage } = this;
        const wipe = form.control("wipe");
        const chosen = Number(form.picked("layer") || content.main);
        // The original is not compared with itself.
        form.part("modes").toggleAttribute("disabled", chosen === 0 && content.main > 0);
        stage.mode = chosen === 0 ? "one" : ((form.picked("mode") || "one") as Mode);
        stage.sides = [0, chosen];
        stage.wipe = Number(wipe.value) / Number(wipe.max);
        wipe.hidden = stage.mode !== "wipe";
        if (stage.mode === "split") form.part("more").removeAttribute("open");
        this.place();
        this.stale = true;
    }

    private option(scheme: Scheme): HTMLOptionElement {
        return this.scheme.querySelector<HTMLOptionElement>(`[value=${scheme}]`)!;
    }

    private allow(scheme: Scheme, allowed: boolean): void {
        const option = this.option(scheme);
        option.hidden = option.disabled = !allowed;
        if (option.selected && !allowed) this.scheme.value = "plain";
    }
}
