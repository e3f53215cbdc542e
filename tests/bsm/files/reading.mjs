// Reads mesh files as a page does: node reading.mjs WEB FILE... prints what each holds, or why it is refused, as JSON.
// Arrays are hashes of their numbers in double precision. WEB is the folder of the npm package, after npm ci.
import { createHash } from "node:crypto";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { basename, join } from "node:path";
import { pathToFileURL } from "node:url";

const [web, ...paths] = process.argv.slice(2);
const { build } = await import(pathToFileURL(join(web, "node_modules/esbuild/lib/main.js")));
mkdirSync(join(web, "node_modules/.cache"), { recursive: true });
const folder = mkdtempSync(join(web, "node_modules/.cache/reading-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
const outfile = join(folder, "reading.mjs");
await build({
    entryPoints: [join(web, "src/together.ts")],
    outfile,
    bundle: true,
    platform: "node",
    format: "esm",
    packages: "external",
    logLevel: "error",
});
const { readMesh } = await import(pathToFileURL(outfile));
globalThis.ProgressEvent ??= class extends Event {}; // which three.js sends for data in addresses, and Node lacks
const hashed = (values) => createHash("sha256").update(Float64Array.from(values, (value) => value + 0)).digest("hex");

function areaOf({ positions, faces }) {
    let area = 0;
    for (let i = 0; i < faces.length; i += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => positions.subarray(3 * faces[i + k], 3 * faces[i + k] + 3));
        const [u, v] = [b, c].map((to) => [0, 1, 2].map((d) => to[d] - a[d]));
        area += Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
    }
    return area;
}

async function readingOf(path) {
    try {
        const { mesh, notes } = await readMesh(new File([readFileSync(path)], basename(path)));
        const { positions, faces, attributes = [], metadata = {}, frames = 0 } = mesh;
        return {
            counts: [positions.length / 3, faces.length / 3],
            frames,
            area: areaOf(mesh),
            positions: hashed(positions),
            faces: hashed(faces),
            attributes: attributes.map(({ name, values, components, domain = "vertex", semantic = "generic", indices }) => ({
                name,
                domain,
                semantic,
                kind: values.constructor.name.replace("Array", "").replace("Clamped", "").toLowerCase(),
                shape: [values.length / components, components],
                values: hashed(values),
                indices: indices ? hashed(indices) : null,
            })),
            metadata,
            notes,
        };
    } catch (error) {
        return { error: error.message };
    }
}

for (const path of paths) console.log(JSON.stringify(await readingOf(path)));
