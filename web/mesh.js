#!/usr/bin/env node
/** Reads OBJ, PLY, STL or GLB with three.js, and writes a BSM stream: npx -p bsm-decoder -p three bsm-encode mesh.obj mesh.bsm */
import { readFileSync, writeFileSync } from "node:fs";

const [source, target, bits = "14", ...more] = process.argv.slice(2);
if (!target || more.length > 0 || !/\.(obj|ply|stl|glb)$/i.test(source) || !/^(\d+|lossless)$/.test(bits)) {
    console.error("usage: bsm-encode MESH.obj|ply|stl|glb MESH.bsm [BITS|lossless]");
    process.exit(2);
}
try {
    const { readMesh, encodeHere } = await import("./built/reading.js");
    const data = readFileSync(source);
    const { mesh, notes } = await readMesh(source, data.buffer.slice(data.byteOffset, data.byteOffset + data.length));
    for (const note of notes) console.error(`bsm-encode: ${source}: ${note}`);
    writeFileSync(target, await encodeHere(mesh, bits === "lossless" ? { lossless: true } : { bits: Number(bits) }));
} catch (error) {
    console.error(`bsm-encode: ${source}: ${error.message}`);
    process.exit(1);
}
