// What a page fetches and how long it takes, in Chromium, beside our Python and Draco: `npm run figures -- MESHES`;
// only
// the race with Draco: `npm run figures -- MESHES race`.
// MESHES is a folder with static/bunny_34834.ply and dynamic/samba.npz; PYTHON names a Python that has bsm's packages.
import { execFileSync, execSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { Worker } from "node:worker_threads";
import { brotliCompressSync } from "node:zlib";
import { chromium } from "playwright-core";
import { WEB } from "./kernels.mjs";

const ROOT = join(WEB, "..");
const PYTHON = process.env.PYTHON ?? "python3";
const ROUNDS = 9;
const PAGES = 5;
const PRESETS = ["small", "balanced", "fine", "near-lossless", "lossless"];
const LINK = 10e6;
const FLAGS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
];

/** Encodes what is timed. */
const PREPARE = `
import sys
import numpy as np, bsm
meshes, folder, *presets = sys.argv[1:]
mesh = bsm.load(f"{meshes}/static/bunny_34834.ply")
for preset in presets:
    open(f"{folder}/bunny-{preset}.bsm", "wb").write(bsm.encode(mesh, preset=preset))
with np.load(f"{meshes}/dynamic/samba.npz") as arrays:
    frames = bsm.encode_sequence(arrays["positions"], arrays["faces"], frame_rate=30)
    groups = bsm.encode_sequence(arrays["positions"], arrays["faces"], frame_rate=30, gop=25)
open(f"{folder}/samba.bsm", "wb").write(frames)
open(f"{folder}/samba-groups.bsm", "wb").write(groups)
print("null")
`;

/** Draco's files of a mesh, and streams that look as much like it. */
const ENTER = `
import json, sys
import bsm
from bsm.evaluation.curve import decode_draco, encode_draco
from bsm.viewer.contents import DRACO_LEVEL
meshes, folder = sys.argv[1:]
mesh = bsm.load(f"{meshes}/static/bunny_34834.ply")
races = []
for bits in (9, 10, 11, 12):
    draco = encode_draco(mesh, bits, DRACO_LEVEL)
    distance = bsm.look(mesh, decode_draco(draco)).distance
    runners = {"draco": draco, "smallest": bsm.encode(mesh, look=distance), "quick": bsm.encode(mesh, look=distance, effort="quick")}
    for way, stream in runners.items():
        open(f"{folder}/{way}-{bits}", "wb").write(stream)
    races.append({"bits": bits, "distance": distance})
print(json.dumps(races))
`;

const DECODE = `
import json, sys, time, bsm
data = open(sys.argv[1], "rb").read()
times = []
for _ in range(int(sys.argv[2])):
    begin = time.perf_counter()
    bsm.decode(data, threads=1)
    times.append(1000 * (time.perf_counter() - begin))
print(json.dumps(times))
`;

function python(program, ...args) {
    const environment = { ...process.env, PYTHONPATH: join(ROOT, "src"), OMP_NUM_THREADS: "1" };
    return JSON.parse(
        execFileSync(PYTHON, ["-c", program, ...args], { cwd: ROOT, env: environment, encoding: "utf8" }),
    );
}

const built = (name) => readFileSync(join(WEB, "built", name));
const draco = (name) => readFileSync(join(WEB, "node_modules/three/examples/jsm/libs/draco", name));
const milliseconds = (time) => `${time.toFixed(0)} ms`;
const smallest = (times) => Math.min(...times);

/** What a server has: contents, files that were built, and an empty page. */
function compressed(contents, names) {
    const all = {
        empty: Buffer.from("<!doctype html><title>empty</title>"),
        ...Object.fromEntries(names.map((name) => [name, built(name)])),
        ...contents,
    };
    return Object.fromEntries(Object.entries(all).map(([name, content]) => [name, brotliCompressSync(content)]));
}

/** A server of the loopback interface; everything comes compressed, as a page would fetch it. */
async function serve(files) {
    const server = createServer((request, response) => {
        const file = files[request.url.slice(1)];
        if (!file) return response.writeHead(404).end();
        const type = request.url.endsWith(".wasm")
            ? "application/wasm"
            : request.url.endsWith(".js")
              ? "text/javascript"
              : "text/html";
        response
            .writeHead(200, { "Content-Type": type, "Content-Encoding": "br", "Content-Length": file.length })
            .end(file);
    });
    await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
    return { server, address: `http://127.0.0.1:${server.address().port}/` };
}

