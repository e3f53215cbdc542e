/** The decoder and the page in headless Firefox. */
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after, before, describe } from "node:test";
import puppeteer, { type Browser, type Page } from "puppeteer-core";
import { decode } from "../src/index";
import { base64, BUILDS, compile, savedPage, VECTORS, WEB } from "./shared";

const FIREFOX = process.env.FIREFOX ?? "/usr/bin/firefox-esr";
const NAMES = ["good-labels", "good-grid", "good-layers", "good-sequence-learnt", "good-attribute-uv-blocks", "good-sections"];

describe("Firefox", { skip: !existsSync(FIREFOX) && `no Firefox at ${FIREFOX}`, timeout: 120_000 }, () => {
    const folder = mkdtempSync(join(tmpdir(), "bsm-firefox-"));
    const read = (name: string): Buffer => readFileSync(join(VECTORS, `${name}.bsm`));
    let browser: Browser;
    let page: Page;

    before(async () => {
        browser = await puppeteer.launch({ browser: "firefox", executablePath: FIREFOX, headless: true });
        page = await browser.newPage();
    });
    after(async () => {
        await browser?.close();
        rmSync(folder, { recursive: true, force: true });
    });

    test("decodes to the last bit what node does", async () => {
        const kernels = await compile(BUILDS[0]);
        const [script, wasm] = ["bsm.js", BUILDS[0]].map((name) => base64(readFileSync(join(WEB, "built", name))));
        for (const name of NAMES) {
            const found = await page.evaluate(
                async (script, wasm, stream) => {
                    const bytes = (text: string): Uint8Array<ArrayBuffer> => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
                    const bsm = await import(`data:text/javascript;base64,${script}`);
                    return [...bsm.decode(await bsm.Kernels.compile(bytes(wasm)), bytes(stream)).positions];
                },
                script,
                wasm,
                base64(read(name)),
            );
            assert.deepEqual(found, [...decode(kernels, read(name)).positions], name);
        }
    });

    test("decodes with a helper", async () => {
        await page.goto(savedPage(folder, {}));
        const [script, wasm, stream] = [join(WEB, "built/bsm.js"), join(WEB, "built", BUILDS[0]), join(VECTORS, "good-keys.bsm")].map((path) => base64(readFileSync(path)));
        const found = await page.evaluate(
            async (script, wasm, stream) => {
                const bytes = (text: string): Uint8Array<ArrayBuffer> => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
                const bsm = await import(`data:text/javascript;base64,${script}`);
                let shared = 0;
                window.Worker = class extends Worker {
                    constructor(url: string | URL, options?: WorkerOptions) {
                        super(url, options);
                        this.addEventListener("message", ({ data }) => (shared += Number("shared" in data)));
                    }
                };
                const team = new bsm.Team(1, 0);
                const { positions } = await team.decode(await bsm.Kernels.compile(bytes(wasm)), bytes(stream));
                team.close();
                return { positions: [...positions], shared };
            },
            script,
            wasm,
            stream,
        );
        assert.deepEqual(found, { positions: [...decode(await compile(BUILDS[0]), read("good-keys")).positions], shared: 2 });
    });

    test("draws and plays, or says that this machine cannot draw", async (t) => {
        await page.goto(savedPage(folder, { sequence: read("good-sequence-learnt") }));
        await page.waitForSelector("body[data-state=complete], body[data-state=failed]", { timeout: 30_000 });
        if (await page.evaluate(() => document.createElement("canvas").getContext("webgl2") === null)) {
            assert.match(await page.$eval("[role=alert]", (alert) => alert.textContent ?? ""), /does not draw in three dimensions/);
            return t.skip("Firefox draws nothing here: no WebGL");
        }
        await page.waitForFunction(() => Number(document.body.dataset.frame) > 0, { timeout: 30_000 });
    });
});
