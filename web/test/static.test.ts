/** The page that `bsm view --static` writes, on a plain web server: Chromium shows its mesh and encodes files that are dropped on it; Firefox encodes, too. */
import assert from "node:assert/strict";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { describe, test } from "node:test";
import { chromium } from "playwright-core";
import puppeteer from "puppeteer-core";
import { base64, CHROMIUM, FIREFOX, FLAGS, PATIENCE, silhouette } from "./shared";

const given = process.env.BSM_STATIC;

describe("a page of files", { skip: !given && "bsm view has written none" }, () => {
    const { address, name, files, folder } = JSON.parse(given ?? "{}") as { address: string; name: string; files: string[]; folder: string };

    test("shows its mesh in Chromium, and encodes", { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}` }, async () => {
        const browser = await chromium.launch({ executablePath: CHROMIUM, headless: true, args: FLAGS });
        try {
            const page = await browser.newPage({ viewport: { width: 800, height: 500 } });
            const complaints: string[] = [];
            page.on("pageerror", (error) => complaints.push(error.message));
            page.on("dialog", (dialog) => complaints.push(dialog.message()));
            page.setDefaultTimeout(PATIENCE);
            await page.goto(address);
            await page.waitForSelector("body[data-state=complete]");
            assert.equal(await page.locator("h1").textContent(), name);
            await page.addStyleTag({ content: ".bsm-ui > * { opacity: 0 !important } .bsm-stage { background: #808890 !important }" });
            assert.ok(silhouette(await page.locator("canvas").screenshot()).share > 0.05);
            assert.ok(await page.locator("[name=keep]").isHidden(), "there is a file of this stream");
            const drop = (path: string): Promise<void> =>
                page.evaluate(([name, data]) => {
                    const transfer = new DataTransfer();
                    transfer.items.add(new File([Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))], name));
                    document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
                }, [basename(path), base64(readFileSync(path))] as const);
            for (const path of files) {
                await drop(path);
                await page.waitForFunction((name) => document.querySelector("h1")!.textContent === name && document.body.dataset.layers === "2", basename(path));
                assert.equal(await page.locator("[role=alert]").textContent(), "");
                await page.waitForFunction(() => /Largest vertex error0\.0\d+/.test(document.querySelector("[data-part=facts]")!.textContent!));
                const saved = page.waitForEvent("download");
                await page.locator("[name=keep]").evaluate((button: HTMLElement) => button.click());
                await (await saved).saveAs(join(folder, `${basename(path)}.bsm`));
            }
            writeFileSync(join(folder, "corners.ply"), "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n");
            await drop(join(folder, "corners.ply"));
            await page.waitForFunction(() => /corners\.ply cannot be shown.*four corners/.test(document.querySelector("[role=alert]")!.textContent!));
            assert.deepEqual(complaints, []);
        } finally {
            await browser.close();
        }
    });

    test("encodes in Firefox to the same bytes", { skip: !existsSync(FIREFOX) && `no Firefox at ${FIREFOX}` }, async () => {
        const browser = await puppeteer.launch({ browser: "firefox", executablePath: FIREFOX, headless: true });
        try {
            const page = await browser.newPage();
            await page.goto(address);
            for (const path of files) {
                const stream = await page.evaluate((name, data) => new Promise<number[]>((resolve, reject) => {
                    const worker = new Worker("encoder.js", { type: "module" });
                    worker.onerror = ({ message }) => reject(new Error(message));
                    worker.onmessage = ({ data }) => ("stream" in data ? resolve([...data.stream]) : "error" in data && reject(new Error(data.error)));
                    worker.postMessage({ file: new File([Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))], name), preset: "14 bits" });
                }), basename(path), base64(readFileSync(path)));
                const theirs = join(folder, `${basename(path)}.bsm`);
                if (existsSync(theirs)) assert.ok(readFileSync(theirs).equals(Buffer.from(stream)), path);
                else writeFileSync(theirs, Buffer.from(stream));
            }
        } finally {
            await browser.close();
        }
    });
});
