// What `bsm glb` makes of scenes: bytes, also over those of gltf-transform with Draco, and how alike pictures by
// GLTFLoader are to those of the
// scene as it was: `npm run scenes -- FILE...`. PYTHON names a Python that has bsm, GLTF_TRANSFORM the command of
// @gltf-transform/cli (without
// it nothing is compared); IMAGES a rule for images (webp:85), which both follow; OPTIONS more options of `bsm glb`.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { basename, dirname, extname, join, resolve } from "node:path";
import { chromium } from "playwright-core";
import { WEB } from "./kernels.mjs";

const SIZE = 512;
const FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const TYPES = { ".js": "text/javascript", ".wasm": "application/wasm" };
const MAP = '{"imports":{"three":"/three/build/three.module.js","three/addons/":"/three/examples/jsm/"}}';
const SCRIPT = `
import { AmbientLight, AnimationMixer, Box3, DirectionalLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from "three";
import { DRACOLoader } from "three/addons/loaders/DRACOLoader.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { GLTFBSMExtension } from "/bsm/gltf.js";
const renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(${SIZE}, ${SIZE});
document.body.append(renderer.domElement);
const draco = new DRACOLoader().setDecoderPath("/three/examples/jsm/libs/draco/");
const loader = new GLTFLoader().setDRACOLoader(draco).register((parser) => new GLTFBSMExtension(parser));
/**
 * Gray values of a scene, half a second into its first animation and with its morph targets half there, from two sides.
 */
let box;
window.pictures = async (address, first) => {
    const gltf = await loader.loadAsync(address);
    const scene = new Scene().add(gltf.scene, new AmbientLight(0xffffff, 1.5));
    const light = new DirectionalLight(0xffffff, 2);
    light.position.set(1, 2, 3);
    scene.add(light);
    if (gltf.animations.length) {
        const mixer = new AnimationMixer(gltf.scene);
        mixer.clipAction(gltf.animations[0]).play();
        mixer.update(0.5);
    } else gltf.scene.traverse(({ morphTargetInfluences }) => morphTargetInfluences?.fill(0.5 / morphTargetInfluences.length));
    scene.updateMatrixWorld(true);
    if (first) box = new Box3().setFromObject(gltf.scene, true);
    const [center, extent] = [box.getCenter(new Vector3()), box.getSize(new Vector3()).length() || 1];
    const found = [];
    for (const [x, y, z] of [[0.5, 0.35, 1], [-1, 0.35, -0.6]]) {
        const camera = new PerspectiveCamera(40, 1, extent / 100, extent * 100);
        camera.position.copy(center).addScaledVector(new Vector3(x, y, z).normalize(), extent * 1.2);
        camera.lookAt(center);
        renderer.setClearColor(0x808080);
        renderer.render(scene, camera);
        const pixels = new Uint8Array(4 * ${SIZE * SIZE});
        renderer.getContext().readPixels(0, 0, ${SIZE}, ${SIZE}, 0x1908, 0x1401, pixels);
        found.push(Array.from({ length: ${SIZE * SIZE} }, (_, i) => Math.round(0.299 * pixels[4 * i] + 0.587 * pixels[4 * i + 1] + 0.114 * pixels[4 * i + 2])));
    }
    return found;
};
window.ready = true;
`;

/**
 * Structural similarity of two pictures of gray values (Wang and others 2004), over squares of 8 by 8 that overlap by
 * half, where either shows something.
 */
function similarity(one, other) {
    const [c1, c2] = [(0.01 * 255) ** 2, (0.03 * 255) ** 2];
    let [sum, count] = [0, 0];
    for (let y = 0; y + 8 <= SIZE; y += 4) {
        for (let x = 0; x + 8 <= SIZE; x += 4) {
            const s = [0, 0, 0, 0, 0];
            for (let k = 0; k < 64; k++) {
                const at = (y + (k >> 3)) * SIZE + x + (k & 7);
                const [a, b] = [one[at], other[at]];
                [a, b, a * a, b * b, a * b].forEach((value, i) => (s[i] += value / 64));
            }
            const [va, vb, cov] = [s[2] - s[0] * s[0], s[3] - s[1] * s[1], s[4] - s[0] * s[1]];
            if (va + vb < 1e-9 && s[0] === s[1]) continue; // nothing but the background
            sum += ((2 * s[0] * s[1] + c1) * (2 * cov + c2)) / ((s[0] ** 2 + s[1] ** 2 + c1) * (va + vb + c2));
            count++;
        }
    }
    return count ? sum / count : 1;
}

