// Loads of a sequence in the page of `bsm view`, while other programs use all processors: `npm run views -- STREAM.bsm
// LOADS`.
// For each browser and size, how many pictures of a frame differ from that of a load at rest: a hole would. Without a
// screen, Firefox draws in a virtual one: xvfb-run -a npm run views -- STREAM.bsm 100.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { availableParallelism, tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { setTimeout as delay } from "node:timers/promises";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";
import { WEB } from "./kernels.mjs";

const BROWSERS = {
    chrome: {
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    },
    firefox: {
        executablePath: process.env.FIREFOX ?? "/usr/bin/firefox-esr",
        extraPrefsFirefox: { "webgl.force-enabled": true },
    },
};
const SIZES = [
    [390, 780],
    [1280, 800],
];
const PATIENCE = 120_000;
const FRAME = "7";
const QUIET = 300;
/** Nothing but the mesh is compared. */
const BARE = ".bsm-ui > * { opacity: 0 !important } .bsm-stage { background: #808890 !important }";

/** Run programs that do nothing but take all processors; returns what stops them. */
function busy() {
    const programs = Array.from({ length: availableParallelism() }, () => spawn(process.execPath, ["-e", "for (;;);"]));
    return () => programs.forEach((program) => program.kill("SIGKILL"));
}

/**
 * The picture of a frame, once all have come and edges are smooth, for which the canvas has more pixels than the page.
 */
async function pictureOf(page, url) {
    await page.goto(url);
    await page.waitForSelector("body[data-state=complete][data-frame]", { timeout: PATIENCE }); // the sequence has begun
    await page.evaluate(
        (frame, style) => {
            document.head.append(Object.assign(document.createElement("style"), { textContent: style }));
            const [play, slider] = [document.querySelector("[name=play]"), document.querySelector("[name=frame]")];
            if (play.textContent === "Pause") play.click();
            slider.value = frame;
            slider.dispatchEvent(new Event("input"));
        },
        FRAME,
        BARE,
    );
    await page.waitForSelector(`body[data-frame="${FRAME}"]`, { timeout: PATIENCE });
    await delay(QUIET);
    await page.waitForFunction(() => document.querySelector("canvas").width > innerWidth, { timeout: PATIENCE });
    return Buffer.from(await page.screenshot());
}

const [stream, loads = "100"] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "bsm-views-"));
const saved = join(folder, "page.html");
execFileSync(
    process.env.PYTHON ?? "python3",
    ["-m", "bsm", "view", resolve(process.env.INIT_CWD ?? ".", stream), "-q", "--save", saved],
    { cwd: join(WEB, "..") },
);
const url = pathToFileURL(saved).href;
let wrong = 0;
for (const [name, options] of Object.entries(BROWSERS)) {
    const browser = await puppeteer.launch({ browser: name, headless: name === "chrome", ...options });
    for (const size of SIZES) {
        const page = await browser.newPage();
        await page.setViewport({ width: size[0], height: size[1] });
        const expected = await pictureOf(page, url);
        const stop = busy();
        let different = 0;
        try {
            for (let k = 0; k < Number(loads); k++) {
                const found = await pictureOf(page, url);
                if (found.equals(expected)) continue;
                different++;
                writeFileSync(join(tmpdir(), `bsm-views-${name}-${size.join("x")}.png`), found);
            }
        } finally {
            stop();
        }
        await page.close();
        wrong += different;
        console.log(`${await browser.version()}, ${size.join(" x ")}: ${different} of ${loads} loads differ`);
    }
    await browser.close();
}
rmSync(folder, { recursive: true, force: true });
process.exitCode = wrong > 0 ? 1 : 0;
