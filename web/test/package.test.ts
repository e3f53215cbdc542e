/** What `npm pack` makes: it has types, runs in Node, and is of the version that the Python package has. */
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after, before, describe } from "node:test";
import { pathToFileURL } from "node:url";
import { build } from "esbuild";
import { NodeIO } from "@gltf-transform/core";
// @ts-expect-error the package has no types
import { validateBytes } from "gltf-validator";
import { readNpz } from "./npz";
import { kernels, eventsOf, meshOfEvents, VECTORS, WEB } from "./shared";

const CONSUMER = `
import { decode, loadKernels, Pool, type Metadata } from "bsm-decoder";
import * as quick from "bsm-decoder/quick";
import { BSMLoader, BSMSequence, type BSMGeometry } from "bsm-decoder/three";
import { GLTFBSMExtension } from "bsm-decoder/gltf";
import { EXTBSMCompression, loadSceneDecoder } from "bsm-decoder/gltf-transform";
import { registerBSM } from "bsm-decoder/babylon";
import { BSMPlayer } from "bsm-decoder/player";
import { encode } from "bsm-decoder/encode";
import { WebIO } from "@gltf-transform/core";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { Mesh, type Group } from "three";
const gltf: GLTFLoader = new GLTFLoader().register((parser) => new GLTFBSMExtension(parser));
const io: Promise<WebIO> = loadSceneDecoder().then((decoder) => new WebIO().registerExtensions([EXTBSMCompression]).registerDependencies({ "bsm.decoder": decoder }));
const loader: BSMLoader = new BSMLoader().setWorkerLimit(2).preload("quick");
loader.load("a.bsm", (geometry) => new Mesh(geometry), (event) => event.loaded, (error: unknown) => error);
const scene: Promise<Group> = loader.loadScene("a.bsm");
const sequence: Promise<BSMSequence> = loader.loadSequence("a.bsm");
const geometry: Promise<BSMGeometry> = loader.parseAsync(new ArrayBuffer(8));
const metadata: Metadata = new Map();
const blob: Promise<Blob> = encode({ positions: [0, 0, 0], faces: [0, 0, 0] }).then((bytes) => new Blob([bytes]));
const playing: BSMSequence | undefined = document.querySelector("bsm-player")?.sequence;
export { BSMPlayer, blob, playing, registerBSM, gltf, io, decode, loadKernels, Pool, quick, scene, sequence, geometry, metadata };
`;
const PROGRAM = `
import { readFileSync } from "node:fs";
import { decode, loadKernels, Pool } from "bsm-decoder";
const data = new Uint8Array(readFileSync(process.argv[2]));
const { positions, faces } = decode(await loadKernels(), data);
const damaged = data.slice();
damaged[data.length >> 1] ^= 1;
const problem = await new Promise((keep) => {
    const stream = new Pool().open({ onError: keep, onEnd: keep }, { drawing: "whole" });
    stream.receiveData(damaged);
    stream.receiveEof();
});
const drawn = await new Promise((keep, fail) => {
    const stream = new Pool().open({ onPicture: (picture) => picture.type === "whole" && keep(picture.shape.index.length), onError: fail }, { drawing: "whole" });
    stream.receiveData(data);
    stream.receiveEof();
});
console.log(JSON.stringify([positions.length > 0, faces.length === drawn, problem.message.includes("checksum")]));
`;
/** Five rounds of 20 loads; how many of their geometries are kept at the end. */
const ROUNDS = `
import { readFileSync } from "node:fs";
import { BSMLoader } from "bsm-decoder/three";
const data = new Uint8Array(readFileSync(process.argv[2]));
const loader = new BSMLoader();
const stop = new AbortController();
const kept = [];
for (let round = 0; round < 5; round++) {
    for (const geometry of await Promise.all(Array.from({ length: 20 }, () => loader.parseAsync(data, { signal: stop.signal })))) kept.push(new WeakRef(geometry));
    await new Promise((go) => setTimeout(go, 20));
    gc();
}
console.log(kept.filter((one) => one.deref()).length);
`;

test("threads have names of their own, by which webpack makes files of them", () => {
    const names = [
        ...readFileSync(join(WEB, "built/pool.js"), "utf8").matchAll(
            /"\.\/[a-z-]*worker\.js",import\.meta\.url\),\{type:"module",name:"([^"]*)"/g,
        ),
    ].map(([, name]) => name);
    assert.equal(new Set(names).size, 2);
    assert.equal(names.length, 2);
});

test("no file starts or imports one that leads back to it: bundlers would follow it for ever", () => {
    const names = readdirSync(join(WEB, "built")).filter((name) => name.endsWith(".js"));
    const next = new Map(
        names.map((name) => [
            name,
            [...readFileSync(join(WEB, "built", name), "utf8").matchAll(/"\.\/([\w-]+\.js)"/g)].map(
                ([, other]) => other,
            ),
        ]),
    );
    const walk = (name: string, path: string[]): void => {
        assert.ok(!path.includes(name), `${[...path, name].join(" -> ")}`);
        for (const other of next.get(name) ?? assert.fail(`${path.at(-1)} names ${name}, which is not there`))
            walk(other, [...path, name]);
    };
    for (const name of names) walk(name, []);
});

