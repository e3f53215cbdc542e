/**
 * A geometry is for other tools, too: boxes, rays, exporters and trees of three.js take every kind of stream, in the oldest
 * and the newest three.js that the package names.
 */
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { chromium, type Browser } from "playwright-core";
import { serveSite, type Site } from "./server";
import { CHROMIUM, FLAGS, PATIENCE, WEB } from "./shared";

const GPU = ["--enable-unsafe-webgpu", "--enable-features=Vulkan", "--use-webgpu-adapter=swiftshader"];
/** A mesh of blocks, grids, parts, textures, colors, normals; sequences, of one mesh and of several. */
const STREAMS = [
    "good-labels",
    "good-light-tent",
    "good-keys",
    "good-attribute-textured",
    "good-attribute-colors",
    "good-attribute-uv-blocks",
    "good-sequence-learnt",
];

const mapOf = (three: string): string =>
    JSON.stringify({
        imports: {
            three: `/${three}/build/three.module.js`,
            "three/webgpu": `/${three}/build/three.webgpu.js`,
            "three/tsl": `/${three}/build/three.tsl.js`,
            "three/addons/": `/${three}/examples/jsm/`,
            "three-mesh-bvh": "/bvh/build/index.module.js",
            "bsm/three": "/bsm/three.js",
        },
    });

/** What the tools of three.js say of the meshes of a stream. */
const SCRIPT = `
import * as THREE from "three";
import { BSMLoader } from "bsm/three";
import { MeshBVH } from "three-mesh-bvh";
import { GLTFExporter } from "three/addons/exporters/GLTFExporter.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { OBJExporter } from "three/addons/exporters/OBJExporter.js";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { STLExporter } from "three/addons/exporters/STLExporter.js";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
const boxOf = (object) => new THREE.Box3().setFromObject(object);
const trianglesOf = (object) => { let n = 0; object.traverse((o) => { if (o.isMesh) n += (o.geometry.index ?? o.geometry.attributes.position).count / 3; }); return n; };
const far = (a, b) => Math.max(a.min.distanceTo(b.min), a.max.distanceTo(b.max)) / b.getSize(new THREE.Vector3()).length();
/** The box of the corners of faces that are drawn. */
function boxOfFaces(mesh) {
    const { index, attributes: { position } } = mesh.geometry;
    const box = new THREE.Box3();
    for (let i = 0; i < index.count; i++) box.expandByPoint(new THREE.Vector3().fromBufferAttribute(position, index.getX(i)).applyMatrix4(mesh.matrixWorld));
    return box;
}
/** A ray that should hit the largest face of a mesh. */
function hits(mesh) {
    const { index, attributes: { position } } = mesh.geometry;
    const [a, b, c, n, best] = [0, 1, 2, 3, 4].map(() => new THREE.Vector3());
    let [most, middle] = [0, new THREE.Vector3()];
    for (let i = 0; i < index.count; i += 3) {
        [a, b, c].forEach((corner, k) => corner.fromBufferAttribute(position, index.getX(i + k)).applyMatrix4(mesh.matrixWorld));
        n.copy(b).sub(a).cross(c.clone().sub(a));
        if (n.length() > most) [most, middle] = [n.length(), a.clone().add(b).add(c).divideScalar(3), best.copy(n).normalize()];
    }
    const side = mesh.material.side;
    const box = boxOf(mesh).getSize(n).length();
    const ray = new THREE.Raycaster(middle.clone().addScaledVector(best, box), best.clone().negate());
    return ray.intersectObject(mesh).some(({ distance }) => Math.abs(distance - box) < 1e-3 * box) || ray.intersectObject(mesh).some(({ distance }) => distance < box);
}
async function told(root) {
    root.updateMatrixWorld(true);
    const meshes = [];
    root.traverse((object) => { if (object.isMesh && object.geometry.index.count > 0) meshes.push(object); });
    const wrong = [];
    const own = trianglesOf(root);
    const whole = new THREE.Box3();
    for (const mesh of meshes) {
        const box = boxOfFaces(mesh);
        whole.union(box);
        if (far(boxOf(mesh), box) > 1e-4) wrong.push("Box3 of " + mesh.name);
        if (!hits(mesh)) wrong.push("Raycaster at " + mesh.name);
        for (const [name, { array, itemSize, count }] of Object.entries(mesh.geometry.attributes))
            if ((array.BYTES_PER_ELEMENT * itemSize) % 4 || count !== mesh.geometry.attributes.position.count) wrong.push(name + " of " + mesh.name);
        const tree = new MeshBVH(mesh.geometry, { indirect: true });
        const corner = new THREE.Vector3().fromBufferAttribute(mesh.geometry.attributes.position, mesh.geometry.index.getX(0));
        if (!(tree.closestPointToPoint(corner, {}).distance < 1e-6)) wrong.push("three-mesh-bvh at " + mesh.name);
    }
    const check = (what, count, box) => {
        if (count !== own) wrong.push(what + ": " + count + " triangles of " + own);
        if (far(box, whole) > 1e-3) wrong.push(what + ": another box");
    };
    const stl = new STLLoader().parse(new STLExporter().parse(root, { binary: true }).buffer);
    check("STL", trianglesOf(new THREE.Mesh(stl)), boxOf(new THREE.Mesh(stl)));
    const text = new OBJExporter().parse(root);
    const obj = new OBJLoader().parse(text);
    check("OBJ", trianglesOf(obj), boxOf(obj));
    const used = meshes.reduce((sum, { geometry }) => sum + geometry.attributes.position.count, 0);
    const written = text.match(/^v /gm).length;
    if (written !== used || used > 3 * own) wrong.push("OBJ: " + written + " vertices");
    const glb = await new GLTFExporter().parseAsync(root, { binary: true });
    const { scene } = await new GLTFLoader().parseAsync(glb, "");
    scene.updateMatrixWorld(true);
    check("glTF", trianglesOf(scene), boxOf(scene));
    return wrong;
}
async function drawn(root) {
    if (!navigator.gpu || !(await navigator.gpu.requestAdapter())) return "none";
    const { WebGPURenderer } = await import("three/webgpu");
    const renderer = new WebGPURenderer();
    await renderer.init();
    if (!renderer.backend.isWebGPUBackend) return "none";
    const scene = new THREE.Scene().add(root, new THREE.HemisphereLight(0xffffff, 0xffffff, 3));
    const { center, radius } = boxOf(root).getBoundingSphere(new THREE.Sphere());
    const camera = new THREE.PerspectiveCamera(60, 1, radius / 100, 10 * radius);
    camera.position.copy(center).add(new THREE.Vector3(0.6, 0.7, 2).multiplyScalar(radius));
    camera.lookAt(center);
    const target = new THREE.RenderTarget(64, 64);
    renderer.setRenderTarget(target);
    await renderer.renderAsync(scene, camera);
    const pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, 64, 64);
    return pixels.filter((value, i) => i % 4 < 3 && value > 20).length;
}
const loader = new BSMLoader();
const seen = {};
for (const name of NAMES) {
    const wrong = (seen[name] = []);
    const root = await loader.loadScene("/stream/" + name + ".bsm");
    wrong.push(...(await told(root)));
    const [mesh] = root.children;
    if (WEBGPU) { const pixels = await drawn(root); if (pixels !== "none" && !(pixels > 100)) wrong.push("WebGPU draws " + pixels); }
    if (!/sequence/.test(name)) continue;
    const sequence = await loader.loadSequence("/stream/" + name + ".bsm");
    while (!sequence.complete) await new Promise((go) => setTimeout(go, 20));
    const moving = sequence.mesh(new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
    for (const frame of [0, sequence.length >> 1, sequence.length - 1]) {
        sequence.seek(frame);
        for (const one of await told(moving)) wrong.push("frame " + frame + ": " + one);
    }
}
globalThis.seen = seen;
`;

