/** Damaged streams: every one ends in an error of the package or in a mesh, soon and within the memory allowed. */
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { basename, join } from "node:path";
import test from "node:test";
import { BsmError, LimitError, TruncatedError, decode } from "../src/index";
import { kernels, eventsOf, FOLDERS, mended, meshOfEvents, PATIENCE, VECTORS } from "./shared";

const MEMORY = 2 ** 26;
const STREAMS = FOLDERS.flatMap((folder) => readdirSync(folder).map((name) => join(folder, name)))
    .filter((path) => basename(path).startsWith("good-") && path.endsWith(".bsm"))
    .map((path) => readFileSync(path));

/** Numbers in [0, 1), the same in every run (Park and Miller, 1988). */
function* numbers(seed: number): Generator<number, never> {
    for (let state = seed; ;) yield (state = (state * 48271) % 2147483647) / 2147483647;
}

test("mutated streams", { timeout: 5 * PATIENCE }, async () => {
    const random = numbers(20);
    const next = (count: number): number => Math.floor(random.next().value * count);
    let refused = 0;
    for (let k = 0; k < 1500; k++) {
        const stream = Uint8Array.from(STREAMS[next(STREAMS.length)]);
        for (let changes = 1 + next(3); changes > 0; changes--) stream[5 + next(stream.length - 5)] = next(256);
        try {
            decode(kernels, k % 3 ? mended(stream) : stream, { memory: MEMORY, work: 1e9 });
        } catch (error) {
            assert.ok(error instanceof BsmError, `${error}`);
            refused++;
        }
    }
    assert.ok(refused > 1000);
});

test("every beginning of a stream is truncated", async () => {
    for (const name of ["good-refined", "good-keys"]) {
        const stream = readFileSync(join(VECTORS, `${name}.bsm`));
        for (let size = 0; size < stream.length; size++) {
            assert.throws(
                () => meshOfEvents(eventsOf(kernels, stream.subarray(0, size), stream.length)),
                TruncatedError,
            );
        }
    }
});

test("memory is limited", async () => {
    const stream = readFileSync(join(VECTORS, "good-fine.bsm"));
    assert.throws(() => decode(kernels, stream, { memory: 200_000 }), LimitError);
});
