/** A decoder and helpers that share the chains of a stream: the same as the decoder alone. */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { BsmError, Decoder, Helper, NEED_BLOCK, type Event, type Kernels } from "../src/index";
import { kernels, mended, VECTORS } from "./shared";

const CHAINS = ["good-independent-predicted", "good-independent", "good-key-seed", "good-keys"];

/** All events, and the message of the error behind them, of a stream in pieces; `among` share it. */
function decodeShared(
    kernels: Kernels,
    data: Uint8Array,
    size: number,
    among: number,
    tolerant: boolean,
): { events: Event[]; error?: string; awaited: number } {
    const decoder = new Decoder(kernels, {}, { tolerant, helpers: () => among - 1 });
    const helpers = Array.from(
        { length: among - 1 },
        (_, k) => new Helper(kernels, { number: k + 1, among }, {}, tolerant),
    );
    const all = [decoder, ...helpers];
    const events: Event[] = [];
    let awaited = 0;
    const take = (): void => {
        for (let event; (event = decoder.nextEvent()) === NEED_BLOCK || typeof event !== "string";) {
            if (event !== NEED_BLOCK) events.push(event);
            else {
                awaited++;
                const sent = helpers.flatMap((helper) => {
                    const shared = helper.nextBlock();
                    return typeof shared === "string" ? [] : [shared];
                });
                assert.ok(sent.length > 0, "a block never comes");
                sent.forEach((shared) => decoder.receiveBlock(shared));
            }
        }
    };
    try {
        for (let at = 0; at < data.length; at += size) {
            for (const each of all) each.receiveData(data.subarray(at, at + size));
            take();
        }
        for (const each of all) each.receiveEof();
        take();
        return { events, awaited };
    } catch (error) {
        assert.ok(error instanceof BsmError, `${error}`);
        return { events, error: error.message, awaited };
    }
}

for (const name of CHAINS) {
    test(`${name} with helpers`, async () => {
        const data = readFileSync(join(VECTORS, `${name}.bsm`));
        const alone = decodeShared(kernels, data, data.length, 1, false);
        assert.equal(alone.error, undefined);
        for (const [among, size] of [2, 3, 8].flatMap((among) => [
            [among, data.length],
            [among, 5],
        ])) {
            const { awaited, ...together } = decodeShared(kernels, data, size, among, false);
            assert.ok(awaited > 0);
            assert.deepEqual({ ...together, awaited: 0 }, alone);
        }
    });
}

const [DAMAGED, LAST] = ["good-keys", 3];

test(`${DAMAGED}, damaged, with helpers, strict and tolerant`, async () => {
    const data = readFileSync(join(VECTORS, `${DAMAGED}.bsm`));
    const [lost, refused] = [new Set<number | undefined>(), new Set<string | undefined>()];
    for (let at = 5; at < data.length; at++) {
        const changed = Uint8Array.from(data);
        changed[at] ^= 64;
        for (const damaged of [changed, mended(Uint8Array.from(changed))]) {
            for (const tolerant of [false, true]) {
                const { awaited: _, ...alone } = decodeShared(kernels, damaged, damaged.length, 1, tolerant);
                const { awaited, ...together } = decodeShared(kernels, damaged, damaged.length, 2, tolerant);
                assert.deepEqual(together, alone, `byte ${at}`);
                for (const event of alone.events) if (event.type === "loss") lost.add(event.block);
                if (awaited > 0) refused.add(alone.error);
            }
        }
    }
    // All chains, and errors that only their decoders find.
    for (let index = 0; index <= LAST; index++) assert.ok(lost.has(index), `${[...lost]}`);
    assert.ok(
        [...refused].some((message) => message?.includes("[byte") && message.includes(`block ${LAST}`)),
        `${[...refused]}`,
    );
});
