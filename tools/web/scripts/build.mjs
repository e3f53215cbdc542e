// Everything that is committed as built, from sources: the kernels by `npm run kernels`, the rest by `npm run build`.
// `npm run build -- --check` writes nothing and fails if what is committed is not what the sources build.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { build } from "esbuild";
import { compileKernels, compiler, KERNEL_BUILDS, WEB } from "./kernels.mjs";

const VIEWER = join(WEB, "../../bsm/viewer");
const SOURCES = join(WEB, "src");
const OPTIONS = { bundle: true, minify: true, format: "esm", target: "es2022", charset: "utf8", loader: { ".wasm": "binary", ".html": "text" }, legalComments: "none", logLevel: "warning", write: false };
const BUNDLED = ["three", "fzstd"];

/** Lets a script import another as text, bundled to run in a thread of its own: `worker:./path.ts`. */
const THREADS = {
    name: "threads",
    setup({ onResolve, onLoad }) {
        onResolve({ filter: /^worker:/ }, ({ path, resolveDir }) => ({ path: join(resolveDir, path.slice("worker:".length)), namespace: "thread" }));
        onLoad({ filter: /./, namespace: "thread" }, async ({ path }) => ({ contents: await bundle(path, { format: "iife" }), loader: "text" }));
    },
};

/** Leaves out what most meshes can do without: sequences, attributes, split vertices, damage, packed coefficients. */
const SMALL = {
    name: "small",
    setup({ onResolve }) {
        onResolve({ filter: /^\.\/(sequence|attributes|declaration|splits|tolerant|zstd)$/ }, () => ({ path: join(SOURCES, "absent.ts") }));
    },
};

async function bundle(entry, options = {}) {
    const result = await build({ ...OPTIONS, plugins: [THREADS], ...options, entryPoints: [entry] });
    return result.outputFiles[0].text;
}

function licences(packages) {
    return packages.map((name) => `${name}\n\n${readFileSync(join(WEB, "node_modules", name, "LICENSE"), "utf8").trim()}`).join("\n\n\n");
}

/** Path and content of everything that is built of TypeScript. */
async function products() {
    const define = { LICENCES: JSON.stringify(licences(BUNDLED)) };
    const script = (await bundle(join(SOURCES, "viewer/viewer.ts"), { define })).replaceAll("</script", "<\\/script");
    return [
        [join(WEB, "built/bsm.js"), await bundle(join(SOURCES, "index.ts"))],
        [join(WEB, "built/small.js"), await bundle(join(SOURCES, "index.ts"), { plugins: [SMALL] })],
        [join(WEB, "built/three.js"), await bundle(join(SOURCES, "three.ts"), { external: ["three"] })],
        [join(WEB, "built/LICENSES.txt"), `${licences(BUNDLED)}\n`],
        [join(VIEWER, "page.html"), readFileSync(join(SOURCES, "viewer/page.html"), "utf8")],
        [join(VIEWER, "viewer.js"), script],
    ];
}

/** Built kernels that differ, where the compiler is the one that the committed bytes are of. */
function staleKernels() {
    const [theirs, ours] = [readFileSync(join(WEB, "built/compiler.txt"), "utf8").trim(), compiler()];
    if (theirs !== ours) {
        console.log(`kernels are not compared: they were built by ${theirs}; here is ${ours ?? "no clang"}`);
        return [];
    }
    return Object.entries(KERNEL_BUILDS).filter(([path, options]) => !readFileSync(join(WEB, path)).equals(compileKernels(options))).map(([path]) => path);
}

const check = process.argv.includes("--check");
const stale = check ? staleKernels() : [];
for (const [path, content] of await products()) {
    if (check) {
        if (!existsSync(path) || readFileSync(path, "utf8") !== content) stale.push(relative(WEB, path));
    } else {
        mkdirSync(dirname(path), { recursive: true });
        writeFileSync(path, content);
    }
}
if (stale.length > 0) {
    console.error(`not what the sources build: ${stale.join(", ")}; run npm run kernels and npm run build`);
    process.exit(1);
}
