#!/usr/bin/env node
/** Reads OBJ, PLY, STL or GLB with three.js, or a folder of these, the frames of a sequence, and writes a BSM stream: npx -p bsm-decoder -p three bsm-encode mesh.obj mesh.bsm */
import { readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const FILES = /\.(obj|ply|stl|glb)$/i;
const [source = "", target, bits = "14", rate = "24", ...more] = process.argv.slice(2);
const isFolder = statSync(source, { throwIfNoEntry: false })?.isDirectory() ?? false;
if (!target || more.length > 0 || !(isFolder ? /^\d+$/ : /^(\d+|lossless)$/).test(bits) || !(isFolder || FILES.test(source)) || !(Number(rate) > 0)) {
    console.error("usage: bsm-encode MESH.obj|ply|stl|glb MESH.bsm [BITS|lossless]\n       bsm-encode FOLDER SEQUENCE.bsm [BITS [FRAMES PER SECOND]]");
    process.exit(2);
}

let path = source;

/** A mesh of a file. */
async function meshAt(readMesh) {
    const data = readFileSync(path);
    const { mesh, notes } = await readMesh(path, data.buffer.slice(data.byteOffset, data.byteOffset + data.length));
    return { mesh, notes };
}

/** The frames of a folder, by the numbers in their names; attributes, but for normals, are those of the first. */
async function framesIn(readMesh) {
    const names = readdirSync(source).filter((name) => FILES.test(name)).sort(new Intl.Collator("en", { numeric: true }).compare);
    if (names.length === 0) throw new Error("there are no OBJ, PLY, STL or GLB files in it");
    let first;
    let positions;
    for (const [frame, name] of names.entries()) {
        path = join(source, name);
        const { mesh, notes } = await meshAt(readMesh);
        first ??= { mesh, notes };
        positions ??= new first.mesh.positions.constructor(mesh.positions.length * names.length);
        if (mesh.faces.length !== first.mesh.faces.length || mesh.positions.length !== first.mesh.positions.length || mesh.faces.some((vertex, i) => vertex !== first.mesh.faces[i])) throw new Error(`it has other faces than ${names[0]}; bsm encode --runs takes such frames`);
        positions.set(mesh.positions, frame * mesh.positions.length);
    }
    path = source;
    const attributes = first.mesh.attributes.filter(({ semantic }) => semantic !== "normal");
    return { mesh: { ...first.mesh, positions, attributes, frames: names.length, metadata: { ...first.mesh.metadata, frame_rate: Number(rate) } }, notes: first.notes };
}

try {
    const { readMesh, encodeHere } = await import("./built/reading.js");
    const { mesh, notes } = await (isFolder ? framesIn : meshAt)(readMesh);
    for (const note of notes) console.error(`bsm-encode: ${source}: ${note}`);
    writeFileSync(target, await encodeHere(mesh, bits === "lossless" ? { lossless: true } : { bits: Number(bits) }));
} catch (error) {
    console.error(`bsm-encode: ${path}: ${error.message}`);
    process.exit(1);
}
