/**
 * The page that `bsm view --static` writes, on a plain web server: Chromium shows its mesh and encodes files that are
 * dropped on it; Firefox encodes, too.
 */
import assert from "node:assert/strict";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { describe, test } from "node:test";
import puppeteer from "puppeteer-core";
import { base64, CHROMIUM, chromiumFor, drop, FIREFOX, PATIENCE, silhouette, tableOf } from "./shared";

const given = process.env.BSM_STATIC;

describe("a page of files", { skip: !given && "bsm view has written none" }, () => {
    const { address, name, files, folder, pairs, moving } = JSON.parse(given ?? "{}") as {
        address: string;
        name: string;
        files: string[];
        folder: string;
        pairs: [paths: string[], row: string, percent: number][];
        moving: [name: string, frames: number, paths: string[], unused: string][];
    };

    test(
        "shows its mesh in Chromium, and encodes",
        { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}` },
        async (context) => {
            const browser = await chromiumFor(context);
            const page = await browser.newPage({ viewport: { width: 800, height: 500 } });
            const complaints: string[] = [];
            page.on("pageerror", (error) => complaints.push(error.message));
            page.on("dialog", (dialog) => complaints.push(dialog.message()));
            page.setDefaultTimeout(PATIENCE);
            await page.goto(address);
            await page.waitForSelector("body[data-state=complete]");
            assert.equal(await page.locator("h1").textContent(), name);
            await page.addStyleTag({
                content: ".bsm-ui > * { opacity: 0 !important } .bsm-stage { background: #808890 !important }",
            });
            assert.ok(silhouette(await page.locator("canvas").screenshot()).share > 0.05);
            assert.ok(await page.locator("[name=keep]").isHidden(), "there is a file of this stream");
            const bytes = (path: string): [string, Buffer] => [basename(path), readFileSync(path)];
            const save = async (name: string): Promise<void> => {
                const saved = page.waitForEvent("download");
                await page.locator("[name=keep]").evaluate((button: HTMLElement) => button.click());
                await (await saved).saveAs(join(folder, `${name}.bsm`));
            };
            for (const path of files) {
                await drop(page, Object.fromEntries([bytes(path)]));
                await page.waitForFunction(
                    (name) =>
                        document.querySelector("h1")!.textContent === name && document.body.dataset.layers === "2",
                    basename(path),
                );
                assert.equal(await page.locator("[role=alert]").textContent(), "");
                await page.waitForFunction(() =>
                    /Largest vertex error0\.0\d+/.test(document.querySelector("[data-part=facts]")!.textContent!),
                );
                assert.match(
                    await page.locator("[data-part=claim]").innerText(),
                    /^Close: differences up to 0\.0\d+.% of the diagonal, [\d.]+ times smaller$|^Close: differences up to [\d.]+.meters, [\d.]+ times smaller$/,
                );
                await save(basename(path));
            }
            for (const [paths, row, percent] of pairs) {
                await drop(page, Object.fromEntries(paths.map(bytes)));
                await page.waitForFunction(
                    (name) =>
                        document.querySelector("h1")!.textContent === name && document.body.dataset.layers === "2",
                    basename(paths[1]),
                );
                const found = parseFloat((await tableOf(page))[row]);
                assert.ok(Math.abs(found / percent - 1) < 0.01, `${paths}: ${row} ${found}, not ${percent}`);
                assert.equal(await page.locator("[role=alert]").textContent(), "");
                assert.ok(await page.locator("[name=keep]").isHidden());
                await page.locator("canvas").press("e");
                await page
                    .getByText(
                        row.includes("surface") ? "Distance from the original's surface" : "Distance from the original",
                        { exact: true },
                    )
                    .waitFor();
            }
            for (const [name, frames, paths, unused] of moving) {
                await drop(page, Object.fromEntries(paths.map(bytes)));
                await page.waitForFunction(
                    ([name, there]) =>
                        document.querySelector("h1")!.textContent === name &&
                        document.body.dataset.layers === "2" &&
                        document.body.dataset.there === there,
                    [name, String(frames)],
                );
                await page.waitForFunction(() => Number(document.body.dataset.frame) > 2);
                const { "Files used": used, "Files not used": left } = await tableOf(page);
                assert.deepEqual(
                    [used, left],
                    [
                        paths
                            .map((path) => basename(path))
                            .filter((path) => path !== unused)
                            .join(", "),
                        unused,
                    ],
                );
                await save(name);
            }
            writeFileSync(
                join(folder, "two.obj"),
                "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 3 3 3\no one\nf 1 2 3\nf 1 3 4\no other\nf 2 3 5\n",
            );
            await drop(page, Object.fromEntries([bytes(join(folder, "two.obj"))]));
            await page.waitForFunction(
                () => document.querySelector("h1")!.textContent === "two.obj" && document.body.dataset.layers === "2",
            );
            assert.deepEqual(await page.locator("[data-part=parts] label").allTextContents(), [
                "one2 triangles",
                "other1 triangles",
            ]);
            const shares: number[] = [];
            for (let press = 0; press < 3; press++) {
                await page.waitForTimeout(500);
                shares.push(silhouette(await page.locator("canvas").screenshot()).share);
                await page
                    .locator("[data-part=parts] button")
                    .first()
                    .evaluate((button: HTMLElement) => button.click());
            }
            assert.ok(
                shares[1] < 0.9 * shares[0] && Math.abs(shares[2] / shares[0] - 1) < 0.02,
                `alone, then all again: ${shares.join()}`,
            );
            writeFileSync(
                join(folder, "corners.ply"),
                "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n",
            );
            await drop(page, Object.fromEntries([bytes(join(folder, "corners.ply"))]));
            await page.waitForFunction(
                () =>
                    document.querySelector("h1")!.textContent === "corners.ply" &&
                    /polygons were cut into triangles: 1/.test(
                        document.querySelector("[data-part=facts]")!.textContent!,
                    ),
            );
            assert.deepEqual(complaints, []);
        },
    );

    test(
        "encodes in Firefox to the same bytes",
        { skip: !existsSync(FIREFOX) && `no Firefox at ${FIREFOX}` },
        async (context) => {
            const browser = await puppeteer.launch({ browser: "firefox", executablePath: FIREFOX, headless: true });
            context.after(() => browser.close());
            const page = await browser.newPage();
            await page.goto(address);
            for (const path of files) {
                const stream = await page.evaluate(
                    async (name, data) => {
                        const kernels = await WebAssembly.compile(await (await fetch("kernels.wasm")).arrayBuffer());
                        return new Promise<number[]>((resolve, reject) => {
                            const worker = new Worker("encoder.js", { type: "module" });
                            worker.onerror = ({ message }) => reject(new Error(message));
                            worker.onmessage = ({ data }) =>
                                "content" in data
                                    ? resolve([...data.content.layers[1].bytes])
                                    : "error" in data && reject(new Error(data.error));
                            worker.postMessage({
                                files: [
                                    new File([Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))], name),
                                ],
                                preset: "14 bits",
                                kernels,
                            });
                        });
                    },
                    basename(path),
                    base64(readFileSync(path)),
                );
                const theirs = join(folder, `${basename(path)}.bsm`);
                if (existsSync(theirs)) assert.ok(readFileSync(theirs).equals(Buffer.from(stream)), path);
                else writeFileSync(theirs, Buffer.from(stream));
            }
        },
    );
});
