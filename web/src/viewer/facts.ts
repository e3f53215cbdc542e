/** The numbers of the result card, in the words of the command line. */
import { Vector3 } from "three";
import type { BSMGeometry } from "../geometry";
import type { Picture } from "../index";
import type { Inlined } from "./inlined";

const SECOND = 1000;
const CLOSE = 2; // look distance up to which two meshes are close
const MOST_NAMES = 6;
/** Invisible contents of a file, as notes name them. */
const SCENERY =
    "cameras?|(punctual )?lights?|(other )?(scenes|animations)|skins|morph targets|tangent|extras|comments?";
const OF_FILES =
    "the number of triangles in the header|\\d+ bytes after the last triangle|.*(metadata|mesh_features).*";
const UNSEEN = new RegExp(`^((${SCENERY})( (of|amid) .*)?|${OF_FILES})( \\(.*\\))?$`, "i");
const PIXEL = 1e-3; // of the diagonal: what a pixel is of a mesh that fills a large picture

/** A mesh: its stream or pictures, the size of the file, and the error of each vertex, if it is known. */
export interface Layer extends Inlined {
    title: string;
    detail: string;
    size: number;
    off?: Inlined;
    pictures?: Picture[];
}

type ErrorFigure = "max_error" | "mean_error" | "range" | "max_angle_deg" | "mean_angle_deg";
type AttributeErrors = Partial<Record<ErrorFigure, number | null>>;

/** What is shown, as `bsm.viewer.page` lists it; `main` is the stream that arrives, the others are there at once. */
export interface Content {
    name: string;
    main: number;
    layers: Layer[];
    facts: {
        preset?: string | null;
        promised?: { look?: number; farthest?: number };
        look?: number;
        /** Frames of a sequence whose looks were measured; `look` is the worst one. */
        drawn?: number;
        farthest?: number;
        /** The mean distance of two surfaces with other faces; `farthest` is their largest one then. */
        apart?: number;
        /** Vertices and faces of the original. */
        before?: [number, number];
        /** The largest error of each frame of a sequence. */
        errors?: number[];
        angle?: number;
        /** Errors of attributes by name; null: one is missing. */
        attributes?: Record<string, AttributeErrors | null>;
        seconds?: number;
        diagonal?: number;
        draco?: { bytes: number; bits: number } | null;
        /** What reader and encoder say, and whether they left something of the file out. */
        notes?: string[];
        less?: boolean;
        /** What the stream has and the page cannot draw. */
        unshown?: string[];
        /** Files that were given together, those that they name and are not there, and those that nothing names. */
        used?: string[];
        missing?: string[];
        unused?: string[];
    };
    /** Whether it is still being written, so that what was before one came is not missed. */
    live?: boolean;
    tiles?: string;
}

export type Row = [string, string, string?];

export function counted(count: number): string {
    return count.toLocaleString("en");
}

export function spent(milliseconds: number): string {
    return milliseconds < SECOND ? `${Math.ceil(milliseconds)} ms` : `${(milliseconds / SECOND).toFixed(2)} s`;
}

export function sized(bytes: number): string {
    const [number, unit] = bytes < 1e3 ? [bytes, "bytes"] : bytes < 1e7 ? [bytes / 1e3, "kB"] : [bytes / 1e6, "MB"];
    return `${number.toLocaleString("en", { maximumFractionDigits: number < 100 && unit !== "bytes" ? 1 : 0 })} ${unit}`;
}

export function percent(share: number): string {
    return `${Number((100 * share).toPrecision(3))}\u00a0%`;
}

const short = (number: number): string => `${Number(number.toPrecision(3))}`;

function times(ratio: number): string {
    return ratio.toLocaleString("en", { maximumFractionDigits: ratio < 10 ? 1 : 0 });
}

export function element(tag: string, text: string, ...inside: Node[]): HTMLElement {
    const made = document.createElement(tag);
    made.textContent = text;
    made.append(...inside);
    return made;
}

