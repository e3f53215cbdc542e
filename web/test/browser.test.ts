/** The page in headless Chromium: streams in pieces, draws them, reports the error of a damaged stream. */
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import test, { after, before, describe } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium, type BrowserContext, type Page } from "playwright-core";
import { readNpz } from "./npz";
import {
    base64,
    CHROMIUM,
    contentOf,
    drop,
    FLAGS,
    PATIENCE,
    rowsOf,
    savedPage,
    silhouette,
    tableOf,
    VECTORS,
    viewerScript,
} from "./shared";

const STREAM = "good-labels";
/** One of the specification, and a real one if it is named. */
const SEQUENCES = [
    join(VECTORS, "good-sequence-learnt.bsm"),
    join(VECTORS, "good-sequence-runs.bsm"),
    ...(process.env.BSM_SEQUENCE ? [process.env.BSM_SEQUENCE] : []),
];

/** Hide what lies over the mesh, and what changes behind it, so that two pictures differ by the mesh alone. */
const BARE = ".bsm-ui > * { opacity: 0 !important } .bsm-stage { background: #e9ecf0 !important }";

/** Shares of the pixels that are red and green, and how high these are on the mean, from the top. */
function colorsIn(png: Buffer): { red: number; green: number; redHeight: number; greenHeight: number } {
    const [counts, heights] = [
        [0, 0],
        [0, 0],
    ];
    let all = 1;
    for (const { row, channels, y, width, height } of rowsOf(png)) {
        all = width * height;
        for (let i = 0; i < row.length; i += channels) {
            const [r, g, b] = row.subarray(i, i + 3);
            const which = r > 2 * g && r > 2 * b ? 0 : g > 2 * r && g > 2 * b ? 1 : undefined;
            if (which !== undefined) [counts[which], heights[which]] = [counts[which] + 1, heights[which] + y];
        }
    }
    return {
        red: counts[0] / all,
        green: counts[1] / all,
        redHeight: heights[0] / counts[0],
        greenHeight: heights[1] / counts[1],
    };
}

