// Everything that is committed as built, from sources: the kernels by `npm run kernels`, the rest by `npm run build`.
// `npm run build -- --check` writes nothing and fails if what is committed is not what the sources build.
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { build, transform } from "esbuild";
import { minify } from "terser";
import { compileKernels, compiler, fingerprint, KERNEL_BUILDS, WEB } from "./kernels.mjs";
import { drawingOnly } from "./three.mjs";

const VIEWER = join(WEB, "../src/bsm/viewer");
const SOURCES = join(WEB, "src");
const OPTIONS = {
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    charset: "utf8",
    loader: { ".html": "text", ".wasm": "binary" },
    tsconfigRaw: { compilerOptions: { useDefineForClassFields: false } },
    legalComments: "none",
    logLevel: "warning",
    write: false,
};
const BUNDLED = ["three"];

const SENTENCE =
    /(new (?:Format|Unsupported|Corrupt|Truncated|Limit|Numeric|Range|Type)?Error\(|[.]nonsense\(|\brefuse\()\s*(?:"[^"\n]*"|`(?:[^`$\\]|\$\{[^{}`]*\})*`)(?=\s*[,)])/g;
/** Leaves out what errors say: a pool asks the full decoder for the error of a stream. */
const TERSE = {
    name: "terse",
    setup({ onLoad }) {
        onLoad({ filter: /src.\w+\.ts$/ }, ({ path }) => ({
            contents: readFileSync(path, "utf8").replace(SENTENCE, '$1""'),
            loader: "ts",
        }));
    },
};

/** Styles of pages in fewer bytes. */
const STYLED = {
    name: "styled",
    setup({ onLoad }) {
        onLoad({ filter: /\.html$/ }, async ({ path }) => {
            const page = readFileSync(path, "utf8");
            const [, style] = /<style>([^]*?)<\/style>/.exec(page);
            const { code } = await transform(style, { loader: "css", minify: true, target: "es2022" });
            const brief = page.replace(style, () => code.trim()).replace(/\n\s+(?=<\/?(?:path|d[dt]|option)\b)/g, "");
            return { contents: brief.replace(/\n\s+/g, "\n"), loader: "text" };
        });
    },
};

/** The elements of well-formed HTML without texts: the name, the attributes and the children of each. */
function treesOf(html) {
    const all = [null, {}];
    const open = [all];
    for (const [, end, tag, attributes, isEmpty] of html.matchAll(
        /<(\/?)(\w+)((?:\s+[\w-]+(?:="[^"]*")?)*)\s*(\/?)>/g,
    )) {
        if (end) {
            if (open.pop()[0] !== tag) throw new Error(`player.html: </${tag}> ends another element`);
            continue;
        }
        const pairs = [...attributes.matchAll(/([\w-]+)(?:="([^"]*)")?/g)].map(([, name, value = ""]) => [name, value]);
        const element = [tag, Object.fromEntries(pairs)];
        open.at(-1).push(element);
        if (!isEmpty) open.push(element);
    }
    return all.slice(2);
}

/** The page of players as elements and a sheet of styles: policies forbid a text of both. */
const TREES = {
    name: "trees",
    setup({ onLoad }) {
        onLoad({ filter: /player\.html$/ }, async ({ path }) => {
            const [, style, rest] = /<style>([^]*?)<\/style>([^]*)/.exec(readFileSync(path, "utf8"));
            const { code } = await transform(style, { loader: "css", minify: true, target: "es2022" });
            const contents = `export const style = ${JSON.stringify(code.trim())}; export default ${JSON.stringify(treesOf(rest))};`;
            return { contents, loader: "js" };
        });
    },
};

/** Meshes without attributes are drawn as they are. */
const BARE = {
    name: "bare",
    setup({ onResolve }) {
        onResolve({ filter: /^\.\/parting$/ }, () => ({ path: join(SOURCES, "absent.ts") }));
    },
};

/** A loader with the decoder of light grids inside. */
const NEAR = {
    name: "near",
    setup({ onResolve }) {
        onResolve({ filter: /^\.\/source$/ }, ({ importer }) =>
            importer.endsWith("near.ts") ? undefined : { path: join(SOURCES, "near.ts") },
        );
        onResolve({ filter: /^quick\.wasm$/ }, () => ({ path: join(WEB, "built/quick.wasm") }));
    },
};

/** Modules that are files of their own beside the one that asks for them. */
const BESIDE = {
    content: "content.js",
    encode: "encode.js",
    encoding: "encoding.js",
    errors: "errors.js",
    gltf: "gltf.js",
    index: "bsm.js",
    pool: "pool.js",
    scene: "scene.js",
    three: "three.js",
    workerSmall: "small-worker.js",
};
const beside = (...names) => ({
    name: "beside",
    setup({ onResolve }) {
        onResolve({ filter: new RegExp(`^\\./(${names.join("|")})$`) }, ({ path, kind }) =>
            kind === "entry-point" ? undefined : { path: `./${BESIDE[path.slice(2)]}`, external: true },
        );
    },
});

/**
 * Names of private members, which may be shortened: those by which nothing else is called than a member of `this`, so that
 * neither the platform, nor who uses the decoder, nor a string can mean the same.
 */
function privateNames() {
    const texts = readdirSync(SOURCES)
        .filter((name) => name.endsWith(".ts"))
        .map((name) => readFileSync(join(SOURCES, name), "utf8"));
    const code = texts.join("\n").replace(/\/\*[^]*?\*\/|\/\/.*$/gm, "");
    const names = [...code.matchAll(/(?:private|protected)(?: (?:readonly|override|async|get|set))* (\w+)/g)].map(
        ([, name]) => name,
    );
    const others = code.replace(/(?:private|protected)(?: \w+)* \w+\??: /g, "");
    const elsewhere = (name) => new RegExp(`(?<!\\bthis)[.]${name}\\b|\\b${name}\\??: |"${name}"`).test(others);
    return [...new Set(names)].filter((name) => !elsewhere(name)).sort();
}

async function bundle(entry, options = {}) {
    const result = await build({ ...OPTIONS, ...options, entryPoints: entry ? [entry] : undefined });
    return result.outputFiles[0].text;
}

/** A module in fewer bytes. */
async function smaller(text) {
    return (await minify(text, { module: true, ecma: 2022, compress: { passes: 3 } })).code;
}

/** A module that others call by all of its names. */
function open(entry, ...plugins) {
    return bundle(join(SOURCES, entry), {
        plugins,
        external: ["three", "three/addons/*", "@react-three/fiber", "@gltf-transform/core", "@babylonjs/*"],
    });
}

/** A module of the decoder: private names are short. */
function plain(entry, plugins) {
    return bundle(join(SOURCES, entry), { plugins, mangleProps: new RegExp(`^(${privateNames().join("|")})$`) });
}

/** The whole decoder inside of one function, `bsm`, whose text makes threads without a file. */
async function inlined() {
    const text = await plain("index.ts", []);
    const [exports, list] = /export\{([^}]*)\};\s*$/.exec(text);
    const names = list.split(",").map((item) => item.split(" as ").reverse());
    const given = names.map(([name, own]) => (own ? `${name}:${own}` : name));
    const code = `const made=function bsm(){${text.slice(0, -exports.length)}return{${given}}};export const bsm=made;export const{${names.map(([name]) => name)}}=made();\n`;
    return {
        name: "inlined",
        setup({ onResolve, onLoad }) {
            onResolve({ filter: /\/(index|errors|workerSmall)$/ }, () => ({ path: "bsm.js", namespace: "decoder" }));
            onLoad({ filter: /./, namespace: "decoder" }, () => ({ contents: code, loader: "js" }));
        },
    };
}

/** Methods that only code of the same thread calls: no message has them, nor the platform. */
const INNER =
    "receiveData receiveEof nextEvent receiveBlock nextBlock release doubles creased grown addFrame startRun flush settle placesOf guarded findHelpers accept pause bounds crc32 crc16 charge losses handed located described moved changes wishes members onBlock onOver engine carried attribute begin decoder finish growing hear last listener metadata moves points received report rows sources state text waiting".split(
        " ",
    );

/** A thread in one file, so that no request waits for another: all of a module, which then serves; pages may import it. */
function thread(module, plugins = [], isImported = false) {
    const shared = `export { openDesk } from "./${module}"; if (globalThis.WorkerGlobalScope)`;
    const contents = `import { serve } from "./${module}"; ${isImported ? shared : ""} serve();`;
    const mangleProps = new RegExp(`^(${[...privateNames(), ...INNER].join("|")})$`);
    return bundle(undefined, { stdin: { contents, resolveDir: SOURCES }, plugins, mangleProps });
}

function licenses(packages) {
    return packages
        .map((name) => `${name}\n\n${readFileSync(join(WEB, "node_modules", name, "LICENSE"), "utf8").trim()}`)
        .join("\n\n\n");
}

/** Path and content of everything that is built of TypeScript. */
async function products() {
    const define = { LICENSES: JSON.stringify(licenses(BUNDLED)) };
    const mangleProps = /^_/; // names that three.js uses for its private members
    const script = (
        await smaller(
            await bundle(join(SOURCES, "viewer/viewer.ts"), {
                define,
                mangleProps,
                plugins: [await inlined(), STYLED, drawingOnly(WEB)],
            }),
        )
    ).replaceAll("</script", "<\\/script");
    const built = {
        "errors.js": await plain("errors.ts", []),
        "bsm.js": await plain("index.ts", [beside("errors")]),
        "small.js": await plain("small.ts", [BARE, beside("errors")]),
        "quick.js": await plain("quick.ts", [TERSE, beside("errors"), BARE]),
        "worker.js": await thread("index"),
        "small-worker.js": await thread("workerSmall", [TERSE, BARE], true),
        "pool.js": await open("pool.ts", beside("errors", "index", "workerSmall")),
        "main.js": await open("facade.ts", beside("errors", "index", "pool")),
        "three.js": await open("three.ts", beside("index", "scene", "workerSmall")), // with its pool: no request waits for another
        "three-near.js": await open("three.ts", beside("index", "scene", "workerSmall"), NEAR, TERSE), // no request and no thread for small streams
        "scene.js": await open("scene.ts", beside()),
        "gltf.js": await open("gltf.ts", beside("three")),
        "gltf-transform.js": await open("transform.ts", beside("encode", "errors", "index", "pool")),
        "babylon.js": await open("babylon.ts", beside("errors", "index", "pool")),
        "encode.js": await open("encode.ts", beside("content", "encoding", "errors")),
        "reading.js": await open("together.ts", beside("content", "encode", "encoding", "errors", "gltf")),
        "content.js": await open("content.ts", beside("encoding")),
        "encoding.js": await plain("encoding.ts", []),
        "encode-worker.js": await thread("encoding"),
        "player.js": await open("player.ts", beside("scene", "three"), TREES),
        "player-three.js": await bundle(join(SOURCES, "player.ts"), {
            plugins: [beside("errors", "index", "pool", "workerSmall"), TREES],
            mangleProps,
        }),
        "react.js": await open("react.ts", beside("three")),
    };
    return [
        ...(await Promise.all(
            Object.entries(built).map(async ([name, text]) => [join(WEB, "built", name), `${await smaller(text)}\n`]),
        )),
        [join(WEB, "built/LICENSES.txt"), `${licenses(BUNDLED)}\n`],
        [join(VIEWER, "viewer.js"), script],
        [join(VIEWER, "encoder.js"), await smaller(await bundle(join(SOURCES, "viewer/encoder.ts")))],
    ];
}

/**
 * Built kernels that are not of these sources. The fingerprint tells that without a compiler; with the one that made
 * them, those that came out the same are left out.
 */
function staleKernels() {
    const [theirs, sources] = readFileSync(join(WEB, "built/compiler.txt"), "utf8").split("\n");
    if (sources === fingerprint()) return [];
    const ours = compiler();
    const paths = Object.keys(KERNEL_BUILDS);
    if (theirs !== ours) {
        console.log(
            `the kernels are of other sources: run \`npm run kernels\` with ${theirs} (here: ${ours ?? "no clang"})`,
        );
        return paths;
    }
    return paths.filter((path) => !readFileSync(join(WEB, path)).equals(compileKernels(KERNEL_BUILDS[path])));
}

const check = process.argv.includes("--check");
const stale = check ? staleKernels() : [];
const made = await products();
for (const name of readdirSync(join(WEB, "built"))) {
    const path = join(WEB, "built", name);
    if (!name.endsWith(".js") || made.some(([own]) => own === path)) continue;
    if (check) stale.push(relative(WEB, path));
    else rmSync(path);
}
for (const [path, content] of made) {
    if (check) {
        if (!existsSync(path) || !readFileSync(path).equals(Buffer.from(content))) stale.push(relative(WEB, path));
    } else {
        mkdirSync(dirname(path), { recursive: true });
        writeFileSync(path, content);
    }
}
if (stale.length > 0) {
    console.error(`not what the sources build: ${stale.join(", ")}; run npm run kernels and npm run build`);
    process.exit(1);
}