async function withPage(work) {
    const browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        headless: true,
        args: FLAGS,
    });
    try {
        const page = await browser.newPage({ viewport: { width: 800, height: 500 } });
        return await work(page, await page.context().newCDPSession(page));
    } finally {
        await browser.close();
    }
}

/**
 * Milliseconds of decodings, alone and in a pool of threads, and the least times that both took in turns; the first is that of a page
 * which has decoded nothing yet.
 */
function decodeInPage(address) {
    return withPage(async (page) => {
        await page.goto(`${address}empty`);
        return page.evaluate(
            async ([rounds]) => {
                const { decode, Kernels, Pool } = await import("/main.js");
                const kernels = new Kernels(
                    await WebAssembly.compile(await (await fetch("/kernels.wasm")).arrayBuffer()),
                );
                const stream = new Uint8Array(await (await fetch("/bunny-balanced.bsm")).arrayBuffer());
                const pool = new Pool();
                const inPool = () =>
                    new Promise((onEnd, onError) => {
                        const decoding = pool.open({ onEnd, onError }, { drawing: "whole" });
                        decoding.receiveData(stream.slice());
                        decoding.receiveEof();
                    });
                const [alone, together] = [[], []];
                for (let k = 0; k < rounds; k++) {
                    const before = performance.now();
                    decode(kernels, stream);
                    const between = performance.now();
                    await inPool();
                    alone.push(between - before);
                    together.push(performance.now() - between);
                }
                return { alone, together, processors: navigator.hardwareConcurrency };
            },
            [ROUNDS],
        );
    });
}

/**
 * Bytes at which the faces have come and the first block is there, and milliseconds of work up to it, in a page of its
 * own.
 */
function beginInPage(address, name) {
    return withPage(async (page) => {
        await page.goto(`${address}empty`);
        return page.evaluate(
            async ([name]) => {
                const { Decoder, Kernels, NEED_DATA } = await import("/bsm.js");
                const kernels = new Kernels(
                    await WebAssembly.compile(await (await fetch("/kernels.wasm")).arrayBuffer()),
                );
                const stream = new Uint8Array(await (await fetch(`/${name}`)).arrayBuffer());
                const firstOf = (size) => {
                    const decoder = new Decoder(kernels);
                    for (let at = 0; ; at += size) {
                        for (let event; (event = decoder.nextEvent()) !== NEED_DATA;)
                            if (event.type === "block") return at;
                        decoder.receiveData(stream.subarray(at, at + size));
                    }
                };
                const first = firstOf(1);
                const begin = performance.now();
                firstOf(first);
                return { first, bytes: stream.length, work: performance.now() - begin };
            },
            [name],
        );
    });
}

/**
 * Milliseconds until each frame of a sequence is there, from the moment that all its bytes are; the page's thread
 * slowed down.
 */
function framesInPage(address, name, rate) {
    return withPage(async (page, session) => {
        await page.goto(`${address}empty`);
        await session.send("Emulation.setCPUThrottlingRate", { rate });
        return page.evaluate(
            async ([name]) => {
                const { Decoder, END_OF_STREAM, Kernels } = await import("/bsm.js");
                const kernels = new Kernels(
                    await WebAssembly.compile(await (await fetch("/kernels.wasm")).arrayBuffer()),
                );
                const stream = new Uint8Array(await (await fetch(`/${name}`)).arrayBuffer());
                const begin = performance.now();
                const decoder = new Decoder(kernels);
                const times = [];
                decoder.receiveData(stream);
                decoder.receiveEof();
                for (let event; (event = decoder.nextEvent()) !== END_OF_STREAM;)
                    if (event.type === "frame") times.push(performance.now() - begin);
                return times;
            },
            [name],
        );
    });
}

/** Seconds from nothing to the mesh over the link, decoder and file fetched at the same time. */
function fetchInPage(address, script) {
    return withPage(async (page, session) => {
        await page.goto(`${address}empty`);
        await session.send("Network.enable");
        await session.send("Network.setCacheDisabled", { cacheDisabled: true });
        await session.send("Network.emulateNetworkConditions", {
            offline: false,
            latency: 0,
            downloadThroughput: LINK / 8,
            uploadThroughput: LINK / 8,
        });
        return page.evaluate(script);
    });
}

/**
 * What ends each race: when all had been fetched and when the mesh was there, and the least time of later decodings.
 */
const FINISH = `
    const cold = performance.now() - begin;
    const fetched = Math.max(...performance.getEntriesByType("resource").map(({ responseEnd }) => responseEnd)) - begin;
    let warm = Infinity;
    for (let k = 0; k < 5; k++) {
        await new Promise((rest) => setTimeout(rest, 20));
        const start = performance.now();
        await again();
        warm = Math.min(warm, performance.now() - start);
    }
    return { cold, fetched, warm };
`;

