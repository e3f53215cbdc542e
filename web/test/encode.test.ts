/** The encoder for pages: streams that the decoder reads, errors, progress. tests/engine/test_encode.py compares their bytes with those of C. */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test, { describe } from "node:test";
import { brotliCompressSync } from "node:zlib";
import { BufferAttribute, BufferGeometry, Mesh, TorusKnotGeometry } from "three";
import { BSMExporter, encodeHere, encodeWith, meshOf, type MeshInput } from "../src/encode";
import { decode } from "../src/index";
import { BUILDS, compile, WEB } from "./shared";

const wasm = readFileSync(join(WEB, "built/encode.wasm"));
const module = await WebAssembly.compile(wasm);
const kernels = await compile(BUILDS[0]);

/** A mesh with an attribute of each kind. */
function dressed(): MeshInput {
    const geometry = new TorusKnotGeometry(1, 0.3, 60, 8);
    const mesh = meshOf(geometry);
    const corners = mesh.faces.length;
    const attributes = [
        ...(mesh.attributes ?? []),
        { name: "color", values: Uint8Array.from({ length: mesh.positions.length }, (_, i) => (7 * i) & 255), components: 3, semantic: "color" as const },
        { name: "part", values: Int32Array.from({ length: corners / 3 }, (_, i) => i & 3), components: 1, domain: "face" as const },
        { name: "chart", values: Float32Array.from({ length: 2 * corners }, (_, i) => (i % 64) / 64), components: 2, domain: "corner" as const, semantic: "texcoord" as const },
    ];
    return { ...mesh, attributes, metadata: { unit: "mm", count: 3, scale: 0.5, "image.0.data": Uint8Array.from([1, 2, 3]) } };
}

describe("encoding", () => {
    test("what is encoded comes back", () => {
        const mesh = dressed();
        const decoded = decode(kernels, encodeWith(module, mesh, { lossless: true, keepOrder: true }));
        assert.deepEqual([...decoded.positions].map(Math.fround), [...mesh.positions]);
        assert.deepEqual([...decoded.faces], [...mesh.faces]);
    });

    test("errors say what is wrong", async () => {
        const mesh = dressed();
        assert.throws(() => encodeWith(module, mesh, { bits: 21 }), { name: "EncodeError", status: 2 });
        assert.throws(() => encodeWith(module, { ...mesh, faces: mesh.faces.map((v) => v + 1) }), /is vertex \d+ of \d+/);
        const far = Float64Array.from(mesh.positions, (x) => x + 1e7);
        assert.throws(() => encodeWith(module, { ...mesh, positions: far }, { lossless: true }), { name: "EncodeError", status: 10 });
        await assert.rejects(new BSMExporter().parseAsync({} as Mesh), /meshes with a geometry/);
        await assert.rejects(encodeHere({ ...mesh, positions: mesh.positions.slice(1) }, { wasm: module }), /three numbers/);
    });

    test("progress ascends; who listens can end the work", async () => {
        const seen: number[] = [];
        encodeWith(module, dressed(), { onProgress: (part) => void seen.push(part) });
        assert.deepEqual(seen, [...seen].sort((a, b) => a - b));
        assert.equal(seen.at(-1), 1);
        const stop = new Error("enough");
        const thrown = (): Uint8Array => encodeWith(module, dressed(), { onProgress: () => { throw stop; } });
        assert.throws(thrown, stop);
        await assert.rejects(encodeHere(dressed(), { wasm: module, signal: AbortSignal.abort() }), { name: "AbortError" });
    });

    test("BSMExporter writes what three.js has, indexed, interleaved or not", async () => {
        const plain = new BufferGeometry().setAttribute("position", new BufferAttribute(Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0]), 3));
        for (const geometry of [plain, new TorusKnotGeometry(1, 0.3, 60, 8)]) {
            const bytes = await new BSMExporter().parseAsync(new Mesh(geometry), { wasm: module, qualities: { normal: "recompute" } });
            const { positions, faces } = decode(kernels, bytes);
            assert.equal(faces.length, geometry.index?.count ?? 3);
            assert.ok(positions.length > 0);
        }
    });

    test("the download is small", () => assert.ok(brotliCompressSync(wasm).length <= 82_000));
});
