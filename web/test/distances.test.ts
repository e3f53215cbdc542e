/**
 * Distances of two meshes on the page: of vertices where the faces agree, in any order, and between surfaces where they
 * do not.
 */
import assert from "node:assert/strict";
import test from "node:test";
import { BufferAttribute, SphereGeometry, Triangle, Vector3 } from "three";
import { BSMGeometry } from "../src/geometry";
import { fieldOf } from "../src/viewer/colors";
import { distancesOf } from "../src/viewer/distances";

function geometryOf(points: ArrayLike<number>, faces: ArrayLike<number>): BSMGeometry {
    const geometry = new BSMGeometry();
    geometry
        .setAttribute("position", new BufferAttribute(Float32Array.from(points), 3))
        .setIndex(new BufferAttribute(Uint32Array.from(faces), 1));
    return Object.assign(geometry, { header: { vertices: points.length / 3, faces: faces.length / 3 } }) as BSMGeometry;
}

/**
 * A tetrahedron in many pieces: each side is a grid, so that faces are of one kind and no two vertices share a place.
 */
function lattice(count: number, bump: number): [number[], number[]] {
    const [points, faces]: [number[], number[]] = [[], []];
    for (let y = 0; y <= count; y++)
        for (let x = 0; x <= count; x++) points.push(x, y, bump * Math.sin(x * 0.7) * Math.cos(y * 0.4));
    const at = (x: number, y: number): number => y * (count + 1) + x;
    for (let y = 0; y < count; y++)
        for (let x = 0; x < count; x++)
            faces.push(at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
    return [points, faces];
}

const always = (): boolean => true;

test("vertices are compared where the faces agree, however they are numbered", async () => {
    const [points, faces] = lattice(9, 2);
    const moved = points.map((value, i) => value + (i % 3 === 2 ? 0.001 * Math.floor(i / 3) : 0));
    const expected = Float32Array.from({ length: 100 }, (_, vertex) => 0.001 * vertex);
    const near = (found: ArrayLike<number>, named = (vertex: number): number => vertex): void =>
        expected.forEach((far, vertex) =>
            assert.ok(Math.abs(found[named(vertex)] - far) < 1e-5, `${vertex}: ${found[named(vertex)]}`),
        );
    const there = (await distancesOf(geometryOf(moved, faces), geometryOf(points, faces), always))!;
    near(there.off);
    assert.equal(there.mean, undefined);
    assert.ok(Math.abs(there.errors[0] - 0.099) < 1e-5);
    const other = (vertex: number): number => (7 * vertex + 3) % 100;
    const shuffled: number[] = [];
    for (let vertex = 0; vertex < 100; vertex++)
        for (let d = 0; d < 3; d++) shuffled[3 * other(vertex) + d] = moved[3 * vertex + d];
    const turned = Array.from({ length: faces.length / 3 }, (_, i) => faces.slice(3 * i, 3 * i + 3))
        .reverse()
        .flatMap(([a, b, c]) => [b, c, a].map(other));
    const again = (await distancesOf(geometryOf(shuffled, turned), geometryOf(points, faces), always))!;
    near(again.off, other);
    assert.equal(again.mean, undefined);
});

test("surfaces are compared where the faces differ, as by measuring every face", async () => {
    const [fine, coarse] = [new SphereGeometry(1, 40, 30), new SphereGeometry(1.1, 13, 9)].map(
        ({ attributes: { position }, index }) => geometryOf(position.array, index!.array),
    );
    const brute = (from: BSMGeometry, to: BSMGeometry): number[] => {
        const [point, place, triangle, corners] = [
            new Vector3(),
            new Vector3(),
            new Triangle(),
            to.attributes.position as BufferAttribute,
        ];
        return [...new Set(from.index!.array)]
            .sort((a, b) => a - b)
            .map((vertex) => {
                point.fromBufferAttribute(from.attributes.position as BufferAttribute, vertex);
                let best = Infinity;
                for (let i = 0; i < to.index!.count; i += 3) {
                    triangle.setFromAttributeAndIndices(
                        corners,
                        to.index!.array[i],
                        to.index!.array[i + 1],
                        to.index!.array[i + 2],
                    );
                    const far = triangle.closestPointToPoint(point, place).distanceTo(point);
                    if (far < best) best = far;
                }
                return best;
            });
    };
    for (const [stream, original] of [
        [fine, coarse],
        [coarse, fine],
    ]) {
        const found = (await distancesOf(stream, original, always))!;
        const [off, back] = [brute(stream, original), brute(original, stream)];
        assert.deepEqual(
            [...found.off].filter((far) => far >= 0),
            off.map(Math.fround),
        );
        assert.equal(found.errors[0], Math.max(...off, ...back));
        assert.ok(Math.abs(found.mean! - off.reduce((sum, far) => sum + far, 0) / off.length) < 1e-9);
    }
});

test("nothing is measured of what cannot be compared, or is no longer shown", async () => {
    const [points, faces] = lattice(3, 1);
    const mesh = geometryOf(points, faces);
    await assert.rejects(distancesOf(mesh, geometryOf(points, []), always), /no triangles/);
    const moving = geometryOf(points, faces);
    moving.frames.push({
        positions: Float32Array.from(points),
        normals: new Int16Array(0),
        attributes: [],
        shape: { index: Uint32Array.from(faces) },
    } as never);
    await assert.rejects(distancesOf(moving, mesh, always), /sequence/);
    const [large, other] = [new SphereGeometry(1, 300, 300), new SphereGeometry(1, 301, 299)].map(
        ({ attributes: { position }, index }) => geometryOf(position.array, index!.array),
    );
    assert.equal(await distancesOf(large, other, () => false), undefined);
});

test("an attribute has colors from its least value to its largest, several numbers by their length", () => {
    const geometry = new BSMGeometry()
        .setAttribute("heat", new BufferAttribute(Float32Array.of(2, 4, 6), 1))
        .setAttribute("flow", new BufferAttribute(Float32Array.of(3, 4, 0, 0), 2)) as BSMGeometry;
    assert.deepEqual(fieldOf(geometry, "of heat"), { values: Float32Array.of(2, 4, 6), low: 2, high: 6 });
    assert.deepEqual(
        [fieldOf(geometry, "of flow")?.high, fieldOf(geometry, "of none"), fieldOf(geometry, "error")],
        [5, undefined, undefined],
    );
});
