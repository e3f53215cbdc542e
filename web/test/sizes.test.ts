/** What pages load is not more than it was. */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { brotliCompressSync, gzipSync } from "node:zlib";
import { VIEWER, WEB } from "./shared";

/**
 * Bytes in brotli, at most, of the files that a page fetches to decode streams of a kind, to encode, and for the page
 * itself.
 */
const LOADS: Record<string, [most: number, files: string[]]> = {
    "light grids": [20700, ["small-worker.js", "quick.wasm"]],
    "light grids of parts": [24000, ["small-worker.js", "parts.wasm"]],
    grids: [55800, ["small-worker.js", "grid.wasm"]],
    blocks: [71900, ["small-worker.js", "blocks.wasm"]],
    "static meshes": [90000, ["small-worker.js", "small.wasm"]],
    sequences: [81200, ["small-worker.js", "moving.wasm"]],
    everything: [125550, ["worker.js", "kernels.wasm"]],
    encoding: [83600, ["encode-worker.js", "encode.js", "encode.wasm"]],
    "the page": [8700, ["three.js"]],
};

for (const [what, [most, files]] of Object.entries(LOADS)) {
    test(`${what} is at most ${most} bytes`, () => {
        const sizes = files.map((name) => brotliCompressSync(readFileSync(join(WEB, "built", name))).length);
        const whole = sizes.reduce((sum, size) => sum + size);
        assert.ok(whole <= most, `${whole}: ${files.map((name, i) => `${name} ${sizes[i]}`).join(", ")}`);
    });
}

test("the page of tiles is at most 233650 bytes as `bsm view` sends it", () => {
    const sizes = [join(VIEWER, "viewer.js"), join(WEB, "built/grid.wasm")].map(
        (path) => gzipSync(readFileSync(path), { level: 9 }).length,
    );
    assert.ok(sizes[0] + sizes[1] <= 233_650, `viewer.js ${sizes[0]}, grid.wasm ${sizes[1]}`);
});
