// The kernels of `bitstream` and `codec` as WebAssembly, with and without vector instructions: `npm run kernels`.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { delimiter, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const WEB = dirname(dirname(fileURLToPath(import.meta.url)));
const ROOT = join(WEB, "../..");

const SOURCES = [
    "bitstream/attributes/faces.c",
    "bitstream/attributes/normals.c",
    "bitstream/attributes/places.c",
    "bitstream/attributes/scalars.c",
    "bitstream/attributes/seams.c",
    "bitstream/attributes/texcoords.c",
    "bitstream/attributes/values.c",
    "bitstream/coefficients/adaptive.c",
    "bitstream/coefficients/contexts.c",
    "bitstream/coefficients/matrices.c",
    "bitstream/coefficients/trellis.c",
    "bitstream/connectivity/conquest.c",
    "bitstream/connectivity/halfedges.c",
    "bitstream/connectivity/partition.c",
    "bitstream/connectivity/permutation.c",
    "bitstream/connectivity/seams.c",
    "bitstream/entropy/symbols.c",
    "bitstream/fields/corners.c",
    "bitstream/fields/grid.c",
    "bitstream/fields/levels.c",
    "bitstream/fields/seen.c",
    "bitstream/fields/value.c",
    "codec/basis/cosines.simd.c",
    "codec/basis/orthogonal_iteration.simd.c",
    "codec/basis/solver/cholesky.simd.c",
    "codec/basis/solver/cholesky_qr.simd.c",
    "codec/basis/solver/fronts.c",
    "codec/basis/solver/householder.c",
    "codec/basis/solver/panels.simd.c",
    "codec/basis/solver/substitution.simd.c",
    "codec/basis/weighted.c",
    "codec/blocks/bisection.c",
    "codec/blocks/blend.c",
    "codec/blocks/overlap.c",
    "codec/blocks/partition.c",
    "codec/geometry/graph.c",
    "codec/geometry/incidence.c",
    "codec/sequence/row_prediction.c",
    "codec/signal/detail.c",
    "codec/signal/frames.c",
    "codec/signal/predict.c",
    "codec/signal/smooth.c",
    "codec/signal/transform.simd.c",
    "tools/web/src/memory.c",
];

/** Tables alone, which are sent as differences. */
const TABLES = ["bitstream/entropy/tables.c", "bitstream/fields/tables.c"];

