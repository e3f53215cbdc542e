/** The extension for glTF-Transform, with its own library. */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test, { describe } from "node:test";
import { pathToFileURL } from "node:url";
import { WebIO } from "@gltf-transform/core";
import type * as Transform from "../src/transform";
import { decode } from "../src/index";
import { sceneOf } from "./scene";
import { BUILDS, compile, VECTORS, WEB } from "./shared";

describe("glTF-Transform", async () => {
    // The built module finds its kernels beside itself.
    const { EXTBSMCompression, loadSceneDecoder } = (await import(pathToFileURL(join(WEB, "built/gltf-transform.js")).href)) as typeof Transform;
    const decoder = await loadSceneDecoder();
    const stream = new Uint8Array(readFileSync(join(VECTORS, "good-attribute-uv-plain.bsm")));
    const shape = decoder(stream);
    const io = (): WebIO => new WebIO().registerExtensions([EXTBSMCompression]).registerDependencies({ "bsm.decoder": decoder });
    const [vertices, corners] = [shape.positions.length / 3, shape.index.length];

    test("reads what streams hold, and writes it plain", async () => {
        const document = await io().readBinary(sceneOf(stream, vertices, corners));
        const written = await new WebIO().readBinary(await io().writeBinary(document)); // by who does not know the extension
        const [primitive] = written.getRoot().listMeshes()[0].listPrimitives();
        const { positions, faces } = decode(await compile(BUILDS[0]), stream);
        assert.deepEqual([...(primitive.getAttribute("POSITION")?.getArray() ?? [])], [...shape.positions]);
        assert.deepEqual([...(primitive.getAttribute("NORMAL")?.getArray() ?? [])], [...shape.normals]);
        assert.deepEqual([...(primitive.getIndices()?.getArray() ?? [])], [...shape.index]);
        assert.equal(faces.length, corners);
        const drawn = [0, 1, 2].map((k) => shape.positions[3 * shape.index[0] + k]);
        assert.ok(drawn.every((value, k) => Math.abs(value - positions[3 * faces[0] + k]) < 1e-5));
        assert.deepEqual(written.getRoot().listExtensionsUsed(), []);
        assert.equal(written.getRoot().listBuffers().length, 1);
    });

    test("says what is wrong", async () => {
        await assert.rejects(io().readBinary(sceneOf(stream, vertices + 1, corners)), /POSITION has \d+ bytes/);
        await assert.rejects(io().readBinary(sceneOf(stream.subarray(0, -30), vertices, corners)), { name: "TruncatedError" });
        await assert.rejects(new WebIO().registerExtensions([EXTBSMCompression]).readBinary(sceneOf(stream, vertices, corners)), /bsm\.decoder/);
    });
});
