#!/usr/bin/env node
/** Reads a BSM stream and writes OBJ: npx bsm-decoder mesh.bsm > mesh.obj */
import { readFileSync, writeSync } from "node:fs";
import { decode, loadKernels } from "bsm-decoder";

const path = process.argv[2];
if (!path) {
    console.error("usage: bsm-decoder MESH.bsm > MESH.obj");
    process.exit(2);
}
try {
    const { positions, faces } = decode(await loadKernels(), new Uint8Array(readFileSync(path)));
    const lines = [];
    for (let i = 0; i < positions.length; i += 3) lines.push(`v ${positions[i]} ${positions[i + 1]} ${positions[i + 2]}\n`);
    for (let i = 0; i < faces.length; i += 3) lines.push(`f ${faces[i] + 1} ${faces[i + 1] + 1} ${faces[i + 2] + 1}\n`);
    const text = Buffer.from(lines.join(""));
    for (let at = 0; at < text.length; ) at += writeSync(1, text, at);
} catch (error) {
    if (error.code === "EPIPE") process.exit(0); // nobody reads on
    console.error(`bsm-decoder: ${path}: ${error.message}`);
    process.exit(1);
}
