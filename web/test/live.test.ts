/**
 * The page of a stream that is still being written, in headless Chromium: it plays what has arrived; a page opened
 * later starts at the newest GOP.
 */
import { test } from "node:test";
import assert from "node:assert/strict";
import { appendFileSync, existsSync, readFileSync } from "node:fs";
import type { Page } from "playwright-core";
import { CHROMIUM, chromiumFor, PATIENCE } from "./shared";

const FRAMES = 6;
const given = process.env.BSM_LIVE;

test(
    "a stream that is still being written",
    { skip: !given || (!existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}`) },
    async (context) => {
        const { address, whole, growing, ends } = JSON.parse(given!) as {
            address: string;
            whole: string;
            growing: string;
            ends: number[];
        };
        const stream = readFileSync(whole);
        const write = (from: number, to: number): void => appendFileSync(growing, stream.subarray(from, to));
        const browser = await chromiumFor(context);
        const there = (page: Page, frames: number): Promise<unknown> =>
            page.waitForFunction((frames) => Number(document.body.dataset.there) === frames, frames);
        const state = (page: Page): Promise<string | null> => page.locator("body").getAttribute("data-state");
        const [early, late] = [await browser.newPage(), await browser.newPage()];
        for (const page of [early, late]) page.setDefaultTimeout(PATIENCE);
        await early.goto(address);
        await there(early, FRAMES);
        write(ends[0], ends[1] + 2); // one group, and a little of the next
        await there(early, 2 * FRAMES);
        assert.equal(await state(early), "loading");
        await late.goto(address);
        await there(late, FRAMES);
        assert.match((await late.locator("body").textContent())!, /entered at frame 7/);
        write(ends[1] + 2, stream.length);
        await Promise.all([there(early, 3 * FRAMES), there(late, 2 * FRAMES)]);
        for (const page of [early, late]) await page.waitForSelector("body[data-state=complete]");
        await late.reload();
        await there(late, 3 * FRAMES); // what has ended is seen from its beginning
    },
);