/** Ours: what is on a grid is decoded as it comes, blocks by a pool of threads. */
const ours = {
    quick: (stream) => `(async () => {
    const begin = performance.now();
    const script = import("/quick.js");
    const compiling = WebAssembly.compileStreaming(fetch("/quick.wasm"));
    const coming = fetch("/${stream}");
    const { decode, Decoder, Kernels, NEED_DATA } = await script;
    const kernels = new Kernels(await compiling);
    const decoder = new Decoder(kernels);
    const reader = (await coming).body.getReader();
    const chunks = [];
    for (let part; !(part = await reader.read()).done; ) {
        chunks.push(part.value);
        decoder.receiveData(part.value);
        while (decoder.nextEvent() !== NEED_DATA);
    }
    const { faces } = decoder.finish();
    const whole = new Uint8Array(await new Blob(chunks).arrayBuffer());
    const again = () => decode(kernels, whole);
    ${FINISH}
})()`,
    smallest: (stream) => `(async () => {
    const begin = performance.now();
    const bytes = fetch("/${stream}").then((response) => response.arrayBuffer());
    const { Pool } = await import("/pool.js");
    const pool = new Pool();
    void pool.preload("small");
    const whole = await bytes;
    const again = () => new Promise((onEnd, onError) => {
        const decoding = pool.open({ onEnd, onError }, { drawing: "whole" });
        decoding.receiveData(new Uint8Array(whole.slice()));
        decoding.receiveEof();
    });
    await again();
    ${FINISH}
})()`,
};

const draconic = (stream) => `(async () => {
    const begin = performance.now();
    const bytes = async (name) => (await fetch(name)).arrayBuffer();
    const script = new Promise((keep) => {
        const element = document.head.appendChild(document.createElement("script"));
        element.onload = keep;
        element.src = "/draco_wasm_wrapper.js";
    });
    const [wasmBinary, whole] = await Promise.all([bytes("/draco_decoder.wasm"), bytes("/${stream}"), script]);
    const module = await new Promise((onModuleLoaded) => DracoDecoderModule({ wasmBinary, onModuleLoaded: (module) => onModuleLoaded({ module }) }));
    const draco = module.module;
    const again = () => {
        const [decoder, mesh, buffer] = [new draco.Decoder(), new draco.Mesh(), new draco.DecoderBuffer()];
        buffer.Init(new Int8Array(whole), whole.byteLength);
        const status = decoder.DecodeBufferToMesh(buffer, mesh);
        if (!status.ok()) throw new Error(status.error_msg());
        const copied = (count, get) => {
            const pointer = draco._malloc(4 * count);
            get(4 * count, pointer);
            const copy = draco.HEAPF32.slice(pointer / 4, pointer / 4 + count);
            draco._free(pointer);
            return copy;
        };
        const position = decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, draco.POSITION));
        const faces = copied(3 * mesh.num_faces(), (size, pointer) => decoder.GetTrianglesUInt32Array(mesh, size, pointer));
        const positions = copied(3 * mesh.num_points(), (size, pointer) => decoder.GetAttributeDataArrayForAllPoints(mesh, position, draco.DT_FLOAT32, size, pointer));
        [decoder, mesh, buffer].forEach((made) => draco.destroy(made));
        return { faces: new Uint32Array(faces.buffer), positions };
    };
    again();
    ${FINISH}
})()`;

/** What each way fetches beside its stream, and what its page does. */
const WAYS = {
    draco: { decoder: ["draco_wasm_wrapper.js", "draco_decoder.wasm"], script: draconic },
    quick: { decoder: ["quick.js", "quick.wasm"], script: ours.quick },
    smallest: { decoder: ["pool.js", "small.js", "small.wasm"], script: ours.smallest },
};

/** One run; now and then Chromium does not slow a page down, which bytes that came too early tell: then another. */
async function overLink(address, script, bytes) {
    for (let k = 0; k < PAGES; k++) {
        const run = await fetchInPage(address, script);
        if (run.fetched >= (8000 * bytes) / LINK) return run;
    }
    throw new Error("this Chromium imitates no slow link");
}

