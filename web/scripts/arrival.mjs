/**
 * Time to the picture: `npm run arrival -- MESHES [ROUNDS] [MBIT...]`, in headless Chromium, for eight known meshes, as
 * Draco (fewest bits with a look of at most 1, level 10), meshoptimizer with brotli (the same bits), and our default and
 * `--quick`.
 *
 * Three states of each visitor: cold (nothing is cached), cached (another page, to which the decoder comes from the
 * cache of the browser), and warm (that page has decoded the mesh before). The link is made by the server, which sends
 * all bytes one after the other at a rate (0: without one): Chromium emulates none for threads. Times are the least of
 * all rounds, from the call of the loader; processor time is that of the whole renderer. STATES names some of the
 * states, NAMES some of the meshes. MESHES is a folder with static/*.ply, or scenes with commas between them
 * (a.glb,b.glb): these by GLTFLoader, as gltfpack -cc (GLTFPACK names its command) and by `bsm glb`, default and
 * `--quick`. PYTHON names a Python that has bsm[eval].
 */
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, renameSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { basename, extname, join } from "node:path";
import { brotliCompressSync } from "node:zlib";
import { MeshoptEncoder } from "meshoptimizer";
import { chromium } from "playwright-core";
import { WEB } from "./kernels.mjs";

const [meshes, rounds = "3", ...rates] = process.argv.slice(2);
if (!meshes) throw new Error("name a folder of meshes, or scenes");
const SCENES = meshes.split(",").filter((path) => path.endsWith(".glb"));
const OF_SCENES = SCENES.length > 0;
const KNOWN = [
    "c3d_spot",
    "gargoyle_10002",
    "dragon_22998",
    "bunny_34834",
    "horse_48485",
    "block",
    "fandisk_6475",
    "fr_casting",
];
const NAMES = OF_SCENES ? SCENES.map((path) => basename(path, ".glb")) : (process.env.NAMES?.split(" ") ?? KNOWN);
/** How the page loads each kind of file. */
const WAYS = OF_SCENES
    ? { gltfpack: "gltfpack", default: "scene", quick: "scene" }
    : { draco: "draco", meshopt: "meshopt", default: "bsm", quick: "bsm", near: "near" };
// near: quick, by the loader with its decoder inside
const STATES = (process.env.STATES ?? "cold cached warm").split(" ");
const PIECE = 4096; // bytes that are sent at a time
const FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const TYPES = { ".js": "text/javascript", ".wasm": "application/wasm" };
const PREPARE = `
import json, sys, bsm, numpy as np
from bsm.evaluation.curve import decode_draco, encode_draco
meshes, folder, *names = sys.argv[1:]
for name in names:
    mesh = bsm.load(f"{meshes}/static/{name}.ply")
    for bits in range(8, 16):
        draco = encode_draco(mesh, bits, 10)
        if bsm.look(mesh, decode_draco(draco)).distance <= 1 or bits == 15:
            break
    low, size = mesh.positions.min(axis=0), np.ptp(mesh.positions, axis=0).max()
    cells = np.rint((mesh.positions - low) / size * (2**bits - 1)).astype("<u2")
    np.pad(cells, ((0, 0), (0, 1))).tofile(f"{folder}/{name}.cells")
    mesh.faces.astype("<u4").tofile(f"{folder}/{name}.corners")
    files = {"draco": draco, "default": bsm.encode(mesh), "quick": bsm.encode(mesh, effort="quick")}
    for way, data in files.items():
        open(f"{folder}/{name}-{way}", "wb").write(data)
    print(name, bits, file=sys.stderr)
`;
const MAP = '{"imports":{"three":"/three/build/three.module.js","three/addons/":"/three/examples/jsm/"}}';
const BASE = "/three/examples/jsm/libs/draco/";
/** In the page: each way loads an address, and tells when there is a first picture; what it imports is asked for first. */
const SCRIPT = `
const whole = (loader) => (url) => loader.loadAsync(url);
const ways = {
    draco: async () => {
        const { DRACOLoader } = await import("three/addons/loaders/DRACOLoader.js");
        return whole(new DRACOLoader().setDecoderPath("${BASE}"));
    },
    meshopt: async () => {
        const { MeshoptDecoder } = await import("three/addons/libs/meshopt_decoder.module.js");
        return async (url) => {
            const data = new Uint8Array(await (await fetch(url)).arrayBuffer());
            const [vertices, corners, split] = new Uint32Array(data.slice(0, 12).buffer);
            await MeshoptDecoder.ready;
            const [points, faces] = [new Uint8Array(8 * vertices), new Uint8Array(4 * corners)];
            MeshoptDecoder.decodeVertexBuffer(points, vertices, 8, data.subarray(12, 12 + split));
            MeshoptDecoder.decodeIndexBuffer(faces, corners, 4, data.subarray(12 + split));
        };
    },
    gltfpack: async () => {
        const [{ GLTFLoader }, { MeshoptDecoder }] = await Promise.all([
            import("three/addons/loaders/GLTFLoader.js"),
            import("three/addons/libs/meshopt_decoder.module.js"),
        ]);
        return whole(new GLTFLoader().setMeshoptDecoder(MeshoptDecoder));
    },
    scene: async () => {
        const [{ GLTFLoader }, { GLTFBSMExtension }] = await Promise.all([
            import("three/addons/loaders/GLTFLoader.js"),
            import("/bsm/gltf.js"),
        ]);
        return whole(new GLTFLoader().register((parser) => new GLTFBSMExtension(parser)));
    },
    bsm: (file = "three") => async () => {
        const { BSMLoader } = await import("/bsm/" + file + ".js");
        const loader = new BSMLoader();
        return (url, first) =>
            new Promise((keep, fail) => loader.load(url, keep, undefined, fail, { onBlock: () => first() }));
    },
};
[ways.near, ways.bsm] = [ways.bsm("three-near"), ways.bsm()];
let loading;
window.load = async (way, url) => {
    const begin = performance.now();
    let seen;
    loading ??= ways[way]();
    await (await loading)(url, () => (seen ??= performance.now() - begin));
    const whole = performance.now() - begin;
    return { first: seen ?? whole, whole };
};
window.three = import("three"); // which the page has anyway
`;

