// The kernels of `bitstream` and `codec` as WebAssembly, with and without vector instructions: `npm run kernels`.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { delimiter, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const WEB = dirname(dirname(fileURLToPath(import.meta.url)));
const ROOT = join(WEB, "../..");

/** C files below a folder of the repository. */
function sourcesIn(folder) {
    return readdirSync(join(ROOT, folder), { recursive: true }).filter((name) => name.endsWith(".c")).map((name) => join(folder, name)).sort();
}

/** Whether a file holds tables, which the kernels make for themselves, by `tables.c`. */
const isTable = (path) => readFileSync(join(ROOT, path), "utf8").startsWith("/* Written by");

/** All kernels; the linker takes what those that are asked for need. Filters have no place in a decoder, and need a C library. */
const FOUND = ["bitstream", "codec"].flatMap(sourcesIn).filter((path) => !path.startsWith("codec/denoise"));
const SOURCES = [...FOUND.filter((path) => !isTable(path)), ...sourcesIn("tools/web/src")];
const TABLES = FOUND.filter(isTable);

const KERNELS = [
    "make_tables", "make_value_tables", "learn_beforehand", "add_noise",
    "code_one_unsigned", "match_halfedges", "conquer", "code_fans", "code_degenerate", "code_steps", "code_turns",
    "code_labels", "points_of_levels", "code_block", "bisect", "refine_partition",
    "group_by_label", "chain_blocks", "order_scratch", "order_block", "add_copies", "collect_edges",
    "find_fronts", "suspend", "factorize_fronts", "continue_known", "resize_columns", "cosines", "iteration_space", "iterate", "completion_space", "complete_columns",
    "multiply_matrices", "turn_columns", "reconstruct", "look_around", "smooth_all",
    "find_rings", "filter_rows", "link_corners", "order_vertices", "code_grid", "code_floats", "code_light", "place_values", "code_levels",
    "local_frames", "add_heights", "add_slides", "tangent_steps", "code_matrix", "project", "code_edges", "join_corners",
    "expect_normals", "code_scalars", "code_texcoords", "code_normals", "code_faces", "cotangents", "hold", "pull", "learn_around", "follow_rows",
];

const TARGET = "--target=wasm32";
const FLAGS = [
    TARGET, "-DBSM_DECODER", "-std=gnu11", "-ffreestanding", "-fno-builtin", "-ffp-contract=off", "-ffunction-sections",
    "-fdata-sections", "-fvisibility=hidden", "-Wno-unknown-pragmas",
];

const LINK = [
    "-Wl,--no-entry", "-Wl,--gc-sections", "-Wl,--strip-all", "-Wl,-z,stack-size=262144", "-Wl,--stack-first", "-Wl,--max-memory=4294967296",
];

/** Sources whose functions are copied to where they are called only if that makes them smaller: they are not the slow ones. */
const LEAN = /connectivity|attributes|fields|codec\/blocks|fronts\.c|geometry/;

/** Kernels of sequences, and of split vertices. */
const FRAMES = ["continue_known", "cosines", "multiply_matrices", "turn_columns", "completion_space", "complete_columns", "code_matrix", "project", "cotangents", "hold", "pull", "learn_around", "follow_rows"];
/** Kernels of attributes. */
const ATTRIBUTES = ["code_edges", "join_corners", "expect_normals", "code_scalars", "code_texcoords", "code_normals", "code_faces"];
/** Kernels of light grids. */
const LIGHT = ["link_corners", "code_light", "place_values"];
/** Kernels of grids and refinements. */
const FIELDS = [
    "make_value_tables", "order_vertices", "code_grid", "code_floats", "code_levels", "local_frames", "add_heights", "add_slides",
    "tangent_steps",
];
/** Kernels of blocks. */
const BLOCKS = [
    "learn_beforehand", "add_noise", "points_of_levels", "code_block", "code_labels", "bisect", "refine_partition",
    "group_by_label", "chain_blocks", "order_scratch", "order_block", "add_copies", "collect_edges", "find_fronts", "suspend", "factorize_fronts",
    "continue_known", "resize_columns", "cosines", "iteration_space", "iterate", "cholesky_onorm", "householder", "reconstruct", "look_around",
    "smooth_all", "find_rings", "filter_rows",
];

/** Name and version of the compiler, of which the bytes are a function; undefined where there is none. */
export function compiler() {
    const { stdout } = spawnSync("clang", ["--version"], { encoding: "utf8" });
    return stdout?.split("\n")[0];
}

