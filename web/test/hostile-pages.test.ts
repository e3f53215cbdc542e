/** Pages as they are, not as they are tried: what loader, player, view and tiles do in each, as the table says. */
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { after, before, describe, test } from "node:test";
import { chromium, type Browser, type BrowserContextOptions, type Page } from "playwright-core";
import { serveSite, type Site } from "./server";
import { CHROMIUM, FLAGS, PATIENCE, savedPage, VECTORS, WEB } from "./shared";

type Surface = "loader" | "player" | "view" | "tiles";
interface Row extends Partial<Record<Surface, string>> {
    page: string;
    headers?: Record<string, string>;
    host?: string;
    stream?: string;
    html?: string;
    media?: "print";
    finer?: boolean;
    hidden?: boolean;
    context?: BrowserContextOptions;
}

const ROWS = JSON.parse(readFileSync(join(WEB, "test/hostile-pages.json"), "utf8")) as Row[];
const SURFACES: Surface[] = ["loader", "player", "view", "tiles"];
const MAP = '{"imports":{"three":"/three/build/three.module.js","three/addons/":"/three/examples/jsm/"}}';
const HASH = `'sha256-${createHash("sha256").update(MAP).digest("base64")}'`;
const MOVING = "/stream/good-sequence-learnt.bsm";

/** What a loader finds, as a picture that it draws. */
const LOADER = `
import { Mesh, MeshNormalMaterial, PerspectiveCamera, Scene, WebGLRenderer } from "three";
import { BSMLoader } from "/bsm/three.js";
const note = document.querySelector("p");
try {
    const geometry = await new BSMLoader().loadAsync(document.body.dataset.stream);
    const renderer = new WebGLRenderer({ preserveDrawingBuffer: true, alpha: true });
    document.body.append(renderer.domElement);
    const camera = new PerspectiveCamera(40, 2, 0.001, 1e5);
    const { center, radius } = geometry.boundingSphere;
    camera.position.copy(center).z += 3 * radius;
    renderer.render(new Scene().add(new Mesh(geometry, new MeshNormalMaterial({ side: 2 }))), camera);
    document.body.dataset.state = "complete";
} catch (error) { note.textContent = error.message; document.body.dataset.state = "failed"; }`;
/** Runs beside a player. */
const PLAYER = `
import "/bsm/player.js";
const player = document.querySelector("bsm-player");
const tell = (state) => () => (document.body.dataset.state = state);
player.addEventListener("load", tell("complete"));
player.addEventListener("error", tell("failed"));`;

/** In a page whose tab is hidden: browsers ask for no pictures until somebody sees it. */
function hideTab(): void {
    const request = window.requestAnimationFrame.bind(window);
    const waiting: FrameRequestCallback[] = [];
    window.requestAnimationFrame = (act) => waiting.push(act);
    Object.assign(window, {
        showTab: () => {
            window.requestAnimationFrame = request;
            waiting.splice(0).forEach(request);
        },
    });
}

/** The files of `bsm tile` for one tile. */
function tileFiles(stream: Buffer): [name: string, content: Buffer][] {
    const sumOf = (bytes: Buffer): string => createHash("sha256").update(bytes).digest("hex");
    const place = { offset: 0, size: stream.length, sha256: sumOf(stream) };
    const index = Buffer.from(
        JSON.stringify([{ name: "0", ...place, faces: 100, error: 0, low: [-1, -1, -1], high: [1, 1, 1] }]),
    );
    const shard = Buffer.concat([stream, index, Buffer.alloc(16)]);
    const shards = [{ file: "0.tiles", size: shard.length, index: index.length, sha256: sumOf(index) }];
    const manifest = { cell: 1, origin: [0, 0, 0], levels: [{}], shards };
    return [
        ["manifest.json", Buffer.from(JSON.stringify(manifest))],
        ["0.tiles", shard],
    ];
}

/** Pixels of a canvas that something is drawn in. */
const covered = (page: Page): Promise<number> =>
    page.evaluate(() => {
        const inside = document.querySelector("bsm-player")?.shadowRoot ?? document;
        const canvas = inside.querySelector("canvas")!;
        const copy = Object.assign(document.createElement("canvas"), { width: 100, height: 100 });
        const pen = copy.getContext("2d")!;
        pen.drawImage(canvas, 0, 0, 100, 100);
        return pen.getImageData(0, 0, 100, 100).data.filter((value, i) => i % 4 === 3 && value > 0).length;
    });
const wide = (page: Page): Promise<number> =>
    page.evaluate(() => (document.querySelector("bsm-player")?.shadowRoot ?? document).querySelector("canvas")!.width);

