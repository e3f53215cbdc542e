/** Any number of damaged streams, and between them good ones of the same loader, which all come out right. */
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { Pool } from "../src/pool";
import { BSMLoader, type BSMGeometry } from "../src/three";
import { Lines, drawing, staged } from "./replay";
import { serveSite } from "./server";
import { CHROMIUM, chromiumFor, mended, PATIENCE, VECTORS } from "./shared";

/** How many damaged streams; `BSM_DAMAGES=10000` makes all that are promised. */
const DAMAGES = Number(process.env.BSM_DAMAGES ?? 240);
/** One with helpers, one of a lesser decoder, one that moves. */
const NAMES = ["keys", "light", "sequence-learnt"];
const STREAMS = NAMES.map((name) => Uint8Array.from(readFileSync(join(VECTORS, `good-${name}.bsm`))));

/**
 * Damaged stream number k: a bit flipped or the end cut, at each place of each stream in turn; with right checksums now
 * and then.
 */
function damaged(k: number): Uint8Array {
    const stream = Uint8Array.from(STREAMS[k % STREAMS.length]);
    const step = Math.max(1, Math.floor((3 * STREAMS.length * stream.length) / DAMAGES)); // all places are met by few, too
    const turn = Math.floor(k / STREAMS.length);
    const place = (Math.floor(turn / 3) * step + Math.floor((turn * step) / (3 * stream.length))) % stream.length;
    if (turn % 3 === 2) return stream.slice(0, place);
    stream[place] ^= 1 << (turn % 8);
    return turn % 3 === 1 ? mended(stream) : stream;
}

/** All numbers that are drawn of a geometry. */
function numbersOf(geometry: BSMGeometry): number[][] {
    return [
        [...geometry.getIndex()!.array],
        [...geometry.getAttribute("position").array],
        ...geometry.frames.map(({ positions }) => [...positions]),
    ];
}

for (const threads of [12, 0]) {
    test(
        `${DAMAGES} damaged streams between good ones, ${threads ? "in threads" : "without threads"}`,
        { timeout: 3_600_000 },
        async (context) => {
            const lines = new Lines(drawing(7));
            const { source, restore } = staged(lines);
            context.after(restore);
            const loader = new BSMLoader();
            const pool = new Pool(threads ? source : { ...source, worker: () => undefined }, threads || 1);
            const { open } = pool;
            pool.open = (listener, wishes) => open.call(pool, listener, { ...wishes, worthwhile: 0 }); // helpers for small ones, too
            (loader as unknown as { used: Pool }).used = pool;
            const load = async (data: Uint8Array): Promise<BSMGeometry | string> => {
                let outcome: BSMGeometry | string | undefined;
                void loader.parseAsync(data, { onBlock: () => {} }).then(
                    (geometry) => (outcome = geometry),
                    (error: Error) => (outcome = `${error.name}: ${error.message}`),
                );
                await lines.run(() => outcome !== undefined);
                return outcome ?? "nothing came";
            };
            const good = [];
            for (const stream of STREAMS) good.push(numbersOf((await load(stream)) as BSMGeometry));
            let refused = 0;
            for (let k = 0; k < DAMAGES; k++) {
                const outcome = await load(damaged(k));
                refused += typeof outcome === "string" ? 1 : 0;
                if (typeof outcome === "string")
                    assert.match(
                        outcome,
                        /^(Corrupt|Truncated|Format|Unsupported|Limit|Numeric)Error: /,
                        `stream ${k}`,
                    );
                const which = (k * 7) % STREAMS.length;
                const next = await load(STREAMS[which]);
                assert.ok(typeof next !== "string", `${NAMES[which]} after stream ${k}: ${next}`);
                assert.deepEqual(numbersOf(next), good[which], `${NAMES[which]} after stream ${k}`);
            }
            assert.ok(refused > 0.6 * DAMAGES, `${refused} refused`);
            console.log(`${DAMAGES} damaged streams, ${refused} refused; ${DAMAGES} good ones after them, 0 differ`);
        },
    );
}

test(
    `${DAMAGES} damaged streams in a page, between good ones`,
    { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}`, timeout: 3_600_000 },
    async (context) => {
        const site = await serveSite();
        const browser = await chromiumFor(context);
        context.after(() => site.close());
        const page = await browser.newPage();
        page.setDefaultTimeout(30 * PATIENCE);
        site.extra.set(
            "/damaged",
            Buffer.concat(
                Array.from({ length: DAMAGES }, (_, k) => damaged(k)).flatMap((data) => [
                    Buffer.from(Uint32Array.of(data.length).buffer),
                    data,
                ]),
            ),
        );
        site.extra.set(
            "/script.js",
            `
        import { BSMLoader } from "bsm/three";
        const loader = new BSMLoader();
        const bytes = new Uint8Array(await (await fetch("/damaged")).arrayBuffer());
        const names = ${JSON.stringify(NAMES)};
        const good = await Promise.all(names.map(async (name) => new Uint8Array(await (await fetch("/stream/good-" + name + ".bsm")).arrayBuffer())));
        const numbers = (geometry) => [geometry.index.array.join(), geometry.attributes.position.array.join(), ...geometry.frames.map(({ positions }) => positions.join())].join(" ");
        const right = await Promise.all(good.map(async (stream) => numbers(await loader.parseAsync(stream.slice()))));
        const wrong = [];
        let refused = 0;
        for (let at = 0, k = 0; at < bytes.length; k++) {
            const size = new DataView(bytes.buffer).getUint8(at) + 256 * bytes[at + 1];
            await loader.parseAsync(bytes.slice(at + 4, at + 4 + size)).catch((error) => { refused++; if (!/^(Corrupt|Truncated|Format|Unsupported|Limit|Numeric)Error/.test(error.name)) wrong.push(k + " " + error); });
            at += 4 + size;
            const which = (k * 7) % names.length;
            const found = await loader.parseAsync(good[which].slice()).then(numbers, String);
            if (found !== right[which]) wrong.push(names[which] + " after " + k + ": " + found.slice(0, 200));
        }
        window.found = { wrong, refused };`,
        );
        await page.goto(site.address);
        const { wrong, refused } = (await (
            await page.waitForFunction(() => (window as unknown as { found: unknown }).found)
        ).jsonValue()) as { wrong: string[]; refused: number };
        assert.deepEqual(wrong, []);
        assert.ok(refused > 0.6 * DAMAGES, `${refused} refused`);
    },
);
