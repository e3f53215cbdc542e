/** What objects of three.js hold, row by row of the table of README.md: kept, refused or noted. */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test, { describe } from "node:test";
import {
    BoxGeometry,
    BufferAttribute,
    BufferGeometry,
    Color,
    Float16BufferAttribute,
    Group,
    InstancedBufferAttribute,
    InstancedBufferGeometry,
    InstancedMesh,
    InterleavedBuffer,
    InterleavedBufferAttribute,
    LOD,
    Mesh,
    MeshBasicMaterial,
    Points,
    SkinnedMesh,
    SphereGeometry,
    SRGBColorSpace,
    Texture,
} from "three";
import { encodeHere, EncodeError, type EncodeOptions, type Drawn, type MeshInput } from "../src/encode";
import { BSMGeometry } from "../src/geometry";
import { decode, type Attribute } from "../src/index";
import { materialsOf } from "../src/materials";
import { factsOf } from "../src/viewer/facts";
import { numbersOf } from "../src/parting";
import { kernels, WEB } from "./shared";

const wasm = await WebAssembly.compile(readFileSync(join(WEB, "built/encode.wasm")));

interface Found {
    low: number[];
    high: number[];
    faces: number;
    attribute: (name: string) => Attribute | undefined;
    notes: string[];
    /** Whether faces look away from the middle of their mesh. */
    volume: number;
}

/** What comes back of what was encoded exactly. */
async function back(given: MeshInput | Drawn, options: EncodeOptions = { lossless: true }): Promise<Found> {
    const notes: string[] = [];
    const {
        positions: p,
        faces,
        attributes,
    } = decode(kernels, await encodeHere(given, { ...options, wasm, onNote: (note) => notes.push(note) }));
    const ends = (end: (...numbers: number[]) => number): number[] =>
        [0, 1, 2].map((d) => Math.fround(end(...p.filter((_, i) => i % 3 === d))));
    let volume = 0;
    for (let i = 0; i < faces.length; i += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => p.subarray(3 * faces[i + k], 3 * faces[i + k] + 3));
        volume +=
            (a[0] * (b[1] * c[2] - b[2] * c[1]) +
                a[1] * (b[2] * c[0] - b[0] * c[2]) +
                a[2] * (b[0] * c[1] - b[1] * c[0])) /
            6;
    }
    return {
        low: ends(Math.min),
        high: ends(Math.max),
        faces: faces.length / 3,
        attribute: (name) => attributes.find((each) => each.name === name),
        notes,
        volume,
    };
}

const box = (): BufferGeometry => new BoxGeometry(2, 2, 2);
const positions = (geometry: BufferGeometry, attribute: BufferAttribute | InterleavedBufferAttribute): BufferGeometry =>
    geometry.setAttribute("position", attribute);
const moved = (mesh: Mesh): Mesh => (mesh.position.set(5, 0, 0), mesh.scale.set(1, 1, -2), new Group().add(mesh), mesh);
const CUBE = [-1, -1, -1];

