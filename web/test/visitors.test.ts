/** What visitors and other origins need: threads from a CDN, one request for many loads, fingers, and reduced motion. */
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { extname, join } from "node:path";
import { after, before, describe, test } from "node:test";
import { gzipSync } from "node:zlib";
import { chromium, type Browser, type BrowserContextOptions, type Page } from "playwright-core";
import { CHROMIUM, VECTORS, WEB } from "./shared";

const [STREAM, MOVING] = ["good-attribute-textured", "good-sequence-learnt"];
const TYPES: Record<string, string> = { ".js": "text/javascript", ".wasm": "application/wasm" };
const GRAPHICS = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/** A server of pages whose import map names the package at an address; it counts the requests of each path. */
async function serve(origin: () => string): Promise<{ address: string; asked: string[]; close: () => void }> {
    const asked: string[] = [];
    const server = createServer((request, response) => {
        const path = request.url!;
        asked.push(path);
        const base = origin();
        const at = (name: string): string => `"bsm-decoder/${name}": "${base}/built/${name}.js"`;
        const three = `"three": "${base}/three/build/three.module.js", "three/addons/": "${base}/three/examples/jsm/"`;
        const map = `{"imports": {${three}, ${["three", "encode", "player"].map(at).join()}}}`;
        if (path === "/") {
            response.writeHead(200, { "Content-Type": "text/html" });
            const viewport = '<meta name="viewport" content="width=device-width">';
            return response.end(`<!doctype html>${viewport}<script type="importmap">${map}</script><body></body>`);
        }
        const [, folder, ...rest] = path.split("/");
        const root = {
            built: join(WEB, "built"),
            three: join(WEB, "node_modules/three"),
            gzip: VECTORS,
            stream: VECTORS,
        };
        const place = join(root[folder as keyof typeof root] ?? "", ...rest);
        if (!(folder in root) || !existsSync(place)) return response.writeHead(404).end();
        const bytes = folder === "gzip" ? gzipSync(readFileSync(place)) : readFileSync(place);
        response.writeHead(200, {
            "Content-Type": TYPES[extname(path)] ?? "application/octet-stream",
            "Content-Length": bytes.length,
            "Access-Control-Allow-Origin": "*",
            ...(folder === "gzip" && { "Content-Encoding": "gzip" }),
        });
        response.end(bytes);
    });
    await new Promise<void>((ready) => server.listen(0, "127.0.0.1", ready));
    return {
        address: `http://127.0.0.1:${(server.address() as AddressInfo).port}`,
        asked,
        close: () => server.close(),
    };
}