const PYTHON = process.env.PYTHON ?? "python3";
const folder = process.env.ARRIVAL ?? mkdtempSync(join(tmpdir(), "bsm-arrival-")); // ARRIVAL: a folder that keeps them
if (!existsSync(join(folder, `${NAMES.at(-1)}-quick`)))
    if (OF_SCENES) SCENES.forEach(prepareScene);
    else execFileSync(PYTHON, ["-c", PREPARE, meshes, folder, ...NAMES], { stdio: "inherit" });

/** A scene as each way has it. */
function prepareScene(path) {
    const program = process.env.GLTFPACK ?? "gltfpack";
    const make = (way, command, ...args) => {
        const made = join(folder, `${basename(path, ".glb")}-${way}`);
        execFileSync(command, [...args, "-o", `${made}.glb`], { stdio: "inherit" }); // which all of them ask for
        renameSync(`${made}.glb`, made);
    };
    make("gltfpack", program, "-i", path, "-cc");
    make("default", PYTHON, "-m", "bsm", "glb", path, "-f", "-q");
    make("quick", PYTHON, "-m", "bsm", "glb", path, "-f", "-q", "--quick");
}

/** A mesh by meshoptimizer: counts, vertices, faces, as GLB has them. */
async function meshoptOf(name) {
    await MeshoptEncoder.ready;
    const [cells, corners] = ["cells", "corners"].map((kind) => readFileSync(join(folder, `${name}.${kind}`)));
    const index = new Uint32Array(corners.buffer.slice(corners.byteOffset, corners.byteOffset + corners.length));
    const [order, count] = MeshoptEncoder.reorderMesh(index, true, true);
    const points = new Uint8Array(8 * count);
    order.forEach((to, from) => {
        if (to !== 0xffffffff) points.set(cells.subarray(8 * from, 8 * from + 8), 8 * to);
    });
    const vertices = MeshoptEncoder.encodeVertexBuffer(points, count, 8);
    const faces = MeshoptEncoder.encodeIndexBuffer(new Uint8Array(index.buffer), index.length, 4);
    const head = new Uint8Array(Uint32Array.of(count, index.length, vertices.length).buffer);
    return Buffer.concat([head, vertices, faces]);
}

const files = new Map();
for (const name of NAMES)
    for (const way of Object.keys(WAYS)) {
        const data =
            way === "meshopt"
                ? await meshoptOf(name)
                : readFileSync(join(folder, `${name}-${way === "near" ? "quick" : way}`));
        files.set(`/file/${name}-${way}`, brotliCompressSync(data));
    }
const compressed = new Map();
const bodyOf = (path) => {
    const [, place, ...rest] = path.split("/");
    const root = { bsm: join(WEB, "built"), three: join(WEB, "node_modules/three") }[place];
    if (!root) return files.get(path);
    if (!compressed.has(path)) compressed.set(path, brotliCompressSync(readFileSync(join(root, ...rest))));
    return compressed.get(path);
};

