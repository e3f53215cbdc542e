#!/usr/bin/env node
/** Reads OBJ, PLY or STL with three.js, and writes a BSM stream: npx -p bsm-decoder -p three bsm-encode mesh.obj mesh.bsm */
import { readFileSync, writeFileSync } from "node:fs";
import { encodeHere, meshOf } from "bsm-decoder/encode";

const [source, target, bits, ...more] = process.argv.slice(2);
const loaders = { obj: "OBJLoader", ply: "PLYLoader", stl: "STLLoader" };
const kind = source?.toLowerCase().split(".").at(-1);
if (!target || more.length > 0 || !loaders[kind] || !/^(\d+|lossless|undefined)$/.test(`${bits}`)) {
    console.error("usage: bsm-encode MESH.obj|ply|stl MESH.bsm [BITS|lossless]");
    process.exit(2);
}

/** Geometries of an object and of all in it, without materials and lines. */
function* geometriesIn(object) {
    if (object.isBufferGeometry) yield object;
    else if (object.isMesh) yield object.geometry;
    for (const child of object.children ?? []) yield* geometriesIn(child);
}

/** Meshes as one, with what all of them have. */
function joined(meshes) {
    const all = (values) => values.flatMap((list) => [...list]);
    let vertices = 0;
    const faces = meshes.map((mesh) => {
        const first = vertices;
        vertices += mesh.positions.length / 3;
        return mesh.faces.map((vertex) => vertex + first);
    });
    const shared = meshes[0].attributes.filter(({ name }) => meshes.every((mesh) => mesh.attributes.some((other) => other.name === name)));
    const attributes = shared.map((attribute) => ({ ...attribute, values: attribute.values.constructor.from(all(meshes.map((mesh) => mesh.attributes.find(({ name }) => name === attribute.name).values))) }));
    return { positions: Float32Array.from(all(meshes.map(({ positions }) => positions))), faces: Uint32Array.from(all(faces)), attributes };
}

try {
    const { [loaders[kind]]: Loader } = await import(`three/addons/loaders/${loaders[kind]}.js`);
    const data = readFileSync(source);
    const content = kind === "obj" ? data.toString() : data.buffer.slice(data.byteOffset, data.byteOffset + data.length);
    const meshes = [...geometriesIn(new Loader().parse(content))].map(meshOf);
    if (meshes.length === 0) throw new Error("no triangles");
    writeFileSync(target, await encodeHere(joined(meshes), bits === "lossless" ? { lossless: true } : { bits: Number(bits ?? 14) }));
} catch (error) {
    console.error(`bsm-encode: ${source}: ${error.message}`);
    process.exit(1);
}
