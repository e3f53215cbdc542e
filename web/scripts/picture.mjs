// The picture of a stream that arrives, from the page of `bsm view` in Chromium: `npm run picture -- STREAM.bsm
// OUT.png`.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { WEB } from "./kernels.mjs";

const FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const SHARES = [0.55, 0.65, 0.76, 0.88, 1];
const SIDE = 220;

const [stream, target] = process.argv.slice(2).map((path) => resolve(process.env.INIT_CWD ?? ".", path));
const folder = mkdtempSync(join(tmpdir(), "bsm-picture-"));
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    args: FLAGS,
});
try {
    const saved = join(folder, "page.html");
    execFileSync(process.env.PYTHON ?? "python3", ["-m", "bsm", "view", stream, "-q", "--save", saved], {
        cwd: join(WEB, ".."),
    });
    const page = await browser.newPage({ viewport: { width: 3 * SIDE, height: 3 * SIDE } });
    await page.goto(pathToFileURL(saved).href);
    await page.waitForSelector("body[data-state=complete]");
    await page.addStyleTag({
        content: ".bsm-ui > * { opacity: 0 !important } .bsm-stage { background: white !important }",
    });
    await page.getByRole("button", { name: "Settings" }).click();
    await page.getByRole("combobox", { name: "Color" }).selectOption("blocks");
    const size = statSync(stream).size;
    const pictures = [];
    for (const share of SHARES.toReversed()) {
        const cut = Math.round(share * size);
        await page.getByLabel("Stop after byte").fill(String(cut));
        await page.waitForFunction((cut) => Number(document.body.dataset.taken) === cut, cut);
        await page.waitForTimeout(300);
        const picture = await page.locator("canvas").screenshot();
        const text = await page.locator("[data-part=status]").textContent();
        pictures.unshift(
            `<figure><img src="data:image/png;base64,${picture.toString("base64")}"><figcaption>${cut.toLocaleString("en")} bytes<br>${text.split(",")[0]}</figcaption></figure>`,
        );
    }
    const style = `<style>body { margin: 0; display: flex; background: white; font: 14px system-ui, sans-serif; text-align: center } figure { margin: 4px } img { width: ${SIDE}px; display: block }</style>`;
    await page.setViewportSize({ width: SHARES.length * (SIDE + 8), height: SIDE + 52 });
    await page.setContent(style + pictures.join(""));
    await page.screenshot({ path: target });
    console.log(`${target}: ${statSync(target).size} bytes`);
} finally {
    await browser.close();
    rmSync(folder, { recursive: true, force: true });
}
