// The kernels of `bitstream` and `codec` as WebAssembly with vector instructions: `npm run kernels`.
import { execFileSync, spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { delimiter, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const WEB = dirname(dirname(fileURLToPath(import.meta.url)));
const ROOT = join(WEB, "..");

/** C files below a folder of the repository. */
function sourcesIn(folder) {
    return readdirSync(join(ROOT, folder), { recursive: true })
        .filter((name) => name.endsWith(".c"))
        .map((name) => join(folder, name))
        .sort();
}

/** All that a decoder is made of; the linker takes what those functions that are asked for need. */
const SOURCES = ["bitstream", "codec", "library"]
    .flatMap(sourcesIn)
    .filter(
        (path) =>
            !/^codec\/(denoise|look|static\/choice|geometry\/metrics)|^library\/(examples|python|ahead)/.test(path),
    );

/** Functions for what is drawn (library/wasm/draw.c). */
const DRAW = ["page_move", "page_grow", "page_crease", "page_bounds"];
/** Functions for the page (library/wasm/page.c, library/bsmdec.h). */
const PAGE = [
    ...[
        "take",
        "give",
        "open",
        "close",
        "share",
        "next",
        "error",
        "state",
        "header",
        "loose",
        "metadata",
        "handed",
        "room",
        "add",
        "lose",
        "changes",
        "losses",
    ].map((name) => `page_${name}`),
    ...DRAW,
    ...["push", "finish", "faces", "positions", "attribute_at", "attribute_values", "attribute_indices"].map(
        (name) => `bsmdec_${name}`,
    ),
];
/** Functions for a page that decodes light grids alone (library/wasm/light.c). */
const LIGHT = [
    "page_take",
    "page_give",
    ...DRAW,
    ...["open", "close", "charge", "sum", "short_sum", "sum_of_positions", "error", "begin", "faces", "positions"].map(
        (name) => `light_${name}`,
    ),
];

/** Functions for a page that encodes (library/wasm/encode.c). */
const ENCODE = [
    "page_take",
    "page_give",
    ...["begin", "attribute", "metadata", "run", "message", "bytes", "size", "end"].map((name) => `encode_${name}`),
];

const TARGET = "--target=wasm32";
const FLAGS = [
    TARGET,
    "-std=gnu11",
    "-ffreestanding",
    "-fno-builtin",
    "-ffp-contract=off",
    "-ffunction-sections",
    "-fdata-sections",
    "-fvisibility=hidden",
    "-Wno-unknown-pragmas",
    "-mbulk-memory",
    "-isystem",
    "library/wasm/include",
];

const LINK = [
    "-Wl,--no-entry",
    "-Wl,--gc-sections",
    "-Wl,--lto-O2",
    "-Wl,--strip-all",
    "-Wl,-z,stack-size=262144",
    "-Wl,--stack-first",
    "-Wl,--max-memory=4294967296",
];

/** Sources that charge and take memory: what is over the kernels. */
const DRIVERS =
    /^library|^bitstream\/(context|pool|container|payloads)|^codec\/(basis\/(structure|dictionaries)|signal\/(chain|assembly|layer)|sequence\/(parts|gop|frames))\.c/;

/**
 * Sources whose functions are copied to where they are called only if that makes them smaller: they are not the slow
 * ones.
 */
const LEAN = /connectivity|attributes|fields|codec\/blocks|fronts\.c|geometry/;

/** Name and version of the compiler, of which the bytes are a function; undefined where there is none. */
export function compiler() {
    const { stdout } = spawnSync("clang", ["--version"], { encoding: "utf8" });
    return stdout?.split("\n")[0];
}

/**
 * What tells the built kernels and all that they are built of, but for the compiler: where it is as written, they are
 * not compiled again to compare.
 */
export function fingerprint() {
    const hash = createHash("sha256");
    const headers = ["bitstream", "codec", "library"]
        .flatMap((folder) =>
            readdirSync(join(ROOT, folder), { recursive: true })
                .filter((name) => name.endsWith(".h"))
                .map((name) => join(folder, name)),
        )
        .sort();
    const own = ["package-lock.json", "scripts/kernels.mjs", ...Object.keys(KERNEL_BUILDS)].map((name) =>
        join("web", name),
    );
    for (const path of [...SOURCES, ...headers, "spec/priors.bin", "spec/start.bin", ...own])
        hash.update(path).update(readFileSync(join(ROOT, path)));
    return hash.digest("hex");
}

/** Where programs are, but for those of packages: clang would call a wasm-opt of its own accord, with other options. */
function withoutPackages() {
    return process.env.PATH.split(delimiter)
        .filter((folder) => !folder.includes("node_modules"))
        .join(delimiter);
}

/** Slots that nothing was learnt for have one of these, and a count of 0. */
const UNLEARNT = [2048, 409, 3686];

/** Numbers as places in a list of the different ones, which are few. */
function indexed(numbers) {
    const list = [...new Set(numbers)].sort((a, b) => a - b);
    return { list, places: numbers.map((number) => list.indexOf(number)) };
}

/** What coefficients start from (specification, M 9.1), as bytes that are easier to compress, and `make_priors`, which makes it of them: for every
 * slot, by node, bin and expectation, its count, or which of `UNLEARNT` it is; the probabilities of the others; weights. */
function packedPriors(bytes) {
    const words = new Uint16Array(bytes.buffer, bytes.byteOffset, bytes.length / 2);
    const [expectations, bins, nodes] = [3, 48, 38];
    const slots = expectations * bins * nodes;
    const others = words.length - slots;
    const [counts, probabilities, weights] = [[], [], [...words.slice(0, others)]];
    for (let i = 0; i < slots; i++) {
        const [node, bin, expectation] = [
            Math.floor(i / expectations / bins),
            Math.floor(i / expectations) % bins,
            i % expectations,
        ];
        const word = words[others + (expectation * bins + bin) * nodes + node];
        const [count, probability] = [word & 15, word >> 4];
        if (count === 0 && !UNLEARNT.includes(probability))
            throw new Error("a slot that nothing was learnt for has another probability");
        counts.push(count || -UNLEARNT.indexOf(probability));
        if (count > 0) probabilities.push(probability);
    }
    const [count, share, number] = [counts, probabilities, weights].map(indexed);
    return `#include <stdint.h>
unsigned char PRIORS[${bytes.length}];
static const uint8_t COUNTS[] = {${count.places}}, SHARES[] = {${share.places}}, NUMBERS[] = {${number.places}};
static void set(int place, unsigned value) {
    PRIORS[2 * place] = (unsigned char)value;
    PRIORS[2 * place + 1] = (unsigned char)(value >> 8);
}
void make_priors(void) {
    static const uint16_t NUMBER[] = {${number.list}};
    static const uint16_t SHARE[] = {${share.list}}, UNLEARNT[] = {${UNLEARNT}};
    static const int8_t COUNT[] = {${count.list}};
    const uint8_t *count = COUNTS, *share = SHARES;
    for (int i = 0; i < ${others}; i++) set(i, NUMBER[NUMBERS[i]]);
    for (int node = 0; node < ${nodes}; node++)
        for (int i = 0; i < ${expectations * bins}; i++) {
            int seen = COUNT[*count++];
            unsigned probability = seen > 0 ? SHARE[*share++] : UNLEARNT[-seen];
            set(${others} + (i % ${expectations} * ${bins} + i / ${expectations}) * ${nodes} + node, probability << 4 | (seen > 0 ? seen : 0));
        }
}
`;
}

/** Compare the priors that the kernels make with those of the repository. */
function checkPriors(clang, object, priors, target) {
    const exported = ["make_priors", "PRIORS"].map((name) => `-Wl,--export=${name}`);
    clang(TARGET, "-nostdlib", object, "-Wl,--no-entry", "-Wl,--initial-memory=2097152", ...exported, "-o", target);
    const { exports } = new WebAssembly.Instance(new WebAssembly.Module(readFileSync(target)));
    exports.make_priors();
    const made = new Uint8Array(exports.memory.buffer, exports.PRIORS.value, priors.length);
    if (priors.some((value, i) => made[i] !== value))
        throw new Error("the kernels make other priors than the repository has");
}

/**
 * Sources of what takes most time, which are compiled for speed, and not for their size alone; vectors that they do not
 * ask for make them slower.
 */
const FAST = /basis\/cholesky|codec\/blocks|conquest|fields\/(layer|expectation|grid)/;

/** Those of the decoder of everything and of the encoder of pages, which would be too large with all of them. */
const FAST_OF_ALL = /conquest|fields\/(layer|expectation|grid)/;
const FAST_TO_ENCODE = /fields\/(layer|expectation|grid)/;
const NOTHING = /^$/;
const SPEED = ["-fno-vectorize", "-fno-slp-vectorize"];

/**
 * Sources that stay apart when the rest is optimized as one: what runs WebAssembly compiles smaller functions sooner.
 */
const APART = /basis\/structure|payloads\/topology|signal\/layer|library\/stages/;

/** How a source is compiled; the decoder of light grids is the smallest. */
function optionsOf(source, fast, light) {
    if (fast.test(source)) return ["-O2", ...SPEED];
    return [
        "-Oz",
        ...(APART.test(source) && !light ? [] : ["-flto"]),
        ...(LEAN.test(source) || DRIVERS.test(source) ? ["-DBSM_LEAN"] : []),
        ...(light ? [`-DBSMDEC_LIGHT=${light}`] : []),
    ];
}

/** A build of static meshes without attributes, and without more. */
function still(more, lacks) {
    const rest =
        /(library\/(sequence|attribute|attribute_set|split|whole)|codec\/sequence\/(gop|parts|frames)|container\/declaration|payloads\/zstd)\.c/;
    return {
        without: new RegExp(`${rest.source}|${more.source}`),
        lacks: `${lacks} || record.count[SEQUENCE] || record.number[PAPER][0] > 0 || header->attributes`,
    };
}

/**
 * Every build: what of the decoder it is without, which headers ask for that, and which sources are compiled for speed;
 * `light`: for light grids alone, 2: with congruent parts, too; `writes`: the encoder; `long`: without brief streams.
 */
export const KERNEL_BUILDS = {
    "built/kernels.wasm": { fast: FAST_OF_ALL },
    "built/small.wasm": still(NOTHING, "false"),
    "built/grid.wasm": still(/^codec(?!\/basis\/structure)/, "!header->on_grid"),
    "built/blocks.wasm": { ...still(/payloads\/grid\.c/, "header->on_grid"), long: true },
    "built/moving.wasm": {
        without:
            /(library\/(attribute|attribute_set|split|whole)|payloads\/(grid|zstd)|signal\/layer|container\/declaration)\.c/,
        long: true,
        lacks: "header->on_grid || header->refined || record.number[PAPER][0] > 0 || header->attributes",
    },
    "built/encode.wasm": {
        exported: ENCODE,
        fast: FAST_TO_ENCODE,
        writes: true,
        without:
            /^codec(?!\/basis\/structure)|fields\/(twins|images)|payloads\/zstd\.c|library\/(sequence|split|whole|changes)\.c|library\/encode\/moving\.c|library\/wasm\/(page|light)\.c/,
        long: true,
        lacks: "!header->on_grid || header->congruence",
    },
    "built/encode-moving.wasm": {
        exported: [...ENCODE, "make_priors"],
        writes: true,
        without:
            /fields\/(twins|images)|payloads\/zstd\.c|signal\/layer\.c|library\/(split|whole|changes)\.c|library\/wasm\/(page|light)\.c/,
        long: true,
        lacks: "header->on_grid || header->refined || record.number[PAPER][0] > 0",
    },
    "built/quick.wasm": { exported: LIGHT, without: /^codec(?!\/basis\/structure)/, fast: /conquest/, light: 1 },
    "built/parts.wasm": { exported: LIGHT, without: /^codec(?!\/basis\/structure)/, fast: NOTHING, light: 2 }, // CAD: small
};

/** Bytes of the learnt start that light grids use: weights of whole vertices (V 17.11). */
const WEIGHTS_OF_WHOLE = 40;

/** Objects of sources, which builds have in common. */
const compiled = new Map();

/** One of them. */
export function compileKernels({
    exported = PAGE,
    without,
    lacks,
    fast = FAST,
    light = 0,
    writes = false,
    long = false,
}) {
    const folder = mkdtempSync(join(tmpdir(), "bsm-kernels-"));
    try {
        const data = join(folder, "data.c");
        const priors = Uint8Array.from(readFileSync(join(ROOT, "spec/priors.bin")));
        // Light grids start with the last weights alone (V 17.12): the others compress to nothing.
        const learnt = readFileSync(join(ROOT, "spec/start.bin"));
        const start = [...learnt].map((byte, i) => (light && i < learnt.length - WEIGHTS_OF_WHOLE ? 0 : byte));
        writeFileSync(data, `${packedPriors(priors)}const unsigned char START[] = {${start}};\n`);
        const target = join(folder, "kernels.wasm");
        const clang = (...args) =>
            execFileSync("clang", args, { cwd: ROOT, env: { ...process.env, PATH: withoutPackages() } });
        const objects = [...SOURCES, data].map((source, i) => {
            const object = join(folder, `${i}.o`);
            const options = [
                ...FLAGS,
                writes ? "-DBSMDEC_WRITES" : "-DBSM_DECODER",
                ...optionsOf(source, fast, light),
                ...(without && DRIVERS.test(source)
                    ? [
                          ...(writes ? [] : ["-DBSMDEC_TERSE"]),
                          ...(lacks ? [`-DBSMDEC_LACKS=(${lacks})`] : []),
                          ...(long ? ["-DBSMDEC_LONG=1"] : []),
                      ]
                    : []),
                "-msimd128",
                "-I",
                ".",
                "-c",
                source,
            ];
            const key = options.join(" ");
            if (source === data || !compiled.has(key)) {
                clang(...options, "-o", object);
                compiled.set(key, readFileSync(object));
            } else writeFileSync(object, compiled.get(key));
            return object;
        });
        checkPriors(clang, objects.at(-1), priors, target);
        clang(
            TARGET,
            "-nostdlib",
            ...objects.filter((_, i) => !without?.test(SOURCES[i])),
            ...LINK,
            ...(without ? ["-Wl,--unresolved-symbols=ignore-all"] : []),
            ...exported.map((name) => `-Wl,--export=${name}`),
            "-o",
            target,
        );
        const features = [
            "--enable-bulk-memory",
            "--enable-sign-ext",
            "--enable-nontrapping-float-to-int",
            "--enable-simd",
        ];
        // The stack grows down to the first address, which it never reaches: so no pointer wraps where a constant is
        // added.
        const passes = [
            "-Oz",
            "--converge",
            "--low-memory-unused",
            "--flatten",
            "--rereloop",
            "-Oz",
            "-Oz",
            "--one-caller-inline-max-function-size=100",
        ];
        execFileSync(join(WEB, "node_modules/.bin/wasm-opt"), [target, ...passes, ...features, "-o", target]);
        return readFileSync(target);
    } finally {
        rmSync(folder, { recursive: true });
    }
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    for (const [path, options] of Object.entries(KERNEL_BUILDS))
        writeFileSync(join(WEB, path), compileKernels(options));
    writeFileSync(join(WEB, "built/compiler.txt"), `${compiler()}\n${fingerprint()}\n`);
}
