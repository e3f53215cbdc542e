/**
 * The page, whose messages to and from threads take times drawn at random, while the reader chooses one stream after
 * the other: the last picture is right.
 */
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";
import type { Page } from "playwright-core";
import { drawing } from "./replay";
import { CHROMIUM, chromiumFor, PATIENCE, savedPage, VECTORS } from "./shared";

/** How many orders; `BSM_DELAYS=100` draws more. */
const ORDERS = Number(process.env.BSM_DELAYS ?? 5);
const GOOD = ["sequence-learnt", "sequence-runs", "keys", "refined", "grid-chunks", "attribute-textured"];
const BARE = ".bsm-ui > * { opacity: 0 !important } .bsm-stage { background: #808890 !important }";

/** In the page: each message of a thread, and each to it, waits; the order of each line stays. */
function delay(seed: number): void {
    let state = seed * 16807 + 11;
    const wait = (): number => ((state = (state * 48271) % 2147483647) % 4 === 0 ? state % 150 : 0);
    const line = (): ((act: () => void) => void) => {
        let last: Promise<unknown> = Promise.resolve();
        return (act) => void (last = last.then(() => new Promise((go) => setTimeout(go, wait()))).then(act));
    };
    window.Worker = class extends Worker {
        private readonly out = line();
        private readonly into = line();
        override postMessage(message: unknown, moved?: any): void {
            this.out(() => super.postMessage(message, moved));
        }
        override set onmessage(hear: (event: MessageEvent) => void) {
            this.addEventListener("message", (event) => this.into(() => hear.call(this, event)));
        }
    };
}

/** The picture of a stream, of a sequence its first frame, once it is there and edges are smooth. */
async function pictureOf(page: Page, size: number): Promise<Buffer> {
    await page.waitForFunction(
        (size) =>
            document.body.dataset.state === "complete" &&
            document.querySelector("[data-part=bytes]")!.textContent!.startsWith(`${size.toLocaleString("en")} of`),
        size,
    );
    await page.waitForTimeout(500);
    await page.evaluate(() => {
        const play = document.querySelector<HTMLButtonElement>("[name=play]")!;
        const slider = document.querySelector<HTMLInputElement>("[name=frame]")!;
        if (play.closest("[hidden]")) return;
        if (play.textContent === "Pause") play.click();
        slider.value = "0";
        slider.dispatchEvent(new Event("input"));
    });
    await page.waitForTimeout(600);
    await page.waitForFunction(() => document.querySelector("canvas")!.width > innerWidth);
    return page.screenshot();
}

test(
    `${ORDERS} orders of messages and streams end in the right picture`,
    { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}`, timeout: 3_600_000 },
    async (context) => {
        const folder = mkdtempSync(join(tmpdir(), "bsm-delays-"));
        const browser = await chromiumFor(context);
        context.after(() => rmSync(folder, { recursive: true, force: true }));
        const streams: Record<string, Uint8Array> = Object.fromEntries(
            GOOD.map((name) => [name, Uint8Array.from(readFileSync(join(VECTORS, `good-${name}.bsm`)))]),
        );
        streams.damaged = Uint8Array.from(streams.keys, (byte, i) => byte ^ Number(i === 400));
        const address = savedPage(folder, streams);
        const open = async (seed?: number): Promise<Page> => {
            const page = await browser.newPage({ viewport: { width: 300, height: 300 } });
            page.setDefaultTimeout(PATIENCE);
            if (seed !== undefined) await page.addInitScript(delay, seed);
            await page.goto(address);
            await page.addStyleTag({ content: BARE });
            return page;
        };
        const expected = new Map<string, Buffer>();
        const plain = await open();
        for (const name of GOOD) {
            await plain.locator("[name=stream]").selectOption(name, { force: true });
            expected.set(name, await pictureOf(plain, streams[name].length));
        }
        for (let seed = 1; seed <= ORDERS; seed++) {
            const draw = drawing(seed);
            const page = await open(seed);
            const names = [
                ...Array.from({ length: 1 + draw(4) }, () => Object.keys(streams)[draw(GOOD.length + 1)]),
                GOOD[draw(GOOD.length)],
            ];
            for (const name of names) {
                await page.waitForTimeout(draw(250));
                await page.locator("[name=stream]").selectOption(name, { force: true });
            }
            const last = names.at(-1)!;
            assert.ok(
                (await pictureOf(page, streams[last].length)).equals(expected.get(last)!),
                `order ${seed}: ${names.join(", ")}`,
            );
            await page.close();
        }
    },
);
