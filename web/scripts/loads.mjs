// How long pages load meshes by BSMLoader, and by DRACOLoader beside it: `npm run loads -- MESHES`, a folder with
// static/*.ply.
// Times of 100 loads of a small mesh at once and in turn, of one mesh once the page is warm, and the longest task of
// the page's thread while
// a large one comes: what it took of a processor, since the thread may have to wait for one. PYTHON names a Python that
// has bsm's packages, `eval` among them.
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
from bsm.evaluation.curve import encode_draco
meshes, folder = sys.argv[1:]
for name in ("c3d_spot", "nicolo", "dragon_437645"):
    mesh = bsm.load(f"{meshes}/static/{name}.ply")
    open(f"{folder}/{name}.bsm", "wb").write(bsm.encode(mesh))
    open(f"{folder}/{name}-quick.bsm", "wb").write(bsm.encode(mesh, effort="quick"))
    open(f"{folder}/{name}.drc", "wb").write(encode_draco(mesh, 11, 7))
`;
const MAP = '{"imports":{"three":"/three/build/three.module.js","three/addons/":"/three/examples/jsm/"}}';
const SCRIPT = `
import { BSMLoader } from "/bsm/three.js";
import { DRACOLoader } from "three/addons/loaders/DRACOLoader.js";
const loaders = { bsm: new BSMLoader(), drc: new DRACOLoader().setDecoderPath("/three/examples/jsm/libs/draco/") };
const timed = async (work) => {
    const begin = performance.now();
    await work();
    return performance.now() - begin;
};
let number = 0;
const load = (kind, name) => loaders[kind].loadAsync("/file/" + name + "." + kind + "?" + number++);
window.load = load;
window.measure = async (kind, small, single) => {
    await load(kind, small);
    const atOnce = await timed(() => Promise.all(Array.from({ length: ${LOADS} }, () => load(kind, small))));
    const inTurn = await timed(async () => { for (let k = 0; k < ${LOADS}; k++) await load(kind, small); });
    for (let k = 0; k < 5; k++) await load(kind, single);
    const times = [];
    for (let k = 0; k < 7; k++) times.push(await timed(() => load(kind, single)));
    return { atOnce, inTurn, single: times.sort((a, b) => a - b)[3] };
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
    if (pathname === "/")
        return response
            .writeHead(200, { "Content-Type": "text/html" })
            .end(
                `<!doctype html><script type="importmap">${MAP}</script><script type="module" src="/script.js"></script>`,
            );
    if (!folders[place] && pathname !== "/script.js") return response.writeHead(404).end();
    const content = pathname === "/script.js" ? SCRIPT : readFileSync(join(folders[place], ...rest));
    response.writeHead(200, { "Content-Type": TYPES[extname(pathname)] ?? "application/octet-stream" }).end(content);
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    args: FLAGS,
});
const page = await browser.newPage();
page.on("pageerror", (error) => console.error(error));
/** Milliseconds of a processor that the longest task of the page's thread takes while `work` is done. */
async function longestTask(work) {
    await browser.startTracing(page, { categories: ["toplevel"] });
    await work();
    const { traceEvents } = JSON.parse((await browser.stopTracing()).toString());
    const pages = new Set(
        traceEvents
            .filter(({ name, args }) => name === "thread_name" && args.name === "CrRendererMain")
            .map(({ pid, tid }) => `${pid} ${tid}`),
    );
    const tasks = traceEvents.filter(
        ({ name, ph, pid, tid }) => name.endsWith("RunTask") && ph === "X" && pages.has(`${pid} ${tid}`),
    );
    if (tasks.length === 0) throw new Error("no task of the page was seen");
    return tasks.reduce((longest, { tdur = 0 }) => Math.max(longest, tdur / 1e3), 0);
}
/** Least times of all rounds, and the longest task. */
const seen = {};
for (let round = 0; round < ROUNDS; round++) {
    for (const [way, kind, suffix] of [
        ["Draco", "drc", ""],
        ["ours", "bsm", ""],
        ["ours, --quick", "bsm", "-quick"],
    ]) {
        await page.goto(`http://127.0.0.1:${server.address().port}/`);
        await page.waitForFunction("window.ready");
        const [small, single, large] = ["c3d_spot", "nicolo", "dragon_437645"].map((name) => name + suffix);
        const found = await page.evaluate((given) => window.measure(...given), [kind, small, single]);
        const [before, task] = [
            seen[way] ?? found,
            await longestTask(() => page.evaluate((given) => window.load(...given).then(() => {}), [kind, large])),
        ];
        seen[way] = Object.fromEntries(
            Object.entries(found).map(([name, time]) => [name, Math.min(time, before[name])]),
        );
        seen[way].task = Math.max(task, before.task ?? 0);
    }
}
for (const [way, { atOnce, inTurn, single, task }] of Object.entries(seen)) {
    console.log(
        `${way}: c3d_spot ${LOADS} times at once ${atOnce.toFixed(0)} ms, in turn ${inTurn.toFixed(0)} ms; nicolo, warm ${single.toFixed(0)} ms; dragon_437645 takes ${task.toFixed(1)} ms of the page's thread at most`,
    );
}
await browser.close();
server.close();
rmSync(folder, { recursive: true, force: true });
