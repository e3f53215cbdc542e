#!/usr/bin/env node
/**
 * Reads OBJ, PLY, STL or GLB, or a folder of these, the frames of a sequence, and writes a BSM stream:
 * npx -p bsm-decoder -p three bsm-encode mesh.obj mesh.bsm
 */
import { readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";

const USAGE = `usage: bsm-encode MESH.obj|ply|stl|glb MESH.bsm [BITS|lossless]
       bsm-encode FOLDER SEQUENCE.bsm [BITS [FRAMES PER SECOND]]
In place of MESH.bsm, - writes the stream to the standard output.`;
if (process.argv.includes("--help") || process.argv.includes("-h")) {
    console.log(USAGE);
    process.exit(0);
}
const MOST_BITS = 20;
const FILES = /\.(obj|ply|stl|glb)$/i;
const [source = "", target, bits = "14", rate = "24", ...more] = process.argv.slice(2);
const isFolder = statSync(source, { throwIfNoEntry: false })?.isDirectory() ?? false;
if (
    !target ||
    /\.(?!bsm$)[a-z]\w*$/i.test(target) ||
    more.length > 0 ||
    !(isFolder ? /^\d+$/ : /^(\d+|lossless)$/).test(bits) ||
    !(Number(rate) > 0)
) {
    console.error(USAGE);
    process.exit(2);
}

/** A file as pages have them. */
const fileAt = (path) => new File([readFileSync(path)], basename(path));

try {
    if (!isFolder && !FILES.test(source))
        throw new Error("only OBJ, PLY, STL and GLB files are read here, and folders of these");
    if (Number(bits) < 1 || Number(bits) > MOST_BITS) throw new Error(`BITS are from 1 to ${MOST_BITS}, not ${bits}`);
    globalThis.ProgressEvent ??= class extends Event {}; // which three.js sends for data in addresses, and Node lacks
    const { readFrames, readMesh, inSingle, encodeHere } = await import("./built/reading.js");
    const files = isFolder
        ? readdirSync(source)
              .filter((name) => FILES.test(name))
              .map((name) => fileAt(join(source, name)))
        : [];
    if (isFolder && files.length === 0) throw new Error("there are no OBJ, PLY, STL or GLB files in it");
    const { mesh, notes } = await (isFolder ? readFrames(files, Number(rate)) : readMesh(fileAt(source)));
    for (const note of notes) console.error(`bsm-encode: ${source}: ${note}`);
    const encoded =
        bits === "lossless" ? encodeHere(inSingle(mesh), { lossless: true }) : encodeHere(mesh, { bits: Number(bits) });
    writeFileSync(target === "-" ? 1 : target, await encoded);
} catch (error) {
    const absent = `no such file or folder: ${error.path}`;
    console.error(`bsm-encode: ${source}: ${error.code === "ENOENT" ? absent : error.message}`);
    process.exit(1);
}