const KERNELS = [
    "make_tables",
    "code_one_unsigned", "match_halfedges", "conquer", "code_fans", "code_degenerate", "code_steps", "code_turns",
    "code_labels", "points_of_levels", "code_rows", "code_block", "vertex_faces", "bisect", "refine_partition",
    "group_by_label", "chain_blocks", "order_scratch", "order_block", "add_copies", "collect_edges",
    "find_fronts", "suspend", "factorize_fronts", "solve_columns", "resize_columns", "iteration_space", "iterate",
    "cholesky_onorm", "householder", "reconstruct", "look_around", "block_normals", "smooth_all",
    "find_rings", "filter_rows", "link_corners", "order_vertices", "keep_borders", "code_grid", "code_levels",
    "local_frames", "add_levels", "code_matrix", "project", "code_edges", "join_corners",
    "expect_normals", "code_scalars", "code_texcoords", "code_normals", "code_faces", "cotangents", "hold", "pull", "follow_rows",
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

/** Kernels of sequences and attributes. */
const REST = [
    "code_matrix", "project", "cotangents", "hold", "pull", "follow_rows", "code_edges", "join_corners", "expect_normals",
    "code_scalars", "code_texcoords", "code_normals", "code_faces",
];

/** Kernels without which positions on grids can do. */
const BLOCKS = [
    "points_of_levels", "code_rows", "code_block", "code_labels", "vertex_faces", "bisect", "refine_partition", "group_by_label", "chain_blocks",
    "order_scratch", "order_block", "add_copies", "collect_edges", "find_fronts", "suspend", "factorize_fronts", "solve_columns",
    "resize_columns", "iteration_space", "iterate", "cholesky_onorm", "householder", "reconstruct", "look_around", "block_normals",
    "smooth_all", "find_rings", "filter_rows", "keep_borders", "code_levels", "local_frames", "add_levels",
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

const BYTES = { uint16_t: 2, int16_t: 2, int32_t: 4 };

/**
 * The tables of a C file as differences, which are easier to compress; their bytes plane by plane, the least first.
 * `unpack_NAME` makes a table of them.
 */
function packedTables(text) {
    return [...text.matchAll(/const (\w+) (\w+)\[(\d+)\] = \{([^}]*)\}/g)].map(([, type, name, length, body]) => {
        const values = body.split(",").map(Number).slice(0, Number(length));
        const differences = values.map((value, i) => value - (i ? values[i - 1] : 0));
        const planes = Array.from({ length: BYTES[type] }, (_, k) => differences.map((step) => (step >> (8 * k)) & 255)).flat();
        return `static const uint8_t PACKED_${name}[] = {${planes}};
${type} ${name}[${length}];
void unpack_${name}(void) { unpack_table(PACKED_${name}, ${name}, ${length}, ${BYTES[type]}); }
`;
    });
}

/**
 * What coefficients start from (specification, M 9.1), each of the two sets with its slots not by expectation, bin and
 * node, but by node, bin and expectation: so they are easier to compress.
 */
function arrangedPriors(bytes) {
    const words = new Uint16Array(bytes.buffer, bytes.byteOffset, bytes.length / 2);
    const [expectations, bins, nodes] = [3, 48, 38];
    const others = words.length / 2 - expectations * bins * nodes;
    const arranged = [0, words.length / 2].flatMap((start) => [
        ...words.subarray(start, start + others),
        ...Array.from({ length: expectations * bins * nodes }, (_, i) => {
            const [node, bin, expectation] = [Math.floor(i / expectations / bins), Math.floor(i / expectations) % bins, i % expectations];
            return words[start + others + (expectation * bins + bin) * nodes + node];
        }),
    ]);
    return [...new Uint8Array(Uint16Array.from(arranged).buffer)];
}

const UNPACK = `#include <stdint.h>
#define unpack_table(packed, table, length, bytes) \\
    for (int32_t i = 0, value = 0; i < (length); i++) { \\
        uint32_t step = 0; \\
        for (int k = 0; k < (bytes); k++) step |= (uint32_t)(packed)[k * (length) + i] << (8 * k); \\
        value = (int32_t)((uint32_t)value + step); \\
        (table)[i] = value; \\
    }
`;

/** Sources of what takes most time where positions are on a grid, or refined. */
const HOT = /fields|conquest/;

/**
 * Every build: whether with vector instructions, which kernels it is without, and which sources are compiled for speed,
 * and not for their size alone.
 */
export const KERNEL_BUILDS = {
    "built/kernels.wasm": { vectors: true, fast: HOT },
    "built/kernels-scalar.wasm": { vectors: false, fast: HOT },
    "built/small.wasm": { vectors: true, without: REST },
    "built/quick.wasm": { vectors: true, without: [...REST, ...BLOCKS, "PRIORS"], fast: HOT },
};

/** One of them. */
export function compileKernels({ vectors, without = [], fast }) {
    const folder = mkdtempSync(join(tmpdir(), "bsm-kernels-"));
    try {
        const data = join(folder, "data.c");
        const priors = Uint8Array.from(readFileSync(join(ROOT, "spec/priors.bin")));
        const tables = TABLES.flatMap((path) => packedTables(readFileSync(join(ROOT, path), "utf8")));
        const unpackers = tables.map((table) => /unpack_[A-Z]+/.exec(table)[0]);
        writeFileSync(data, [UNPACK, ...tables, `void make_tables(void) { ${unpackers.map((name) => `${name}();`).join(" ")} }`,
            `const unsigned char PRIORS[${priors.length}] = {${arrangedPriors(priors)}};`].join("\n"));
        const target = join(folder, "kernels.wasm");
        const clang = (...args) => execFileSync("clang", args, { cwd: ROOT, env: { ...process.env, PATH: withoutPackages() } });
        const objects = [...SOURCES, data].map((source, i) => {
            const object = join(folder, `${i}.o`);
            // Short loops of 64-bit products are slower as vectors.
            const how = fast?.test(source) ? ["-O2", "-fno-vectorize", "-fno-slp-vectorize"] : LEAN.test(source) ? ["-Oz", "-DBSM_LEAN"] : ["-Oz"];
            clang(...FLAGS, ...how, ...(vectors ? ["-msimd128"] : []), "-I", ".", "-c", source, "-o", object);
            return object;
        });
        const exported = ["__heap_base", "PRIORS", ...KERNELS].filter((name) => !without.includes(name));
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