/** Bytes of images in a .glb. */
function imagesOf(path) {
    const data = readFileSync(path);
    const tree = JSON.parse(data.toString("utf8", 20, 20 + data.readUInt32LE(12)));
    return (tree.images ?? []).reduce(
        (sum, { bufferView }) => sum + (tree.bufferViews[bufferView]?.byteLength ?? 0),
        0,
    );
}

const { PYTHON = "python3", GLTF_TRANSFORM, IMAGES, OPTIONS } = process.env;
const folder = mkdtempSync(join(tmpdir(), "bsm-scenes-"));
const transform = (...args) => execFileSync(GLTF_TRANSFORM, args, { stdio: ["ignore", "ignore", "inherit"] });

function prepare(path) {
    const name = basename(path, extname(path));
    const [ours, theirs] = [join(folder, `${name}.bsm.glb`), join(folder, `${name}.draco.glb`)];
    execFileSync(
        PYTHON,
        [
            "-m",
            "bsm",
            "glb",
            path,
            "-o",
            ours,
            "--force",
            ...(IMAGES ? ["--images", IMAGES] : []),
            ...(OPTIONS?.split(" ") ?? []),
        ],
        { stdio: ["ignore", "ignore", "ignore"] },
    );
    if (!GLTF_TRANSFORM) return { name, ours };
    let from = path;
    if (IMAGES) {
        const [kind, quality] = IMAGES.split(/[:@]/);
        transform(kind, path, (from = join(folder, "images.glb")), "--quality", quality ?? "85");
    }
    transform("draco", from, theirs);
    return { name, ours, theirs };
}

const folders = { bsm: join(WEB, "built"), three: join(WEB, "node_modules/three"), made: folder };
const server = createServer((request, response) => {
    const [, place, ...rest] = decodeURIComponent(new URL(request.url, "http://localhost").pathname).split("/");
    if (!place)
        return response
            .writeHead(200, { "Content-Type": "text/html" })
            .end(
                `<!doctype html><script type="importmap">${MAP}</script><script type="module" src="/script.js"></script>`,
            );
    try {
        const content = place === "script.js" ? SCRIPT : readFileSync(join(folders[place], ...rest));
        response
            .writeHead(200, {
                "Content-Type":
                    TYPES[extname(place === "script.js" ? place : rest.at(-1))] ?? "application/octet-stream",
            })
            .end(content);
    } catch {
        response.writeHead(404).end();
    }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const address = `http://127.0.0.1:${server.address().port}`;
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    args: FLAGS,
});
const page = await browser.newPage();
const [wholes, bares] = [[], []];
let worst = 1;
for (const file of process.argv.slice(2)) {
    const path = resolve(file);
    let found;
    try {
        found = prepare(path);
    } catch (error) {
        console.log(`${basename(path)}: ${error.message.split("\n")[0]}`);
        continue;
    }
    const { name, ours, theirs } = found;
    folders.given = dirname(path);
    await page.goto(address);
    await page.waitForFunction("window.ready");
    const pictures = async (at, first) => page.evaluate(([where, is]) => window.pictures(where, is), [at, first]);
    const before = await pictures(`/given/${basename(path)}`, true);
    const alike = async (made) =>
        Math.min(
            ...(await pictures(`/made/${basename(made)}`, false)).map((picture, side) =>
                similarity(picture, before[side]),
            ),
        );
    const look = await alike(ours);
    worst = Math.min(worst, look);
    const [size, images] = [statSync(ours).size, imagesOf(ours)];
    let line = `${name}: ${size} bytes, ${images} of images; SSIM ${look.toFixed(4)}`;
    if (theirs) {
        const [theirSize, theirImages] = [statSync(theirs).size, imagesOf(theirs)];
        wholes.push(size / theirSize);
        bares.push((size - images) / (theirSize - theirImages));
        line += `; Draco ${theirSize}, ${theirImages} of images; SSIM ${(await alike(theirs)).toFixed(4)}; ratio ${wholes.at(-1).toFixed(3)}, without images ${bares.at(-1).toFixed(3)}`;
    }
    console.log(line);
}
const mean = (ratios) => Math.exp(ratios.reduce((sum, ratio) => sum + Math.log(ratio), 0) / ratios.length).toFixed(3);
console.log(
    `least SSIM ${worst.toFixed(4)}${wholes.length ? `; bytes over Draco's, geometric means: ${mean(wholes)}, without images ${mean(bares)}` : ""}`,
);
await browser.close();
server.close();
rmSync(folder, { recursive: true, force: true });
