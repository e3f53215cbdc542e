/** Colors of vertices: their errors, or blocks. */
import { Color } from "three";
import type { BSMGeometry } from "../geometry";

export type Scheme = "plain" | "own" | "blocks" | "error" | `of ${string}`; // of: an attribute

export const LEGENDS: Partial<Record<Scheme, string>> = {
    blocks: "Order in which blocks arrive",
    error: "Distance from the original",
};

const STOPS = ["#e9eef2", "#ffe08a", "#fd9a3c", "#e0312d", "#7a0f6b"];
export const RAMP = `linear-gradient(90deg, ${STOPS.join(", ")})`;
const STEPS = Array.from({ length: 256 }, (_, i) => {
    const place = (i / 255) * (STOPS.length - 1);
    const at = Math.min(Math.floor(place), STOPS.length - 2);
    return new Color(STOPS[at]).lerp(new Color(STOPS[at + 1]), place - at).toArray();
});

/** Of distances over a diagonal, a round number (1, 2 or 5 times a power of ten) that few exceed. */
export function topOf(off: ArrayLike<number>, diagonal: number): number {
    const known = Float64Array.from(off)
        .filter((far) => far >= 0)
        .sort();
    const far = known[Math.floor(0.995 * (known.length - 1))] / diagonal || 1e-9;
    const power = 10 ** Math.floor(Math.log10(far));
    return power * [1, 2, 5, 10].find((step) => step * power >= far)!;
}

/** The attribute of a scheme at each drawn vertex: its number, or the length of its numbers; and the range. */
export function fieldOf(
    geometry: BSMGeometry | undefined,
    scheme: Scheme,
): { values: Float32Array; low: number; high: number } | undefined {
    const attribute = scheme.startsWith("of ") ? geometry?.attributes[scheme.slice(3)] : undefined;
    if (!attribute) return undefined;
    const numbers = Array.from({ length: attribute.itemSize }, (_, d) => d);
    const lengthAt = (i: number): number => Math.hypot(...numbers.map((d) => attribute.getComponent(i, d)));
    const valueAt = (_: unknown, i: number): number => (numbers.length > 1 ? lengthAt(i) : attribute.getX(i));
    const values = Float32Array.from({ length: attribute.count }, valueAt);
    const [low, high] = values.reduce(([a, b], c) => [Math.min(a, c), Math.max(b, c)], [Infinity, -Infinity]);
    return { values, low, high };
}

/** Colors of all drawn vertices, shape (n, 3), within the range of a field; undefined where a mesh has no such values. */
export function colorsOf(
    geometry: BSMGeometry,
    scheme: Scheme,
    off?: Float32Array,
    top = 1,
    { low, high } = { low: 0, high: 1 },
): Float32Array | undefined {
    const { header, origin, parted } = geometry;
    const field = fieldOf(geometry, scheme)?.values;
    if ((scheme !== "blocks" && scheme !== "error" && !field) || !header) return undefined;
    const last = Math.max((header.blocks || geometry.blocks) - 1, 1);
    const share = (i: number, vertex = parted?.[i] ?? i): number =>
        field ? (field[i] - low) / (high - low) : scheme === "error" ? off![vertex] / top : origin[vertex] / last;
    const drawn = geometry.getAttribute("position").count;
    const count = scheme === "error" ? (off?.length ?? 0) : field ? drawn : origin.length;
    if (count === 0 || (parted ?? { length: count }).length !== drawn) return undefined; // of a later run
    const colors = new Float32Array(3 * drawn);
    for (let i = 0; i < drawn; i++) colors.set(STEPS[Math.round(255 * Math.min(Math.max(share(i) || 0, 0), 1))], 3 * i);
    return colors;
}
