/** The decoder and the page in headless Firefox. */
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after, before, describe } from "node:test";
import { setTimeout as delay } from "node:timers/promises";
import puppeteer, { type Browser, type Page } from "puppeteer-core";
import { decode } from "../src/index";
import { serveSite, POLICY, type Site } from "./server";
import { kernels, FIREFOX, PATIENCE, savedPage, VECTORS } from "./shared";

const NAMES = ["good-labels", "good-grid", "good-refined", "good-sequence-learnt", "good-attribute-uv-blocks"];

describe("Firefox", { skip: !existsSync(FIREFOX) && `no Firefox at ${FIREFOX}`, timeout: 5 * PATIENCE }, () => {
    const folder = mkdtempSync(join(tmpdir(), "bsm-firefox-"));
    const read = (name: string): Buffer => readFileSync(join(VECTORS, `${name}.bsm`));
    let browser: Browser;
    let page: Page;
    let site: Site;
    /** As `page.waitForFunction`, which the policy of the page stops: it makes a function of a text. */
    const until = async (holds: () => boolean): Promise<void> => {
        for (const end = performance.now() + PATIENCE; !(await page.evaluate(holds)); await delay(20))
            assert.ok(performance.now() < end, `it did not become true: ${holds}`);
    };

    before(async () => {
        browser = await puppeteer.launch({ browser: "firefox", executablePath: FIREFOX, headless: true });
        page = await browser.newPage();
        site = await serveSite();
        site.headers["Content-Security-Policy"] = POLICY;
    });
    after(async () => {
        await browser?.close();
        site?.close();
        rmSync(folder, { recursive: true, force: true });
    });

    test("decodes to the last bit what node does", async () => {
        site.extra.set("/script.js", 'import * as bsm from "bsm"; window.bsm = bsm;');
        await page.goto(site.address);
        await until(() => "bsm" in window);
        for (const name of NAMES) {
            const found = await page.evaluate(async (name) => {
                const { decode, loadKernels } = (window as any).bsm;
                const bytes = new Uint8Array(await (await fetch(`/stream/${name}.bsm`)).arrayBuffer());
                return [...decode(await loadKernels(), bytes).positions];
            }, name);
            assert.deepEqual(found, [...decode(kernels, read(name)).positions], name);
        }
    });

    test("decodes with a helper, in threads that are used again", async () => {
        await page.goto(site.address);
        await until(() => "bsm" in window);
        const found = await page.evaluate(async (patience) => {
            const { Pool } = (window as any).bsm;
            let [helped, workers] = [0, 0];
            window.Worker = class extends Worker {
                constructor(url: string | URL, options?: WorkerOptions) {
                    super(url, options);
                    workers++;
                }
                override postMessage(message: object, moved?: any): void {
                    if ("help" in message) helped++;
                    super.postMessage(message, moved);
                }
            };
            const bytes = new Uint8Array(await (await fetch("/stream/good-keys.bsm")).arrayBuffer());
            const pool = new Pool(undefined, 2);
            const decoded = (wishes: object): Promise<number[]> =>
                new Promise((keep, fail) => {
                    const places: number[] = [];
                    const onEvent = (event: any): void => {
                        if (event.type === "block")
                            event.vertices.forEach((vertex: number, i: number) =>
                                [0, 1, 2].forEach((d) => (places[3 * vertex + d] = event.positions[3 * i + d])),
                            );
                    };
                    const stream = pool.open({ onEvent, onEnd: () => keep(places), onError: fail }, wishes);
                    setTimeout(() => fail(new Error(`${JSON.stringify(wishes)}: ${places.length} places`)), patience);
                    stream.receiveData(bytes.slice());
                    stream.receiveEof();
                });
            const positions = await decoded({ worthwhile: 0 });
            await Promise.all([0, 1, 2, 3, 4].map(() => decoded({ drawing: "whole" })));
            pool.dispose();
            return { positions, helped, workers };
        }, PATIENCE);
        assert.deepEqual(found, {
            positions: [...decode(kernels, read("good-keys")).positions],
            helped: 1,
            workers: 2,
        });
    });

    test("draws and plays, or says that this machine cannot draw", async (t) => {
        await page.goto(savedPage(folder, { sequence: read("good-sequence-learnt") }));
        await page.waitForSelector("body[data-state=complete], body[data-state=failed]", { timeout: PATIENCE });
        if (await page.evaluate(() => document.createElement("canvas").getContext("webgl2") === null)) {
            assert.match(
                await page.$eval("[role=alert]", (alert) => alert.textContent ?? ""),
                /WebGL is not available/,
            );
            return t.skip("Firefox draws nothing here: no WebGL");
        }
        await until(() => Number(document.body.dataset.frame) > 0);
    });
});
