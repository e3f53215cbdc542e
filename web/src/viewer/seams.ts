/**
 * Normals of tiles that lie beside each other, joined where they meet.
 *
 * A tile is decoded by itself, so the normals along its rim know nothing of the faces beyond it, and light breaks there.
 * Tiles of one level have the same places along their common rim, to the last bit. So each tile keeps, once, the vertices
 * of its rim by their places, with the sum of the normals of its own faces; whenever other tiles are shown, the sums of
 * all that meet at a place are added. Between tiles of different levels only the places that both have are joined.
 */
import { type BufferGeometry, Vector3 } from "three";

/** The vertices at a place of the rim, and the area vectors of the faces around them. */
interface RimPlace {
    vertices: number[];
    sum: Vector3;
}

/** Vertices of edges that have a face on one side only, by their places. */
function rimOf(geometry: BufferGeometry): Map<string, RimPlace> {
    const [index, { array, count }] = [geometry.getIndex()!.array, geometry.getAttribute("position")];
    const edges = new Set<number>();
    const eachEdge = (act: (a: number, b: number) => void): void => {
        for (let i = 0; i < index.length; i += 3)
            for (let k = 0; k < 3; k++) act(index[i + k], index[i + ((k + 1) % 3)]);
    };
    eachEdge((a, b) => edges.add(a * count + b));
    const rim = new Map<number, RimPlace>();
    const places = new Map<string, RimPlace>();
    eachEdge((a, b) => {
        if (edges.has(b * count + a)) return;
        for (const vertex of [a, b]) {
            if (rim.has(vertex)) continue;
            const key = array.subarray(3 * vertex, 3 * vertex + 3).join();
            const place = places.get(key) ?? { vertices: [], sum: new Vector3() };
            place.vertices.push(vertex);
            places.set(key, place);
            rim.set(vertex, place);
        }
    });
    const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
    for (let i = 0; i < index.length; i += 3) {
        const met = [0, 1, 2].flatMap((k) => rim.get(index[i + k]) ?? []);
        if (met.length === 0) continue;
        [a, b, c].forEach((corner, k) => corner.fromArray(array, 3 * index[i + k]));
        b.sub(a).cross(c.sub(a));
        for (const { sum } of met) sum.add(b);
    }
    return places;
}

/** Join the normals of geometries where they have the same places; those of one alone are its own again. */
export function joinNormals(geometries: BufferGeometry[]): void {
    const rims = geometries.map((geometry) => (geometry.userData.rim ??= rimOf(geometry)) as Map<string, RimPlace>);
    const sums = new Map<string, Vector3>();
    for (const rim of rims) for (const [key, { sum }] of rim) sums.set(key, (sums.get(key) ?? new Vector3()).add(sum));
    geometries.forEach((geometry, i) => {
        const normals = geometry.getAttribute("normal");
        if (!normals) return;
        for (const [key, { vertices }] of rims[i]) {
            const { x, y, z } = sums.get(key)!.clone().normalize();
            for (const vertex of vertices) normals.setXYZ(vertex, x, y, z);
        }
        normals.needsUpdate = true;
    });
}
