// How a sequence plays in pages, through `BSMLoader.loadSequence`, in Chromium and Firefox: `npm run plays --
// STREAM.bsm ...`.
// Of each: milliseconds until the first picture and until all frames are there, and between frames that come one after
// the other; the longest
// stretch in which the page's thread did nothing else, in Chromium also the most that a task took of a processor;
// pictures that the page missed
// while it played, and frames that were never shown. Nothing is drawn: without graphics hardware that would take the
// processors.
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { basename, extname, join } from "node:path";
import puppeteer from "puppeteer-core";
import { WEB } from "./kernels.mjs";

const BROWSERS = {
    chrome: { executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] },
    firefox: { executablePath: process.env.FIREFOX ?? "/usr/bin/firefox-esr" },
};
const TYPES = { ".js": "text/javascript", ".wasm": "application/wasm" };
const MAP = '{"imports":{"three":"/three/build/three.module.js"}}';
const SCRIPT = `
import { BSMLoader, BSMSequence } from "/bsm/three.js";
/**
 * The longest time between two tasks of the page's thread that are to come every few milliseconds; it begins anew where
 * it is asked.
 */
const idle = new MessageChannel();
let [before, blocked] = [performance.now(), 0];
idle.port1.onmessage = () => {
    const now = performance.now();
    blocked = Math.max(blocked, now - before);
    before = now;
    setTimeout(() => idle.port2.postMessage(0), 1);
};
idle.port2.postMessage(0);
const longest = () => {
    const found = blocked;
    blocked = 0;
    return found;
};
const picture = () => new Promise(requestAnimationFrame);
/** Load a stream, and play it from its first frame on, at a number of frames a second. */
window.play = async (url, rate) => {
    for (let k = 0; k < 120; k++) await picture(); // while the browser starts
    longest();
    const loader = new BSMLoader();
    const begin = performance.now();
    const arrived = [];
    const sequence = await new Promise((keep, fail) => {
        let sequence;
        const onFrame = (index, geometry) => {
            arrived.push(performance.now() - begin);
            if (index === 0) keep((sequence = new BSMSequence(geometry)));
        };
        loader.load(url, () => (sequence.complete = true), undefined, fail, { onFrame });
    });
    sequence.loop = false;
    sequence.speed = rate / sequence.rate;
    const shown = new Set([0]);
    let [waits, missed, over] = [0, 0, false];
    sequence.addEventListener("frame", ({ index }) => shown.add(index));
    sequence.addEventListener("waiting", () => waits++);
    sequence.addEventListener("ended", () => (over = true));
    let now = await picture();
    while (!over) {
        const next = await picture();
        missed += Math.max(0, Math.round(((next - now) * 60) / 1000) - 1);
        sequence.update((next - now) / 1000);
        now = next;
    }
    loader.dispose();
    const steps = arrived.slice(1).map((time, k) => time - arrived[k]).sort((a, b) => a - b);
    const part = (share) => steps[Math.floor(share * (steps.length - 1))];
    return { first: arrived[0], all: arrived.at(-1), median: part(0.5), most: part(0.95), worst: part(1), blocked: longest(), missed, waits: waits - 1, frames: arrived.length, shown: shown.size };
};
window.ready = true;
`;

/** Milliseconds of a processor that the longest task of the page's thread takes while `work` is done. */
async function longestTask(page, work) {
    await page.tracing.start({ categories: ["toplevel"] });
    const found = await work();
    const { traceEvents } = JSON.parse(new TextDecoder().decode(await page.tracing.stop()));
    const pages = new Set(
        traceEvents
            .filter(({ name, args }) => name === "thread_name" && args.name === "CrRendererMain")
            .map(({ pid, tid }) => `${pid} ${tid}`),
    );
    const tasks = traceEvents.filter(
        ({ name, ph, pid, tid }) => name.endsWith("RunTask") && ph === "X" && pages.has(`${pid} ${tid}`),
    );
    return { ...found, task: tasks.reduce((longest, { tdur = 0 }) => Math.max(longest, tdur / 1e3), 0) };
}

const streams = Object.fromEntries(process.argv.slice(2).map((path) => [basename(path), readFileSync(path)]));
const folders = { bsm: join(WEB, "built"), three: join(WEB, "node_modules/three") };
const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, "http://localhost");
    const [, place, ...rest] = pathname.split("/");
    if (pathname === "/")
        return response
            .writeHead(200, { "Content-Type": "text/html" })
            .end(
                `<!doctype html><script type="importmap">${MAP}</script><script type="module" src="/script.js"></script>`,
            );
    const content =
        pathname === "/script.js"
            ? SCRIPT
            : place === "file"
              ? streams[rest[0]]
              : folders[place] && readFileSync(join(folders[place], ...rest));
    if (!content) return response.writeHead(404).end();
    response.writeHead(200, { "Content-Type": TYPES[extname(pathname)] ?? "application/octet-stream" }).end(content);
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
for (const [name, options] of Object.entries(BROWSERS)) {
    const browser = await puppeteer.launch({ browser: name, headless: true, ...options });
    const version = await browser.version();
    for (const stream of Object.keys(streams)) {
        for (const rate of [30, 60]) {
            const page = await browser.newPage();
            await page.goto(`http://127.0.0.1:${server.address().port}/`);
            await page.waitForFunction("window.ready");
            const work = () => page.evaluate((...given) => window.play(...given), `/file/${stream}`, rate);
            const found = name === "chrome" ? await longestTask(page, work) : await work();
            const { first, all, median, most, worst, blocked, task, missed, waits, frames, shown } = found;
            const times = [first, all, median, most, worst, blocked].map((time) => time.toFixed(1));
            const taken = task === undefined ? "" : ` (of a processor ${task.toFixed(1)})`;
            console.log(
                `${version}, ${stream} at ${rate} frames a second: first frame after ${times[0]} ms, all ${frames} after ${times[1]}; between frames ${times[2]} ms, 95 % at most ${times[3]}, at most ${times[4]}; ` +
                    `the page's thread is blocked for ${times[5]} ms at most${taken}; ${missed} pictures of the page missed, ${waits} waits for frames, ${shown} of ${frames} frames shown`,
            );
            await page.close();
        }
    }
    await browser.close();
}
server.close();