/** Where programs are, but for those of packages: clang would call a wasm-opt of its own accord, with other options. */
function withoutPackages() {
    return process.env.PATH.split(delimiter).filter((folder) => !folder.includes("node_modules")).join(delimiter);
}

/** Slots that nothing was learnt for have one of these, and a count of 0. */
const UNLEARNT = [2048, 409, 3686];

/** Numbers as places in a list of the different ones, which are few. */
function indexed(numbers) {
    const list = [...new Set(numbers)].sort((a, b) => a - b);
    return { list, places: numbers.map((number) => list.indexOf(number)) };
}

/**
 * What coefficients start from (specification, M 9.1), as bytes that are easier to compress: for every slot, by node, bin and
 * expectation, its count, or which of `UNLEARNT` it is; the probabilities of the others; weights. `learn_beforehand`
 * makes a model of them.
 */
function packedPriors(bytes) {
    const words = new Uint16Array(bytes.buffer, bytes.byteOffset, bytes.length / 2);
    const [expectations, bins, nodes] = [3, 48, 38];
    const slots = expectations * bins * nodes;
    const others = words.length - slots;
    const [counts, probabilities, weights] = [[], [], [...new Int16Array(words.slice(0, others).buffer)]];
    for (let i = 0; i < slots; i++) {
        const [node, bin, expectation] = [Math.floor(i / expectations / bins), Math.floor(i / expectations) % bins, i % expectations];
        const word = words[others + (expectation * bins + bin) * nodes + node];
        const [count, probability] = [word & 15, word >> 4];
        if (count === 0 && !UNLEARNT.includes(probability)) throw new Error("a slot that nothing was learnt for has another probability");
        counts.push(count || -UNLEARNT.indexOf(probability));
        if (count > 0) probabilities.push(probability);
    }
    const [count, share, number] = [counts, probabilities, weights].map(indexed);
    return `#include "bitstream/kernel.h"
static const uint8_t COUNTS[] = {${count.places}}, SHARES[] = {${share.places}}, NUMBERS[] = {${number.places}};
int64_t learn_beforehand(Ints2 expectations, Ints2 weights, Words slots) {
    static const int16_t NUMBER[] = {${number.list}};
    static const uint16_t SHARE[] = {${share.list}}, UNLEARNT[] = {${UNLEARNT}};
    static const int8_t COUNT[] = {${count.list}};
    int64_t learnt = expectations.rows * expectations.columns, others = learnt + weights.rows * weights.columns;
    if (others != ${others} || slots.size != ${slots}) return MISUSED;
    const uint8_t *count = COUNTS, *share = SHARES;
    for (int64_t i = 0; i < others; i++) {
        int32_t value = NUMBER[NUMBERS[i]];
        if (i < learnt) expectations.data[i] = value;
        else weights.data[i - learnt] = 16 * value;
    }
    for (int node = 0; node < ${nodes}; node++)
        for (int i = 0; i < ${expectations * bins}; i++) {
            int seen = COUNT[*count++];
            uint32_t probability = seen > 0 ? SHARE[*share++] : UNLEARNT[-seen];
            slots.data[(i % ${expectations} * ${bins} + i / ${expectations}) * ${nodes} + node] = probability << 20 | 1 << 19 | (seen > 0 ? seen << 2 : 0);
        }
    return 0;
}
`;
}

