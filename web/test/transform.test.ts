/** The extension for glTF-Transform, with its own library. */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test, { describe } from "node:test";
import { pathToFileURL } from "node:url";
import { Document, WebIO, type Primitive } from "@gltf-transform/core";
// @ts-expect-error the package has no types
import { validateBytes } from "gltf-validator";
import { TorusKnotGeometry } from "three";
import type * as Transform from "../src/transform";
import type { SceneDecoder } from "../src/transform";
import { decode, type Picture, type Shape } from "../src/index";
import type { Listener, Pool } from "../src/pool";
import { CodedViews } from "../src/views";
import { sceneOf } from "./scene";
import { kernels, VECTORS, WEB } from "./shared";

describe("glTF-Transform", async () => {
    // The built module finds its kernels beside itself.
    const { EXTBSMCompression, loadSceneDecoder, loadSceneEncoder } = (await import(
        pathToFileURL(join(WEB, "built/gltf-transform.js")).href
    )) as typeof Transform;
    const decoder = await loadSceneDecoder();
    const stream = new Uint8Array(readFileSync(join(VECTORS, "good-attribute-uv-plain.bsm")));
    const shape = decoder(stream);
    const io = (): WebIO =>
        new WebIO().registerExtensions([EXTBSMCompression]).registerDependencies({ "bsm.decoder": decoder });
    const [vertices, corners] = [shape.positions.length / 3, shape.index.length];

    test("reads what streams hold, and writes it plain", async () => {
        const document = await io().readBinary(sceneOf(stream, vertices, corners));
        const written = await new WebIO().readBinary(await io().writeBinary(document)); // by who does not know the extension
        const [primitive] = written.getRoot().listMeshes()[0].listPrimitives();
        const { positions, faces } = decode(kernels, stream);
        assert.deepEqual([...(primitive.getAttribute("POSITION")?.getArray() ?? [])], [...shape.positions]);
        assert.deepEqual([...(primitive.getAttribute("NORMAL")?.getArray() ?? [])], [...shape.normals]);
        assert.deepEqual([...(primitive.getIndices()?.getArray() ?? [])], [...shape.index]);
        assert.equal(faces.length, corners);
        const drawn = [0, 1, 2].map((k) => shape.positions[3 * shape.index[0] + k]);
        assert.ok(drawn.every((value, k) => Math.abs(value - positions[3 * faces[0] + k]) < 1e-5));
        assert.deepEqual(written.getRoot().listExtensionsUsed(), []);
        assert.equal(written.getRoot().listBuffers().length, 1);
    });

    /** A scene whose bufferViews name so many streams, all of the same bytes, by their places. */
    function repeated(count: number): Uint8Array {
        const plain = sceneOf(stream, vertices, corners);
        const [view, length] = [new DataView(plain.buffer, plain.byteOffset), plain.byteLength];
        const end = 20 + view.getUint32(12, true);
        const tree = JSON.parse(new TextDecoder().decode(plain.subarray(20, end)));
        const [of, first] = [tree.bufferViews[0], tree.bufferViews[1]];
        for (let i = 0; i < count; i++) {
            const stream = tree.bufferViews.push({ ...of }) - 1;
            tree.bufferViews.push({ ...first, extensions: { EXT_bsm_compression: { stream, attribute: "POSITION" } } });
        }
        const json = Buffer.from(JSON.stringify(tree).padEnd(Math.ceil(JSON.stringify(tree).length / 4) * 4));
        const head = Buffer.from(Uint32Array.of(2, 20 + json.length + length - end, json.length, 0x4e4f534a).buffer);
        return Buffer.concat([Buffer.from("glTF"), head, json, plain.subarray(end)]);
    }

    test("decodes equal bytes once, and bounds what all become", async () => {
        const decoded: Shape[] = [];
        const counting = (made: (given: Uint8Array) => Shape) => (given: Uint8Array) => {
            decoded.push(made(given));
            return decoded.at(-1)!;
        };
        const reader = (made: SceneDecoder): WebIO =>
            new WebIO().registerExtensions([EXTBSMCompression]).registerDependencies({ "bsm.decoder": counting(made) });
        const document = await reader(decoder).readBinary(repeated(300));
        assert.equal(decoded.length, 1);
        assert.deepEqual(
            [...document.getRoot().listMeshes()[0].listPrimitives()[0].getAttribute("POSITION")!.getArray()!],
            [...shape.positions],
        );
        const vast = (given: Uint8Array): Shape => ({
            ...decoder(given),
            normals: { byteLength: 2 ** 30 } as Float32Array,
        });
        await assert.rejects(reader(vast).readBinary(repeated(1)), /become more than 1073741824 bytes/);
    });

    test("ends all decodings of a scene whose streams or frames become too much", async () => {
        const closed: string[] = [];
        const decoding = (name: string) => ({
            close: () => void closed.push(name),
            receiveData: () => undefined,
            receiveEof: () => undefined,
        });
        const views = new CodedViews<Shape>();
        const half = { ...shape, index: { byteLength: 2 ** 29 } as Uint32Array };
        const heard: ((picture: Picture) => void)[] = [];
        const begin = (name: string): Promise<unknown> =>
            views
                .decode(
                    { open: ({ onPicture }: Listener) => (heard.push(onPicture!), decoding(name)) } as unknown as Pool,
                    new Uint8Array(),
                    name,
                    () => {},
                    () => {},
                )
                .catch(String);
        void begin("a");
        heard[0]({ type: "whole", shape: half, run: 0 });
        void begin("b");
        assert.deepEqual(closed, []);
        const frame = {
            type: "frame",
            index: 0,
            positions: { byteLength: 2 ** 29 } as Float32Array,
            normals: new Int16Array(),
        } as const;
        const bounds = { low: [], high: [], center: [0, 0, 0] as [number, number, number], radius: 0 };
        assert.throws(() => heard[1]({ ...frame, ...bounds, attributes: [] }), /become more than/); // which the pool passes on
        assert.deepEqual(closed, ["a", "b"]);
        assert.match(String(await begin("c")), /become more than/);
        assert.deepEqual(closed.slice(2).sort(), ["a", "b", "c"]);
    });

    /**
     * A document of a knot with normals, texture coordinates, a number of each vertex, and another primitive of its
     * lower half.
     */
    function knotted(): Document {
        const [document, knot] = [new Document(), new TorusKnotGeometry(1, 0.3, 120, 12)];
        const buffer = document.createBuffer();
        const accessor = (
            type: "VEC3" | "VEC2" | "SCALAR",
            array: ArrayLike<number>,
            Kind: typeof Float32Array | typeof Uint16Array | typeof Uint8Array,
        ) => document.createAccessor().setType(type).setArray(Kind.from(array)).setBuffer(buffer);
        const { position, normal, uv } = knot.attributes;
        const places = accessor("VEC3", position.array, Float32Array);
        const mesh = document.createMesh();
        for (const [first, end] of [
            [0, knot.index!.count],
            [0, knot.index!.count / 2],
        ]) {
            const indices = accessor("SCALAR", knot.index!.array.slice(first, end), Uint16Array);
            mesh.addPrimitive(document.createPrimitive().setIndices(indices).setAttribute("POSITION", places));
        }
        mesh.listPrimitives()[0]
            .setAttribute("NORMAL", accessor("VEC3", normal.array, Float32Array))
            .setAttribute("TEXCOORD_0", accessor("VEC2", uv.array, Float32Array))
            .setAttribute(
                "_PART",
                accessor(
                    "SCALAR",
                    Uint8Array.from({ length: position.count }, (_, i) => i & 3),
                    Uint8Array,
                ),
            );
        document.createScene().addChild(document.createNode().setMesh(mesh));
        return document;
    }

    /** How far corners of two primitives that are sorted alike lie apart. */
    function apart(a: Primitive, b: Primitive): number {
        const sorted = (primitive: Primitive): number[][] => {
            const [index, places] = [primitive.getIndices()!.getArray()!, primitive.getAttribute("POSITION")!];
            return [...index]
                .map((vertex) => places.getElement(vertex, [] as number[]))
                .sort((p, q) => Math.round(64 * (p[0] - q[0])) || Math.round(64 * (p[1] - q[1])) || p[2] - q[2]);
        };
        const [given, found] = [sorted(a), sorted(b)];
        assert.equal(found.length, given.length);
        const sum = (points: number[][]): number[] =>
            [0, 1, 2].map((d) => points.reduce((total, point) => total + point[d], 0) / points.length);
        const [from, to] = [sum(given), sum(found)];
        return Math.hypot(...from.map((value, d) => value - to[d]));
    }

    test(
        "writes streams, which are read again",
        { skip: !loadSceneEncoder && "built/ is of older sources" },
        async () => {
            const encoder = await loadSceneEncoder();
            const [given, plain] = [knotted(), await new WebIO().writeBinary(knotted())];
            given.createExtension(EXTBSMCompression);
            const line = given
                .createPrimitive()
                .setMode(1)
                .setAttribute("POSITION", given.getRoot().listMeshes()[0].listPrimitives()[0].getAttribute("POSITION"));
            given.getRoot().listMeshes()[0].addPrimitive(line);
            const packed = await io().registerDependencies({ "bsm.encoder": encoder }).writeBinary(given);
            const { issues } = (await validateBytes(packed)) as { issues: { messages: { severity: number }[] } };
            assert.deepEqual(
                issues.messages.filter(({ severity }) => severity === 0),
                [],
            );
            const found = await io().readBinary(packed);
            const [[whole, half, kept], [all, lower]] = [found, given].map((document) =>
                document.getRoot().listMeshes()[0].listPrimitives(),
            );
            assert.ok(apart(all, whole) < 1e-4 && apart(lower, half) < 1e-4);
            assert.deepEqual(kept.getAttribute("POSITION")?.getArray(), line.getAttribute("POSITION")?.getArray());
            assert.deepEqual(whole.listSemantics().sort(), all.listSemantics().sort());
            assert.deepEqual(new Set(whole.getAttribute("_PART")!.getArray()), new Set([0, 1, 2, 3]));
            given.getRoot().listMeshes()[0].removePrimitive(line);
            line.dispose();
            const smaller = await io().registerDependencies({ "bsm.encoder": encoder }).writeBinary(given);
            assert.ok(smaller.length < plain.length / 4, `${smaller.length} of ${plain.length}`);
            await assert.rejects(io().writeBinary(given), /bsm\.encoder/);
        },
    );

    test("says what is wrong", async () => {
        await assert.rejects(io().readBinary(sceneOf(stream, vertices + 1, corners)), /POSITION has \d+ bytes/);
        await assert.rejects(io().readBinary(sceneOf(stream.subarray(0, -30), vertices, corners)), {
            name: "TruncatedError",
        });
        await assert.rejects(
            new WebIO().registerExtensions([EXTBSMCompression]).readBinary(sceneOf(stream, vertices, corners)),
            /bsm\.decoder/,
        );
    });
});