/** The same mesh with the same look, cold, each in pages of its own and in turns: minimum and median. */
async function race(address, files, { bits, distance }) {
    const runs = Object.fromEntries(Object.keys(WAYS).map((way) => [way, []]));
    const sizes = Object.fromEntries(
        Object.entries(WAYS).map(([way, { decoder }]) => [
            way,
            [...decoder, `${way}-${bits}`].map((name) => files[name].length),
        ]),
    );
    for (let k = 0; k < PAGES; k++) {
        for (const [way, { script }] of Object.entries(WAYS)) {
            const bytes = sizes[way].reduce((sum, size) => sum + size);
            runs[way].push(await overLink(address, script(`${way}-${bits}`), bytes));
        }
    }
    console.log(`bunny over ${LINK / 1e6} Mbit/s, cold, at a look of ${distance.toFixed(2)} (Draco's ${bits} bits):`);
    for (const [way, each] of Object.entries(sizes)) {
        const stream = each.pop();
        const decoder = each.reduce((sum, size) => sum + size);
        const [cold, fetched, warm] = ["cold", "fetched", "warm"].map((name) =>
            runs[way].map((run) => run[name]).sort((a, b) => a - b),
        );
        console.log(
            `    ${way.padEnd(8)} ${milliseconds(cold[0])} (median ${milliseconds(cold[PAGES >> 1])}), all fetched after ${milliseconds(fetched[0])}; warm ${milliseconds(warm[0])}; ${decoder} + ${stream} bytes`,
        );
    }
}

/** Stops processes three quarters of the time, from a thread of its own. */
function brake(processes) {
    const program = `
        const { workerData } = require("node:worker_threads");
        const still = new Int32Array(new SharedArrayBuffer(4));
        const tell = (signal) => workerData.forEach((id) => { try { process.kill(id, signal); } catch {} });
        for (;;) {
            tell("SIGSTOP");
            Atomics.wait(still, 0, 0, 12);
            tell("SIGCONT");
            Atomics.wait(still, 0, 0, 4);
        }`;
    const worker = new Worker(program, { eval: true, workerData: processes });
    return async () => {
        await worker.terminate();
        for (const id of processes) process.kill(id, "SIGCONT");
    };
}

/** The processes in which Chromium runs pages, among those that this one has started. */
function renderers() {
    const rows = execSync("ps -eo pid,ppid,args", { encoding: "utf8" })
        .split("\n")
        .map((row) => /^\s*(\d+)\s+(\d+)\s+(.*)$/.exec(row))
        .filter(Boolean);
    const ours = new Set([process.pid]);
    for (let grown = -1; grown !== ours.size;) {
        grown = ours.size;
        for (const [, id, parent] of rows) if (ours.has(Number(parent))) ours.add(Number(id));
    }
    return rows
        .filter(([, id, , args]) => ours.has(Number(id)) && args.includes("--type=renderer"))
        .map(([, id]) => Number(id));
}

/** The page of `bsm view` over 1 Mbit/s: seconds until a sequence plays, and which of its frames are shown when. */
function playInPage(folder, stream, slow) {
    return withPage(async (page, session) => {
        const saved = join(folder, "page.html");
        execFileSync(PYTHON, ["-m", "bsm", "view", join(folder, stream), "-f", "-q", "--save", saved], { cwd: ROOT });
        await page.goto(pathToFileURL(saved).href);
        await page.getByText("Controls", { exact: true }).click();
        await page.getByLabel("Bandwidth, Mbit/s").fill("1");
        await page.getByLabel("Begin again at the end").uncheck();
        if (slow === "main thread") await session.send("Emulation.setCPUThrottlingRate", { rate: 4 });
        const release = slow === "everything" ? brake(renderers()) : async () => {};
        try {
            const seen = await page.evaluate(async () => {
                document.querySelector("[name=again]").click();
                delete document.body.dataset.frame;
                const begin = performance.now();
                const seen = [];
                while (!(
                    document.body.dataset.state === "complete" &&
                    document.querySelector("[name=play]").textContent === "Play"
                )) {
                    const now = await new Promise(requestAnimationFrame);
                    const frame = document.body.dataset.frame;
                    if (frame !== undefined)
                        seen.push({ frame, time: now - begin, there: document.body.dataset.there });
                }
                return seen.map(({ frame, time, there }) => ({ frame: Number(frame), time, there: Number(there) }));
            });
            // Playing begins where frames begin to follow each other; before that the first one waits for those behind
            // it.
            const second = seen.find(({ frame }) => frame > 0);
            const start = second.time - (1000 / 30) * second.frame;
            const changes = seen.filter(({ frame }, i) => i === 0 || frame !== seen[i - 1].frame);
            const late = changes.slice(1).map(({ frame, time }) => time - start - (1000 / 30) * frame);
            const last = seen.at(-1).frame + 1;
            const due = Array.from(
                { length: last },
                (_, k) => (seen.find(({ time }) => time >= start + (1000 / 30) * k) ?? seen.at(-1)).there > k,
            );
            return { start, last, shown: changes.length, there: due.filter(Boolean).length, late: Math.max(...late) };
        } finally {
            await release();
        }
    });
}