describe("kept", () => {
    const half = (): number[] => [...box().getAttribute("position").array].map((x) => (x > 0 ? 0x3c00 : 0xbc00));
    const whole = (one: number): number[] => [...box().getAttribute("position").array].map((x) => one * x);
    const spaced = (): InterleavedBufferAttribute => {
        const { array } = box().getAttribute("position");
        const buffer = new InterleavedBuffer(
            Int16Array.from({ length: (4 * array.length) / 3 }, (_, i) =>
                i % 4 ? 32767 * array[3 * (i >> 2) + (i % 4) - 1] : 7,
            ),
            4,
        );
        return new InterleavedBufferAttribute(buffer, 3, 1, true);
    };
    for (const [what, geometry] of Object.entries({
        "normalized int16": positions(box(), new BufferAttribute(Int16Array.from(whole(32767)), 3, true)),
        "normalized int8": positions(box(), new BufferAttribute(Int8Array.from(whole(127)), 3, true)),
        "plain int32": positions(box(), new BufferAttribute(Int32Array.from(whole(1)), 3)),
        "half floats": positions(box(), new Float16BufferAttribute(Uint16Array.from(half()), 3)),
        doubles: positions(box(), new BufferAttribute(Float64Array.from(whole(1)), 3)),
        "interleaved, normalized": positions(box(), spaced()),
        "no index": box().toNonIndexed(),
        "four numbers": positions(
            box(),
            new BufferAttribute(
                Float32Array.from({ length: 96 }, (_, i) => (i % 4 < 3 ? whole(1)[3 * (i >> 2) + (i % 4)] : 9)),
                4,
            ),
        ),
        "no shape of a morph": Object.assign(box(), { morphAttributes: { position: [] } }),
        "beside numbers of 64 bits": box().setAttribute("id", new BufferAttribute(new BigInt64Array(24) as never, 1)),
        "a longer attribute": box().setAttribute("uv", new BufferAttribute(new Float32Array(60), 2)),
    })) {
        test(`positions: ${what}`, async () => {
            const found = await back(geometry);
            assert.deepEqual([found.low, found.high, found.faces], [CUBE, [1, 1, 1], 12]);
        });
    }

    test("other attributes as the numbers that they stand for", async () => {
        const [geometry, count] = [box(), 24];
        geometry.setAttribute(
            "uv",
            new BufferAttribute(
                Uint16Array.from({ length: 2 * count }, () => 65535),
                2,
                true,
            ),
        );
        geometry.setAttribute(
            "heat",
            new BufferAttribute(
                Float32Array.from({ length: count }, (_, i) => i),
                1,
            ),
        );
        const { attribute } = await back(geometry);
        assert.deepEqual([attribute("uv")!.values[0], attribute("heat")!.kind], [1, "float32"]);
    });

    test("colors, which are linear in three.js and glTF, and sRGB in streams", async () => {
        const [bytes, color] = [Uint8Array.from({ length: 72 }, (_, i) => (37 * i) & 255), new Color()];
        const linear = Float32Array.from(bytes, (byte) => color.setRGB(byte / 255, 0, 0, SRGBColorSpace).r);
        const colored = async (values: Float32Array | Uint8Array): Promise<Attribute> =>
            (
                await back(box().setAttribute("color", new BufferAttribute(values, 3, true)), {
                    lossless: true,
                    keepOrder: true,
                })
            ).attribute("color")!;
        const [exact, coarse, bright] = [
            await colored(linear),
            await colored(bytes),
            await colored(linear.map((share) => 2 * share)),
        ];
        assert.deepEqual(
            [exact.values, exact.kind, coarse.kind, bright.semantic],
            [Float64Array.from(bytes), "uint8", "uint16", "generic"],
        );
        const given = [...linear, ...[...bytes, ...bytes].map((byte) => byte / 255)];
        [exact, { ...exact, name: "COLOR_0" }, coarse]
            .flatMap((each) => [...numbersOf(each)])
            .forEach((share, i) => assert.ok(Math.abs(share - given[i]) < 2e-5));
    });

    test("the draw range, and the materials of groups", async () => {
        const geometry = box();
        geometry.setDrawRange(6, 12);
        const found = await back(geometry);
        assert.equal(found.faces, 4);
        assert.deepEqual([...new Set(found.attribute("material")!.values)].sort(), [1, 2]);
        for (const few of [
            [new MeshBasicMaterial()],
            [0, 1, 2, 3, 4, 5].map((i) => new MeshBasicMaterial({ visible: i === 3 })),
        ])
            assert.equal((await back(new Mesh(box(), few))).faces, 2);
    });

    test("where an object is, what it mirrors, its parts, and their materials", async () => {
        const one = await back(moved(new Mesh(new SphereGeometry(1, 8, 6))));
        assert.deepEqual([one.low[0], one.high[2]], [4, 2]);
        assert.ok(one.volume > 0, "turned inside out");
        const normals = one.attribute("normal")!.values;
        assert.ok(Math.abs(Math.hypot(...normals.subarray(0, 3)) - 1) < 1e-3);
        const still = Object.assign(new Mesh(box()), { matrixAutoUpdate: false });
        still.matrix.makeTranslation(9, 0, 0);
        assert.deepEqual((await back(still)).low, [8, -1, -1]);
        const group = new Group().add(
            new Mesh(box(), new MeshBasicMaterial({ name: "red" })),
            moved(new Mesh(box(), new MeshBasicMaterial({ name: "blue" }))),
        );
        const both = await back(group);
        assert.deepEqual([both.low, both.high, both.faces], [[-1, -1, -2], [6, 1, 2], 24]);
        assert.deepEqual(
            [[...new Set(both.attribute("part")!.values)], [...new Set(both.attribute("material")!.values)]].map(
                (each) => each.sort(),
            ),
            [
                [0, 1],
                [0, 1],
            ],
        );
    });

    test("plain arrays, and whole numbers as positions", async () => {
        const flat = { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], faces: [0, 2, 1] };
        for (const mesh of [
            flat,
            { ...flat, positions: Int16Array.from(flat.positions) },
            { ...flat, faces: Uint16Array.from(flat.faces) },
        ]) {
            const found = await back(mesh);
            assert.deepEqual([found.low, found.high, found.faces], [[0, 0, 0], [1, 1, 0], 1]);
        }
        const mesh = { ...flat, attributes: [{ name: "heat", values: [1, 2, 3], components: 1 }] };
        assert.deepEqual([...(await back(mesh)).attribute("heat")!.values].sort(), [1, 2, 3]);
    });
});

