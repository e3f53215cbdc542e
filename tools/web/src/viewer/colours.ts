/** What colours say of a mesh: the block, refinement, or the distance from the original, vertex by vertex. */
import { Color } from "three";
import type { BSMGeometry } from "../geometry";

export type Scheme = "plain" | "own" | "blocks" | "refined" | "error";

/** Share of the diagonal from which on a distance has the last colour. */
const FAR = 0.01;

export const LEGENDS: Record<Scheme, string> = {
    plain: "",
    own: "As the stream has them.",
    blocks: "Blue: the first block of the chain; red: the last.",
    refined: "Blue: the base alone; red: refined.",
    error: "Blue: where the original is; red: 1 % of the diagonal away, or more. The colours follow the root of the distance.",
};

/** From blue for 0 to red for 1. */
function ramp(share: number): Color {
    return new Color().setHSL(0.68 * (1 - Math.min(Math.max(share, 0), 1)), 0.75, 0.55);
}

/** Colours of all vertices, shape (n, 3); undefined for the plain scheme. */
export function coloursOf(geometry: BSMGeometry, scheme: Scheme, distances?: Float64Array): Float32Array | undefined {
    const { header, origin, refined } = geometry;
    if (scheme === "plain" || scheme === "own" || !header || (scheme === "error" && !distances)) return undefined;
    if ((geometry.parted ?? origin).length * 3 !== geometry.getAttribute("position").array.length) return undefined; // of a later run
    const last = Math.max((header.blocks || geometry.blocks) - 1, 1);
    const shares: Record<Exclude<Scheme, "plain" | "own">, (vertex: number) => number> = {
        blocks: (vertex) => origin[vertex] / last,
        refined: (vertex) => refined[vertex],
        error: (vertex) => Math.sqrt(distances![vertex] / FAR),
    };
    const steps = Array.from({ length: 256 }, (_, i) => ramp(i / 255).toArray());
    const colours = new Float32Array(3 * origin.length);
    for (let vertex = 0; vertex < origin.length; vertex++) {
        const share = shares[scheme](vertex);
        if (origin[vertex] >= 0) colours.set(steps[Math.round(255 * Math.min(Math.max(share, 0), 1))], 3 * vertex);
    }
    return geometry.spread(colours, 3);
}

/** How far a mesh is from its original: distances and angles of what is there. */
export interface Errors {
    /** Of each vertex, in diagonals of the original. */
    distances: Float64Array;
    rms: number;
    farthest: number;
    /** Mean angle between the normals of the faces, in degrees. */
    angle: number;
}

/** Compare what is there with the original's positions, numbered as the stream numbers them. */
export function errorsOf(geometry: BSMGeometry, original: Float32Array): Errors {
    const { origin } = geometry;
    const positions = geometry.points;
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    original.forEach((value, i) => {
        low[i % 3] = Math.min(low[i % 3], value);
        high[i % 3] = Math.max(high[i % 3], value);
    });
    const diagonal = Math.hypot(...high.map((value, d) => value - low[d])) || 1;
    const distances = new Float64Array(origin.length);
    let [squares, farthest, there] = [0, 0, 0];
    for (let v = 0; v < origin.length; v++) {
        if (origin[v] < 0) continue;
        distances[v] = Math.hypot(...[0, 1, 2].map((d) => positions[3 * v + d] - original[3 * v + d])) / diagonal;
        squares += distances[v] ** 2;
        farthest = Math.max(farthest, distances[v]);
        there++;
    }
    const { parted } = geometry;
    const corners = geometry.getIndex()?.array.slice(0, geometry.drawRange.count) ?? [];
    const drawn = parted ? corners.map((corner) => parted[corner]) : corners;
    return { distances, rms: Math.sqrt(squares / Math.max(there, 1)), farthest, angle: meanAngle(drawn, positions, original) };
}

function meanAngle(faces: ArrayLike<number>, first: ArrayLike<number>, second: ArrayLike<number>): number {
    let [sum, count] = [0, 0];
    for (let i = 0; i < faces.length; i += 3) {
        const [a, b] = [first, second].map((positions) => normal(positions, faces[i], faces[i + 1], faces[i + 2]));
        const lengths = Math.hypot(...a) * Math.hypot(...b);
        if (lengths === 0) continue;
        const cosine = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / lengths;
        sum += Math.acos(Math.min(Math.max(cosine, -1), 1));
        count++;
    }
    return ((sum / Math.max(count, 1)) * 180) / Math.PI;
}

function normal(p: ArrayLike<number>, a: number, b: number, c: number): number[] {
    const [ux, uy, uz] = [0, 1, 2].map((d) => p[3 * b + d] - p[3 * a + d]);
    const [vx, vy, vz] = [0, 1, 2].map((d) => p[3 * c + d] - p[3 * a + d]);
    return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}
