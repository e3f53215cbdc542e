/** Lines over a mesh: edges that are wrong, and normals. */
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Vector3 } from "three";
import { BSMGeometry } from "../geometry";

/** Edges that one face alone has (red), or more than two (violet), as lines. */
export function wrongEdges(geometry: BufferGeometry): LineSegments {
    const [index, { array, count }] = [geometry.getIndex()!, geometry.getAttribute("position")];
    const parted = geometry instanceof BSMGeometry ? geometry.parted : undefined;
    const edges = new Map<number, [number, number, number]>();
    for (let i = 0; i < index.count; i++) {
        const [a, b] = [index.getX(i), index.getX(i - (i % 3) + ((i + 1) % 3))];
        const [u, v] = [parted?.[a] ?? a, parted?.[b] ?? b];
        const key = Math.min(u, v) * count + Math.max(u, v);
        edges.set(key, [a, b, 1 + (edges.get(key)?.[2] ?? 0)]);
    }
    const wrong = [...edges.values()].filter(([a, b, faces]) => faces !== 2 && a !== b);
    const placeOf = (drawn: number): number[] => [...array.slice(3 * drawn, 3 * drawn + 3)];
    const places = wrong.flatMap(([a, b]) => [...placeOf(a), ...placeOf(b)]);
    const colors = wrong.flatMap(([, , faces]) => (faces === 1 ? [1, 0, 0, 1, 0, 0] : [0.5, 0, 1, 0.5, 0, 1]));
    const lines = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
    lines.setAttribute("color", new BufferAttribute(new Float32Array(colors), 3));
    return new LineSegments(lines, new LineBasicMaterial({ vertexColors: true }));
}

/** Normals of vertices as lines of this length. */
export function normalLines(geometry: BufferGeometry, length: number): LineSegments {
    const { position, normal } = geometry.attributes;
    const places = new Float32Array(6 * position.count);
    const [from, to] = [new Vector3(), new Vector3()];
    for (let i = 0; i < position.count; i++) {
        to.fromBufferAttribute(normal, i).multiplyScalar(length).add(from.fromBufferAttribute(position, i));
        from.toArray(places, 6 * i);
        to.toArray(places, 6 * i + 3);
    }
    const lines = new BufferGeometry().setAttribute("position", new BufferAttribute(places, 3));
    return new LineSegments(lines, new LineBasicMaterial({ color: 0x0b63ce }));
}