/** Compare the tables and models that the kernels make with those of the repository. */
function checkTables(clang, objects, priors, target) {
    const tables = TABLES.flatMap((path) => [...readFileSync(join(ROOT, path), "utf8").matchAll(/const (\w+)_t (\w+)\[(\d+)\] = \{([^}]*)\}/g)]);
    const exported = ["make_tables", "make_value_tables", "learn_beforehand", "__heap_base", ...tables.map(([, , name]) => name)].map((name) => `-Wl,--export=${name}`);
    clang(TARGET, "-nostdlib", ...objects, "-Wl,--no-entry", "-Wl,--initial-memory=1048576", ...exported, "-o", target);
    const { exports } = new WebAssembly.Instance(new WebAssembly.Module(readFileSync(target)));
    const { buffer } = exports.memory;
    const compare = (name, made, values) => {
        if (values.some((value, i) => made[i] !== value)) throw new Error(`the kernels make other ${name} than the repository has`);
    };
    exports.make_tables();
    exports.make_value_tables();
    for (const [, type, name, length, body] of tables) {
        const kind = { uint16: Uint16Array, int16: Int16Array, int32: Int32Array }[type];
        compare(name, new kind(buffer, exports[name].value, Number(length)), body.split(",").map(Number).slice(0, Number(length)));
    }
    const [given, sizes] = [exports.__heap_base.value, [[18, 20], [76, 3], [5472]]];
    const places = sizes.map((_, k) => given + 1024 + 32768 * k);
    sizes.forEach((shape, k) => new BigInt64Array(buffer, given + 64 * k).set([places[k], ...shape].map(BigInt)));
    const words = new Uint16Array(priors.buffer);
    exports.learn_beforehand(given, given + 64, given + 128);
    compare("expectations", new Int32Array(buffer, places[0], 360), words.subarray(0, 360));
    compare("weights", new Int32Array(buffer, places[1], 228), Array.from(words.subarray(360, 588), (word) => 16 * ((word << 16) >> 16)));
    compare("slots", new Uint32Array(buffer, places[2], 5472), Array.from(words.subarray(588), (word) => (((word >> 4) << 20) | (1 << 19) | ((word & 15) << 2)) >>> 0));
}

/** Sources of what takes most time where positions are on a grid, or refined. */
const HOT = /fields|conquest/;

/**
 * Every build: whether with vector instructions, which kernels it is without, and which sources are compiled for speed,
 * and not for their size alone.
 */
export const KERNEL_BUILDS = {
    "built/kernels.wasm": { vectors: true, fast: HOT },
    "built/kernels-scalar.wasm": { vectors: false, fast: HOT },
    "built/small.wasm": { vectors: true, without: [...FRAMES, ...ATTRIBUTES] },
    "built/moving.wasm": { vectors: true, without: [...LIGHT, ...FIELDS, ...ATTRIBUTES] },
    "built/quick.wasm": { vectors: true, without: [...FRAMES, ...ATTRIBUTES, ...FIELDS, ...BLOCKS], fast: HOT },
};

/** Objects of sources, which builds have in common. */
const compiled = new Map();

/** One of them. */
export function compileKernels({ vectors, without = [], fast }) {
    const folder = mkdtempSync(join(tmpdir(), "bsm-kernels-"));
    try {
        const data = join(folder, "data.c");
        const priors = Uint8Array.from(readFileSync(join(ROOT, "spec/priors.bin")));
        writeFileSync(data, packedPriors(priors));
        const target = join(folder, "kernels.wasm");
        const clang = (...args) => execFileSync("clang", args, { cwd: ROOT, env: { ...process.env, PATH: withoutPackages() } });
        const objects = [...SOURCES, data].map((source, i) => {
            const object = join(folder, `${i}.o`);
            // Short loops of 64-bit products are slower as vectors.
            const how = fast?.test(source) ? ["-O2", "-fno-vectorize", "-fno-slp-vectorize"] : LEAN.test(source) ? ["-Oz", "-DBSM_LEAN"] : ["-Oz"];
            const options = [...FLAGS, ...how, ...(vectors ? ["-msimd128"] : []), "-I", ".", "-c", source];
            const key = options.join(" ");
            if (source === data || !compiled.has(key)) {
                clang(...options, "-o", object);
                compiled.set(key, readFileSync(object));
            } else writeFileSync(object, compiled.get(key));
            return object;
        });
        checkTables(clang, objects.slice(-2), priors, target);
        const exported = ["__heap_base", ...KERNELS].filter((name) => !without.includes(name));
        clang(TARGET, "-nostdlib", ...objects, ...LINK, ...exported.map((name) => `-Wl,--export=${name}`), "-o", target);
        const features = ["--enable-bulk-memory", "--enable-sign-ext", "--enable-nontrapping-float-to-int", ...(vectors ? ["--enable-simd"] : [])];
        const limits = fast ? ["--one-caller-inline-max-function-size=100"] : [];
        // The stack grows down to the first address, which it never reaches: so no pointer wraps where a constant is added.
        execFileSync(join(WEB, "node_modules/.bin/wasm-opt"), [target, "-Oz", "--converge", "--low-memory-unused", ...limits, ...features, "-o", target]);
        return readFileSync(target);
    } finally {
        rmSync(folder, { recursive: true });
    }
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    for (const [path, options] of Object.entries(KERNEL_BUILDS)) writeFileSync(join(WEB, path), compileKernels(options));
    writeFileSync(join(WEB, "built/compiler.txt"), `${compiler()}\n`);
}
