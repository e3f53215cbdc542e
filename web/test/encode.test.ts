/**
 * The encoder for pages: streams that the decoder reads, errors, progress. tests/library/test_encode.py compares their
 * bytes with those of C.
 */
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { describe } from "node:test";
import { BufferAttribute, BufferGeometry, Mesh, TorusKnotGeometry } from "three";
import {
    BSMExporter,
    encodeHere,
    encodeWith,
    type AttributeInput,
    type EncodeOptions,
    type MeshInput,
} from "../src/encode";
import { meshOf } from "../src/content";
import { decode } from "../src/index";
import { POLICY, serveSite } from "./server";
import { CHROMIUM, chromiumFor, eventsOf, kernels, PATIENCE, WEB } from "./shared";

const wasm = readFileSync(join(WEB, "built/encode.wasm"));
const module = await WebAssembly.compile(wasm);

/** A mesh with an attribute of each kind. */
function dressed(): ReturnType<typeof meshOf> {
    const geometry = new TorusKnotGeometry(1, 0.3, 60, 8);
    const mesh = meshOf(geometry);
    const corners = mesh.faces.length;
    const attributes: AttributeInput[] = [
        ...(mesh.attributes ?? []),
        {
            name: "color",
            values: Uint8Array.from({ length: mesh.positions.length }, (_, i) => (7 * i) & 255),
            components: 3,
            semantic: "color" as const,
        },
        {
            name: "part",
            values: Int32Array.from({ length: corners / 3 }, (_, i) => i & 3),
            components: 1,
            domain: "face" as const,
        },
        {
            name: "chart",
            values: Float32Array.from({ length: 2 * corners }, (_, i) => (i % 64) / 64),
            components: 2,
            domain: "corner" as const,
            semantic: "texcoord" as const,
        },
    ];
    return {
        ...mesh,
        attributes,
        metadata: { unit: "mm", count: 3, scale: 0.5, "image.0.data": Uint8Array.from([1, 2, 3]) },
    };
}

/** One triangle. */
const SINGLE = {
    "one.ply":
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "one.stl":
        "solid one\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid one\n",
};

/** A page that encodes in a worker, and aborts; and how long it could not do anything else. */
const PAGE = `
    import { encode } from "/bsm/encode.js";
    const knot = await (await fetch("/knot.json")).json();
    const mesh = { positions: Float32Array.from(knot.positions), faces: Uint32Array.from(knot.faces) };
    const tasks = [];
    new PerformanceObserver((list) => tasks.push(...list.getEntries().map(({ duration }) => duration))).observe({ type: "longtask" });
    await new Promise((next) => setTimeout(next, 200));
    tasks.length = 0;
    const [parts, stop] = [[], new AbortController()];
    const bytes = await encode(mesh, { onProgress: (part) => parts.push(part) });
    await new Promise((next) => setTimeout(next, 200));
    const blocked = Math.max(0, ...tasks);
    const failure = async (options, given = mesh) => encode(given, options).then(() => "", (error) => error.name + ": " + error.message);
    const aborted = await failure({ signal: stop.signal, onProgress: () => stop.abort() });
    const refused = await failure({ bits: 21 });
    window.found = { bytes: [...bytes], parts, blocked, aborted, refused, again: (await encode(mesh)).length };
`;

describe("encoding in Chromium", { skip: !existsSync(CHROMIUM) && `no Chromium at ${CHROMIUM}` }, () => {
    test("a worker writes the same bytes, reports, and can be stopped", async (context) => {
        const [browser, site] = [await chromiumFor(context), await serveSite()];
        context.after(() => site.close());
        const mesh = meshOf(new TorusKnotGeometry(1, 0.3, 1000, 50));
        site.extra.set("/knot.json", JSON.stringify({ positions: [...mesh.positions], faces: [...mesh.faces] }));
        site.extra.set("/script.js", PAGE);
        site.headers["Content-Security-Policy"] = POLICY;
        const page = await browser.newPage();
        await page.goto(site.address);
        type Found = {
            bytes: number[];
            parts: number[];
            blocked: number;
            aborted: string;
            refused: string;
            again: number;
        };
        const found = (await (
            await page.waitForFunction(() => (window as unknown as { found: unknown }).found, undefined, {
                timeout: PATIENCE,
            })
        ).jsonValue()) as Found;
        assert.deepEqual(
            Buffer.from(found.bytes),
            Buffer.from(encodeWith(module, { positions: mesh.positions, faces: mesh.faces })),
        );
        assert.equal(found.again, found.bytes.length);
        assert.ok(found.parts.length > 3 && found.parts.at(-1) === 1);
        assert.match(found.aborted, /^AbortError/);
        assert.match(found.refused, /^EncodeError: .*bits/);
        context.diagnostic(`longest task of the page: ${found.blocked} ms`);
    });
});