describe("refused", () => {
    const morphed = (): BufferGeometry => {
        const geometry = box();
        geometry.morphAttributes.position = [geometry.getAttribute("position").clone() as BufferAttribute];
        return geometry;
    };
    const instanced = (): BufferGeometry =>
        box().setAttribute("shift", new InstancedBufferAttribute(new Float32Array(6), 3));
    const mesh = { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], faces: [0, 1, 2] };
    const corners = { name: "uv", values: [0, 0, 1, 1], components: 2, domain: "corner" as const };
    for (const [what, [given, said, options]] of Object.entries({
        "morph targets": [morphed(), /morph targets/],
        "morph targets of an object": [new Mesh(morphed()), /morph targets/],
        skins: [new SkinnedMesh(box()), /skins/],
        instances: [new InstancedMesh(box(), undefined, 2), /instances/],
        "instances of a geometry": [new InstancedBufferGeometry().copy(box() as InstancedBufferGeometry), /instances/],
        "instances of an attribute": [instanced(), /instances/],
        "levels of detail": [new LOD().addLevel(new Mesh(box())), /levels of detail/],
        points: [new Points(box()), /only points and lines/],
        "no face in the draw range": [Object.assign(box(), { drawRange: { start: 99, count: 3 } }), /no face is drawn/],
        "nothing that can be seen": [Object.assign(new Mesh(box()), { visible: false }), /only what is invisible/],
        "a half vertex": [{ ...mesh, faces: [0, 0.5, 2] }, /whole numbers/],
        "a vertex below 0": [{ ...mesh, faces: [0, -1, 2] }, /whole numbers/],
        "short indices": [{ ...mesh, attributes: [{ ...corners, indices: [0, 1] }] }, /for each corner/],
        "short values": [{ ...mesh, attributes: [{ ...corners, domain: "vertex" as const }] }, /for each vertex/],
        "metadata of no kind": [{ ...mesh, metadata: { on: true as unknown as string } }, /metadata on/],
        "bits that are no number": [mesh, /finite/, { bits: NaN }],
        "a cell that is no number": [mesh, /finite/, { cell: NaN }],
        "a bound that is no number": [
            { ...mesh, attributes: [{ name: "heat", values: [1, 2, 3], components: 1, quality: { bound: NaN } }] },
            /quality/,
        ],
    } as Record<string, [MeshInput | Drawn, RegExp, EncodeOptions?]>)) {
        test(what, async () => {
            await assert.rejects(
                back(given, options),
                (error: Error) => (error instanceof EncodeError && said.test(error.message)) || assert.fail(`${error}`),
            );
        });
    }
});

test("noted: points beside meshes, what is invisible, what some parts lack, wide attributes, textures", async () => {
    const wide = box().setAttribute("wide", new BufferAttribute(new Float32Array(24 * 16), 16));
    const group = new Group().add(
        new Mesh(wide, new MeshBasicMaterial({ map: new Texture() })),
        new Mesh(box().deleteAttribute("uv")),
        new Points(box()),
        Object.assign(new Mesh(box()), { visible: false }),
    );
    const { notes, faces } = await back(group);
    assert.equal(faces, 24);
    assert.deepEqual(notes, ["Left out: points and lines, what is invisible, uv, wide, textures."]);
});

test("black beside an image is no color, and MTL has colors of screens", async () => {
    const metadata = new Map<string, string | number>([
        ["material.0.Kd", "0 0 0"],
        ["material.0.map_Kd", 0],
        ["material.0.Ke", "0.5 0.5 0.5"],
    ]);
    const [{ color, emissive }] = await materialsOf({ metadata, pieces: [] } as unknown as BSMGeometry);
    assert.deepEqual([color.getHexString(), emissive.getHexString()], ["ffffff", "808080"]);
});

test("what of a file is left out and cannot be seen hides no sizes", () => {
    const layers = [1000, 100].map((size) => ({ title: "", detail: "", size }));
    const sizesWith = (note: string): number | undefined =>
        factsOf({ name: "a", main: 1, layers, facts: { less: true, notes: [note] } }, 100, new BSMGeometry()).plain;
    const header = "the number of triangles in the header (0; by its size, the file has 12)";
    for (const what of [
        "comments amid the data (2)",
        header,
        "TANGENT of attributes, skins",
        "cameras",
        "7 bytes after the last triangle",
    ])
        assert.equal(sizesWith(`left out: ${what}`), 1000, what);
    for (const what of ["points and lines", "COLOR_1 of attributes, cameras", "colors in comments (#MRGB)"])
        assert.equal(sizesWith(`left out: ${what}`), undefined, what);
});
