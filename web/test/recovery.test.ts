/** Damaged streams, decoded as far as they can be: the same events as those of the decoder in Python. */
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { BsmError, Decoder, END_OF_STREAM, type Event } from "../src/index";
import { PREAMBLE } from "../src/constants.json";
import { frameOf, parseVarint } from "../src/varint";
import { kernels, VECTORS } from "./shared";

/** The folder with damaged streams, and what Python makes of each. */
const FOLDER = process.env.BSM_DAMAGED;

/** What a tolerant decoder tells of a stream that comes in pieces. */
async function tolerantEvents(data: Uint8Array, size: number): Promise<{ events: Event[]; error?: string }> {
    const decoder = new Decoder(kernels, { work: 1e10 }, { tolerant: true });
    const events: Event[] = [];
    try {
        for (let at = 0; at < data.length; at += size) {
            decoder.receiveData(data.subarray(at, at + size));
            for (let event; typeof (event = decoder.nextEvent()) !== "string";) events.push(event);
        }
        decoder.receiveEof();
        for (let event; (event = decoder.nextEvent()) !== END_OF_STREAM;) events.push(event as Event);
    } catch (error) {
        assert.ok(error instanceof BsmError, `${error}`);
        return { events, error: error.name };
    }
    return { events };
}

/** What is compared of an event. */
function essence(event: Event): unknown[] {
    if (event.type === "connectivity") return ["connectivity", event.faces.length / 3, event.vertices];
    if (event.type === "block") return ["block", event.index, event.vertices.length];
    if (event.type === "refinement") return ["refinement", event.vertices.length];
    if (event.type === "frame") return ["frame", event.index];
    if (event.type === "loss")
        return ["loss", event.block ?? null, event.frames?.first ?? 0, event.frames?.count ?? 0, event.error.name];
    if (event.type === "end")
        return ["end", [...event.missing].sort((a, b) => a - b), [...event.degraded].sort((a, b) => a - b)];
    return [event.type];
}

test(
    "damaged streams, as Python decodes them",
    { skip: !FOLDER && "nobody has put damaged streams anywhere" },
    async () => {
        const names = readdirSync(FOLDER!).filter((name) => name.endsWith(".bsm"));
        assert.ok(names.length > 0);
        for (const name of names) {
            const expected = JSON.parse(readFileSync(join(FOLDER!, name.replace(".bsm", ".json")), "utf8"));
            const data = readFileSync(join(FOLDER!, name));
            for (const size of [data.length, 7]) {
                const { events, error } = await tolerantEvents(data, size);
                // Python gives no metadata, no blocks of the first frame of a sequence, and attributes in pieces.
                const sequence = events.some((event) => event.type === "header" && event.header.gopFrames > 0);
                const compared = events.filter(
                    (event) =>
                        event.type !== "attribute" &&
                        event.type !== "metadata" &&
                        (!sequence || event.type !== "block"),
                );
                assert.deepEqual(
                    { events: compared.map(essence), error: error ?? null },
                    expected,
                    `${name} in pieces of ${size}`,
                );
            }
        }
    },
);

test("blocks of other chains than the damaged one are as they were", async () => {
    const whole = readFileSync(join(VECTORS, "good-keys.bsm"));
    const { events } = await tolerantEvents(whole, whole.length);
    const blocks = events.flatMap((event) => (event.type === "block" ? [event] : []));
    const damaged = Uint8Array.from(whole);
    damaged[whole.length - 40] ^= 1;
    const found = (await tolerantEvents(damaged, whole.length)).events;
    const losses = found.flatMap((event) => (event.type === "loss" ? [event] : []));
    assert.ok(losses.length > 0);
    for (const event of found)
        if (event.type === "block") assert.deepEqual(event.positions.length, blocks[event.index].positions.length);
    const end = found.at(-1)!;
    assert.ok(end.type === "end" && end.missing.length + end.degraded.length > 0);
});

/** The frames of a stream behind its preamble, of each its type and its bytes. */
function framesOf(stream: Uint8Array): { type: number; bytes: Uint8Array }[] {
    const frames = [];
    for (let at: number = PREAMBLE.length; at < stream.length;) {
        const { type, end } = frameOf(parseVarint(stream, at, stream.length)!);
        frames.push({ type, bytes: stream.subarray(at, end) });
        at = end;
    }
    return frames;
}

test("a block that follows a lost one is not read, and levels from the first on are", async () => {
    const frames = framesOf(readFileSync(join(VECTORS, "good-refined.bsm")));
    const [HEADER, CONNECTIVITY, BLOCK, REFINEMENT] = [1, 3, 6, 13];
    const [first, last] = frames.filter(({ type }) => type === BLOCK);
    const [header, connectivity, refinement] = [HEADER, CONNECTIVITY, REFINEMENT].map((kind) =>
        frames.find(({ type }) => type === kind)!,
    );
    const damage = { bytes: new Uint8Array(9).fill(255) };
    const parts = [{ bytes: Uint8Array.from(PREAMBLE) }, header, connectivity, first, damage, last, refinement];
    const data = Buffer.concat(parts.map(({ bytes }) => bytes));
    const { events, error } = await tolerantEvents(data, data.length);
    const kinds = events.map(({ type }) => type);
    assert.deepEqual([...new Set(kinds)], ["header", "connectivity", "block", "loss", "refinement", "end"]);
    assert.equal(error, undefined);
});