describe("encoding", () => {
    test("what is encoded comes back", () => {
        const mesh = dressed();
        const decoded = decode(kernels, encodeWith(module, mesh, { lossless: true, keepOrder: true }));
        assert.deepEqual([...decoded.positions].map(Math.fround), [...mesh.positions]);
        assert.deepEqual([...decoded.faces], [...mesh.faces]);
    });

    test("errors say what is wrong", async () => {
        const mesh = dressed();
        assert.throws(() => encodeWith(module, mesh, { bits: 21 }), { name: "EncodeError", status: 2 });
        assert.throws(
            () => encodeWith(module, { ...mesh, faces: mesh.faces.map((v) => v + 1) }),
            /is vertex \d+ of \d+/,
        );
        const odd: [string, unknown, unknown][] = [
            ["bits", { ...mesh }, { bits: 2.5 }],
            ["bits", { ...mesh }, { bits: 10n }],
            ["cell", { ...mesh }, { cell: "1" }],
            ["metadata", { ...mesh, metadata: { a: null } }, {}],
            ["metadata", { ...mesh, metadata: { a: 1n } }, {}],
            ["metadata", { ...mesh, metadata: { a: [1] } }, {}],
            ["faces", { ...mesh, faces: BigInt64Array.from(mesh.faces, BigInt) }, {}],
            ["faces", { ...mesh, faces: null }, {}],
            ["faces", { ...mesh, faces: "012" }, {}],
            ["positions", { ...mesh, positions: BigInt64Array.of(0n, 1n, 2n) }, {}],
            ["positions", { ...mesh, positions: [null, 1, 2] }, {}],
            ["positions", { ...mesh, positions: undefined }, {}],
            ...[{}, { bits: 2.5 }, { bits: null }, { shine: 1 }].map((quality): [string, unknown, unknown] => [
                "quality",
                mesh,
                { qualities: { [mesh.attributes![0].name]: quality } },
            ]),
            ["values", { ...mesh, attributes: [{ ...mesh.attributes![0], values: [1n] }] }, {}],
            ["indices", { ...mesh, attributes: [{ ...mesh.attributes![0], domain: "corner", indices: [1n] }] }, {}],
        ];
        for (const [what, input, options] of odd)
            assert.throws(
                () => encodeWith(module, input as MeshInput, options as EncodeOptions),
                { name: "EncodeError", status: 2 },
                what,
            );
        const far = Float64Array.from(mesh.positions, (x) => x + 1e7);
        assert.throws(() => encodeWith(module, { ...mesh, positions: far }, { lossless: true }), {
            name: "EncodeError",
            status: 10,
        });
        await assert.rejects(new BSMExporter().parseAsync({} as Mesh), /objects with meshes/);
        await assert.rejects(
            encodeHere({ ...mesh, positions: mesh.positions.slice(1) }, { wasm: module }),
            /three numbers/,
        );
    });

    test("progress ascends; who listens can end the work", async () => {
        const seen: number[] = [];
        encodeWith(module, dressed(), { onProgress: (part) => void seen.push(part) });
        assert.deepEqual(
            seen,
            [...seen].sort((a, b) => a - b),
        );
        assert.equal(seen.at(-1), 1);
        const stop = new Error("enough");
        const thrown = (): Uint8Array =>
            encodeWith(module, dressed(), {
                onProgress: () => {
                    throw stop;
                },
            });
        assert.throws(thrown, stop);
        await assert.rejects(encodeHere(dressed(), { wasm: module, signal: AbortSignal.abort() }), {
            name: "AbortError",
        });
    });

    test("BSMExporter writes what three.js has, indexed, interleaved or not", async () => {
        const plain = new BufferGeometry().setAttribute(
            "position",
            new BufferAttribute(Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0]), 3),
        );
        for (const geometry of [plain, new TorusKnotGeometry(1, 0.3, 60, 8)]) {
            const bytes = await new BSMExporter().parseAsync(new Mesh(geometry), {
                wasm: module,
                qualities: { normal: "recompute" },
            });
            const { positions, faces } = decode(kernels, bytes);
            assert.equal(faces.length, geometry.index?.count ?? 3);
            assert.ok(positions.length > 0);
        }
    });

    test("the command reads what three.js reads", (context) => {
        const folder = mkdtempSync(join(tmpdir(), "bsm-encode-"));
        context.after(() => rmSync(folder, { recursive: true }));
        const [source, target] = [join(folder, "two.obj"), join(folder, "two.bsm")];
        const run = (...given: string[]): ReturnType<typeof spawnSync> =>
            spawnSync(process.execPath, [join(WEB, "mesh.js"), ...given], { encoding: "utf8" });
        writeFileSync(source, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no one\nf 1 2 3\nf 1 3 4\no other\nf 2 3 4\n");
        execFileSync(process.execPath, [join(WEB, "mesh.js"), source, target, "lossless"]);
        const { positions, faces } = decode(kernels, new Uint8Array(readFileSync(target)));
        assert.deepEqual([positions.length, faces.length], [12, 9]);
        for (const [name, text] of Object.entries(SINGLE)) {
            writeFileSync(join(folder, name), text);
            assert.equal(run(join(folder, name), target).status, 0, name);
            assert.equal(decode(kernels, new Uint8Array(readFileSync(target))).faces.length, 3);
        }
        writeFileSync(source, "v 0 0 0\n");
        assert.match(String(run(source, target).stderr), /two\.obj: the file has no faces that can be read/);
        assert.match(String(run(join(folder, "a.step"), target).stderr), /only OBJ, PLY, STL and GLB/);
        assert.match(String(run(join(folder, "none.ply"), target).stderr), /no such file or folder/);
        for (const bits of ["0", "21"]) assert.match(String(run(source, target, bits).stderr), /from 1 to 20/);
        assert.equal(run(source, target, "many").status, 2);
    });

    test("the command makes a sequence of a folder, which comes back within half a cell", (context) => {
        const folder = mkdtempSync(join(tmpdir(), "bsm-frames-"));
        context.after(() => rmSync(folder, { recursive: true }));
        const target = join(folder, "all.bsm");
        const write = (frame: number, z: number, ...faces: string[]): void =>
            writeFileSync(
                join(folder, `${frame}.ply`),
                `ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face ${faces.length}\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 ${z}\n${faces.map((corners) => `3 ${corners}\n`).join("")}`,
            );
        const run = (): ReturnType<typeof spawnSync> =>
            spawnSync(process.execPath, [join(WEB, "mesh.js"), folder, target, "10"], { encoding: "utf8" });
        const heights = Array.from({ length: 11 }, (_, frame) => 2 + Math.sin(frame)); // 10.ply comes last
        heights.forEach((z, frame) => write(frame, z, "0 1 2", "0 2 3", "0 3 1"));
        assert.equal(run().status, 0);
        const found = [...eventsOf(kernels, readFileSync(target), Infinity)].flatMap((event) =>
            event.type === "frame" ? [Math.max(...event.positions)] : [],
        );
        assert.equal(found.length, heights.length);
        found.forEach((z, frame) => assert.ok(Math.abs(z - heights[frame]) <= 3 / (2 ** 10 - 1) / 2, `frame ${frame}`));
        write(4, NaN, "0 1 2", "0 2 3", "0 3 1");
        assert.match(String(run().stderr), /finite/);
        for (const faces of [
            ["0 1 2", "0 3 1", "0 2 3"],
            ["0 1 2", "0 2 3"],
        ]) {
            write(4, 2, ...faces);
            assert.match(String(run().stderr), /4\.ply: it has other faces than 0\.ply/);
        }
        for (const [frames, words] of [
            [2, /encode-moving/],
            [4, /in each frame/],
        ] as const)
            assert.throws(
                () => encodeWith(module, { positions: new Float32Array(18), faces: [0, 1, 2], frames }),
                words,
            );
    });
});
