// Files of meshoptimizer, of positions that the caller quantized: node meshopt.mjs PACKAGE FILE BITS... > sizes as JSON.
// FILE holds counts of vertices and triangles, triangles (uint32), and for each of BITS positions (uint16, four each).
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";

const [, , packed, file, ...bits] = process.argv;
const load = async (name) => import(pathToFileURL(`${packed}/${name}`).href);
const { MeshoptEncoder: encoder } = await load("meshopt_encoder.js");
const { MeshoptDecoder: decoder } = await load("meshopt_decoder.mjs");
await Promise.all([encoder.ready, decoder.ready]);
const data = readFileSync(file);
const buffer = data.buffer.slice(data.byteOffset, data.byteOffset + data.length);
const [vertices, triangles] = new Uint32Array(buffer, 0, 2);
const least = (work) => {
  let result, best = Infinity;
  for (let round = 0; round < 3; round++) {
    const start = performance.now();
    result = work();
    best = Math.min(best, performance.now() - start);
  }
  return [result, best / 1000];
};
const found = bits.map((_, k) => {
  const positions = new Uint16Array(buffer, 8 + 12 * triangles + 8 * vertices * k, 4 * vertices);
  const [[indexData, vertexData, moved], encodes] = least(() => {
    const indices = new Uint32Array(buffer.slice(8, 8 + 12 * triangles));
    const [remap] = encoder.reorderMesh(indices, true, true);
    const moved = new Uint16Array(4 * vertices);
    for (let i = 0; i < vertices; i++) moved.set(positions.subarray(4 * i, 4 * i + 4), 4 * remap[i]);
    const bytes = new Uint8Array(moved.buffer);
    return [
      encoder.encodeIndexBuffer(new Uint8Array(indices.buffer), indices.length, 4),
      encoder.encodeVertexBufferLevel(bytes, vertices, 8, 3, 1),
      bytes,
    ];
  });
  const back = new Uint8Array(8 * vertices);
  const faces = new Uint8Array(12 * triangles);
  const [, decodes] = least(() => {
    decoder.decodeIndexBuffer(faces, 3 * triangles, 4, indexData);
    decoder.decodeVertexBuffer(back, vertices, 8, vertexData);
  });
  if (Buffer.compare(Buffer.from(back), Buffer.from(moved))) throw new Error("decoded to something else");
  const both = Buffer.concat([Buffer.from(indexData), Buffer.from(vertexData)]);
  return { bytes: both.length, gzip: gzipSync(both, { level: 9 }).length, encode_s: encodes, decode_s: decodes };
});
console.log(JSON.stringify(found));