describe("the package", () => {
    const folder = mkdtempSync(join(tmpdir(), "bsm-package-"));
    const run = (program: string, ...args: string[]): string =>
        execFileSync(program, args, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
    const own = JSON.parse(readFileSync(join(WEB, "package.json"), "utf8")) as { name: string; version: string };
    let files: string[] = [];

    before(() => {
        const [packed] = JSON.parse(
            execFileSync("npm", ["pack", "--json", "--silent", "--pack-destination", folder], {
                cwd: WEB,
                encoding: "utf8",
            }),
        ) as { filename: string; files: { path: string }[] }[];
        files = packed.files.map(({ path }) => path);
        const place = join(folder, "node_modules", own.name);
        mkdirSync(place, { recursive: true });
        run("tar", "xzf", join(folder, packed.filename), "-C", place, "--strip-components=1");
        for (const name of [
            "three",
            "@types",
            "@gltf-transform",
            "property-graph",
            "@babylonjs",
            "babylonjs-gltf2interface",
        ])
            symlinkSync(join(WEB, "node_modules", name), join(folder, "node_modules", name));
        writeFileSync(join(folder, "package.json"), '{"type": "module"}');
    });
    after(() => rmSync(folder, { recursive: true, force: true }));

    test("has the version of the Python package, and nothing that is not needed", () => {
        const [, version] =
            /__version__ = "(.*)"/.exec(readFileSync(join(WEB, "../src/bsm/__init__.py"), "utf8")) ?? [];
        assert.equal(own.version, version);
        assert.ok(
            files.every((path) =>
                /^(built\/[\w-]+\.(js|wasm)|built\/LICENSES\.txt|types\/\w+\.d\.ts|package\.json|(glb|mesh|obj)\.js|README\.md|LICENSE)$/.test(
                    path,
                ),
            ),
            files.join(" "),
        );
    });

    for (const resolution of [
        ["esnext", "bundler"],
        ["nodenext", "nodenext"],
    ]) {
        test(`has strict types under ${resolution[1]}`, () => {
            writeFileSync(join(folder, "consumer.ts"), CONSUMER);
            const options = [
                "--strict",
                "--noEmit",
                "--skipLibCheck",
                "false",
                "--target",
                "es2022",
                "--lib",
                "es2023,dom,dom.iterable",
                "--types",
                "node",
                "--module",
                resolution[0],
                "--moduleResolution",
                resolution[1],
            ];
            run(process.execPath, join(WEB, "node_modules/typescript/bin/tsc"), ...options, "consumer.ts");
        });
    }

    test("is a command that ends with one sentence, and quietly where nobody reads on", () => {
        const command = join(folder, "node_modules", own.name, "obj.js");
        writeFileSync(join(folder, "cut.bsm"), readFileSync(join(VECTORS, "good-labels.bsm")).subarray(0, 150));
        const cut = spawnSync(process.execPath, [command, "cut.bsm"], { cwd: folder, encoding: "utf8" });
        assert.equal(cut.status, 1);
        assert.match(cut.stderr, /^bsm-decoder: cut\.bsm: [^\n]+\n$/);
        const piped = spawnSync(
            "bash",
            ["-c", `set -o pipefail; "${process.execPath}" "${command}" "${join(VECTORS, "good-labels.bsm")}" | true`],
            { cwd: folder, encoding: "utf8" },
        );
        assert.deepEqual([piped.status, piped.stderr], [0, ""]);
    });

    test("is a command that writes all frames of a sequence, or says that it needs a place for them", () => {
        const [command, name] = [
            join(folder, "node_modules", own.name, "obj.js"),
            join(VECTORS, "good-sequence-learnt.bsm"),
        ];
        const written = (...target: string[]): { status: number | null; stderr: string } =>
            spawnSync(process.execPath, [command, name, ...target], { cwd: folder, encoding: "utf8" });
        assert.match(written().stderr, /a sequence of \d+ frames/);
        for (const target of ["frames", "frames.npz", "frames.pc2", "frames.mdd"])
            assert.deepEqual([written(target).status, written(target).stderr], [0, ""], target);
        const arrays = readNpz(readFileSync(join(folder, "frames.npz")));
        const [positions, faces] = ["positions", "faces"].map((array) => arrays[array].values);
        const expected = meshOfEvents(eventsOf(kernels, new Uint8Array(readFileSync(name)), 1 << 20));
        assert.deepEqual([[...positions], [...faces]], [[...expected.positions], [...expected.faces]]);
        const count = positions.length / 3;
        const objs = readdirSync(join(folder, "frames")).map((file) =>
            readFileSync(join(folder, "frames", file), "utf8"),
        );
        assert.equal(objs.join("").match(/^v /gm)!.length, count);
        const numbers = objs
            .join("")
            .match(/^v .*/gm)!
            .flatMap((line) => line.slice(2).split(" ").map(Number));
        assert.deepEqual(numbers, [...positions]);
        const pc2 = readFileSync(join(folder, "frames.pc2"));
        assert.deepEqual(
            [pc2.readInt32LE(16) * pc2.readInt32LE(28), pc2.length, pc2.readFloatLE(32)],
            [count, 32 + 12 * count, Math.fround(positions[0])],
        );
        const mdd = readFileSync(join(folder, "frames.mdd"));
        const frames = mdd.readInt32BE(0);
        assert.deepEqual(
            [frames, frames * mdd.readInt32BE(4), mdd.readFloatBE(8 + 4 * frames)],
            [objs.length, count, Math.fround(positions[0])],
        );
    });

    test("is a command that writes GLB: frames are morph targets, and images are there", async () => {
        for (const name of ["good-sequence-moving", "good-attribute-textured"]) {
            const [source, target] = [join(VECTORS, `${name}.bsm`), join(folder, `${name}.glb`)];
            run(process.execPath, join(folder, "node_modules", own.name, "obj.js"), source, target);
            const glb = new Uint8Array(readFileSync(target));
            assert.equal((await validateBytes(glb)).issues.numErrors, 0);
            const root = (await new NodeIO().readBinary(glb)).getRoot();
            const { positions, faces } = meshOfEvents(eventsOf(kernels, new Uint8Array(readFileSync(source)), 1 << 20));
            const [primitive] = root.listMeshes()[0].listPrimitives();
            const shown = [undefined, ...primitive.listTargets()];
            assert.deepEqual(
                [root.listAnimations().length, root.listTextures().length],
                shown.length > 1 ? [1, 0] : [0, 1],
            );
            for (const [frame, target] of shown.entries()) {
                const [base, added] = [primitive, target].map((each) => each?.getAttribute("POSITION"));
                const seen = [...primitive.getIndices()!.getArray()!].map((vertex) =>
                    base!.getElement(vertex, []).map((x: number, d) => x + (added?.getElement(vertex, [])[d] ?? 0)),
                );
                const meant = [...faces].map((vertex) =>
                    [...positions.subarray((frame * positions.length) / shown.length + 3 * vertex)].slice(0, 3),
                );
                const triangles = (corners: number[][]): string[] =>
                    corners
                        .flatMap((_, i) =>
                            i % 3
                                ? []
                                : corners
                                      .slice(i, i + 3)
                                      .flat()
                                      .map((x) => x.toFixed(4))
                                      .join(" "),
                        )
                        .sort();
                assert.deepEqual(triangles(seen), triangles(meant));
            }
        }
    });

    test("names setDecoderPath in a bundle of CommonJS, which does not know its address, and decodes with it", async () => {
        const [entry, bundle] = [join(folder, "bundled.mjs"), join(folder, "bundle.cjs")];
        writeFileSync(
            entry,
            `import { BSMLoader } from "${own.name}/three";
            const data = new Uint8Array(${JSON.stringify([...readFileSync(join(VECTORS, "good-labels.bsm"))])});
            const told = (loader) => loader.parseAsync(data.slice()).then((geometry) => geometry.getAttribute("position").count, (error) => error.message);
            (async () => console.log(JSON.stringify([await told(new BSMLoader()), await told(new BSMLoader().setDecoderPath(process.argv[2]))])))();`,
        );
        await build({
            entryPoints: [entry],
            bundle: true,
            format: "cjs",
            platform: "browser",
            outfile: bundle,
            logLevel: "error",
        });
        const [without, count] = JSON.parse(run(process.execPath, bundle, pathToFileURL(join(WEB, "built/")).href)) as [
            string,
            number,
        ];
        assert.match(without, /copy those of bsm-decoder\/built, and name their folder with setDecoderPath/);
        assert.ok(count > 0, `${count}`);
    });

    test("decodes in Node", () => {
        writeFileSync(join(folder, "program.js"), PROGRAM);
        for (const name of ["good-labels", "good-light"])
            assert.deepEqual(JSON.parse(run(process.execPath, "program.js", join(VECTORS, `${name}.bsm`))), [
                true,
                true,
                true,
            ]);
    });

    test("keeps nothing of loads that are over in Node, and warns of nothing", () => {
        writeFileSync(join(folder, "rounds.js"), ROUNDS);
        const { status, stdout, stderr } = spawnSync(
            process.execPath,
            ["--expose-gc", "rounds.js", join(VECTORS, "good-labels.bsm")],
            { cwd: folder, encoding: "utf8" },
        );
        assert.deepEqual([status, stderr], [0, ""]);
        assert.ok(Number(stdout) < 20, `${stdout} of 100 geometries are kept`);
    });
});