describe("tools of three.js", { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}` }, () => {
    let browser: Browser;
    let site: Site;
    const { peerDependencies, devDependencies } = JSON.parse(readFileSync(`${WEB}/package.json`, "utf8"));

    before(async () => {
        browser = await chromium.launch({ executablePath: CHROMIUM, headless: true, args: [...FLAGS, ...GPU] });
        site = await serveSite();
        site.extra.set(
            "/tools.js",
            `const NAMES = ${JSON.stringify(STREAMS)}, WEBGPU = location.search !== "";\n${SCRIPT}`.replace(
                /^(const NAMES.*)\n([^]*?)(const boxOf)/,
                "$2$1\n$3",
            ),
        );
        for (const three of ["three", "three-oldest"])
            site.extra.set(
                `/${three}.html`,
                `<!doctype html><script type="importmap">${mapOf(three)}</script><script type="module" src="/tools.js"></script>`,
            );
    });
    after(async () => {
        await browser?.close();
        site?.close();
    });

    test("the oldest three.js here is the oldest that the package takes", () => {
        assert.equal(peerDependencies.three, `>=${devDependencies["three-oldest"].replace(/^npm:three@|\.0$/g, "")}`);
    });

    for (const three of ["three", "three-oldest"])
        test(`${three} takes geometries of every kind of stream`, { timeout: 3 * PATIENCE }, async () => {
            const page = await browser.newPage();
            const complaints: string[] = [];
            page.on("pageerror", (error) => complaints.push(error.message));
            await page.goto(`${site.address}${three}.html${three === "three" ? "?webgpu" : ""}`);
            const seen = await page.waitForFunction(() => (window as unknown as { seen: unknown }).seen, undefined, {
                timeout: 2 * PATIENCE,
            });
            assert.deepEqual(await seen.jsonValue(), Object.fromEntries(STREAMS.map((name) => [name, []])));
            assert.deepEqual(complaints, []);
        });
});