describe("the page in Chromium", { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}` }, () => {
    const folder = mkdtempSync(join(tmpdir(), "bsm-browser-"));
    let context: BrowserContext;
    let page: Page;
    const complaints: string[] = [];

    before(async () => {
        const options = {
            executablePath: CHROMIUM,
            headless: true,
            args: FLAGS,
            viewport: { width: 800, height: 500 },
        };
        context = await chromium.launchPersistentContext(join(folder, "profile"), options);
        context.setDefaultTimeout(PATIENCE);
        page = await context.newPage();
        await context.addInitScript(
            (bare) =>
                document.addEventListener("DOMContentLoaded", () => {
                    document.head.append(Object.assign(document.createElement("style"), { textContent: bare }));
                    document.querySelector<HTMLElement>("[name=panel]")?.click();
                }),
            BARE,
        );
        page.on("pageerror", (error) => complaints.push(error.message));
        page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || complaints.push(request.url()));
    });
    after(async () => {
        await context?.close();
        rmSync(folder, { recursive: true, force: true });
    });

    const whole = readFileSync(join(VECTORS, `${STREAM}.bsm`));
    const state = (name: string): Promise<unknown> => page.waitForSelector(`body[data-state=${name}]`);

    for (const [name, stream] of Object.entries({ grid: readFileSync(join(VECTORS, "good-grid.bsm")), whole }))
        test(`draws a ${name} stream to its end, and fetches nothing`, async () => {
            await page.goto(savedPage(folder, { [name]: stream }));
            await state("complete");
            const { share, x, y } = silhouette(await page.locator("canvas").screenshot());
            assert.ok(share > 0.05 && share < 0.6, `share ${share}`);
            assert.ok(x > 0.4 && x < 0.8 && Math.abs(y - 0.5) < 0.1, `beside the card: ${x} ${y}`);
            assert.deepEqual(complaints, []);
            assert.equal(page.workers().length, 1, "no thread starts that decodes nothing");
        });

    /** The mesh of the page as a file. */
    async function savedAs(format: string, from = page): Promise<Buffer> {
        const saving = from.waitForEvent("download");
        await from.evaluate((format) => {
            document.querySelector<HTMLSelectElement>("[name=format]")!.value = format;
            document.querySelector<HTMLElement>("[name=export]")!.click();
        }, format);
        return readFileSync(await (await saving).path());
    }

    test("draws edges sharp from the angle on that Python tells", async () => {
        const verticesWith = async (told: object): Promise<number> => {
            await page.goto(savedPage(folder, { whole }, {}, told));
            await state("complete");
            return Number(/element vertex (\d+)/.exec((await savedAs("ply")).toString("latin1"))![1]);
        };
        const smooth = await verticesWith({ creaseAngle: 180 });
        assert.equal(await verticesWith({}), smooth, "a mesh without clearly sharp edges is smooth");
        assert.ok((await verticesWith({ creaseAngle: 0 })) > 4 * smooth);
    });

    test("cuts the stream at any byte, and goes on", async () => {
        await page.getByLabel("Stop after byte").fill("0");
        await page.waitForFunction(() => document.body.dataset.blocks === "0");
        await page.getByLabel("Stop after byte").focus();
        await page.keyboard.press("End");
        await state("complete");
    });

    test("draws again after each of 20 lost contexts", async () => {
        const canvas = page.locator("canvas");
        const before = await canvas.screenshot();
        for (let k = 0; k < 20; k++) {
            await page.evaluate(async () => {
                const canvas = document.querySelector("canvas")!;
                const context = canvas.getContext("webgl2")!.getExtension("WEBGL_lose_context")!;
                const event = (type: string): Promise<unknown> =>
                    new Promise((keep) => canvas.addEventListener(type, keep, { once: true }));
                const lost = event("webglcontextlost");
                context.loseContext();
                await lost;
                const restored = event("webglcontextrestored");
                await new Promise((keep) => setTimeout(keep));
                context.restoreContext();
                await restored;
                await new Promise((keep) => requestAnimationFrame(() => requestAnimationFrame(keep)));
            });
            const isThere = async (): Promise<boolean> =>
                Math.abs(silhouette(await canvas.screenshot()).share - silhouette(before).share) < 0.02;
            for (const end = Date.now() + PATIENCE; !(await isThere());) assert.ok(Date.now() < end, `time ${k + 1}`);
        }
    });

    test("streams over a slow link, block by block", async () => {
        await page.getByLabel("Bandwidth, Mbit/s").fill(String((whole.length * 8) / 1e6 / 2));
        await page.getByRole("button", { name: "Stream again" }).click();
        const seen = new Set<string>();
        for (const start = Date.now(); Date.now() - start < 10_000;) {
            seen.add((await page.locator("body").getAttribute("data-blocks")) ?? "");
            if ((await page.locator("body").getAttribute("data-state")) === "complete") break;
        }
        assert.ok(seen.size > 2, `blocks seen: ${[...seen]}`);
        await page.getByLabel("Bandwidth, Mbit/s").fill("0");
    });

    test("the keyboard turns the mesh", async () => {
        const before = await page.locator("canvas").screenshot();
        await page.locator("canvas").focus();
        await page.keyboard.press("ArrowRight");
        assert.notDeepEqual(await page.locator("canvas").screenshot(), before);
    });

    test("the keyboard reaches every control, in their order, and each has a name", async () => {
        const name = (): Promise<string> =>
            page.evaluate(() => {
                const active = document.activeElement as HTMLElement;
                const label =
                    active.getAttribute("aria-label") ?? (active as HTMLInputElement).labels?.[0]?.textContent;
                return (label ?? active.textContent ?? "")
                    .trim()
                    .split(/[\n,.(:]/)[0]
                    .trim();
            });
        const expected = [
            "The mesh",
            "Measured",
            "Open a mesh or stream",
            "Save a picture",
            "Full screen",
            "Dark or light",
            "Keys",
            "Settings",
            "Light from",
            "Background",
            "From",
            "Parallel projection",
            "Auto-rotate",
            "Copy a link to this view",
            "Section across",
            "Place of the section",
            "Show the other side",
            "Measure between two points",
            "Show",
            "As",
            "Save",
            "Stop after byte",
            "Bandwidth",
            "Stream again",
            "Copy the code",
            "Licenses",
            "Smooth",
            "Color",
        ];
        await page.locator("canvas").focus();
        const met = [await name()];
        for (const _ of expected.slice(1)) met.push((await page.keyboard.press("Tab"), await name()));
        assert.deepEqual(
            met.map((found, i) => found.startsWith(expected[i])),
            expected.map(() => true),
            met.join(" | "),
        );
        await page.getByRole("combobox", { name: "Color" }).selectOption("blocks");
        await page.waitForFunction(() => document.body.textContent!.includes("Order in which blocks arrive"));
        await page.getByRole("combobox", { name: "Color" }).selectOption("plain");
    });

    const frameOf = (): Promise<number> => page.evaluate(() => Number(document.body.dataset.frame ?? -1));

    for (const path of SEQUENCES) {
        test(`plays, holds and seeks ${basename(path)}`, async () => {
            await page.goto(savedPage(folder, { sequence: readFileSync(path) }));
            await state("complete");
            await page.waitForFunction(() => Number(document.body.dataset.frame) > 0);
            const slider = page.getByRole("slider", { name: "Frame" });
            await page.getByRole("button", { name: "Pause" }).click();
            const held = await frameOf();
            await page.waitForTimeout(300);
            assert.equal(await frameOf(), held);
            await slider.focus();
            await page.keyboard.press("Home");
            await page.waitForFunction(() => document.body.dataset.frame === "0");
            const first = await page.locator("canvas").screenshot();
            await page.keyboard.press("End");
            const last = await page.evaluate(() => document.querySelector<HTMLInputElement>("[name=frame]")!.max);
            await page.waitForFunction((last) => document.body.dataset.frame === last, last);
            assert.match((await slider.getAttribute("aria-valuetext")) ?? "", /^frame \d+ of \d+$/);
            const { share } = silhouette(await page.locator("canvas").screenshot());
            assert.ok(share > 0.01 && share < 0.6, `share ${share}`);
            assert.notDeepEqual(await page.locator("canvas").screenshot(), first);
            await page.getByLabel("Loop").uncheck();
            await page.getByRole("button", { name: "Play" }).click();
            await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))); // until it says so
            await page.waitForFunction(() => document.querySelector("[name=play]")!.textContent === "Play");
            assert.equal(await frameOf(), Number(last));
            assert.deepEqual(complaints, []);
        });
    }

    test("plots the largest error of each frame", async () => {
        const frames =
            Number(await page.evaluate(() => document.querySelector<HTMLInputElement>("[name=frame]")!.max)) + 1;
        const errors = Array.from({ length: frames }, (_, i) => (i === 1 ? 0.004 : 0.001));
        assert.ok(await page.locator("[data-part=errors]").isHidden(), "nothing is known of the errors");
        await page.goto(
            savedPage(folder, { sequence: readFileSync(SEQUENCES.at(-1)!) }, { facts: { errors, farthest: 0.004 } }),
        );
        await state("complete");
        const path = (await page.locator("[data-part=errors] path").getAttribute("d"))!.split("L");
        assert.equal(path.length, frames + 2);
        assert.deepEqual(
            path.slice(1, 4).map((point) => Number(point.split(",")[1])),
            [0.75, 0, 0.75],
        );
        await page.getByRole("button", { name: "Pause" }).click();
        await page.getByRole("slider", { name: "Frame" }).fill("1");
        await page.waitForFunction(() =>
            document.querySelector("[data-part=time]")!.textContent!.endsWith("error 0.4\u00a0%"),
        );
        assert.deepEqual(complaints, []);
    });

    test("wears the textures of a stream, and has its axis up", async () => {
        const fresh = await context.newPage();
        // Half of the image is red, half is green: a page without the texture has neither.
        await fresh.goto(savedPage(folder, { worn: readFileSync(join(VECTORS, "good-attribute-textured.bsm")) }));
        await fresh.waitForSelector("body[data-state=complete]");
        await fresh.waitForFunction(() => document.querySelector<HTMLSelectElement>("[name=color]")!.value === "own");
        await fresh.waitForTimeout(300);
        const counts = colorsIn(await fresh.locator("canvas").screenshot());
        assert.ok(counts.red > 0.02 && counts.green > 0.02, JSON.stringify(counts));
        // The red half is the upper one along z, which this mesh calls up.
        assert.ok(counts.redHeight < counts.greenHeight, JSON.stringify(counts));
        await fresh.close();
    });

    test("draws all that it can draw where a graphics card does, with reflections", async () => {
        const fresh = await context.newPage();
        const errors: string[] = [];
        fresh.on("console", (message) => void (message.type() === "error" && errors.push(message.text())));
        await fresh.addInitScript(() => {
            const { getParameter } = WebGL2RenderingContext.prototype;
            WebGL2RenderingContext.prototype.getParameter = function (name): unknown {
                const found: unknown = getParameter.call(this, name);
                return typeof found === "string" && /swiftshader/i.test(found) ? "a card" : found;
            };
        });
        await fresh.goto(savedPage(folder, { worn: readFileSync(join(VECTORS, "good-attribute-textured.bsm")) }));
        await fresh.waitForFunction(() => document.querySelector<HTMLSelectElement>("[name=color]")!.value === "own");
        const pictures = new Map<string, string>();
        const choices = { color: ["plain", "own"], shading: ["flat", "wire", "smooth"] };
        const more = { overlay: ["edges", "backs", "normals", ""], axis: ["x", ""] };
        for (const [name, values] of Object.entries({ ...choices, ...more }))
            for (const value of values) {
                await fresh.evaluate(
                    ([name, value]) => {
                        const control = document.querySelector<HTMLSelectElement>(`[name=${name}]`)!;
                        control.value = value;
                        for (const type of ["input", "change"]) control.dispatchEvent(new Event(type));
                    },
                    [name, value],
                );
                await fresh.waitForTimeout(1000);
                const picture = await fresh.locator("canvas").screenshot();
                pictures.set(`${name} ${value}`, createHash("sha256").update(picture).digest("hex"));
                const { red, green } = colorsIn(picture);
                assert.equal(red > 0.02 && green > 0.02, value !== "plain", `${name} ${value}: ${red} ${green}`);
            }
        assert.deepEqual(errors, []);
        assert.ok(new Set(pictures.values()).size >= 5, JSON.stringify([...pictures]));
        await fresh.close();
    });

    test("closes images of what it shows no longer, and of what it has saved", async () => {
        const fresh = await context.newPage();
        await fresh.addInitScript(() => {
            const counts = Object.assign(globalThis, { images: 0, gone: 0 });
            const [make, close] = [createImageBitmap, ImageBitmap.prototype.close];
            window.createImageBitmap = ((...given: Parameters<typeof make>) => {
                counts.images++;
                return make(...given);
            }) as typeof make;
            ImageBitmap.prototype.close = function () {
                counts.gone++;
                close.call(this);
            };
        });
        type Counts = { images: number; gone: number };
        const counts = (): Promise<Counts> =>
            fresh.evaluate(() => {
                const { images, gone } = globalThis as unknown as Counts;
                return { images, gone };
            });
        const worn = readFileSync(join(VECTORS, "good-attribute-textured.bsm"));
        await fresh.goto(savedPage(folder, { worn }));
        await fresh.waitForFunction(() => document.querySelector<HTMLSelectElement>("[name=color]")!.value === "own");
        assert.deepEqual(await counts(), { images: 1, gone: 0 });
        await savedAs("glb", fresh);
        assert.deepEqual(await counts(), { images: 2, gone: 1 });
        await drop(fresh, { "other.bsm": whole });
        await fresh.waitForFunction(() => document.querySelector("h1")!.textContent === "other.bsm");
        await fresh.waitForSelector("body[data-state=complete]");
        assert.deepEqual(await counts(), { images: 2, gone: 2 });
        await fresh.close();
    });

    test("saves the parts that are drawn", async () => {
        await page.goto(savedPage(folder, { parts: readFileSync(join(VECTORS, "good-labels.bsm")) }));
        await state("complete");
        await page.waitForFunction(() => document.body.dataset.layers);
        const trianglesIn = async (): Promise<number> => (await savedAs("stl")).readUInt32LE(80);
        const all = await trianglesIn();
        const part = page.locator("[data-part=parts] li").first();
        const hidden = Number(/([\d,]+) triangles/.exec((await part.textContent())!)![1].replace(",", ""));
        await part.locator("input").evaluate((box: HTMLInputElement) => box.click());
        assert.ok(hidden > 0);
        assert.equal(await trianglesIn(), all - hidden);
    });

    test("shows three meshes behind one camera, and how far each is off", async () => {
        const { positions } = readNpz(readFileSync(join(VECTORS, `${STREAM}.npz`)));
        const [vertices, diagonal] = [positions.values.length / 3, 2];
        const layer = (title: string, size: number, share?: number): object => ({
            title,
            detail: "",
            size,
            data: base64(whole),
            ...(share === undefined
                ? {}
                : { off: { data: base64(new Uint8Array(new Float32Array(vertices).fill(share * diagonal).buffer)) } }),
        });
        const facts = {
            look: 0.9,
            farthest: 0.01,
            promised: { look: 1, farthest: 0.02 },
            diagonal,
            draco: { bytes: 4000, bits: 11 },
            attributes: { color: { max_error: 3, range: 255 }, chart: null },
        };
        await page.goto(
            savedPage(
                folder,
                { three: whole },
                {
                    main: 1,
                    facts,
                    layers: [
                        layer("Original", 64 * whole.length),
                        layer("BSM", whole.length, 0.0075),
                        layer("Draco", 2000, 0),
                    ],
                },
            ),
        );
        await page.waitForSelector("body[data-layers='3']");
        await page.waitForFunction(() => document.body.innerText.includes("64 times smaller"));
        assert.match(
            await page.locator("[data-part=facts]").innerText(),
            /Look distance\s+0.90\s+promised 1;[^]*1\u00a0%[^]*promised 2\u00a0%[^]*Draco at the same look[^]*4 kB 11 bits[^]*Error of color\s+up to 3 of 255\s+Error of chart\s+missing/,
        );
        const redOf = async (): Promise<number> => {
            await page.waitForTimeout(300);
            const { red } = colorsIn(await page.locator("canvas").screenshot());
            return red;
        };
        assert.equal(await page.locator("[data-part=claim]").innerText(), "Looks the same, 64 times smaller");
        assert.ok(await page.getByRole("radio", { name: "Wipe" }).isChecked());
        await page.keyboard.press("?");
        assert.match(await page.getByRole("region", { name: "Keys" }).innerText(), /wipe, or one mesh/);
        await page.keyboard.press("Escape");
        assert.ok(await page.getByRole("region", { name: "Keys" }).isHidden());
        await page.keyboard.press("1");
        assert.ok(
            await page.getByRole("radio", { name: "Wipe" }).isDisabled(),
            "the original is not compared with itself",
        );
        await page.keyboard.press("2");
        await page.keyboard.press("e");
        await page.waitForFunction(() => document.body.innerText.includes("Distance from the original"));
        assert.match(await page.locator("[data-part=scale]").innerText(), /0\u00a0%[^]*0.5\u00a0%[^]*1\u00a0%\n0.02/);
        const half = await redOf();
        // The handle has 44 pixels, and captions are 14 beside it, but 4 within the page.
        const tagged = (width: number): Promise<unknown> =>
            page.waitForFunction((width) => {
                const share = Number(document.querySelector<HTMLInputElement>("[name=wipe]")!.value) / 1000;
                const tag = document.querySelector<HTMLElement>("[data-part=right]")!;
                return (
                    Math.abs(
                        parseFloat(tag.style.left) -
                            Math.min(22 + share * (width - 44) + 14, width - tag.offsetWidth - 4),
                    ) < 0.01
                );
            }, width);
        await tagged(800);
        await page.setViewportSize({ width: 600, height: 500 });
        await tagged(600);
        await page.setViewportSize({ width: 800, height: 500 });
        await page.getByRole("slider", { name: "Wipe" }).fill("0");
        const most = await redOf();
        assert.ok(half > 0.02 && most > 1.5 * half, `${half} ${most}`);
        await page.keyboard.press("Shift+W"); // as with Caps Lock
        assert.ok((await redOf()) > 1.5 * half, "alone");
        await page.keyboard.press("3");
        assert.ok((await redOf()) < 0.002, "a mesh without errors is not red");
        await page.keyboard.press("1");
        assert.ok((await redOf()) < 0.002, "nor is the original");
        await page.keyboard.press("2");
        await page.keyboard.press("s");
        assert.ok((await redOf()) > 0.01);
        const left = colorsIn(await page.screenshot({ clip: { x: 0, y: 0, width: 400, height: 500 } }));
        assert.ok(left.red < 0.002, `one of two is red: ${left.red}`);
        assert.deepEqual(complaints, []);
    });

    test("saves a picture, and is dark or light", async () => {
        const saved = page.waitForEvent("download");
        await page.getByRole("button", { name: "Save a picture" }).click();
        const picture = await saved;
        assert.equal(picture.suggestedFilename(), "three.png");
        const { share } = silhouette(readFileSync(await picture.path()));
        assert.ok(share > 0.05, `share ${share}`);
        const ink = (): Promise<string> => page.evaluate(() => getComputedStyle(document.body).color);
        const before = await ink();
        await page.getByRole("button", { name: "Dark or light" }).click();
        assert.notEqual(await ink(), before);
    });

    test("shows no numbers of the mesh before where the next one fails", async () => {
        const headless = Uint8Array.from(whole);
        headless[12] ^= 255;
        await page.goto(savedPage(folder, { whole, headless }));
        await state("complete");
        assert.match((await page.locator("[data-part=facts]").textContent()) ?? "", /vertices/);
        await page.getByRole("combobox", { name: "Stream" }).selectOption("headless");
        await state("failed");
        assert.equal(await page.locator("[data-part=facts]").textContent(), "");
        assert.equal(await page.locator("[data-part=claim]").textContent(), "");
        assert.equal(await page.locator("[data-part=figures]").textContent(), `${whole.length} bytes`);
        assert.deepEqual(complaints, []);
    });

    test("has no controls for tiles that do nothing there", async () => {
        const fresh = await context.newPage();
        const url = savedPage(folder, { sequence: readFileSync(SEQUENCES[0]), tiled: whole });
        const path = fileURLToPath(url);
        writeFileSync(
            path,
            readFileSync(path, "utf8").replace('"name":"tiled"', '"name":"tiled","tiles":"http://bsm.test"'),
        );
        const manifest = { cell: 1, origin: [0, 0, 0], levels: [], shards: [] };
        await fresh.route("http://bsm.test/*", (route) =>
            route.fulfill({ json: manifest, headers: { "Access-Control-Allow-Origin": "*" } }),
        );
        await fresh.goto(url);
        await fresh.waitForSelector("body[data-state=complete]");
        await fresh.getByRole("combobox", { name: "Color" }).selectOption("blocks");
        await fresh.getByText("Order in which blocks arrive").waitFor();
        await fresh.getByRole("combobox", { name: "Stream" }).selectOption("tiled");
        await fresh.waitForSelector("body[data-state=complete][data-tiles='0']");
        for (const part of ["sequence", "scale", "colors"])
            assert.ok(await fresh.locator(`[data-part=${part}]`).isHidden(), part);
        await fresh.close();
    });

    test("opens a stream that is dropped on it, and says that a saved page does not encode", async () => {
        await drop(page, { "other.bsm": readFileSync(join(VECTORS, "good-grid.bsm")) });
        await page.waitForFunction(() => document.querySelector("h1")!.textContent === "other.bsm");
        await state("complete");
        await drop(page, { "ball.ply": new Uint8Array(10) });
        await page.waitForFunction(() =>
            document.querySelector("[role=alert]")!.textContent!.includes("bsm view ball.ply"),
        );
        assert.deepEqual(complaints, []);
    });

    test("compares two streams that are dropped on it", async () => {
        const read = (name: string): Buffer => readFileSync(join(VECTORS, `${name}.bsm`));
        const said = async (claim: RegExp): Promise<void> =>
            void (await page.waitForFunction(
                (text) => new RegExp(text).test(document.querySelector("[data-part=claim]")!.textContent!),
                claim.source,
            ));
        await drop(page, { "a.bsm": read("good-labels"), "b.bsm": read("good-labels") });
        await said(/^No difference was measured$/);
        assert.ok(await page.getByRole("radio", { name: "Wipe" }).isChecked());
        assert.deepEqual(
            await page
                .locator("[data-part=layers] label")
                .allInnerTexts()
                .then((all) => all.map((text) => text.split(",")[1].trim())),
            ["a.bsm", "b.bsm"],
        );
        assert.match((await tableOf(page))["Largest vertex error"], /^0.%/);
        await drop(page, { "a.bsm": read("good-labels"), "b.bsm": read("good-tetrahedron") });
        await said(/^Differences up to [\d.]+.% of the diagonal/);
        const table = await tableOf(page);
        assert.ok(
            parseFloat(table["Largest surface distance"]) > parseFloat(table["Mean surface distance"]),
            JSON.stringify(table),
        );
        assert.match(table.Original, /vertices [\d,]+ triangles/);
        await page.locator("canvas").press("e");
        await page.getByText("Distance from the original's surface").waitFor();
        await drop(page, { "a.bsm": read("good-sequence-learnt"), "b.bsm": read("good-sequence-learnt") });
        await said(/^No difference was measured$/);
        assert.ok(await page.locator("[data-part=errors]").isVisible());
        await drop(page, { "a.bsm": read("good-sequence-learnt"), "b.bsm": read("good-grid") });
        await page.waitForFunction(() =>
            /cannot be compared.*sequence/.test(document.querySelector("[role=alert]")!.textContent!),
        );
        await drop(page, { "a.bsm": read("good-grid"), "b.bsm": read("good-grid"), "c.bsm": read("good-grid") });
        await page.waitForFunction(() =>
            /a.bsm and b.bsm and c.bsm cannot be shown. Open one file, or two/.test(
                document.querySelector("[role=alert]")!.textContent!,
            ),
        );
        await drop(page, { "b.ply": new Uint8Array(10), "a.bsm": read("good-grid") });
        await page.waitForFunction(() =>
            document.querySelector("[role=alert]")!.textContent!.includes("bsm view a.bsm --original b.ply"),
        );
        assert.deepEqual(complaints, []);
    });

    test("names what is dropped, and goes back to what it offers", async () => {
        await page.goto(savedPage(folder, { whole, grid: readFileSync(join(VECTORS, "good-grid.bsm")) }));
        await state("complete");
        const streams = page.getByRole("combobox", { name: "Stream" });
        assert.ok(await page.locator("h1").isHidden());
        await drop(page, { "other.bsm": readFileSync(join(VECTORS, "good-light.bsm")) });
        await page.getByRole("heading", { name: "other.bsm" }).waitFor();
        assert.equal(await streams.inputValue(), "");
        await streams.selectOption("whole");
        await page.locator("h1").waitFor({ state: "hidden" });
        await page.waitForFunction(
            (length) => document.querySelector("[data-part=bytes]")!.textContent!.includes(`of ${length} bytes`),
            whole.length,
        );
    });

    test("takes no bytes of a stream that still comes into what is dropped", async () => {
        const fresh = await context.newPage();
        const grid = readFileSync(join(VECTORS, "good-grid.bsm"));
        await fresh.addInitScript(() => {
            window.fetch = async () =>
                new Response(
                    new ReadableStream({
                        start: (out) =>
                            void Object.assign(window, {
                                send: (bytes: number[]) => out.enqueue(Uint8Array.from(bytes)),
                            }),
                    }),
                );
        });
        const send = (bytes: Uint8Array): Promise<void> =>
            fresh.evaluate(
                (bytes) => (window as unknown as { send: (bytes: number[]) => void }).send(bytes),
                [...bytes],
            );
        const taken = (length: number): Promise<unknown> =>
            fresh.waitForFunction(
                (length) => document.querySelector("[data-part=bytes]")!.textContent!.includes(`of ${length} bytes`),
                length,
            );
        await fresh.goto(
            savedPage(
                folder,
                { live: whole },
                { layers: [{ title: "BSM", detail: "", size: 0, url: "http://bsm.test/live" }], live: true },
            ),
        );
        await fresh.waitForFunction(() => "send" in window);
        await send(whole.subarray(0, 100));
        await taken(100);
        await drop(fresh, { "other.bsm": grid });
        await fresh.waitForSelector("body[data-state=complete]");
        await send(whole.subarray(100));
        await fresh.waitForTimeout(300);
        await taken(grid.length);
        assert.equal(await fresh.locator("[role=alert]").textContent(), "");
        await fresh.close();
    });

    test("is a widget of notebooks", async () => {
        const script = `
            import widget from "data:text/javascript;base64,${base64(Buffer.from(viewerScript()))}";
            const traits = { content: ${JSON.stringify(contentOf("a stream", whole))}, height: 400 };
            const listeners = {};
            const model = { get: (name) => traits[name], on: (name, f) => (listeners[name] = f), off: (name) => delete listeners[name] };
            const el = document.querySelector("main");
            window.close = await widget.render({ model, el });
            window.change = () => listeners["change:content"]();`;
        await page.setContent(`<style>${BARE}</style><main></main><script type="module">${script}</script>`);
        const shown = page.locator("main > [data-state=complete]");
        await shown.waitFor();
        const { share } = silhouette(await page.locator("canvas").screenshot());
        assert.ok(share > 0.02 && share < 0.6, `share ${share}`);
        assert.equal(await page.locator("h1").textContent(), "a stream");
        assert.ok(Math.abs((await page.locator("main > div").boundingBox())!.height - 400) < 2);
        await page.evaluate(() => (window as unknown as { change: () => void }).change());
        await shown.waitFor();
        await page.evaluate(() => window.close());
        assert.deepEqual(complaints, []);
    });

    test("says what is wrong with a damaged stream", async () => {
        const damaged = Uint8Array.from(whole);
        damaged[whole.length - 16] ^= 255;
        await page.goto(savedPage(folder, { damaged }));
        await state("damaged");
        assert.match(
            (await page.getByRole("alert").textContent()) ?? "",
            /damaged: blocks? .* the rest is shown.*CorruptError/,
        );
        const { share } = silhouette(await page.locator("canvas").screenshot());
        assert.ok(share > 0.02 && share < 0.6, `share ${share}`);
        const headless = Uint8Array.from(whole);
        headless[12] ^= 255;
        await page.goto(savedPage(folder, { headless }));
        await state("failed");
        assert.match((await page.getByRole("alert").textContent()) ?? "", /cannot be decoded further. CorruptError/);
        assert.deepEqual(complaints, []);
    });
});
