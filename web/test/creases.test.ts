/** Vertices part at sharp edges of CAD models, and nowhere in scans. */
import assert from "node:assert/strict";
import test from "node:test";
import { BoxGeometry, CylinderGeometry, IcosahedronGeometry, SphereGeometry, type BufferGeometry } from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { Drawing, type Picture } from "../src/drawing";
import { Engine } from "../src/engine";
import type { Header } from "../src/index";
import { creaseOf } from "../src/pool";
import { kernels } from "./shared";

type Body = [faces: Int32Array, points: Float64Array];

/** A mesh of shared vertices, each at a place of its own. */
function bodyOf(geometry: BufferGeometry, moved: (place: number, i: number) => number = (place) => place): Body {
    for (const name of ["normal", "uv"]) geometry.deleteAttribute(name);
    const { index, attributes } = mergeVertices(geometry, 1e-5);
    return [Int32Array.from(index!.array), Float64Array.from(attributes.position.array, moved)];
}

/** The vertices at each one of a body, as drawn; of all but the first it is one more. */
function vertices([faces, points]: Body, angle?: number): number {
    const engine = new Engine(kernels, {}, false);
    const [drawn, sources] = engine.creased(faces, points, creaseOf(angle)) ?? [faces, undefined];
    engine.release();
    if (sources)
        assert.deepEqual(
            [...drawn].map((vertex) => sources[vertex]),
            [...faces],
        );
    return sources?.length ?? points.length / 3;
}

test("edges part the vertices of a box and of a cylinder, and none of a ball", () => {
    assert.equal(vertices(bodyOf(new BoxGeometry(1, 2, 3))), 24);
    const around = 48;
    assert.equal(vertices(bodyOf(new CylinderGeometry(1, 1, 2, around, 4))), 2 * (around + 1) + 5 * around);
    const ball = bodyOf(new SphereGeometry(1, 40, 30));
    assert.equal(vertices(ball), ball[1].length / 3);
});

test("a rough ball is no model with edges, but an angle of one's own counts", () => {
    let seed = 1;
    const rough = (place: number): number => {
        seed = (seed * 16807) % 2147483647;
        return place * (1 + 0.05 * (seed / 2147483647));
    };
    const body = bodyOf(new IcosahedronGeometry(1, 20), rough);
    assert.equal(vertices(body), body[1].length / 3);
    assert.ok(vertices(body, 20) > (1.1 * body[1].length) / 3);
    assert.equal(vertices(body, 180), body[1].length / 3);
    assert.equal(vertices(bodyOf(new BoxGeometry(1, 1, 1)), 0), 24);
    assert.equal(vertices(bodyOf(new BoxGeometry(1, 1, 1)), 100), 8);
});

test("faces without an area and a vertex of very many faces are taken", () => {
    const count = 60_000;
    const faces = new Int32Array(3 * count);
    const points = new Float64Array(3 * (count + 1));
    for (let i = 0; i < count; i++) {
        faces.set([0, 1 + i, 1 + ((i + 1) % count)], 3 * i);
        const angle = (2 * Math.PI * i) / count;
        points.set([Math.cos(angle), Math.sin(angle), 0.3], 3 * (i + 1));
    }
    assert.equal(vertices([faces, points], 30), count + 1);
    const [flat, places] = bodyOf(new BoxGeometry(1, 1, 1));
    const more = Int32Array.from([...flat, 0, 0, 1, 2, 2, 2]);
    assert.ok(vertices([more, places], 40) >= 24);
    assert.ok(vertices([flat, places.map((place, i) => (i < 3 ? NaN : place))], 40) >= 8);
});

/** The drawn vertices of a sequence with a run of one frame for each body. */
function inRuns(...bodies: Body[]): number[] {
    const engine = new Engine(kernels, {}, false);
    const counts: number[] = [];
    const count = (picture: Picture): unknown =>
        picture.type === "whole" && counts.push(picture.shape.positions.length / 3);
    const drawing = new Drawing(false, {}, engine, count, creaseOf());
    const loose = { vertices: new Int32Array(0), positions: new Float64Array(0) };
    for (const [run, [faces, positions]] of bodies.entries()) {
        drawing.accept({ type: "header", header: { run, light: 0, blocks: 1 } as Header });
        drawing.accept({ type: "connectivity", faces, vertices: positions.length / 3, loose });
        drawing.accept({ type: "frame", index: run, positions, attributes: [] });
    }
    engine.release();
    return counts;
}

test("the first run of a sequence decides whether edges part vertices", () => {
    const [box, ball] = [bodyOf(new BoxGeometry(1, 1, 1)), bodyOf(new IcosahedronGeometry(1, 0))]; // edges of 42 degrees
    assert.deepEqual(inRuns(box, ball, box), [24, 60, 24]);
    assert.deepEqual(inRuns(ball, box, ball), [12, 8, 12]);
});
