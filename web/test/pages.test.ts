/**
 * Pictures of saved pages in headless Chromium, for the documents: what is drawn is looked at, and kept where BSM_PAGES
 * says.
 */
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium, type Browser } from "playwright-core";
import { CHROMIUM, FLAGS, PATIENCE, silhouette } from "./shared";

interface Shot {
    page: string;
    picture: string;
    layers: number;
    keys: string;
    size: [number, number];
    dark?: boolean;
    /** Keep only the mesh, on white, after so many turns to the right. */
    turns?: number;
}

/** Pixels that the page leaves free above and below a mesh. */
const DOCK = 70;
const BARE = ".bsm-ui > * { opacity: 0 !important } .bsm-stage { background: ";

const given = process.env.BSM_PAGES;

describe("pictures of pages", { skip: !given || (!existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}`) }, () => {
    let browser: Browser;
    before(async () => (browser = await chromium.launch({ executablePath: CHROMIUM, headless: true, args: FLAGS })));
    after(() => browser?.close());
    for (const {
        page: path,
        picture,
        layers,
        keys,
        dark,
        turns,
        size: [width, height],
    } of JSON.parse(given ?? "[]") as Shot[]) {
        test(picture, async () => {
            const bare = turns !== undefined;
            const page = await browser.newPage({
                viewport: { width, height: bare ? height + 2 * DOCK : height },
                colorScheme: dark ? "dark" : "light",
            });
            await page.goto(pathToFileURL(path).href);
            await page.waitForSelector(`body[data-layers="${layers}"]`, { timeout: PATIENCE });
            if (bare) await page.keyboard.press("w"); // alone, not beside the original
            for (const key of keys) await page.keyboard.press(key);
            for (let k = 0; k < (turns ?? 0); k++) await page.locator("canvas").press("ArrowRight");
            await page.waitForTimeout(1000);
            assert.match(await page.locator("[data-part=figures]").innerText(), /^([\d,.]+ kB → )?[\d.]+ kB$/);
            assert.equal(await page.locator("[role=alert]").textContent(), "");
            if (bare) await page.addStyleTag({ content: `${BARE}white !important }` });
            await page.screenshot({
                path: picture,
                type: "jpeg",
                quality: 82,
                clip: { x: 0, y: bare ? DOCK : 0, width, height },
            });
            await page.addStyleTag({ content: `${BARE}#808890 !important }` });
            const { share } = silhouette(await page.locator("canvas").screenshot());
            assert.ok(share > 0.08 && share < 0.8, `share ${share}`);
            await page.close();
        });
    }
});