// No page waits until a file is compressed: servers have done that before.
for (const name of readdirSync(join(WEB, "built"))) bodyOf(`/bsm/${name}`);
for (const name of ["draco_decoder.wasm", "draco_wasm_wrapper.js"]) bodyOf(BASE + name);
for (const name of ["loaders/DRACOLoader.js", "loaders/GLTFLoader.js", "libs/meshopt_decoder.module.js"])
    bodyOf(`/three/examples/jsm/${name}`);

let rate = Infinity; // bits in a millisecond
let free = 0; // when the link has sent all that waits
/** Send a body over the link, which all answers share. */
function send(response, body) {
    if (rate === Infinity) return response.end(body);
    let at = 0;
    const next = () => {
        if (at >= body.length) return response.end();
        const piece = body.subarray(at, at + PIECE);
        at += piece.length;
        free = Math.max(performance.now(), free) + (8 * piece.length) / rate;
        setTimeout(() => (response.write(piece), next()), Math.max(0, free - performance.now()));
    };
    next();
}

const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, "http://localhost");
    if (pathname === "/") {
        const page = `<!doctype html><script type="importmap">${MAP}</script><script type="module">${SCRIPT}</script>`;
        return response.writeHead(200, { "Content-Type": "text/html" }).end(page);
    }
    const body = bodyOf(pathname);
    if (!body) return response.writeHead(404).end();
    const isFile = pathname.startsWith("/file/");
    response.writeHead(200, {
        "Content-Type": TYPES[extname(pathname)] ?? "application/octet-stream",
        "Content-Encoding": "br",
        "Content-Length": body.length,
        "Cache-Control": isFile ? "no-store" : "max-age=3600",
    });
    send(response, body);
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const address = `http://127.0.0.1:${server.address().port}/`;
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    args: FLAGS,
});
const system = await browser.newBrowserCDPSession();
/** Seconds of processors that all renderers have taken. */
async function spent() {
    const { processInfo } = await system.send("SystemInfo.getProcessInfo");
    return processInfo.filter(({ type }) => type === "renderer").reduce((sum, { cpuTime }) => sum + cpuTime, 0);
}

/** The states of one visitor, in their order: the first page fetches the decoder, the next one has it. */
async function arrivals(name, way) {
    const context = await browser.newContext();
    try {
        const open = async () => {
            rate = Infinity;
            const page = await context.newPage();
            await page.goto(address);
            await page.evaluate(() => window.three);
            return page;
        };
        const load = async (page) => {
            [rate, free] = [link === 0 ? Infinity : link * 1000, 0];
            const before = await spent();
            const url = `/file/${name}-${way}?${Math.random()}`;
            const times = await page.evaluate(([kind, url]) => window.load(kind, url), [WAYS[way], url]);
            return { ...times, cpu: 1000 * ((await spent()) - before) };
        };
        const first = await open();
        const cold = await load(first);
        if (STATES.join() === "cold") return { cold };
        await first.close();
        const second = await open();
        const cached = await load(second);
        return { cold, cached, warm: await load(second) };
    } finally {
        await context.close();
    }
}

let link;
try {
    const ways = Object.keys(WAYS);
    for (link of rates.length > 0 ? rates.map(Number) : [3, 10, 50]) {
        const rows = new Map(STATES.map((state) => [state, []]));
        for (const name of NAMES) {
            const cells = new Map(STATES.map((state) => [state, []]));
            for (const way of ways) {
                const visits = [];
                for (let k = 0; k < Number(rounds); k++) visits.push(await arrivals(name, way));
                const bytes = files.get(`/file/${name}-${way}`).length.toLocaleString("en");
                const isWhole = !["bsm", "near"].includes(WAYS[way]);
                for (const state of STATES) {
                    const least = (what) => Math.round(Math.min(...visits.map((visit) => visit[state][what])));
                    const first = isWhole ? "" : `${least("first")}, `;
                    cells.get(state).push(`${bytes}; ${first}${least("whole")}; ${least("cpu")}`);
                }
            }
            for (const state of STATES) rows.get(state).push(`| ${name} | ${cells.get(state).join(" | ")} |`);
            console.error(`${link} Mbit/s: ${name}`);
        }
        for (const [state, lines] of rows) {
            console.log(`\n${link} Mbit/s, ${state}: bytes; ms to the first and to the whole picture; processor ms`);
            console.log(`| | ${ways.join(" | ")} |\n|---|${"---:|".repeat(ways.length)}`);
            console.log(lines.join("\n"));
        }
    }
} finally {
    await browser.close();
    server.close();
    if (!process.env.ARRIVAL) rmSync(folder, { recursive: true, force: true });
}
