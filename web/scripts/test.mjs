// `npm test`: types, then the tests of test/, bundled and run by node.
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, rmSync } from "node:fs";
import { join } from "node:path";
import { build } from "esbuild";
import { WEB } from "./kernels.mjs";

const cache = join(WEB, "node_modules/.cache");
mkdirSync(cache, { recursive: true });
const folder = mkdtempSync(join(cache, "tests-")); // several may run at a time
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
const chosen = process.argv.slice(2);
const tests = readdirSync(join(WEB, "test"))
    .filter((name) => name.endsWith(".test.ts") && (chosen.length === 0 || chosen.some((part) => name.startsWith(part))))
    .map((name) => join(WEB, "test", name));
await build({ entryPoints: tests, outdir: folder, bundle: true, platform: "node", format: "esm", packages: "external", logLevel: "warning", outExtension: { ".js": ".mjs" } });
const bundles = readdirSync(folder).map((name) => join(folder, name));
const run = (program, ...args) => execFileSync(program, args, { cwd: WEB, stdio: "inherit" });
run(process.execPath, join(WEB, "node_modules/typescript/bin/tsc"), "--noEmit");
run(process.execPath, "--test", "--test-reporter", process.stdout.isTTY ? "spec" : "dot", ...bundles);
