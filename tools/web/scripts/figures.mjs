// What a page fetches, and how long Chromium decodes: `npm run figures -- STREAM.bsm [ROUNDS]`.
import { readFileSync } from "node:fs";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { brotliCompressSync } from "node:zlib";
import { chromium } from "playwright-core";
import { WEB } from "./kernels.mjs";

const [stream, rounds = "7"] = process.argv.slice(2);
const read = (name) => readFileSync(join(WEB, "built", name));
const sizes = ["bsm.js", "kernels.wasm"].map((name) => [name, brotliCompressSync(read(name)).length]);
for (const [name, size] of sizes) console.log(`${name}: ${size} bytes in brotli`);
console.log(`together: ${sizes.reduce((sum, [, size]) => sum + size, 0)} bytes`);
if (stream) {
    const profile = mkdtempSync(join(tmpdir(), "bsm-figures-"));
    const flags = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
    const context = await chromium.launchPersistentContext(profile, { executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args: flags });
    try {
        const page = await context.newPage();
        const given = { script: read("bsm.js").toString("base64"), kernels: read("kernels.wasm").toString("base64"), stream: readFileSync(stream).toString("base64"), rounds: Number(rounds) };
        const times = await page.evaluate(async ({ script, kernels, stream, rounds }) => {
            const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
            const { decode, Kernels } = await import(`data:text/javascript;base64,${script}`);
            const start = performance.now();
            const compiled = await Kernels.compile(bytes(kernels));
            const times = [performance.now() - start];
            for (let k = 0; k < rounds; k++) {
                const before = performance.now();
                decode(compiled, bytes(stream));
                times.push(performance.now() - before);
            }
            return times;
        }, given);
        console.log(`kernels compiled in ${times[0].toFixed(0)} ms; decoded in ${times.slice(1).map((time) => time.toFixed(0)).join(", ")} ms`);
    } finally {
        await context.close();
        rmSync(profile, { recursive: true, force: true });
    }
}
