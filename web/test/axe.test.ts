/**
 * What axe-core finds wrong on the page of `bsm view` in each state, dark and light, and on a page with players:
 * nothing.
 */
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after, before, describe } from "node:test";
import { chromium, type Browser, type Page } from "playwright-core";
import { serveSite } from "./server";
import { base64, CHROMIUM, FLAGS, PATIENCE, savedPage, VECTORS, WEB } from "./shared";

const AXE = readFileSync(join(WEB, "node_modules/axe-core/axe.min.js"), "utf8");
const read = (name: string): Buffer => readFileSync(join(VECTORS, `${name}.bsm`));

/** What is wrong, and where. */
async function violations(page: Page): Promise<string[]> {
    await page.evaluate(AXE);
    return page.evaluate(async () => {
        const { violations } = await (
            window as unknown as {
                axe: { run(): Promise<{ violations: { id: string; nodes: { html: string }[] }[] }> };
            }
        ).axe.run();
        return violations.flatMap(({ id, nodes }) => nodes.map(({ html }) => `${id}: ${html.slice(0, 160)}`));
    });
}

describe("axe-core", { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}` }, () => {
    const folder = mkdtempSync(join(tmpdir(), "bsm-axe-"));
    let browser: Browser;
    before(async () => (browser = await chromium.launch({ executablePath: CHROMIUM, headless: true, args: FLAGS })));
    after(async () => {
        await browser?.close();
        rmSync(folder, { recursive: true, force: true });
    });

    const whole = read("good-labels");
    const headless = Uint8Array.from(whole);
    headless[12] ^= 255;
    const layer = (title: string, size: number): object => ({ title, detail: "", size, data: base64(whole) });
    const facts = {
        look: 0.9,
        farthest: 0.01,
        angle: 1.5,
        promised: { look: 1 },
        diagonal: 2,
        notes: ["a name was left out"],
        draco: { bytes: 4000, bits: 11 },
    };
    const compared = {
        main: 1,
        facts,
        layers: [layer("Original", 64 * whole.length), layer("BSM", whole.length), layer("Draco", 2000)],
    };
    const states: [string, Record<string, Uint8Array>, object, (page: Page) => Promise<unknown>][] = [
        ["empty", {}, {}, (page) => page.waitForSelector("body[data-state=empty]")],
        ["mesh", { mesh: read("good-grid") }, {}, (page) => page.getByRole("button", { name: "Settings" }).click()],
        [
            "stream",
            { stream: whole, other: read("good-light") },
            {},
            (page) => page.getByRole("combobox", { name: "Color" }).selectOption("blocks"),
        ],
        [
            "sequence",
            { sequence: read("good-sequence-learnt") },
            { facts: { errors: [1, 2, 3], farthest: 3 } },
            (page) => page.getByRole("button", { name: "Keys" }).click(),
        ],
        ["compared", { compared: whole }, compared, (page) => page.waitForSelector("body[data-layers='3']")],
        ["damaged", { headless }, {}, (page) => page.waitForSelector("body[data-state=failed]")],
    ];
    for (const [name, streams, more, enter] of states) {
        test(name, async () => {
            const page = await browser.newPage({ viewport: { width: 720, height: 500 }, reducedMotion: "reduce" });
            await page.goto(savedPage(folder, streams, more));
            await page.waitForSelector("body:is([data-state=empty], [data-state=complete], [data-state=failed])", {
                timeout: PATIENCE,
            });
            await enter(page);
            for (const colorScheme of ["light", "dark"] as const) {
                await page.emulateMedia({ colorScheme });
                assert.deepEqual(await violations(page), [], colorScheme);
            }
            if (name === "compared") await page.keyboard.press("s");
            if (name === "compared") await page.keyboard.press("e");
            await page.setViewportSize({ width: 320, height: 568 });
            assert.deepEqual(await violations(page), [], "small");
            await page.close();
        });
    }

    test("a page with players", async (context) => {
        const site = await serveSite();
        site.extra.set(
            "/script.js",
            `import "/bsm/player.js"; document.documentElement.lang = "en"; document.title = "Players"; document.body.innerHTML = "<main><h1>Players</h1></main>";
            for (const src of ["good-labels", "good-sequence-learnt", "nothing"]) {
                const player = Object.assign(document.createElement("bsm-player"), { src: "/stream/" + src + ".bsm" });
                for (const type of ["load", "error"]) player.addEventListener(type, () => (document.body.dataset.there = String(1 + Number(document.body.dataset.there ?? 0))));
                document.querySelector("main").append(player);
            }`,
        );
        context.after(() => site.close());
        const page = await browser.newPage();
        await page.goto(site.address);
        await page.waitForSelector("body[data-there='3']", { timeout: PATIENCE });
        assert.deepEqual(await violations(page), []);
    });
});