describe("visitors", { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}` }, () => {
    let browser: Browser;
    let site: Awaited<ReturnType<typeof serve>>;
    let other: Awaited<ReturnType<typeof serve>>;
    let isForeign = false;

    before(async () => {
        browser = await chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", ...GRAPHICS] });
        other = await serve(() => "");
        site = await serve(() => (isForeign ? other.address : ""));
    });
    after(async () => {
        await browser?.close();
        site?.close();
        other?.close();
    });

    async function opened(options: BrowserContextOptions = {}, foreign = false): Promise<Page> {
        isForeign = foreign;
        const page = await (await browser.newContext(options)).newPage();
        await page.goto(site.address);
        return page;
    }

    /** A player that has drawn its stream. */
    async function playing(options: BrowserContextOptions, attributes: string): Promise<Page> {
        const page = await opened(options);
        await page.evaluate(
            async ([name, attributes]) => {
                await import("bsm-decoder/player" as string);
                document.body.innerHTML = `<bsm-player src="/stream/${name}.bsm" ${attributes}></bsm-player>`;
                document.body.insertAdjacentHTML("beforeend", '<p style="height: 2000px"></p>');
                await new Promise((go) => document.querySelector("bsm-player")!.addEventListener("load", go));
            },
            [MOVING, attributes] as const,
        );
        return page;
    }

    test("have threads that come from another origin, to decode and to encode", async () => {
        const page = await opened({}, true);
        const counts = await page.evaluate(async (name) => {
            const Own = window.Worker;
            let [begun, heard] = [0, 0];
            window.Worker = class extends Own {
                constructor(...given: ConstructorParameters<typeof Worker>) {
                    super(...given);
                    begun++;
                    this.addEventListener("message", () => heard++, { once: true });
                }
            };
            const { BSMLoader } = await import("bsm-decoder/three" as string);
            await new BSMLoader().loadAsync(`/stream/${name}.bsm`);
            const decoding = [begun, heard];
            const { encode } = await import("bsm-decoder/encode" as string);
            await encode({ positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], faces: [0, 1, 2] });
            return [...decoding, begun - decoding[0], heard - decoding[1]];
        }, STREAM);
        assert.ok(
            counts.every((count) => count >= 1),
            `${counts}`,
        );
        assert.ok(other.asked.some((path) => path.endsWith("worker.js")));
    });

    test("fetch a stream once, at the same time and with the cache of three.js, and see no more than all", async () => {
        const page = await opened();
        site.asked.length = 0;
        const shares = await page.evaluate(async (name) => {
            const { Cache, FileLoader } = await import("three" as string);
            const { BSMLoader } = await import("bsm-decoder/three" as string);
            const [loader, stop] = [new BSMLoader(), new AbortController()];
            const load = (more = {}): Promise<unknown> => loader.loadAsync(`/stream/${name}.bsm`, undefined, more);
            const stopped = load({ signal: stop.signal }).catch(() => "stopped");
            const loads = [load(), load()];
            stop.abort();
            const fault = (): never => {
                throw new Error("a fault of the page");
            };
            loads.push(loader.loadAsync(`/stream/${name}.bsm`, fault).catch(() => "failed alone"));
            await Promise.all([stopped, ...loads]);
            Cache.enabled = true;
            await new FileLoader().setResponseType("arraybuffer").loadAsync(`/stream/${name}.bsm`);
            for (let i = 0; i < 3; i++) await load();
            const shares: number[] = [];
            await loader.loadAsync(`/gzip/${name}.bsm`, (event: ProgressEvent) => {
                if (event.lengthComputable) shares.push(event.loaded / event.total);
            });
            return shares;
        }, STREAM);
        assert.equal(site.asked.filter((path) => path === `/stream/${STREAM}.bsm`).length, 2);
        assert.ok(
            shares.every((share) => share <= 1),
            `${shares}`,
        );
    });

    test("start and stop a player by a finger, and move the page over it", async () => {
        const size = 'style="display: block; width: 300px; height: 300px"';
        const phone = { viewport: { width: 360, height: 600 }, hasTouch: true, isMobile: true };
        const page = await playing(phone, `controls loop ${size}`);
        const isPaused = (): Promise<boolean> => page.evaluate(() => document.querySelector("bsm-player")!.paused);
        assert.equal(await isPaused(), true);
        await page.touchscreen.tap(150, 120);
        await page.waitForFunction(() => !document.querySelector("bsm-player")!.paused);
        await page.getByRole("button", { name: "Pause" }).tap();
        await page.waitForFunction(() => document.querySelector("bsm-player")!.paused);
        const { length } = await page.evaluate(() =>
            [...document.querySelector("bsm-player")!.shadowRoot!.querySelectorAll("button")].filter(
                (button) => button.getBoundingClientRect().width >= 44 && button.ariaLabel,
            ),
        );
        assert.ok(length >= 1, "buttons are as large as fingers, and have names");
        const session = await page.context().newCDPSession(page);
        const touch = (type: "touchStart" | "touchMove" | "touchEnd", y?: number): Promise<unknown> =>
            session.send("Input.dispatchTouchEvent", { type, touchPoints: y === undefined ? [] : [{ x: 150, y }] });
        await touch("touchStart", 280);
        for (let y = 260; y > 60; y -= 20) await touch("touchMove", y);
        await touch("touchEnd");
        await page.waitForFunction(() => scrollY > 50);
        await page.context().close();
    });

    test("see a player that a page moves, and that was told to play before it had anything", async () => {
        const page = await playing({}, 'style="height: 300px"');
        const found = await page.evaluate(async () => {
            const errors: string[] = [];
            const player = document.querySelector("bsm-player")!;
            player.addEventListener("error", ({ message }) => errors.push(message));
            const again = new Promise((go) => player.addEventListener("load", go));
            document.body.appendChild(document.createElement("div")).append(player); // a context is lost, and another one made
            player.play();
            await again;
            await new Promise((go) => setTimeout(go, 500));
            return errors;
        });
        assert.deepEqual(found, []);
        await page.waitForFunction(() => document.querySelector("bsm-player")!.ended);
        await page.context().close();
    });

    test("see what a page asked for before the player was there, and nothing once it asks for nothing", async () => {
        const page = await opened();
        const found = await page.evaluate(async (name) => {
            const player = document.body.appendChild(document.createElement("bsm-player"));
            [player.src, player.controls, player.alt] = [`/stream/${name}.bsm`, true, "a horse"];
            [player.playbackRate, player.currentTime] = [2, 99];
            const loaded = new Promise((go) => player.addEventListener("load", go));
            await import("bsm-decoder/player" as string);
            await loaded;
            await new Promise((go) => setTimeout(go, 300));
            const before = [player.hasAttribute("src"), player.hasAttribute("controls")];
            before.push(player.canvas.ariaLabel === "a horse", player.rate === 2, player.ended);
            [player.src, player.controls] = [undefined, undefined] as unknown as [string, boolean];
            return [...before, player.hasAttribute("src"), player.hasAttribute("controls")];
        }, MOVING);
        assert.deepEqual(found, [true, true, true, true, true, false, false]);
        await page.context().close();
    });

    test("go on by a frame with each arrow key, and to the last one with End", async () => {
        const page = await playing({}, 'controls style="height: 300px"');
        const frame = (): Promise<number> => page.evaluate(() => document.querySelector("bsm-player")!.sequence!.frame);
        const slider = page.getByRole("slider", { name: "Time" });
        for (const [key, due] of [
            ["ArrowRight", 1],
            ["ArrowRight", 2],
            ["ArrowRight", 3],
            ["ArrowLeft", 2],
            ["Home", 0],
        ] as const) {
            await slider.press(key);
            assert.equal(await frame(), due, key);
        }
        await slider.press("End");
        assert.equal(await page.evaluate(() => document.querySelector("bsm-player")!.ended), true);
        await page.context().close();
    });

    test("see no motion that they did not ask for, and can start it", async () => {
        const page = await playing({ reducedMotion: "reduce" }, 'autoplay loop style="height: 300px"');
        assert.equal(await page.evaluate(() => document.querySelector("bsm-player")!.paused), true);
        await page.getByRole("button", { name: "Play" }).press("Enter");
        await page.waitForFunction(() => document.querySelector("bsm-player")!.currentTime > 0);
        await page.context().close();
    });
});
