// Everything that is committed as built, from sources: the kernels by `npm run kernels`, the rest by `npm run build`.
// `npm run build -- --check` writes nothing and fails if what is committed is not what the sources build.
import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { build } from "esbuild";
import { compileKernels, compiler, KERNEL_BUILDS, WEB } from "./kernels.mjs";

const VIEWER = join(WEB, "../../src/bsm/viewer");
const SOURCES = join(WEB, "src");
const OPTIONS = { bundle: true, minify: true, format: "esm", target: "es2022", charset: "utf8", loader: { ".wasm": "binary", ".html": "text" }, tsconfigRaw: { compilerOptions: { useDefineForClassFields: false } }, legalComments: "none", logLevel: "warning", write: false };
const BUNDLED = ["three", "fzstd"];

/** Puts another module in the place of some. */
const instead = (modules, name) => ({
    name,
    setup({ onResolve }) {
        onResolve({ filter: new RegExp(`^\\./(${modules.join("|")})$`) }, () => ({ path: join(SOURCES, name) }));
    },
});

/**
 * Leaves out what most meshes can do without: sequences, attributes, split vertices, damage, packed coefficients, and
 * decoding while the page does something else.
 */
const SMALL = instead(["sequence", "attributes", "declaration", "splits", "station", "tolerant", "zstd"], "absent.ts");

/**
 * Names of private members, which may be shortened: those by which nothing else is called than a member of `this`, so that
 * neither the platform, nor who uses the decoder, nor a string can mean the same.
 */
function privateNames() {
    const texts = readdirSync(SOURCES).filter((name) => name.endsWith(".ts")).map((name) => readFileSync(join(SOURCES, name), "utf8"));
    const code = texts.join("\n").replace(/\/\*[^]*?\*\/|\/\/.*$/gm, "");
    const names = [...code.matchAll(/(?:private|protected)(?: (?:readonly|override|async|get|set))* (\w+)/g)].map(([, name]) => name);
    const others = code.replace(/(?:private|protected)(?: \w+)* \w+\??: /g, "");
    const elsewhere = (name) => new RegExp(`(?<!\\bthis)[.]${name}\\b|\\b${name}\\??: |"${name}"`).test(others);
    return [...new Set(names)].filter((name) => !elsewhere(name)).sort();
}

async function bundle(entry, options = {}) {
    const result = await build({ ...OPTIONS, ...options, entryPoints: [entry] });
    return result.outputFiles[0].text;
}

/** A decoder as a module. */
function plain(entry, plugins = []) {
    return bundle(join(SOURCES, entry), { plugins, mangleProps: new RegExp(`^(${privateNames().join("|")})$`) });
}

/** The same inside of one function, `bsm`, whose text threads are made of. */
async function decoder(entry, plugins) {
    const text = await plain(entry, plugins);
    const [exports, list] = /export\{([^}]*)\};\s*$/.exec(text);
    const names = list.split(",").map((item) => item.split(" as ").reverse());
    const given = names.map(([name, own]) => (own ? `${name}:${own}` : name));
    return `const made=function bsm(){${text.slice(0, -exports.length)}return{${given}}};export const{${names.map(([name]) => name)}}=made();\n`;
}

/** Takes the decoder from another script, or from its text. */
const using = (resolved) => ({
    name: "using",
    setup({ onResolve, onLoad }) {
        onResolve({ filter: /\/index$/ }, () => (resolved.path ? { path: resolved.path, external: true } : { path: "bsm.js", namespace: "decoder" }));
        onLoad({ filter: /./, namespace: "decoder" }, () => ({ contents: resolved.text, loader: "js" }));
    },
});

function licences(packages) {
    return packages.map((name) => `${name}\n\n${readFileSync(join(WEB, "node_modules", name, "LICENSE"), "utf8").trim()}`).join("\n\n\n");
}

/** Path and content of everything that is built of TypeScript. */
async function products() {
    const define = { LICENCES: JSON.stringify(licences(BUNDLED)) };
    const whole = await decoder("index.ts");
    const script = (await bundle(join(SOURCES, "viewer/viewer.ts"), { define, plugins: [using({ text: whole })] })).replaceAll("</script", "<\\/script");
    return [
        [join(WEB, "built/bsm.js"), whole],
        [join(WEB, "built/small.js"), await decoder("small.ts", [SMALL])],
        [join(WEB, "built/quick.js"), await plain("quick.ts", [SMALL])],
        [join(WEB, "built/three.js"), await bundle(join(SOURCES, "three.ts"), { external: ["three"], plugins: [using({ path: "./bsm.js" })] })],
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
