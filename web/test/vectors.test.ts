/** Every vector of the specification: decoded to the last bit, or refused with the right kind of error. */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { decode, type Attribute, type Event, type Header, type Kernels, type Mesh } from "../src/index";
import { readNpz, type NumpyArray } from "./npz";
import { kernels, eventsOf, FOLDERS, lesserDecode, meshOfEvents } from "./shared";

interface Vector {
    folder: string;
    name: string;
    error?: string;
}

const vectors = FOLDERS.flatMap((folder) => {
    const manifest = JSON.parse(readFileSync(join(folder, "manifest.json"), "utf8")) as { vectors: Vector[] };
    return manifest.vectors.map((vector) => ({ ...vector, folder }));
});
const WAYS: [string, (kernels: Kernels, data: Uint8Array) => Mesh][] = [
    ["whole", decode],
    ["in events", (kernels, data) => meshOfEvents(eventsOf(kernels, data, data.length))],
    [
        "as a whole, in events",
        (kernels, data) => meshOfEvents(eventsOf(kernels, data, data.length, {}, { whole: true })),
    ],
    ["byte by byte", (kernels, data) => meshOfEvents(eventsOf(kernels, data, 1))],
];

for (const [vector, way, take] of vectors.flatMap((vector) => WAYS.map((one) => [vector, ...one] as const))) {
    test(`${vector.name} ${way}`, async () => {
        const data = readFileSync(join(vector.folder, `${vector.name}.bsm`));
        if (vector.error) assert.throws(() => take(kernels, data), { name: errorName(vector.error) });
        else
            compare(
                take(kernels, data),
                readNpz(readFileSync(join(vector.folder, `${vector.name}.npz`))),
                way !== "whole",
            );
    });
}

/** Whether a stream has what the small build leaves out. */
function isLarge({ bits, attributes, gopFrames }: Header): boolean {
    return bits > 0 || attributes > 0 || gopFrames > 0;
}

for (const build of ["small", "grid", "blocks"] as const)
    test(`the ${build} build decodes its meshes to the same, and says that it has no others`, async () => {
        const [take, full] = [await lesserDecode(build), kernels];
        let known = 0;
        for (const { folder, name } of vectors.filter(({ name }) => name.startsWith("good-"))) {
            const data = readFileSync(join(folder, `${name}.bsm`));
            const begin = eventsOf(full, data, data.length).next().value as Event;
            assert.ok(begin.type === "header");
            const kind = begin.header.grid.length > 0 ? "grid" : "blocks";
            const isOwn = !isLarge(begin.header) && (build === "small" || build === kind);
            if (isOwn) assert.deepEqual(take(data), decode(full, data), name);
            else assert.throws(() => take(data), { name: "UnsupportedError" }, name);
            known += isOwn ? 1 : 0;
        }
        assert.ok(known > 0);
    });

test("the build of sequences decodes those without attributes to the same, and says that it has no grids", async () => {
    const [take, full] = [await lesserDecode("moving"), kernels];
    let sequences = 0;
    for (const { folder, name } of vectors.filter(({ name }) => name.startsWith("good-"))) {
        const data = readFileSync(join(folder, `${name}.bsm`));
        const begin = eventsOf(full, data, data.length).next().value as Event;
        assert.ok(begin.type === "header");
        const { bits, attributes, gopFrames, grid } = begin.header;
        if (grid.length > 0) assert.throws(() => take(data), { name: "UnsupportedError" }, name);
        if (gopFrames === 0 || bits > 0 || attributes > 0) continue;
        assert.deepEqual(take(data), meshOfEvents(eventsOf(full, data, data.length)), name);
        sequences++;
    }
    assert.ok(sequences > 0);
});

for (const build of ["quick", "parts"] as const)
    test(`the ${build} build decodes meshes on light grids to the same, and says that it has nothing else`, async () => {
        const [take, full] = [await lesserDecode(build), kernels];
        let lights = 0;
        for (const { folder, name } of vectors.filter(({ name }) => name.startsWith("good-"))) {
            const data = readFileSync(join(folder, `${name}.bsm`));
            const begin = eventsOf(full, data, data.length).next().value as Event;
            assert.ok(begin.type === "header");
            const { light, congruence } = begin.header;
            const isOther = isLarge(begin.header) || light !== 1 || /splits|ordered|repeats/.test(name);
            if (isOther || (build === "quick" && congruence > 0))
                assert.throws(() => take(data), { name: "UnsupportedError" }, name);
            else assert.deepEqual(take(data), decode(full, data), name);
            lights += light === 1 && (build === "quick" || congruence > 0) ? 1 : 0;
        }
        assert.ok(lights > 0);
    });

function errorName(kind: string): string {
    return `${kind[0].toUpperCase()}${kind.slice(1)}Error`;
}

function compare(mesh: Mesh, expected: Record<string, NumpyArray>, all: boolean): void {
    // Events give all frames of a sequence, a mesh is its first one.
    const [vertices, count] = all ? [] : (expected.runs?.values.subarray(1, 3) ?? [expected.positions.shape.at(-2)!]);
    const faces = expected.faces.values.subarray(0, count && 3 * Number(count));
    const positions = { values: expected.positions.values.subarray(0, vertices && 3 * Number(vertices)) };
    assert.deepEqual(mesh.faces, faces);
    assert.equal(mesh.positions.length, positions.values.length);
    positions.values.forEach((value, i) => assert.equal(mesh.positions[i], value, `coordinate ${i}`));
    // Arrays are those of the last run.
    if (all || !expected.runs) compareAttributes(mesh.attributes, expected, all);
}

/** Arrays of attributes are called by number, semantic, domain and name; indices of corners by the number. */
function compareAttributes(attributes: Attribute[], expected: Record<string, NumpyArray>, all: boolean): void {
    const names = Object.keys(expected).filter((name) => name.startsWith("attribute "));
    const byTitle = new Map(
        attributes.map((attribute) => [`${attribute.semantic} ${attribute.domain} ${attribute.name}`, attribute]),
    );
    assert.equal(attributes.length, names.length);
    for (const name of names) {
        const [, number, title] = /^attribute (\d+) (.*)$/s.exec(name)!;
        const found = byTitle.get(title);
        assert.ok(found, `${title} is not among ${[...byTitle.keys()]}`);
        const { values: given, shape } = expected[name];
        const values = shape.length > 2 && !all ? given.subarray(0, given.length / shape[0]) : given;
        assert.equal(found.values.length, values.length);
        found.values.forEach((value, i) =>
            assert.ok(
                Math.abs(value - Number(values[i])) <= 1e-6 * Math.max(Math.abs(Number(values[i])), 1),
                `${title} ${i}: ${value}, not ${values[i]}`,
            ),
        );
        const indices = expected[`indices ${number}`];
        assert.deepEqual(found.indices, indices?.values);
    }
}
