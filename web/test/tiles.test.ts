/**
 * A mesh in tiles in headless Chromium: by our page, and by 3d-tiles-renderer; coarse first, fine where one is near.
 */
import assert from "node:assert/strict";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { build } from "esbuild";
import { chromium, type Browser, type Page } from "playwright-core";
import { serveSite } from "./server";
import { CHROMIUM, FLAGS, PATIENCE, rowsOf, silhouette, WEB } from "./shared";

/** Where `bsm view` serves the tiles, their folder with a tileset, faces of the coarsest level and of all the mesh. */
interface Given {
    address: string;
    folder: string;
    coarsest: number;
    faces: number;
}

const SCRIPT = `
import { AmbientLight, Color, DirectionalLight, PerspectiveCamera, Scene, WebGLRenderer } from "three";
import { TilesRenderer } from "3d-tiles-renderer";
import { GLTFExtensionsPlugin } from "3d-tiles-renderer/plugins";
import { GLTFBSMExtension } from "/bsm/gltf.js";
const renderer = new WebGLRenderer();
renderer.setSize(600, 400);
document.body.append(renderer.domElement);
const camera = new PerspectiveCamera(50, 1.5, 0.01, 1e4);
const scene = new Scene();
scene.background = new Color(0xe9ecf0);
const light = new DirectionalLight(0xffffff, 3);
const tiles = new TilesRenderer("/scan/tileset.json");
tiles.registerPlugin(new GLTFExtensionsPlugin({ plugins: [(parser) => new GLTFBSMExtension(parser)] }));
tiles.errorTarget = 0.5;
tiles.group.rotation.x = -Math.PI / 2;
tiles.setCamera(camera);
tiles.setResolutionFromRenderer(camera, renderer);
scene.add(camera.add(light), new AmbientLight(0xffffff, 0.5), tiles.group);
const loaded = [];
tiles.addEventListener("load-model", ({ tile }) => loaded.push(tile.content.uri));
let [distance, quiet] = [200, 0];
globalThis.from = (far) => { [distance, quiet] = [far, 0]; };
globalThis.tileState = () => {
    let faces = 0;
    tiles.group.traverse((one) => { if (one.isMesh) faces += one.geometry.index.count / 3; });
    return { loaded, faces, quiet };
};
renderer.setAnimationLoop(() => {
    camera.position.set(0, 0, distance);
    camera.updateMatrixWorld();
    tiles.update();
    quiet = tiles.isLoading || tiles.loadProgress < 1 ? 0 : quiet + 1;
    renderer.render(scene, camera);
});
`;

/** The mean of all pixels. */
function brightnessOf(png: Buffer): number {
    let [sum, count] = [0, 0];
    for (const { row, channels } of rowsOf(png))
        for (let i = 0; i < row.length; i += channels) [sum, count] = [sum + row[i], count + 1];
    return sum / count;
}

const given = process.env.BSM_TILES;