/** All figures but the race. */
async function measure(meshes, folder) {
    python(PREPARE, meshes, folder, ...PRESETS);
    const read = (name) => readFileSync(join(folder, name));
    const streams = ["samba.bsm", "samba-groups.bsm", ...PRESETS.map((preset) => `bunny-${preset}.bsm`)];
    const { server, address } = await serve(
        compressed(Object.fromEntries(streams.map((name) => [name, read(name)])), [
            "main.js",
            "pool.js",
            "bsm.js",
            "errors.js",
            "worker.js",
            "kernels.wasm",
        ]),
    );
    try {
        for (const preset of PRESETS) {
            const { first, bytes, work } = await beginInPage(address, `bunny-${preset}.bsm`);
            console.log(
                `bunny, ${preset}: the first block is decoded after ${first} of ${bytes} bytes (${((100 * first) / bytes).toFixed(0)} %) and ${milliseconds(work)} of work`,
            );
        }
        const balanced = join(folder, "bunny-balanced.bsm");
        const [before, inPage, after] = [
            python(DECODE, balanced, String(ROUNDS)),
            await decodeInPage(address),
            python(DECODE, balanced, String(ROUNDS)),
        ];
        const inPython = smallest([...before, ...after]);
        const { alone, together, processors } = inPage;
        console.log(
            `bunny: decoded in ${milliseconds(smallest(alone))} in Chromium (at first ${milliseconds(alone[0])}), ${milliseconds(inPython)} in Python on one thread: ${(smallest(alone) / inPython).toFixed(2)} x; in threads on ${processors} processors ${milliseconds(smallest(together))}`,
        );
        for (const stream of ["samba.bsm", "samba-groups.bsm"]) {
            for (const rate of [1, 4]) {
                const times = await framesInPage(address, stream, rate);
                const steps = times
                    .slice(1)
                    .map((time, k) => time - times[k])
                    .sort((a, b) => a - b);
                const slow = rate > 1 ? `, ${rate} times slower` : "";
                const pace = (1000 * times.length) / times.at(-1);
                console.log(
                    `${stream} in the thread of a page${slow}: the first frame after ${milliseconds(times[0])} of work, the others ${steps[steps.length >> 1].toFixed(1)} ms, at most ${milliseconds(steps.at(-1))}; ${pace.toFixed(0)} frames a second on average`,
                );
            }
            for (const slow of [undefined, "main thread", "everything"]) {
                const { start, there, shown, last, late } = await playInPage(folder, stream, slow);
                console.log(
                    `${stream} (${read(stream).length} bytes) over 1 Mbit/s${slow ? `, ${slow} four times slower` : ""}: plays after ${milliseconds(start)}; ${there} of ${last} frames decoded in time, ${shown} drawn, at most ${milliseconds(late)} late`,
                );
            }
        }
    } finally {
        server.close();
    }
}

/** All races. */
async function raceAll(meshes, folder) {
    const races = python(ENTER, meshes, folder);
    const streams = races.flatMap(({ bits }) => Object.keys(WAYS).map((way) => `${way}-${bits}`));
    const rivals = Object.fromEntries(WAYS.draco.decoder.map((name) => [name, draco(name)]));
    const contents = Object.fromEntries(streams.map((name) => [name, readFileSync(join(folder, name))]));
    const files = compressed({ ...contents, ...rivals }, [
        "errors.js",
        "small-worker.js",
        ...WAYS.quick.decoder,
        ...WAYS.smallest.decoder,
    ]);
    const { server, address } = await serve(files);
    try {
        for (const one of races) await race(address, files, one);
    } finally {
        server.close();
    }
}

const [meshes, only] = process.argv.slice(2);
for (const names of [
    ["quick.js", "quick.wasm"],
    ["small.js", "small.wasm"],
    ["bsm.js", "kernels.wasm"],
]) {
    const sizes = names.map((name) => brotliCompressSync(built(name)).length);
    console.log(
        `to decode: ${names.map((name, i) => `${name} ${sizes[i]}`).join(" + ")} = ${sizes[0] + sizes[1]} bytes in brotli`,
    );
}
if (meshes) {
    const folder = mkdtempSync(join(tmpdir(), "bsm-figures-"));
    try {
        await raceAll(meshes, folder);
        if (only !== "race") await measure(meshes, folder);
    } finally {
        rmSync(folder, { recursive: true, force: true });
    }
}
