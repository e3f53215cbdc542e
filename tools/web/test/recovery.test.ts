/** Damaged streams, decoded as far as they can be: the same events as those of the decoder in Python. */
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { BsmError, Decoder, END_OF_STREAM, type Event } from "../src/index";
import { BUILDS, compile, VECTORS } from "./shared";

const kernels = compile(BUILDS[0]);
/** Where whoever starts the tests has put damaged streams, and what Python makes of each. */
const FOLDER = process.env.BSM_DAMAGED;

/** What a tolerant decoder tells of a stream that comes in pieces. */
async function told(data: Uint8Array, size: number): Promise<{ events: Event[]; error?: string }> {
    const decoder = new Decoder(await kernels, { work: 1e10 }, { tolerant: true });
    const events: Event[] = [];
    try {
        for (let at = 0; at < data.length; at += size) {
            decoder.receiveData(data.subarray(at, at + size));
            for (let event; typeof (event = decoder.nextEvent()) !== "string"; ) events.push(event);
        }
        decoder.receiveEof();
        for (let event; (event = decoder.nextEvent()) !== END_OF_STREAM; ) events.push(event as Event);
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
    if (event.type === "loss") return ["loss", event.block ?? null, event.frames?.first ?? 0, event.frames?.count ?? 0, event.error.name];
    if (event.type === "end") return ["end", [...event.missing].sort((a, b) => a - b), [...event.degraded].sort((a, b) => a - b)];
    return [event.type];
}

test("damaged streams, as Python decodes them", { skip: !FOLDER && "nobody has put damaged streams anywhere" }, async () => {
    const names = readdirSync(FOLDER!).filter((name) => name.endsWith(".bsm"));
    assert.ok(names.length > 0);
    for (const name of names) {
        const expected = JSON.parse(readFileSync(join(FOLDER!, name.replace(".bsm", ".json")), "utf8"));
        const data = readFileSync(join(FOLDER!, name));
        for (const size of [data.length, 7]) {
            const { events, error } = await told(data, size);
            // Python gives no metadata, no blocks of the first frame of a sequence, and attributes in pieces.
            const sequence = events.some((event) => event.type === "header" && event.header.gopFrames > 0);
            const compared = events.filter((event) => event.type !== "attribute" && event.type !== "metadata" && (!sequence || event.type !== "block"));
            assert.deepEqual({ events: compared.map(essence), error: error ?? null }, expected, `${name} in pieces of ${size}`);
        }
    }
});

test("blocks of other chains than the damaged one are as they were", async () => {
    const whole = readFileSync(join(VECTORS, "good-keys.bsm"));
    const { events } = await told(whole, whole.length);
    const blocks = events.flatMap((event) => (event.type === "block" ? [event] : []));
    const damaged = Uint8Array.from(whole);
    damaged[whole.length - 40] ^= 1;
    const found = (await told(damaged, whole.length)).events;
    const losses = found.flatMap((event) => (event.type === "loss" ? [event] : []));
    assert.ok(losses.length > 0);
    for (const event of found) if (event.type === "block") assert.deepEqual(event.positions.length, blocks[event.index].positions.length);
    const end = found.at(-1)!;
    assert.ok(end.type === "end" && end.missing.length + end.degraded.length > 0);
});

/** Streams that ended in a foreign error once, and how they end. */
const FOUND = {
    "a block behind a layer": {
        stream: [
            "iUJTTQCRBYgBOAJwAwIEIAUKCAISykB4jj4elMo8AAAAygAAAADKOwAAAMpAQAAA8H1jq2X7loDJr2uWBAAKhKpRaRlcLcdat5FmY+k8hn8NHfi6mR2P/Tp9",
            "llGejuBWrRABADhEgCSBziGkpJamVg3S0cXo4ZmHYlg+6xDIbghSf+aNn3T28Zwk7dUV1eLBMqJ/NjiP6RImuCLVeByUdvGRD/1Wye0Rj+j+OOy3MZCD78+W",
            "VqMjCXCqEk//DzJVmfgPUkE/auHuZSv1vThIk/OfrCYcJIyxEn8g2HYa4dXIET5dQJkW0Y0CAB4abhjl1oADN/b8msrqtK/btgMBChBUQky2ah47CbqX4hf9",
            "0t3PRHGT3ukLpfU+Xl8Gc5qD1VDL",
        ].join(""),
        events: ["header", "connectivity", "block", "loss", "refinement", "loss"],
        error: "CorruptError",
    },
    "a dictionary for which memory grows": {
        stream: [
            "iUJTTQCRBowBzQGAAs0DAAMEBG4FFggEEMo8QAAAEspAeHMbE8pHf/8AFMo/gAAAGco7gAAAGm5sJHOqtcTB8EHY4R72CQAWmoODWfjEM4ZFhfUbHX4GEXVn",
            "0OA13W0jEv1OyayDNqEvijzuQjB0spebqpFg6s8t8F+CHkIca12Py+APFZRKwqx8kMcdAJm3MY7l8CwZhtYIARad/LgaGQ5YvQc3B54vjGYBkSHIkHXQ3+ax",
            "modsTmukSE6mTLRqKl5EUwHvoa4tB2j7sE0qBSw2TUfvGy9MIq0GqWw98O7mBwIWFzj6tzfA8YOXY8jGuDULQZe0QmgCdHxNPIfiALU2M73H9PsxftScKm7E",
            "g3h3I4zx/nK/KmRCl4ZyqBEPJx6WBgMPU8PgEpERVycBpcpIGnEpkpxlO4fJvAO8PCeWml6S/5Yxs+RoJv40c20RXU/Tm8VyNl8GkXNHabUg",
        ].join(""),
        events: ["header", "connectivity", "block", "block", "block", "block", "end"],
        error: undefined,
    },
};

for (const [name, found] of Object.entries(FOUND)) {
    test(name, async () => {
        const data = Buffer.from(found.stream, "base64");
        const { events, error } = await told(data, data.length);
        assert.deepEqual({ events: events.map((event) => event.type), error }, { events: found.events, error: found.error });
    });
}
