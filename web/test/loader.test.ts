/** The package in pages of headless Chromium: threads, the loader of three.js, and what a page may forbid. */
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import test, { after, before, describe } from "node:test";
import { build } from "esbuild";
import { chromium, type Browser, type Page } from "playwright-core";
import { SphereGeometry, type BufferAttribute } from "three";
import { serveSite, POLICY, type Site } from "./server";
import { decode } from "../src/index";
import { frontOf } from "../src/viewer/camera";
import { sceneOf } from "./scene";
import { CHROMIUM, kernels, eventsOf, FLAGS, PATIENCE, VECTORS, WEB } from "./shared";

const STREAM = "good-labels";
const KEYS = "good-keys";

/** A stream with a wrong bit near its end. */
function broken(name: string): Uint8Array {
    const data = Uint8Array.from(readFileSync(join(VECTORS, `${name}.bsm`)));
    data[Math.floor(0.9 * data.length)] ^= 4;
    return data;
}

describe(
    "the package in Chromium",
    { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}`, timeout: 5 * PATIENCE },
    () => {
        let browser: Browser;
        let page: Page;
        let site: Site;
        const complaints: string[] = [];

        before(async () => {
            browser = await chromium.launch({ executablePath: CHROMIUM, headless: true, args: FLAGS });
            site = await serveSite();
            page = await browser.newPage({ viewport: { width: 400, height: 300 } });
            page.on("pageerror", (error) => complaints.push(error.message));
        });
        after(async () => {
            await browser?.close();
            site?.close();
        });

        /** What a module finds in a page with such headers. */
        async function found(
            script: string,
            headers: Record<string, string> = { "Content-Security-Policy": POLICY },
        ): Promise<Record<string, unknown>> {
            for (const name of Object.keys(site.headers)) delete site.headers[name];
            Object.assign(site.headers, headers);
            site.extra.set(
                "/script.js",
                `import { decode, loadKernels, Pool } from "bsm";
            import { BSMLoader, BSMSceneLoader } from "bsm/three";
            let workers = 0;
            window.Worker = class extends Worker {
                constructor(...given) {
                    super(...given);
                    workers++;
                }
                postMessage(message, ...more) {
                    if ("help" in message) window.helped = (window.helped ?? 0) + 1;
                    super.postMessage(message, ...more);
                }
            };
            const bytesOf = async (name) => new Uint8Array(await (await fetch("/stream/" + name + ".bsm")).arrayBuffer());
            try { window.found = await (async () => { ${script} })(); } catch (error) { window.found = { failed: error.stack ?? String(error) }; }`,
            );
            complaints.length = 0;
            await page.goto(site.address);
            const value = await (
                await page.waitForFunction(() => (window as unknown as { found: unknown }).found, undefined, {
                    timeout: PATIENCE,
                })
            ).jsonValue();
            assert.deepEqual(complaints, []);
            const outcome = value as Record<string, unknown>;
            assert.ok(!("failed" in outcome), String(outcome.failed));
            return outcome;
        }

        /** Scenes of one stream: as it is, with a wrong size, and cut off. */
        async function serveScenes(): Promise<void> {
            const stream = readFileSync(join(VECTORS, "good-attribute-textured.bsm"));
            const { positions, faces } = decode(kernels, stream);
            site.extra.set("/scene.glb", sceneOf(stream, positions.length / 3, faces.length));
            site.extra.set("/wrong.glb", sceneOf(stream, positions.length / 3 + 1, faces.length));
            site.extra.set("/broken.glb", sceneOf(stream.subarray(0, -30), positions.length / 3, faces.length));
        }

        test("fills a geometry of three.js from an address", async () => {
            const seen = await found(`
            const seen = { blocks: 0, frames: 0, bytes: 0 };
            const take = (name, progress) => new Promise((keep, fail) => new BSMLoader().load("/stream/" + name + ".bsm", keep, (event) => (seen.bytes = event.loaded), fail, progress));
            const grown = { begun: [], drawn: [], radii: [], early: 0 };
            const look = (geometry) => {
                const corners = geometry.index.array.subarray(0, geometry.drawRange.count);
                grown.drawn.push(corners.length);
                grown.early += corners.filter((vertex) => geometry.origin[vertex] < 0).length;
                if (!geometry.boundingSphere) geometry.computeBoundingSphere(); // as three.js does to draw
                grown.radii.push(geometry.boundingSphere.radius);
            };
            const whole = await take("${STREAM}", { onBlock: () => seen.blocks++ });
            const sequence = await take("good-sequence-learnt", { onFrame: () => seen.frames++ });
            const parted = await take("${KEYS}", { onConnectivity: (geometry) => (grown.begun.push(geometry.index.count), look(geometry)), onBlock: look });
            const mesh = decode(await loadKernels(), await bytesOf("${KEYS}"));
            const n = parted.getAttribute("normal").array;
            return {
                ...seen, grown, kept: sequence.frames.length, workers,
                drawn: whole.drawRange.count === whole.index.count && whole.index.count > 0,
                faces: mesh.faces.join() === [...parted.index.array].join(),
                positions: [...parted.getAttribute("position").array].every((x, i) => Math.abs(x - mesh.positions[i]) < 1e-5),
                normals: Array.from({ length: n.length / 3 }, (_, i) => Math.hypot(n[3 * i], n[3 * i + 1], n[3 * i + 2])).every((length) => Math.abs(length - 1) < 1e-4),
            };`);
            const { begun, drawn, radii, early } = seen.grown as {
                begun: number[];
                drawn: number[];
                radii: number[];
                early: number;
            };
            assert.equal(begun.length, 1);
            assert.ok(drawn[0] === 0 && drawn.every((count, i) => i === 0 || count >= drawn[i - 1]), `${drawn}`);
            assert.equal(drawn.at(-1), begun.at(-1));
            assert.ok(radii[0] === 0 && radii[1] > 0, `${radii}`);
            assert.equal(early, 0);
            assert.ok(Number(seen.blocks) > 0 && Number(seen.bytes) > 0 && Number(seen.kept) > 1);
            assert.equal(seen.frames, seen.kept);
            assert.deepEqual([seen.drawn, seen.faces, seen.positions, seen.normals], [true, true, true, true]);
            assert.ok(Number(seen.workers) <= 2, `${seen.workers} threads`);
        });

        test("indexes a mesh by all that its corners have", async () => {
            const seen = await found(`
            const load = (name) => new BSMLoader().loadAsync("/stream/" + name + ".bsm");
            const kernels = await loadKernels();
            const [textured, colored] = [await load("good-attribute-uv-blocks"), await load("good-attribute-colors")];
            const mesh = decode(kernels, await bytesOf("good-attribute-uv-blocks"));
            const [{ values, indices }] = mesh.attributes.filter(({ semantic }) => semantic === "texcoord");
            const [index, uv, position] = [textured.index.array, textured.getAttribute("uv"), textured.getAttribute("position")];
            const same = mesh.faces.every((vertex, i) => Math.abs(position.getX(index[i]) - mesh.positions[3 * vertex]) < 1e-5 && Math.abs(uv.getX(index[i]) - values[2 * indices[i]]) < 1e-5);
            const colors = colored.getAttribute("color");
            return { same, expected: new Set([...mesh.faces].map((vertex, i) => vertex + " " + indices[i])).size, drawn: position.count, corners: index.length, colors: colors.count === colored.getAttribute("position").count, brightest: Math.max(...colors.array) };`);
            assert.equal(seen.same, true);
            assert.equal(seen.drawn, seen.expected);
            assert.ok(Number(seen.drawn) < Number(seen.corners));
            assert.ok(seen.colors && Number(seen.brightest) > 0.1 && Number(seen.brightest) <= 1);
        });

        test("keeps its threads, and goes on behind bad streams", async () => {
            const seen = await found(`
            const loader = new BSMLoader().setWorkerLimit(2);
            const names = ["${STREAM}", "bad-sequence-long", "good-grid", "no-such-file", "good-light"].flatMap((name) => [name, name, name]);
            const outcome = await Promise.all(names.map((name) => loader.loadAsync("/stream/" + name + ".bsm").then((geometry) => geometry.index.count > 0, (error) => error.name + ": " + error.message)));
            const after = await loader.loadAsync("/stream/${STREAM}.bsm").then(() => true, String);
            const cut = await loader.parseAsync((await bytesOf("${STREAM}")).slice(0, -20)).catch((error) => error.name);
            const stray = await loader.parseAsync(new TextEncoder().encode("<!doctype html><html></html>")).catch((error) => error.name);
            const before = workers;
            for (let k = 0; k < 5; k++) await loader.parseAsync((await bytesOf("${STREAM}")).buffer);
            return { outcome, after, cut, stray, more: workers - before };`);
            const outcome = seen.outcome as (boolean | string)[];
            assert.deepEqual(outcome.slice(0, 3), [true, true, true]);
            assert.ok(
                outcome
                    .slice(3, 6)
                    .every((text) => /^CorruptError: .stream.bad-sequence-long.bsm: /.test(String(text))),
                `${outcome}`,
            );
            assert.deepEqual(outcome.slice(6, 9), [true, true, true]);
            assert.ok(
                outcome.slice(9, 12).every((text) => /no-such-file.bsm: 404/.test(String(text))),
                `${outcome}`,
            );
            assert.deepEqual(outcome.slice(12), [true, true, true]);
            assert.deepEqual([seen.after, seen.cut, seen.stray, seen.more], [true, "TruncatedError", "FormatError", 0]);
        });

        for (const name of ["good-sequence-low-delay", "good-keys", "good-light-chunks"]) {
            test(`tells once what comes before damage of ${name}`, async () => {
                const damaged = broken(name);
                site.extra.set("/damaged.bsm", damaged);
                const expected: string[] = [];
                assert.throws(
                    () => {
                        for (const { type } of eventsOf(kernels, damaged, damaged.length)) expected.push(type);
                    },
                    { name: "CorruptError" },
                );
                const seen = await found(`
                const data = new Uint8Array(await (await fetch("/damaged.bsm")).arrayBuffer());
                const decoded = (wishes) => new Promise((keep) => {
                    const heard = [];
                    let [corners, drawn] = [0, 0];
                    const onPicture = (picture) => {
                        heard.push(picture.type);
                        if (picture.type === "begun") ({ corners } = picture);
                        if (picture.type === "grown") drawn += picture.index.length;
                    };
                    const onError = ({ name, problem }) => keep({ heard, name, worded: problem !== "", most: drawn <= corners });
                    const stream = new Pool().open({ onEvent: ({ type }) => heard.push(type), onPicture, onError }, wishes);
                    for (let at = 0; at < data.length; at += 50) stream.receiveData(data.slice(at, at + 50));
                    stream.receiveEof();
                });
                return { events: await decoded({}), pictures: await decoded({ drawing: "growing" }), whole: await decoded({ drawing: "whole" }) };`);
                const { events, pictures, whole } = seen as Record<string, { heard: string[] }>;
                assert.deepEqual(events, { heard: expected, name: "CorruptError", worded: true, most: true });
                assert.deepEqual({ ...pictures, heard: [] }, { ...events, heard: [] });
                for (const { heard } of [pictures, whole])
                    assert.deepEqual(
                        heard.filter((type) => type === "header" || type === "frame"),
                        expected.filter((type) => type === "header" || type === "frame"),
                    );
                assert.equal(pictures.heard.filter((type) => type === "begun").length, 1);
            });
        }

        test("keeps the frames before damage, and says then what is wrong", async () => {
            site.extra.set("/damaged.bsm", broken("good-sequence-low-delay"));
            const seen = await found(
                `
            await import("/bsm/player.js");
            const sequence = await new BSMLoader().loadSequence("/damaged.bsm");
            const shown = [];
            sequence.addEventListener("frame", ({ index }) => shown.push(index));
            for (const type of ["loop", "ended"]) sequence.addEventListener(type, () => shown.push(type));
            const failed = new Promise((keep) => sequence.addEventListener("error", ({ error }) => keep(error.name)));
            sequence.loop = false;
            const error = await failed;
            for (let k = 0; k < 3 * sequence.length; k++) sequence.update(1 / sequence.rate);
            const player = Object.assign(document.createElement("bsm-player"), { src: "/damaged.bsm" });
            let loaded = 0;
            player.addEventListener("loadeddata", () => loaded++);
            const wrong = new Promise((keep) => player.addEventListener("error", keep));
            document.body.append(player);
            await wrong;
            const frames = player.sequence.length;
            player.remove();
            return { shown, error, length: sequence.length, frames, loaded, groups: player.scene.children.length };`,
                {},
            );
            assert.deepEqual(seen, {
                shown: [1, 2, 3, 4, 5, "ended"],
                error: "CorruptError",
                length: 6,
                frames: 6,
                loaded: 1,
                groups: 2,
            });
        });

        test("has all threads decode again behind a stream that took several", async () => {
            const seen = await found(`
            const data = await bytesOf("${KEYS}");
            let [busy, most] = [0, 0];
            const pool = new Pool(undefined, 3);
            const decoded = (worthwhile, longest = 20000) => new Promise((keep, fail) => {
                const stream = pool.open({ onEvent: ({ type }) => type === "header" && (most = Math.max(most, ++busy)), onEnd: () => keep(busy--), onError: fail }, { worthwhile });
                stream.receiveData(data.slice(0, 100));
                const end = Date.now() + longest;
                const rest = () => (most < 3 && Date.now() < end ? setTimeout(rest, 20) : (stream.receiveData(data.slice(100)), stream.receiveEof()));
                rest();
            });
            Object.defineProperty(navigator, "hardwareConcurrency", { value: 4 });
            await pool.preload("small");
            const large = decoded(0, 500);
            for (let k = 0; k < 1000 && workers < 3; k++) await new Promise((go) => setTimeout(go, 20));
            const alone = workers;
            await Promise.all([large, decoded(), decoded(), decoded(), decoded()]);
            return { alone, most };`);
            assert.deepEqual(seen, { alone: 3, most: 3 });
        });

        test("fetches one decoder for all that a page names, the smallest that reads it", async () => {
            for (const [build, streams] of Object.entries({
                small: [STREAM, "good-light-tent"],
                kernels: [STREAM, "good-sequence-learnt", "good-attribute-textured"],
            })) {
                const seen = await found(`
                await Promise.all(${JSON.stringify(streams)}.map((name) => new BSMLoader().loadAsync("/stream/" + name + ".bsm")));
                return { kernels: performance.getEntriesByType("resource").flatMap(({ name }) => /\\w+(?=\\.wasm$)/.exec(name) ?? []) };`);
                assert.deepEqual(seen, { kernels: [build] });
            }
        });

        test("stops the loads of a loader that is disposed of, and threads with their last one", async () => {
            const seen = await found(`
            const data = await bytesOf("${STREAM}");
            const problem = (load) => load.then(() => "none", ({ message }) => message);
            const [loader, other] = [new BSMLoader().setDecoderPath("/bsm/"), new BSMLoader().setDecoderPath("/bsm")];
            const loads = [loader.loadAsync("/stream/${STREAM}.bsm"), loader.parseAsync(data)].map(problem);
            const kept = other.parseAsync(data);
            loader.dispose();
            const left = (await kept).index.count > 0;
            other.dispose();
            const stopped = await Promise.all(loads);
            await new Promise((go) => setTimeout(go, 300));
            const before = workers;
            return { stopped, left, before, again: (await loader.parseAsync(data)).index.count > 0 };`);
            const { stopped, ...others } = seen as { stopped: string[] };
            for (const text of stopped) assert.match(text, /the load was stopped$/);
            assert.deepEqual(others, { left: true, before: 1, again: true }); // the other one's
        });

        test("stops on request", async () => {
            const seen = await found(`
            const data = await bytesOf("${STREAM}");
            const problem = (load) => load.then(() => "none", ({ name, message }) => name + " " + message);
            const loader = new BSMLoader();
            const loads = ["${STREAM}", "no-such-file"].map((name) => problem(loader.loadAsync("/stream/" + name + ".bsm")));
            const parses = [problem(loader.parseAsync(data))];
            loader.abort();
            parses.push(problem(loader.parseAsync(data, { signal: AbortSignal.abort() })));
            const scenes = new BSMSceneLoader();
            loads.push(problem(scenes.loadAsync("/stream/${STREAM}.bsm")));
            scenes.abort();
            const parse = loader.loadAsync("/stream/${STREAM}.bsm");
            const thrown = await problem(loader.loadAsync("/stream/${STREAM}.bsm", undefined, { onConnectivity() { throw new Error("mine"); } }));
            return { stopped: await Promise.all(loads), parses: await Promise.all(parses), faces: (await parse).index.count > 0, thrown };`);
            assert.ok(seen.faces);
            assert.match(seen.thrown as string, /^Error .*mine$/);
            for (const text of seen.stopped as string[]) assert.match(text, /^AbortError \/stream\/.*.bsm: /);
            for (const text of seen.parses as string[]) assert.match(text, /^AbortError /);
        });

        test("is used as other loaders are, and finds a relative path from the base of the page", async () => {
            const seen = await found(`
            const { LoadingManager } = await import("three");
            const manager = new LoadingManager();
            const urls = [];
            manager.setURLModifier((url) => (urls.push(url), "/stream/" + url + ".bsm"));
            const loaded = new Promise((keep) => (manager.onLoad = () => keep(true)));
            document.head.append(Object.assign(document.createElement("base"), { href: "/bsm/page.html" }));
            const loader = new BSMLoader(manager).setDecoderPath("./").preload();
            const geometry = await loader.loadAsync("${STREAM}");
            const parsed = await new Promise((keep, fail) => bytesOf("${STREAM}").then((bytes) => loader.parse(bytes, keep, fail)));
            loader.dispose();
            return { urls, loaded: await loaded, same: parsed.index.count === geometry.index.count };`);
            assert.deepEqual(seen, { urls: [STREAM], loaded: true, same: true });
        });

        test("plays a sequence", async () => {
            const seen = await found(`
            const sequence = await new BSMLoader().loadSequence("/stream/good-sequence-learnt.bsm");
            while (!sequence.complete) await new Promise((go) => setTimeout(go, 5));
            const heard = [];
            for (const type of ["play", "pause", "loop", "ended"]) sequence.addEventListener(type, () => heard.push(type));
            const shown = new Set();
            sequence.addEventListener("frame", ({ index }) => shown.add(index));
            sequence.update(0);
            for (let k = 0; k < 3 * sequence.length; k++) sequence.update(1 / sequence.rate);
            sequence.pause();
            const held = sequence.frame;
            sequence.update(1);
            const still = sequence.frame === held;
            sequence.loop = false;
            sequence.seek(0).play();
            for (let k = 0; k < 2 * sequence.length; k++) sequence.update(1 / sequence.rate);
            const last = sequence.frame === sequence.length - 1 && !sequence.playing;
            const normals = sequence.geometry.getAttribute("normal");
            return { heard, shown: shown.size, length: sequence.length, still, last, unit: Math.abs(Math.hypot(normals.getX(0), normals.getY(0), normals.getZ(0)) - 1) < 1e-3 };`);
            assert.equal(seen.shown, seen.length);
            assert.deepEqual([seen.still, seen.last, seen.unit], [true, true, true]);
            assert.deepEqual([...new Set(seen.heard as string[])].sort(), ["ended", "loop", "pause", "play"]);
        });

        test("has the faces of each frame of a sequence where they change", async () => {
            const seen = await found(`
            const sequence = await new BSMLoader().loadSequence("/stream/good-sequence-runs.bsm");
            while (!sequence.complete) await new Promise((go) => setTimeout(go, 5));
            const { geometry } = sequence;
            const drawn = (frame) => (sequence.seek(frame), [geometry.index.count / 3, geometry.getAttribute("position").count, geometry.getAttribute("normal").count, geometry.drawRange.count / 3]);
            const [faces, seen] = [[0, 2, 3, 5, 9, 4, 0].map(drawn), () => [0, 5].map((frame) => (sequence.seek(frame), geometry.index.array.some(Boolean)))];
            const [hidden, shown] = [true, false].map((isHidden) => (geometry.hide(() => isHidden), seen()));
            return { length: sequence.length, faces, hidden, shown };`);
            const [large, small, least] = [
                [64, 32, 32, 64],
                [48, 24, 24, 48], // its edges are sharp, and those of the first run are not
                [40, 20, 20, 40],
            ];
            assert.deepEqual(seen, {
                length: 10,
                faces: [large, large, small, large, least, small, large],
                hidden: [false, false],
                shown: [true, true],
            });
        });

        test("makes scenes with textures", async () => {
            const seen = await found(`
            const scene = await new BSMLoader().loadScene("/stream/good-attribute-textured.bsm");
            const [{ material, geometry }] = scene.children;
            return { name: material.name, size: [material.map.image.width, material.map.image.height], space: material.map.colorSpace, metalness: material.metalness, uv: geometry.hasAttribute("uv"), turned: scene.rotation.x < -1 };`);
            assert.deepEqual(seen, {
                name: "halves",
                size: [8, 8],
                space: "srgb",
                metalness: 0,
                uv: true,
                turned: true,
            });
        });

        test("is an extension of Babylon's loader", async () => {
            const contents = `export { Engine } from "@babylonjs/core/Engines/engine.js";
            export { Scene } from "@babylonjs/core/scene.js";
            export { AppendSceneAsync } from "@babylonjs/core/Loading/sceneLoader.js";
            export { registerGLTFExtension } from "@babylonjs/loaders/glTF/2.0/glTFLoaderExtensionRegistry.js";
            import "@babylonjs/core/Loading/loadingScreen.js";
            import "@babylonjs/loaders/glTF/2.0/glTFLoader.js";`;
            const bundle = await build({
                stdin: { contents, resolveDir: WEB },
                bundle: true,
                format: "esm",
                write: false,
                logLevel: "error",
            });
            site.extra.set("/babylon.js", bundle.outputFiles[0].contents);
            await serveScenes();
            const seen = await found(
                `
            const { Engine, Scene, AppendSceneAsync } = await import("/babylon.js");
            const { registerBSM } = await import("/bsm/babylon.js");
            registerBSM();
            const canvas = document.body.appendChild(document.createElement("canvas"));
            const load = async (url) => {
                const scene = new Scene(new Engine(canvas));
                await AppendSceneAsync(url, scene);
                return scene.meshes.find((mesh) => mesh.getTotalVertices() > 0);
            };
            const mesh = await load("/scene.glb");
            const problems = await Promise.all(["/wrong.glb", "/broken.glb"].map((url) => load(url).then(() => "none", ({ message }) => message)));
            const own = await new BSMLoader().loadAsync("/stream/good-attribute-textured.bsm");
            const same = (name, kind) => [...mesh.getVerticesData(kind)].join() === [...own.getAttribute(name).array].join();
            return { same: [same("position", "position"), same("normal", "normal"), same("uv", "uv")], index: [...mesh.getIndices()].join() === [...own.index.array].join(), problems };`,
                {},
            );
            assert.deepEqual([seen.same, seen.index], [[true, true, true], true]);
            assert.match(
                String(seen.problems),
                /POSITION has \d+ bytes, not \d+.*the stream ends (too early|before its END frame)/,
            );
        });

        test("moves meshes in Babylon.js", async () => {
            const stream = readFileSync(join(VECTORS, "good-sequence-learnt.bsm"));
            const { positions, faces } = decode(kernels, stream);
            site.extra.set("/moving.glb", sceneOf(stream, positions.length / 3, faces.length, true));
            const seen = await found(`
            const { Engine, Scene, AppendSceneAsync } = await import("/babylon.js");
            const { registerBSM } = await import("/bsm/babylon.js");
            registerBSM();
            const scene = new Scene(new Engine(document.body.appendChild(document.createElement("canvas"))));
            await AppendSceneAsync("/moving.glb", scene);
            const mesh = scene.meshes.find((one) => one.getTotalVertices() > 0);
            const { sequence } = mesh.metadata;
            while (!sequence.complete) await new Promise((go) => setTimeout(go, 5));
            const own = await new BSMLoader().loadAsync("/stream/good-sequence-learnt.bsm");
            const same = own.frames.map((frame, index) => (sequence.seek(index), [...mesh.getVerticesData("position")].join() === [...frame.positions].join()));
            sequence.seek(0);
            const pictures = [];
            for (let n = 0; n < 20; n++) {
                scene.onBeforeRenderObservable.notifyObservers(scene);
                pictures.push(sequence.shown);
                await new Promise((go) => setTimeout(go, 20));
            }
            const moved = new Set(pictures).size > 1;
            mesh.dispose();
            await new Promise((go) => setTimeout(go, 20));
            return { same: same.every(Boolean), frames: same.length, moved, left: scene.onBeforeRenderObservable.observers.length };`);
            assert.equal(seen.same, true);
            assert.ok(Number(seen.frames) > 1);
            assert.deepEqual([seen.moved, seen.left], [true, 0]);
        });

        test("moves meshes of glTF", async () => {
            const stream = readFileSync(join(VECTORS, "good-sequence-learnt.bsm"));
            const { positions, faces } = decode(kernels, stream);
            site.extra.set("/moving.glb", sceneOf(stream, positions.length / 3, faces.length, true));
            const name = "good-sequence-low-delay";
            const whole = decode(kernels, readFileSync(join(VECTORS, `${name}.bsm`)));
            site.extra.set("/damaged.glb", sceneOf(broken(name), whole.positions.length / 3, whole.faces.length, true));
            const seen = await found(`
            const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
            const { GLTFBSMExtension } = await import("/bsm/gltf.js");
            const load = (url) => new GLTFLoader().register((parser) => new GLTFBSMExtension(parser)).loadAsync(url);
            const gltf = await load("/moving.glb");
            const [sequence] = gltf.userData.sequences;
            const [damaged] = (await load("/damaged.glb")).userData.sequences;
            while (!damaged.complete) await new Promise((go) => setTimeout(go, 5));
            const [mesh] = gltf.scene.children;
            while (!sequence.complete) await new Promise((go) => setTimeout(go, 5));
            const own = await new BSMLoader().loadAsync("/stream/good-sequence-learnt.bsm");
            const same = own.frames.map((frame, index) => (sequence.seek(index), [...mesh.geometry.getAttribute("position").array].join() === [...frame.positions].join()));
            return { same: same.every(Boolean), frames: same.length, sequences: gltf.userData.sequences.length, before: damaged.length };`);
            assert.equal(seen.same, true);
            assert.equal(seen.before, 6);
            assert.ok(Number(seen.frames) > 1 && seen.sequences === 1);
        });

        test("decodes a small stream in the page while a thread begins, and the next one in that thread", async () => {
            const seen = await found(`
            let [begin, tell, starts] = [, , 0];
            const held = new Promise((go) => (begin = go));
            const ready = new Promise((go) => (tell = go));
            globalThis.Worker = class extends Worker {
                set onmessage(hear) {
                    this.addEventListener("message", (event) => held.then(() => (hear.call(this, event), tell())));
                }
                postMessage(message, ...more) {
                    if ("start" in message) starts++;
                    super.postMessage(message, ...more);
                }
            };
            const loader = new BSMLoader();
            const load = async () => (await loader.loadAsync("/stream/${KEYS}.bsm")).getAttribute("position").array;
            const here = await load();
            const before = starts;
            begin();
            await ready;
            const there = await load();
            return { same: here.every((place, i) => place === there[i]), before, starts, workers };`);
            assert.deepEqual(seen, { same: true, before: 0, starts: 1, workers: 1 });
        });

        test("starts a thread again that failed once", async () => {
            const seen = await found(
                `
            const asked = [];
            globalThis.Worker = class extends Worker {
                constructor(url, options) {
                    asked.push(url);
                    super(asked.length === 1 ? "/no-such-worker.js" : url, options);
                }
            };
            const loads = ["${STREAM}", "${KEYS}"].map((name) => new BSMLoader().loadAsync("/stream/" + name + ".bsm"));
            const [geometry] = await Promise.all(loads);
            return { asked: asked.length, vertices: geometry.getAttribute("position").count };`,
                {},
            );
            assert.ok(Number(seen.asked) >= 2 && Number(seen.vertices) > 0, JSON.stringify(seen));
        });

        test("is an element of which a page may have a hundred", async (t) => {
            const seen = await found(
                `
            await import("/bsm/player.js");
            const players = Array.from({ length: 100 }, () => Object.assign(document.createElement("bsm-player"), { src: "/stream/${STREAM}.bsm" }));
            for (const player of players) player.style.cssText = "width: 60px; height: 60px; display: inline-block";
            const wrong = [];
            for (const player of players) player.addEventListener("error", ({ message }) => wrong.push(message));
            const loads = players.map((player) => new Promise((keep) => player.addEventListener("load", keep, { once: true })));
            document.body.append(...players);
            await Promise.all(loads);
            const drawn = ({ canvas }) => canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((value, i) => i % 4 === 3 && value > 0);
            for (const player of players) player.scrollIntoView();
            while (!players.every(drawn)) await new Promise((keep) => {
                for (const player of players) if (!drawn(player)) { player.scrollIntoView(); break; }
                requestAnimationFrame(keep);
            });
            players[7].canvas.focus();
            const before = players[7].camera.position.toArray().join();
            players[7].canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
            const turned = players[7].camera.position.toArray().join() !== before;
            const begin = performance.now();
            for (const player of players) player.remove();
            return { wrong, turned, removed: performance.now() - begin };`,
                {},
            );
            assert.deepEqual([seen.wrong, seen.turned], [[], true]);
            t.diagnostic(`100 players removed in ${Number(seen.removed).toFixed()} ms`);
        });

        test("is an element that shows all of its mesh, in all frames, at any size, until another one is asked for", async () => {
            const seen = await found(
                `
            await import("/bsm/player.js");
            const { Vector3 } = await import("three");
            const inside = (player) => {
                const [inside, all, point] = [new Set(), new Set(), new Vector3()];
                player.scene.updateMatrixWorld(true);
                player.scene.traverse(({ isMesh, geometry, matrixWorld }) => {
                    const { array, count } = isMesh ? geometry.getAttribute("position") : { count: 0 };
                    for (let i = 0; i < count; i++) {
                        const { x, y, z } = point.fromArray(array, 3 * i).applyMatrix4(matrixWorld).project(player.camera);
                        all.add(i);
                        if (Math.max(Math.abs(x), Math.abs(y), Math.abs(z)) <= 1) inside.add(i);
                    }
                });
                return inside.size / all.size;
            };
            const shares = [];
            for (const src of ["${STREAM}", "good-sequence-learnt", "good-sequence-runs"]) {
                for (const [width, height] of [[300, 150], [60, 400], [200, 200]]) {
                    const player = Object.assign(document.createElement("bsm-player"), { src: "/stream/" + src + ".bsm" });
                    player.style.cssText = "width: " + width + "px; height: " + height + "px";
                    const loaded = new Promise((keep) => player.addEventListener("load", keep, { once: true }));
                    document.body.append(player);
                    await loaded;
                    for (let frame = 0; frame < (player.sequence?.length ?? 1); frame++) {
                        player.sequence?.seek(frame);
                        shares.push(inside(player));
                    }
                    player.canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
                    shares.push(inside(player));
                    player.removeAttribute("src");
                    if (player.scene.children.length !== 2) shares.push("still drawn");
                    player.remove();
                }
            }
            return [...new Set(shares)];`,
                {},
            );
            assert.deepEqual(seen, [1]);
        });

        test("is an element that plays", async () => {
            const seen = await found(
                `
            await import("/bsm/player.js");
            const player = Object.assign(document.createElement("bsm-player"), { src: "/stream/good-sequence-learnt.bsm", loop: true, rate: 4 });
            player.setAttribute("autoplay", "");
            const heard = [];
            for (const type of ["loadeddata", "load", "play", "pause", "loop", "frame", "ended", "error"]) player.addEventListener(type, () => heard.push(type));
            const occurred = (type) => new Promise((keep) => player.addEventListener(type, keep, { once: true }));
            const [loaded, looped] = [occurred("load"), occurred("loop")];
            document.body.append(player);
            await loaded;
            await looped;
            player.pause();
            player.currentTime = 0.5 * player.duration;
            const middle = [player.paused, player.sequence.frame, player.sequence.length];
            const ended = occurred("ended");
            player.loop = false;
            player.play();
            await ended;
            const wrong = occurred("error");
            player.src = "/stream/no-such-file.bsm";
            const { error } = await wrong;
            const note = player.shadowRoot.querySelector("p").textContent;
            const still = occurred("load");
            player.src = "/stream/${STREAM}.bsm";
            await still;
            const [duration, meshes] = [player.duration, player.scene.children.length];
            player.remove();
            return { heard: [...new Set(heard)].sort(), middle, error: error.message, note, cleared: player.shadowRoot.querySelector("p").textContent, duration, meshes };`,
                {},
            );
            assert.deepEqual(seen.heard, ["ended", "error", "frame", "load", "loadeddata", "loop", "pause", "play"]);
            const [paused, frame, length] = seen.middle as [boolean, number, number];
            assert.deepEqual([paused, frame], [true, Math.floor(0.5 * length)]);
            assert.match(String(seen.error), /no-such-file.bsm: 404/);
            assert.deepEqual([seen.note, seen.cleared], [seen.error, ""]);
            assert.deepEqual([seen.duration, seen.meshes], [0, 3]);
        });

        test("is an element that takes the words of <video> before and after it has anything", async () => {
            const seen = await found(
                `
            await import("/bsm/player.js");
            const player = document.createElement("bsm-player");
            const occurred = (type) => new Promise((keep) => player.addEventListener(type, keep, { once: true }));
            document.body.append(player);
            const outcome = (promise) => promise.then(() => "plays", ({ name }) => name);
            player.currentTime = 0.5;
            player.src = "/stream/good-sequence-learnt.bsm";
            const first = outcome(player.play());
            const firstLoad = occurred("load");
            await occurred("loadeddata");
            player.pause();
            await firstLoad;
            await new Promise((go) => setTimeout(go, 300));
            const [rate, begun] = [player.sequence.rate, player.sequence.frame];
            const wrong = occurred("error");
            player.src = "/stream/no-such-file.bsm";
            const missing = outcome(player.play());
            await wrong;
            const still = occurred("load");
            player.src = "/stream/${STREAM}.bsm";
            player.currentTime = 1;
            const stands = outcome(player.play());
            await still;
            const time = player.currentTime;
            player.remove();
            return { due: Math.floor(0.5 * rate), begun, outcomes: await Promise.all([first, missing, stands]), time };`,
                {},
            );
            assert.deepEqual(seen.outcomes, ["plays", "NotSupportedError", "plays"]);
            assert.deepEqual([seen.begun, seen.time], [Math.min(Number(seen.due), Number(seen.begun)), 0]);
            assert.ok(Number(seen.begun) > 0, JSON.stringify(seen));
        });

        test("is an element with a poster until it draws, an ErrorEvent, and keys that turn, zoom, play and pause", async () => {
            const seen = await found(
                `
            await import("/bsm/player.js");
            const poster = "data:image/gif;base64,R0lGODlhAQABAIAAAAAAAP///yH5BAEAAAAALAAAAAABAAEAAAIBRAA7";
            const player = Object.assign(document.createElement("bsm-player"), { src: "/stream/good-sequence-learnt.bsm" });
            player.setAttribute("poster", poster);
            const occurred = (type) => new Promise((keep) => player.addEventListener(type, keep, { once: true }));
            const loaded = occurred("load");
            document.body.append(player);
            const shown = () => player.shadowRoot.querySelector("img").getAttribute("src");
            const posters = [shown()];
            await loaded;
            posters.push(shown());
            const { canvas, camera, orbit } = player;
            const press = (key) => {
                const event = new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true });
                const [from, far] = [camera.position.clone(), camera.position.distanceTo(orbit.target)];
                canvas.dispatchEvent(event);
                const now = camera.position.distanceTo(orbit.target);
                return [event.defaultPrevented, camera.position.distanceTo(from) > 1e-6 * far, Math.abs(now / far - 1) < 1e-6 ? 0 : Math.sign(now - far), player.paused];
            };
            const keys = Object.fromEntries(["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "+", "-", " ", "x"].map((key) => [key, press(key)]));
            keys.again = press(" ");
            const [focus, role, label] = [canvas.tabIndex, canvas.getAttribute("role"), canvas.getAttribute("aria-label") + ". " + canvas.getAttribute("aria-description")];
            const wrong = occurred("error");
            player.src = "/stream/no-such-file.bsm";
            posters.push(shown());
            const event = await wrong;
            posters.push(shown());
            player.remove();
            return { posters: posters.map((src) => src === poster), keys, focus, role, label, event: event instanceof ErrorEvent && event.error instanceof Error && event.message.includes("404") };`,
                {},
            );
            assert.deepEqual(seen.posters, [true, false, true, true]);
            const turn = [true, true, 0, true];
            assert.deepEqual(seen.keys, {
                ArrowLeft: turn,
                ArrowRight: turn,
                ArrowUp: turn,
                ArrowDown: turn,
                "+": [true, true, -1, true],
                "-": [true, true, 1, true],
                " ": [true, false, 0, false],
                x: [false, false, 0, false],
                again: [true, false, 0, true],
            });
            assert.deepEqual([seen.focus, seen.role, seen.event], [0, "application", true]);
            assert.match(String(seen.label), /A mesh.*Arrow keys turn it/);
        });

        test("is an element that stops its load, and gives back what it drew, where another takes its place", async () => {
            const asked: string[] = [];
            const route = "**/slow-*.bsm";
            // What never ends is over only where the page stops it.
            page.on("requestfailed", (request) => asked.push(request.url().replace(/.*slow-/, "")));
            await page.route(route, () => {});
            const seen = await found(
                `
            await import("/bsm/player.js");
            const { WebGLRenderer } = await import("three");
            const player = document.createElement("bsm-player");
            const occurred = (type) => new Promise((keep) => player.addEventListener(type, keep, { once: true }));
            document.body.append(player);
            const first = occurred("load");
            player.src = "/stream/good-attribute-textured.bsm";
            await first;
            const [{ geometry, material }] = player.scene.children.at(-1).children;
            const disposed = [];
            for (const [name, one] of Object.entries({ geometry, material, map: material.map })) one.addEventListener("dispose", () => disposed.push(name));
            player.src = "/slow-a.bsm";
            player.src = "/slow-b.bsm";
            player.rate = -1;
            const rates = [player.rate];
            for (const rate of ["fast", "0.5"]) rates.push((player.setAttribute("rate", rate), player.rate));
            player.remove();
            await new Promise((go) => setTimeout(go, 300));
            const own = document.createElement("canvas").getContext("webgl2");
            for (let k = 0; k < 20; k++) {
                document.body.append(player);
                player.remove();
            }
            await new Promise((go) => setTimeout(go, 300));
            return { disposed: disposed.sort(), rates, lost: own.isContextLost() };`,
                {},
            );
            await page.unroute(route);
            assert.deepEqual(seen, { disposed: ["geometry", "map", "material"], rates: [1, 1, 0.5], lost: false });
            assert.deepEqual(asked.slice(0, 2), ["a.bsm", "b.bsm"]);
        });

        test("stops the load of a sequence that is disposed of", async () => {
            const seen = await found(`
            const data = await bytesOf("good-sequence-low-delay-long");
            const { fetch } = window;
            let stopped = false;
            window.fetch = async (url, options) => String(url).endsWith("/slow") ? new Response(new ReadableStream({
                async start(out) {
                    options.signal.addEventListener("abort", () => {
                        stopped = true;
                        out.error(options.signal.reason);
                    });
                    for (let at = 0; at < data.length && !stopped; at += 50) {
                        out.enqueue(data.slice(at, at + 50));
                        await new Promise((go) => setTimeout(go, 30));
                    }
                },
            })) : fetch(url, options);
            const heard = [];
            const sequence = await new BSMLoader().loadSequence("/slow");
            sequence.addEventListener("error", () => heard.push("error"));
            sequence.dispose();
            await new Promise((go) => setTimeout(go, 300));
            return { stopped, frames: sequence.geometry.frames.length, heard };`);
            assert.deepEqual(seen, { stopped: true, frames: 0, heard: [] });
        });

        test("stops one load, and no other, at a signal of its own", async () => {
            const seen = await found(`
            const loader = new BSMLoader();
            const stop = new AbortController();
            const stopped = loader.loadAsync("/stream/${STREAM}.bsm", undefined, { signal: stop.signal }).then(() => "loaded", (error) => error.name);
            const other = loader.loadAsync("/stream/${STREAM}.bsm").then(() => "loaded", (error) => error.name);
            stop.abort();
            return { stopped: await stopped, other: await other };`);
            assert.deepEqual([seen.stopped, seen.other], ["AbortError", "loaded"]);
        });

        test("limits the threads of the path that is set later, and no others", async () => {
            const seen = await found(`
            const load = (loader) => Promise.all(["${STREAM}", "good-grid", "${KEYS}"].map((name) => loader.loadAsync("/stream/" + name + ".bsm")));
            await load(new BSMLoader().setWorkerLimit(1).setDecoderPath("/bsm/"));
            const own = workers;
            await load(new BSMLoader());
            return { own, shared: workers - own };`);
            assert.equal(seen.own, 1);
            assert.ok(Number(seen.shared) > 1, `${seen.shared}`);
        });

        test("names each address once, and leaves the reason of who stops as it is", async () => {
            const seen = await found(`
            const loader = new BSMLoader();
            const stop = new AbortController();
            const reason = new TypeError("enough");
            const loads = ["a", "b"].map((name) => loader.loadAsync("/stream/" + name + ".bsm", undefined, { signal: stop.signal }).catch(({ message, cause }) => [message, cause === reason]));
            stop.abort(reason);
            const stopped = await Promise.all(loads);
            const { error, place } = await loader.loadAsync("/stream/bad-sequence-long.bsm").catch((error) => ({ error: error.name + " " + error.message, place: error.place }));
            return { stopped, reason: reason.message, error, offset: place.offset > 0 };`);
            assert.deepEqual(seen.stopped, [
                ["/stream/a.bsm: enough", true],
                ["/stream/b.bsm: enough", true],
            ]);
            assert.match(String(seen.error), /^CorruptError .stream.bad-sequence-long.bsm: [^/]*$/);
            assert.deepEqual([seen.reason, seen.offset], ["enough", true]);
        });

        test("says that a page was sent where a stream or a part of the decoder was asked for", async () => {
            for (const name of ["page.bsm", "own/blocks.wasm", "own/small-worker.js"])
                site.extra.set(`/${name}`, "<!DOCTYPE html><html><body>Not here</body></html>");
            const seen = await found(`
            const problem = (loader, url) => loader.loadAsync(url).then(() => "none", ({ message }) => message);
            return { stream: await problem(new BSMLoader(), "/page.bsm"), kernels: await problem(new BSMLoader().setDecoderPath("/own/"), "/stream/${STREAM}.bsm") };`);
            assert.equal(seen.stream, "/page.bsm: the server sent an HTML page; is the address right?");
            assert.match(
                String(seen.kernels),
                /^.stream.good-labels.bsm: http:.*own.blocks.wasm: the server sent an HTML page; is the address right.$/,
            );
        });

        test("is a plug-in of GLTFLoader", async () => {
            await serveScenes();
            const seen = await found(`
            const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
            const { GLTFBSMExtension } = await import("/bsm/gltf.js");
            const load = (url) => new GLTFLoader().register((parser) => new GLTFBSMExtension(parser)).loadAsync(url);
            const { geometry } = (await load("/scene.glb")).scene.children[0];
            const own = await new BSMLoader().loadAsync("/stream/good-attribute-textured.bsm");
            const same = (name) => [...geometry.getAttribute(name).array].join() === [...own.getAttribute(name).array].join();
            const problems = await Promise.all(["/wrong.glb", "/broken.glb"].map((url) => load(url).then(() => "none", (error) => error.name + " " + error.message)));
            return { same: ["position", "normal", "uv"].map(same), index: [...geometry.index.array].join() === [...own.index.array].join(), problems };`);
            assert.deepEqual([seen.same, seen.index], [[true, true, true], true]);
            const [wrong, broken] = seen.problems as string[];
            assert.match(wrong, /bufferView 1: POSITION has \d+ bytes, not \d+/);
            assert.match(broken, /TruncatedError/);
        });

        for (const [place, headers] of [
            ["free", {}],
            ["locked", { "Content-Security-Policy": "worker-src 'none'" }],
        ] as [string, Record<string, string>][]) {
            test(`decodes with helpers where threads are ${place === "free" ? "allowed" : "forbidden"}`, async () => {
                const seen = await found(
                    `
                const kernels = await loadKernels();
                const data = await bytesOf("good-keys");
                const alone = decode(kernels, data);
                const pool = new Pool(undefined, 2);
                const positions = new Float64Array(alone.positions.length);
                await new Promise((keep, fail) => {
                    const onEvent = (event) => event.type === "block" && event.vertices.forEach((vertex, i) => positions.set(event.positions.subarray(3 * i, 3 * i + 3), 3 * vertex));
                    const stream = pool.open({ onEvent, onEnd: keep, onError: fail }, { worthwhile: 0 });
                    for (let at = 0; at < data.length; at += 100) stream.receiveData(data.slice(at, at + 100));
                    stream.receiveEof();
                });
                const problem = await new Promise((keep) => {
                    const stream = pool.open({ onEnd: keep, onError: ({ name }) => keep(name) }, { worthwhile: 0 });
                    stream.receiveData(data.slice(0, -20));
                    stream.receiveEof();
                });
                return { same: positions.every((x, i) => x === alone.positions[i]), helped: window.helped ?? 0, problem };`,
                    headers,
                );
                assert.deepEqual([seen.same, seen.problem], [true, "TruncatedError"]);
                // The last stream is begun again by the decoder of everything, which asks once more.
                if (place === "free") assert.equal(seen.helped, 3);
            });
        }
    },
);

test("a surface faces the mean of its normals, and a closed one nowhere", () => {
    const normals = (...part: number[]): BufferAttribute =>
        new SphereGeometry(1, 40, 30, ...part).getAttribute("normal") as BufferAttribute;
    assert.ok(frontOf(normals()).length() < 0.05);
    const front = frontOf(normals(0, Math.PI)); // the half of z > 0
    assert.ok(front.z > 0.35 && Math.hypot(front.x, front.y) < 0.05, `${front.toArray()}`);
    assert.equal(frontOf().length(), 0);
});
