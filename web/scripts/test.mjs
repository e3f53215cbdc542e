// `npm test`: format, types, then the tests of test/, bundled and run by node.
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { build } from "esbuild";
import { WEB } from "./kernels.mjs";

const MOST_COLUMNS = 140;
const FORMATTED = ["src", "test", "scripts", "*.js"];

const cache = join(WEB, "node_modules/.cache");
mkdirSync(cache, { recursive: true });
const folder = mkdtempSync(join(cache, "tests-")); // several may run at a time
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
const chosen = process.argv.slice(2);
const tests = readdirSync(join(WEB, "test"))
    .filter(
        (name) => name.endsWith(".test.ts") && (chosen.length === 0 || chosen.some((part) => name.startsWith(part))),
    )
    .map((name) => join(WEB, "test", name));
await build({
    entryPoints: tests,
    outdir: folder,
    bundle: true,
    platform: "node",
    format: "esm",
    packages: "external",
    logLevel: "warning",
    outExtension: { ".js": ".mjs" },
});
const bundles = readdirSync(folder).map((name) => join(folder, name));
const run = (program, ...args) => execFileSync(program, args, { cwd: WEB, stdio: "inherit" });
run(
    process.execPath,
    join(WEB, "node_modules/prettier/bin/prettier.cjs"),
    "--check",
    "--log-level",
    "warn",
    ...FORMATTED,
);
for (const name of readdirSync(join(WEB, "src"), { recursive: true }).filter((each) =>
    /\.ts$|(view|player)\.html$/.test(each),
)) {
    const lines = readFileSync(join(WEB, "src", name), "utf8").split("\n");
    const long = lines.findIndex(({ length }) => length > MOST_COLUMNS); // the formatter breaks neither comments nor strings
    if (long >= 0)
        throw new Error(`src/${name}:${long + 1} has ${lines[long].length} columns, more than ${MOST_COLUMNS}`);
}
run(process.execPath, join(WEB, "node_modules/typescript/bin/tsc"), "--noEmit");
run(process.execPath, "--test", "--test-reporter", process.stdout.isTTY ? "spec" : "dot", ...bundles);
