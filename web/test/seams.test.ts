/** Light goes smoothly across tiles: normals of places that both have are the same, and their own again when one goes. */
import assert from "node:assert/strict";
import test from "node:test";
import { BufferAttribute, BufferGeometry } from "three";
import { joinNormals } from "../src/viewer/seams";

/** A strip of a cylinder between two angles, in degrees. */
function strip(from: number, to: number): BufferGeometry {
    const angles = Array.from({ length: 5 }, (_, i) => ((from + ((to - from) * i) / 4) * Math.PI) / 180);
    const points = angles.flatMap((angle) => [0, 1].flatMap((z) => [Math.cos(angle), Math.sin(angle), z]));
    const faces = Array.from({ length: 4 }, (_, i) => 2 * i).flatMap((a) => [a, a + 2, a + 1, a + 1, a + 2, a + 3]);
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(Float32Array.from(points), 3));
    geometry.setIndex(faces).computeVertexNormals();
    return geometry;
}

test("normals are joined where tiles meet", () => {
    const tiles = [strip(0, 60), strip(60, 120)];
    const before = tiles.map((tile) => [...tile.getAttribute("normal").array]);
    const at = (tile: number, vertex: number): number[] =>
        [...tiles[tile].getAttribute("normal").array.subarray(3 * vertex, 3 * vertex + 3)].map((n) =>
            Number(n.toFixed(5)),
        );
    assert.notDeepEqual(at(0, 8), at(1, 0), "each knows its own faces alone");
    joinNormals(tiles);
    for (const k of [0, 1]) assert.deepEqual(at(0, 8 + k), at(1, k));
    const [x, y] = at(0, 8);
    assert.ok(Math.abs(Math.atan2(y, x) - Math.PI / 3) < 0.05, "as of the whole cylinder");
    joinNormals([tiles[0]]);
    before[0].forEach((n, i) => assert.ok(Math.abs(tiles[0].getAttribute("normal").array[i] - n) < 1e-5));
});