/** Names of files, or how many there are and which is the first and the last. */
function filesOf(label: string, paths: string[] = []): Row[] {
    const names = paths.map((path) => path.replace(/^.*\//, ""));
    if (names.length > MOST_NAMES) return [[label, `${counted(names.length)} files`, `${names[0]} to ${names.at(-1)}`]];
    return names.length > 0 ? [[label, names.join(", ")]] : [];
}

/** What the color of a verdict says. */
export type Tone = "good" | "fair" | "poor" | "";

/** What was measured, in words, of looks only where they were; figures are in the rows below. */
function verdictOf(
    { look, farthest, diagonal = 1, unshown }: Content["facts"],
    unit: unknown,
): [words: string, tone: Tone] {
    if (look !== undefined) {
        if (look <= 1) return [unshown ? "The rest looks the same" : "Looks the same", "good"];
        if (look <= CLOSE) return ["Close: differences show side by side", "fair"];
        return ["A preview: differences show at a glance", "poor"];
    }
    if (!farthest) return farthest === 0 ? ["No difference was measured", "good"] : ["", ""];
    const length = Number((farthest * diagonal).toPrecision(2));
    const far = typeof unit === "string" ? `${length}\u00a0${unit}` : `${percent(farthest)} of the diagonal`;
    return farthest <= PIXEL ? [`Close: differences up to ${far}`, "good"] : [`Differences up to ${far}`, "poor"];
}

/** The names in notes of what is left out. */
function leftOut(notes: string[]): string[] {
    const found = notes.flatMap((note) => /^(?:.*: )?left out: (.*?)(?:\.( |$)|$)/i.exec(note)?.[1] ?? []);
    return [...new Set(found.flatMap((names) => names.split(/, (?!because)(?![^(]*\))/)))];
}

/** Those whose absence can be seen; notes that name nothing may mean anything. */
function visibleIn(notes: string[]): string[] {
    const names = leftOut(notes);
    return names.length > 0 ? names.filter((name) => !UNSEEN.test(name)) : ["parts of the file"];
}

/** Sizes, which are compared only if all that can be seen is in the stream; what is claimed of them; the rows below. */
export function factsOf(
    { layers, main, facts }: Content,
    length: number,
    { boundingBox, carried, frames: { length: frames }, header, metadata }: BSMGeometry,
    took?: number,
): { plain?: number; size: number; claim: string; tone: Tone; rows: Row[] } {
    const size = layers[main].size || length;
    const [vertices, faces] = [header?.vertices ?? 0, header?.faces ?? 0];
    const missed = facts.less ? visibleIn(facts.notes ?? []) : [];
    const plain = main > 0 && missed.length === 0 ? layers[0].size : undefined;
    const ratio = (plain ?? 0) / Math.max(size, 1);
    const { look, drawn, farthest, apart, before, angle, seconds, promised = {}, draco, notes = [] } = facts;
    const { used = [], missing, unused, unshown = [] } = facts;
    const rows: Row[] = [
        ...(used.length > 1 || unused?.length ? filesOf("Files used", used) : []),
        ...filesOf("Files missing", missing),
        ...filesOf("Files not used", unused),
        ...notes.map((note): Row => ["Note", note]),
    ];
    if (look !== undefined) {
        const target = promised.look ? `promised ${promised.look}; ` : "";
        const worst = drawn ? `worst of ${drawn} frames drawn; ` : "";
        rows.push(["Look distance", look.toFixed(2), `${target}${worst}at 1, both look the same`]);
    }
    if (farthest !== undefined) {
        const bound = promised.farthest ? `; promised ${percent(promised.farthest)}` : "";
        const what = apart === undefined ? "Largest vertex error" : "Largest surface distance";
        rows.push([what, percent(farthest), `of the diagonal${bound}`]);
    }
    if (apart !== undefined) rows.push(["Mean surface distance", percent(apart), "the faces differ"]);
    if (angle !== undefined) rows.push(["Mean normal error", `${angle.toFixed(2)}°`]);
    if (draco) {
        const more = `${draco.bits} bits, ${times(draco.bytes / size)} times as much`;
        rows.push(["Draco at the same look", sized(draco.bytes), more]);
    }
    if (seconds !== undefined) rows.push(["Encoded in", spent(SECOND * seconds)]);
    if (took !== undefined) rows.push(["Decoded and drawn in", spent(took)]);
    if (boundingBox && vertices > 0) {
        const unit = metadata.get("unit");
        const sides = boundingBox.getSize(new Vector3()).toArray().map(short).join(" × ");
        rows.push(["Box", typeof unit === "string" ? `${sides} ${unit}` : sides]);
    }
    if (vertices > 0) rows.push(["Mesh", `${counted(vertices)} vertices`, `${counted(faces)} triangles`]);
    if (before && before[1] !== faces)
        rows.push(["Original", `${counted(before[0])} vertices`, `${counted(before[1])} triangles`]);
    for (const [name, errors] of Object.entries(facts.attributes ?? {})) {
        const { max_angle_deg: turned, mean_angle_deg: mean = 0, max_error: most = 0, range = 0 } = errors ?? {};
        const label = `Error of ${name}`;
        if (!errors) rows.push([label, "missing"]);
        else if (turned == null) rows.push([label, `up to ${short(most!)}`, `of ${short(range!)}`]);
        else rows.push([label, `up to ${short(turned)}°`, `${short(mean!)}° on average`]);
    }
    const others = carried.filter(({ name }) => !facts.attributes?.[name]);
    if (others.length > 0) rows.push(["Attributes", others.map(({ name }) => name).join(", ")]);
    if (frames > 1) rows.push(["Sequence", `${counted(frames)} frames`, `${sized(Math.round(size / frames))} a frame`]);
    const [words, tone] = verdictOf(facts, metadata.get("unit"));
    const all = leftOut(notes);
    const absent = notes.flatMap((note) => /(\S+) (?:were|was) left out: no such file/.exec(note)?.[1] ?? []);
    const gone = [...new Set([...(missing ?? []), ...absent])];
    const said = [
        gone.length > 0 ? `Missing: ${gone.join(", ")}. ` : "",
        facts.less ? `Left out: ${all.join(", ") || "parts of the file"}. ` : "",
        unshown.length > 0 ? `Not shown: ${unshown.join(", ")}. ` : "",
    ].join("");
    const isLess = missed.length + unshown.length + gone.length > 0;
    const smaller = size > 0 && ratio > 1 && /good|fair/.test(tone) ? `, ${times(ratio)} times smaller` : "";
    return { plain, size, claim: `${said}${words}${smaller}`, tone: isLess && tone === "good" ? "fair" : tone, rows };
}
