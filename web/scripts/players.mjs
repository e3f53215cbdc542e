// The first picture of `<bsm-player>` at five sizes: `npm run players -- STREAM.bsm...`. Says how many of the vertices,
// of a
// sequence those of all frames, are inside of the picture, and whether the picture touches an edge; the exit code is 1
// if any does not fit.
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { basename, join, resolve } from "node:path";
import { chromium } from "playwright-core";
import { WEB } from "./kernels.mjs";

const SIZES = [
    [600, 400],
    [320, 568],
    [844, 390],
    [200, 200],
    [1200, 150],
];
const FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const TYPES = { js: "text/javascript", html: "text/html", wasm: "application/wasm" };
const MAP =
    '{"imports":{"three":"/node_modules/three/build/three.module.js","three/addons/":"/node_modules/three/examples/jsm/"}}';
const pageOf = (
    number,
    [width, height],
) => `<!doctype html><script type="importmap">${MAP}</script><script type="module">import "/built/player.js";</script>
<bsm-player src="/stream/${number}" style="width:${width}px;height:${height}px;background:none"></bsm-player>`;

/** What is drawn of a loaded player: the share of vertices in the picture, and whether a pixel at its edge is drawn. */
async function measure() {
    const { Vector3 } = await import("three");
    const player = document.querySelector("bsm-player");
    const drawn = () => new Promise((then) => setTimeout(then, 300)); // of the loop of pictures
    const { canvas, camera, scene, sequence } = player;
    let [all, inside, edge, pixels] = [0, 0, false, 0];
    const point = new Vector3();
    const look = () => {
        scene.updateMatrixWorld(true);
        scene.traverse(({ isMesh, geometry, matrixWorld }) => {
            const places = isMesh && geometry.getAttribute("position");
            for (let i = 0; i < (places?.count ?? 0); i++) {
                point.fromBufferAttribute(places, i).applyMatrix4(matrixWorld).project(camera);
                all++;
                inside += Math.abs(point.x) <= 1 && Math.abs(point.y) <= 1 && Math.abs(point.z) <= 1;
            }
        });
    };
    const see = async () => {
        await drawn();
        const { width, height } = canvas;
        const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
        for (let i = 0; i < width * height; i++) {
            if (data[4 * i + 3] === 0) continue;
            pixels++;
            const [x, y] = [i % width, Math.floor(i / width)];
            edge ||= x === 0 || y === 0 || x === width - 1 || y === height - 1;
        }
    };
    await see();
    if (!sequence) look();
    for (let frame = 0; frame < (sequence?.length ?? 0); frame++) {
        sequence.seek(frame);
        look();
    }
    if (sequence) player.redraw();
    await see();
    return { all, inside, edge, pixels };
}

const streams = process.argv.slice(2).map((path) => resolve(process.env.INIT_CWD ?? ".", path));
const server = createServer(({ url }, response) => {
    const [, folder, number, size] = url.split("?")[0].split("/");
    try {
        const content =
            folder === "page"
                ? pageOf(number, SIZES[size])
                : folder === "stream"
                  ? readFileSync(streams[number])
                  : readFileSync(join(WEB, url));
        response
            .writeHead(200, {
                "Content-Type":
                    folder === "page" ? TYPES.html : (TYPES[url.split(".").pop()] ?? "application/octet-stream"),
            })
            .end(content);
    } catch {
        response.writeHead(404).end();
    }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    args: FLAGS,
});
let [whole, wrong] = [0, 0];
for (const [number, path] of streams.entries()) {
    const found = [];
    for (const [size, [width, height]] of SIZES.entries()) {
        const page = await browser.newPage({ viewport: { width: width + 20, height: height + 20 } });
        await page.goto(`http://127.0.0.1:${server.address().port}/page/${number}/${size}`, { waitUntil: "commit" });
        await page.evaluate(
            () =>
                new Promise((keep, fail) => {
                    const player = document.querySelector("bsm-player");
                    player.addEventListener("load", keep);
                    player.addEventListener("error", ({ message }) => fail(new Error(message)));
                }),
        );
        const { all, inside, edge, pixels } = await page.evaluate(measure);
        const fits = inside === all && !edge && pixels > 0;
        found.push(
            `${((100 * inside) / all).toFixed(2)} %${edge ? ", at the edge" : ""}${pixels ? "" : ", nothing is drawn"}`,
        );
        if (fits) whole++;
        else wrong++;
        await page.close();
    }
    console.log(`${basename(path)}: ${found.join("; ")}`);
}
await browser.close();
server.close();
console.log(`${whole} of ${whole + wrong} first pictures show all vertices`);
process.exitCode = wrong > 0 ? 1 : 0;
