/** Pictures of saved pages in headless Chromium, for the documents: what is drawn is looked at, and kept where BSM_PAGES says. */
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { describe, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { CHROMIUM, FLAGS, PATIENCE, silhouette } from "./shared";

interface Shot {
    page: string;
    picture: string;
    layers: number;
    keys: string;
    dark: boolean;
    size: [number, number];
}

const given = process.env.BSM_PAGES;

describe("pictures of pages", { skip: !given || (!existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}`) }, () => {
    for (const { page: path, picture, layers, keys, dark, size: [width, height] } of JSON.parse(given ?? "[]") as Shot[]) {
        test(picture, async () => {
            const browser = await chromium.launch({ executablePath: CHROMIUM, headless: true, args: FLAGS });
            try {
                const page = await browser.newPage({ viewport: { width, height }, colorScheme: dark ? "dark" : "light" });
                await page.goto(pathToFileURL(path).href);
                await page.waitForSelector(`body[data-layers="${layers}"]`, { timeout: PATIENCE });
                for (const key of keys) await page.keyboard.press(key);
                await page.waitForTimeout(2000);
                assert.match(await page.locator("[data-part=figures]").innerText(), /^[\d,.]+ kB → [\d.]+ kB$/);
                assert.equal(await page.locator("[role=alert]").textContent(), "");
                await page.screenshot({ path: picture, type: "jpeg", quality: 82 });
                await page.addStyleTag({ content: ".bsm-ui > * { opacity: 0 !important } .bsm-stage { background: #808890 !important }" });
                const { share } = silhouette(await page.locator("canvas").screenshot());
                assert.ok(share > 0.12 && share < 0.8, `share ${share}`);
            } finally {
                await browser.close();
            }
        });
    }
});