/** What each word of the table means. */
const MEANINGS: Record<string, (page: Page, row: Row, surface: Surface) => Promise<void>> = {
    async draws(page, _, surface) {
        assert.match(await page.evaluate(() => document.body.dataset.state ?? ""), /complete/);
        if (surface !== "view" && surface !== "tiles") assert.ok((await covered(page)) > 100, "nothing is drawn");
        if (surface !== "player") return;
        const display = await page.evaluate(() => getComputedStyle(document.querySelector("bsm-player")!).display);
        assert.equal(display, "block");
    },
    async "draws in a thread"(...given) {
        await MEANINGS.draws(...given);
        assert.ok(given[0].workers().length > 0, "the page decodes by itself");
    },
    async "says why"(page) {
        const text = await page.evaluate(
            () => (document.querySelector("bsm-player")?.shadowRoot ?? document).querySelector("p")!.textContent,
        );
        assert.match(text, /other\.test/);
    },
    async "is sharp"(page) {
        const before = await wide(page);
        const session = await page.context().newCDPSession(page);
        const metrics = { width: 800, height: 600, deviceScaleFactor: 2, mobile: false };
        await session.send("Emulation.setDeviceMetricsOverride", metrics);
        const isFiner = async (): Promise<boolean> => (await wide(page)) >= 2 * before;
        for (let i = 0; i < 400 && !(await isFiner()); i++) await page.waitForTimeout(100);
        assert.ok(await isFiner(), `${before} pixels stay ${await wide(page)}`);
    },
    async fits(page) {
        const outside = await page.evaluate(() => {
            const found = [...document.querySelectorAll("body *")].filter((element) => {
                const { left, right, width } = element.getBoundingClientRect();
                const isSeen = getComputedStyle(element).visibility !== "hidden" && width > 0;
                return isSeen && (left < -1 || right > innerWidth + 1);
            });
            return found.map(({ outerHTML }) => outerHTML.slice(0, 80));
        });
        assert.deepEqual(outside, []);
    },
    async "is told"(page) {
        const session = await page.context().newCDPSession(page);
        const { nodes } = (await session.send("Accessibility.getFullAXTree")) as unknown as {
            nodes: Record<"role" | "name" | "description", { value: string } | undefined>[];
        };
        const node = nodes.find(({ role }) => role?.value === "application");
        assert.match(node?.name?.value ?? "", /mesh/i);
        assert.match(node?.description?.value ?? "", /Arrow keys turn it/);
    },
    async waits(page) {
        const [paused, hidden] = await page.evaluate(() => {
            const player = document.querySelector("bsm-player")!;
            return [player.paused, player.shadowRoot!.querySelector<HTMLElement>(".bar")!.hidden];
        });
        assert.deepEqual([paused, hidden], [true, false]);
    },
};

describe("hostile pages", { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}` }, () => {
    const folder = mkdtempSync(join(tmpdir(), "bsm-hostile-"));
    let browser: Browser;
    let site: Site;
    before(async () => {
        browser = await chromium.launch({
            executablePath: CHROMIUM,
            headless: true,
            args: [...FLAGS, "--host-resolver-rules=MAP page.test 127.0.0.1"],
        });
        site = await serveSite();
        site.extra.set("/loader.js", LOADER);
        site.extra.set("/player-page.js", PLAYER);
        const mesh = readFileSync(join(VECTORS, "good-labels.bsm"));
        site.extra.set("/view.html", readFileSync(fileURLToPath(savedPage(folder, { mesh }))));
        const tiled = { name: "tiles", main: 0, layers: [], facts: {}, tiles: "/tiles" };
        site.extra.set("/tiles.html", readFileSync(fileURLToPath(savedPage(folder, { tiles: mesh }, tiled))));
        for (const [name, content] of tileFiles(readFileSync(join(VECTORS, "good-light-tent.bsm"))))
            site.extra.set(`/tiles/${name}`, content);
    });
    after(async () => {
        await browser?.close();
        site?.close();
        rmSync(folder, { recursive: true, force: true });
    });

    for (const row of ROWS)
        for (const surface of SURFACES) {
            const meaning = row[surface];
            if (!meaning) continue;
            test(`${surface}, ${row.page}: ${meaning}`, { timeout: 2 * PATIENCE }, async () => {
                for (const name of Object.keys(site.headers)) delete site.headers[name];
                for (const [name, value] of Object.entries(row.headers ?? {}))
                    site.headers[name] = value.replace("HASH", HASH);
                const stream = row.stream ?? MOVING;
                const inside =
                    surface === "loader"
                        ? "<p></p><script type=module src=/loader.js></script>"
                        : `<bsm-player src="${stream}" autoplay></bsm-player><script type=module src=/player-page.js></script>`;
                const head = `<!doctype html><html lang=en ${row.html ?? ""}><title>t</title><script type=importmap>${MAP}</script>`;
                site.extra.set("/page.html", `${head}<body data-stream="${stream}">${inside}</body></html>`);
                const context = await browser.newContext({ viewport: { width: 800, height: 600 }, ...row.context });
                try {
                    const page = await context.newPage();
                    if (row.media) await page.emulateMedia({ media: row.media });
                    if (row.hidden) await page.addInitScript(hideTab);
                    const name = surface === "view" || surface === "tiles" ? `${surface}.html` : "page.html";
                    await page.goto(site.address.replace("127.0.0.1", row.host ?? "127.0.0.1") + name);
                    if (row.html) await page.evaluate(() => (document.documentElement.dir = "rtl"));
                    if (row.hidden) {
                        await page.waitForTimeout(500);
                        await page.evaluate("showTab()");
                    }
                    await page.waitForFunction(
                        () => /complete|failed/.test(document.body.dataset.state ?? ""),
                        undefined,
                        { timeout: PATIENCE },
                    );
                    await page.waitForTimeout(300);
                    await MEANINGS[meaning](page, row, surface);
                } finally {
                    await context.close();
                }
            });
        }
});
