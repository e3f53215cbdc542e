/** The page in headless Chromium: streams in pieces, draws what it should, says what is wrong with a damaged stream. */
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after, before, describe } from "node:test";
import { pathToFileURL } from "node:url";
import { inflateSync } from "node:zlib";
import { chromium, type BrowserContext, type Page } from "playwright-core";
import { VECTORS, WEB } from "./shared";

const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
const FLAGS = [
    "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];
const PAGE = join(WEB, "../../bsm/viewer/page.html");
const STREAM = "good-labels";

/** The page with streams in it, as `bsm view --save` writes it. */
function savedPage(folder: string, streams: Record<string, Uint8Array>): string {
    const list = Object.entries(streams).map(([name, bytes]) => ({ name, data: Buffer.from(bytes).toString("base64") }));
    const slot = '<script type="application/json" id="streams">';
    const path = join(folder, "page.html");
    writeFileSync(path, readFileSync(PAGE, "utf8").replace(`${slot}[]`, () => slot + JSON.stringify(list)));
    return pathToFileURL(path).href;
}

/** Share of the pixels that differ from the corner, and where their middle is; of an 8-bit PNG. */
function silhouette(png: Buffer): { share: number; x: number; y: number } {
    const [width, height, channels] = [png.readUInt32BE(16), png.readUInt32BE(20), png[25] === 6 ? 4 : 3];
    const parts: Buffer[] = [];
    for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
        if (png.toString("latin1", at + 4, at + 8) === "IDAT") parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
    }
    const rows = inflateSync(Buffer.concat(parts));
    const stride = width * channels;
    let above = new Uint8Array(stride);
    let [count, sumX, sumY] = [0, 0, 0];
    let corner: Uint8Array | undefined;
    for (let y = 0; y < height; y++) {
        const filter = rows[y * (stride + 1)];
        const row = Uint8Array.from(rows.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1)));
        for (let i = 0; i < stride; i++) {
            const [a, b, c] = [i < channels ? 0 : row[i - channels], above[i], i < channels ? 0 : above[i - channels]];
            const paeth = [a, b, c].sort((p, q) => Math.abs(a + b - c - p) - Math.abs(a + b - c - q))[0];
            row[i] += [0, a, b, (a + b) >> 1, paeth][filter];
        }
        corner ??= row.slice(0, 3);
        for (let x = 0; x < width; x++) {
            if ([0, 1, 2].some((d) => Math.abs(row[x * channels + d] - corner![d]) > 8)) [count, sumX, sumY] = [count + 1, sumX + x, sumY + y];
        }
        above = row;
    }
    return { share: count / (width * height), x: sumX / count / width, y: sumY / count / height };
}

describe("the page in Chromium", { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}` }, () => {
    const folder = mkdtempSync(join(tmpdir(), "bsm-browser-"));
    let context: BrowserContext;
    let page: Page;
    const complaints: string[] = [];

    before(async () => {
        const options = { executablePath: CHROMIUM, headless: true, args: FLAGS, viewport: { width: 800, height: 500 } };
        context = await chromium.launchPersistentContext(join(folder, "profile"), options);
        page = await context.newPage();
        page.on("pageerror", (error) => complaints.push(error.message));
        page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || complaints.push(request.url()));
    });
    after(async () => {
        await context?.close();
        rmSync(folder, { recursive: true, force: true });
    });

    const whole = readFileSync(join(VECTORS, `${STREAM}.bsm`));
    const state = (name: string): Promise<unknown> => page.waitForSelector(`body[data-state=${name}]`, { timeout: 20_000 });

    test("draws a stream to its end, and fetches nothing", async () => {
        await page.goto(savedPage(folder, { whole }));
        await state("complete");
        const { share, x, y } = silhouette(await page.locator("canvas").screenshot());
        assert.ok(share > 0.05 && share < 0.6, `share ${share}`);
        assert.ok(Math.abs(x - 0.5) < 0.1 && Math.abs(y - 0.5) < 0.1, `middle ${x} ${y}`);
        assert.deepEqual(complaints, []);
    });

    test("draws a grid", async () => {
        await page.goto(savedPage(folder, { grid: readFileSync(join(VECTORS, "good-grid.bsm")) }));
        await state("complete");
        const { share } = silhouette(await page.locator("canvas").screenshot());
        assert.ok(share > 0.05 && share < 0.6, `share ${share}`);
        await page.goto(savedPage(folder, { whole }));
        await state("complete");
    });

    test("cuts the stream at any byte, and goes on", async () => {
        await page.locator("#cut").fill("0");
        await page.waitForFunction(() => document.body.dataset.blocks === "0");
        await page.locator("#cut").focus();
        await page.keyboard.press("End");
        await state("complete");
    });

    test("streams over a slow link, block by block", async () => {
        await page.locator("#rate").fill(String((whole.length * 8) / 1e6 / 2));
        await page.locator("#again").click();
        const seen = new Set<string>();
        for (const start = Date.now(); Date.now() - start < 10_000; ) {
            seen.add((await page.locator("body").getAttribute("data-blocks")) ?? "");
            if ((await page.locator("body").getAttribute("data-state")) === "complete") break;
        }
        assert.ok(seen.size > 2, `blocks seen: ${[...seen]}`);
        await page.locator("#rate").fill("0");
    });

    test("the keyboard turns the mesh", async () => {
        const before = await page.locator("canvas").screenshot();
        await page.locator("canvas").focus();
        await page.keyboard.press("ArrowRight");
        assert.notDeepEqual(await page.locator("canvas").screenshot(), before);
    });

    test("every control has a name for those who do not see it", async () => {
        const snapshot = await page.locator("form").ariaSnapshot();
        for (const name of ["Stream", "Cut the stream", "Link, Mbit/s", "Stream again", "Colour blocks", "Wireframe"]) {
            assert.match(snapshot, new RegExp(name));
        }
    });

    test("says what is wrong with a damaged stream", async () => {
        const damaged = Uint8Array.from(whole);
        damaged[Math.floor(whole.length / 2)] ^= 255;
        await page.goto(savedPage(folder, { damaged }));
        await state("failed");
        assert.match((await page.locator("[role=alert]").textContent()) ?? "", /CorruptError/);
        assert.deepEqual(complaints, []);
    });
});
