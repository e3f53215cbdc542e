// How long pages load meshes by BSMLoader, and by DRACOLoader beside it: `npm run loads -- MESHES`, a folder with static/*.ply.
// Times of 100 loads of a small mesh at once and in turn, of one mesh once the page is warm, and the longest stop of the page's thread while
// a large one comes. PYTHON names a Python that has bsm's packages, `eval` among them.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { chromium } from "playwright-core";
import { WEB } from "./kernels.mjs";

const LOADS = 100;
const ROUNDS = 3;
const FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const PREPARE = `
import sys, bsm
from bsm.evaluation.draco import encode_draco
meshes, folder = sys.argv[1:]
for name in ("c3d_spot", "nicolo", "dragon_437645"):
    mesh = bsm.load(f"{meshes}/static/{name}.ply")
    open(f"{folder}/{name}.bsm", "wb").write(bsm.encode(mesh))
    open(f"{folder}/{name}-quick.bsm", "wb").write(bsm.encode(mesh, quick=True))
    open(f"{folder}/{name}.drc", "wb").write(encode_draco(mesh, 11, 7))
`;
const MAP = '{"imports":{"three":"/three/build/three.module.js","three/addons/":"/three/examples/jsm/"}}';
const SCRIPT = `
import { BSMLoader } from "/bsm/three.js";
import { DRACOLoader } from "three/addons/loaders/DRACOLoader.js";
const loaders = { bsm: new BSMLoader(), drc: new DRACOLoader().setDecoderPath("/three/examples/jsm/libs/draco/") };
/** The longest time between two turns of the page's thread, while something is done. */
async function longestStop(work) {
    let [last, longest, over] = [performance.now(), 0, false];
    const channel = new MessageChannel();
    channel.port1.onmessage = () => {
        const now = performance.now();
        longest = Math.max(longest, now - last);
        last = now;
        if (!over) channel.port2.postMessage(0);
    };
    channel.port2.postMessage(0);
    await work();
    await new Promise((rest) => setTimeout(rest, 20));
    over = true;
    return longest;
}
const timed = async (work) => {
    const begin = performance.now();
    await work();
    return performance.now() - begin;
};
let number = 0;
const load = (kind, name) => loaders[kind].loadAsync("/file/" + name + "." + kind + "?" + number++);
window.measure = async (kind, small, single, large) => {
    await load(kind, small);
    const atOnce = await timed(() => Promise.all(Array.from({ length: ${LOADS} }, () => load(kind, small))));
    const inTurn = await timed(async () => { for (let k = 0; k < ${LOADS}; k++) await load(kind, small); });
    for (let k = 0; k < 5; k++) await load(kind, single);
    const times = [];
    for (let k = 0; k < 7; k++) times.push(await timed(() => load(kind, single)));
    const stop = await longestStop(() => load(kind, large));
    return { atOnce, inTurn, single: times.sort((a, b) => a - b)[3], stop };
};
window.ready = true;
`;
const TYPES = { ".js": "text/javascript", ".wasm": "application/wasm" };

const [meshes] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "bsm-loads-"));
execFileSync(process.env.PYTHON ?? "python3", ["-c", PREPARE, meshes, folder], { stdio: "inherit" });
const folders = { bsm: join(WEB, "built"), three: join(WEB, "node_modules/three"), file: folder };
const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, "http://localhost");
    const [, place, ...rest] = pathname.split("/");
    if (pathname === "/") return response.writeHead(200, { "Content-Type": "text/html" }).end(`<!doctype html><script type="importmap">${MAP}</script><script type="module" src="/script.js"></script>`);
    if (!folders[place] && pathname !== "/script.js") return response.writeHead(404).end();
    const content = pathname === "/script.js" ? SCRIPT : readFileSync(join(folders[place], ...rest));
    response.writeHead(200, { "Content-Type": TYPES[extname(pathname)] ?? "application/octet-stream" }).end(content);
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args: FLAGS });
const page = await browser.newPage();
page.on("pageerror", (error) => console.error(error));
const least = {};
for (let round = 0; round < ROUNDS; round++) {
    for (const [way, kind, suffix] of [["Draco", "drc", ""], ["ours", "bsm", ""], ["ours, --quick", "bsm", "-quick"]]) {
        await page.goto(`http://127.0.0.1:${server.address().port}/`);
        await page.waitForFunction("window.ready");
        const found = await page.evaluate(([kind, ...names]) => window.measure(kind, ...names), [kind, ...["c3d_spot", "nicolo", "dragon_437645"].map((name) => name + suffix)]);
        least[way] = Object.fromEntries(Object.entries(found).map(([name, time]) => [name, Math.min(time, least[way]?.[name] ?? Infinity)]));
    }
}
for (const [way, { atOnce, inTurn, single, stop }] of Object.entries(least)) {
    console.log(`${way}: c3d_spot ${LOADS} times at once ${atOnce.toFixed(0)} ms, in turn ${inTurn.toFixed(0)} ms; nicolo, warm ${single.toFixed(0)} ms; dragon_437645 stops the page for ${stop.toFixed(1)} ms at most`);
}
await browser.close();
server.close();
rmSync(folder, { recursive: true, force: true });