describe("tiles", { skip: !given || (!existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}`) }, () => {
    const { address, folder, coarsest, faces } = JSON.parse(given ?? "{}") as Given;
    const pages: Page[] = [];
    const complaints: string[] = [];
    let browser: Browser;

    before(async () => {
        browser = await chromium.launch({ executablePath: CHROMIUM, headless: true, args: FLAGS });
    });
    after(() => browser.close());

    async function opened(): Promise<Page> {
        const page = await browser.newPage({ viewport: { width: 600, height: 400 } });
        page.on("pageerror", (error) => complaints.push(error.message));
        pages.push(page);
        return page;
    }

    test("the page shows coarse tiles first, and as many more as there are pixels for", async () => {
        const page = await opened();
        const asked: (string | undefined)[] = [];
        const [events, kernels]: string[][] = [[], []];
        page.on(
            "request",
            (request) => request.url().endsWith(".wasm") && kernels.push(request.url().replace(address, "")),
        );
        page.on(
            "request",
            (request) =>
                request.url().endsWith(".tiles") && events.push("asked") && asked.push(request.headers().range),
        );
        page.on("requestfinished", (request) => request.url().endsWith(".tiles") && events.push("came"));
        await page.addInitScript(() => {
            const seen: number[] = ((globalThis as unknown as { seen: number[] }).seen = []);
            new MutationObserver(() => seen.push(Number(document.body?.dataset.faces ?? 0))).observe(document, {
                attributes: true,
                subtree: true,
                attributeFilter: ["data-faces"],
            });
        });
        await page.goto(address);
        await page.waitForSelector("body[data-state=complete]", { timeout: PATIENCE });
        // A function, since a text that is not true at once would be evaluated by the page, which forbids that.
        await page.waitForFunction(() => (globalThis as unknown as { seen: number[] }).seen.some((faces) => faces > 0));
        const seen = (await page.evaluate("seen.filter((faces) => faces > 0)")) as number[];
        const far = await page.locator("canvas").screenshot();
        // A busy machine may draw no frame before more has come.
        assert.deepEqual(events.slice(0, 2), ["asked", "came"], "the coarsest comes first, and alone");
        assert.ok(
            seen[0] >= coarsest && seen.every((faces, i) => i === 0 || faces >= seen[i - 1]),
            "never less is seen",
        );
        assert.ok(asked.length > 2 && asked.every((range) => range?.startsWith("bytes=")), "by ranges");
        assert.deepEqual(kernels, ["grid.wasm"], "no more of the decoder than tiles need");
        const { share } = silhouette(far);
        assert.ok(share > 0.05 && share < 0.9, `share ${share}`);
        await page.keyboard.press("h"); // nothing lies before the mesh
        const brightness = [];
        for (const _ of ["flat", "wire", "smooth"]) {
            await page.keyboard.press("d");
            await page.waitForTimeout(500);
            brightness.push(brightnessOf(await page.locator("canvas").screenshot()));
        }
        assert.ok(brightness[1] < brightness[0] - 2, `edges are drawn: ${brightness}`);
        const before = Number(await page.locator("body").getAttribute("data-faces"));
        await page.locator("canvas").focus();
        for (let k = 0; k < 12; k++) await page.keyboard.press("+");
        await page.waitForFunction(
            (before) => document.body.dataset.state === "complete" && Number(document.body.dataset.faces) > before,
            before,
            { timeout: PATIENCE },
        );
        assert.ok(Number(await page.locator("body").getAttribute("data-faces")) <= faces);
        assert.ok(silhouette(await page.locator("canvas").screenshot()).share > share);
        for (let k = 0; k < 60; k++) await page.keyboard.press("-");
        await page.waitForFunction((before) => Number(document.body.dataset.faces) < before, before, {
            timeout: PATIENCE,
        });
        assert.deepEqual(complaints, []);
    });

    for (const content of ["plain", "coded"])
        test(`3d-tiles-renderer shows the ${content} tileset, coarse from afar and fine from near`, async (context) => {
            const site = await serveSite();
            context.after(() => site.close());
            const options = {
                stdin: { contents: SCRIPT, resolveDir: WEB },
                bundle: true,
                external: ["/bsm/*"],
                write: false as const,
                format: "esm" as const,
                logLevel: "error" as const,
            };
            site.extra.set("/script.js", (await build(options)).outputFiles[0].text);
            site.extra.set("/scan/tileset.json", readFileSync(join(folder, content, "tileset.json"), "utf8"));
            for (const name of readdirSync(join(folder, content, "glb")))
                site.extra.set(`/scan/glb/${name}`, readFileSync(join(folder, content, "glb", name)));
            assert.equal(
                readFileSync(join(folder, content, "glb", "r.glb")).includes("EXT_bsm_compression"),
                content === "coded",
            );
            const page = await opened();
            await page.goto(site.address);
            const tileState = async (over: number): Promise<{ loaded: string[]; faces: number }> => {
                await page.waitForFunction(`tileState().quiet > 5 && tileState().faces > ${over}`, undefined, {
                    timeout: PATIENCE,
                });
                return (await page.evaluate("tileState()")) as { loaded: string[]; faces: number };
            };
            const far = await tileState(0);
            assert.equal(far.faces, coarsest);
            assert.deepEqual(far.loaded, ["glb/r.glb"]);
            await page.evaluate("from(2.5)");
            const near = await tileState(2 * coarsest); // loads may begin frames after the camera moved
            assert.ok(near.faces <= faces, `${near.faces} faces`);
            const { share, x, y } = silhouette(await page.locator("canvas").screenshot());
            assert.ok(share > 0.1 && Math.abs(x - 0.5) < 0.1 && Math.abs(y - 0.5) < 0.15, `${share} ${x} ${y}`);
            assert.deepEqual(complaints, []);
        });
});
