// The types of the package, `types/*.d.ts`, from the sources: what `npm pack` takes with it.
import { execFileSync } from "node:child_process";
import { readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { WEB } from "./kernels.mjs";

const folder = join(WEB, "types");
rmSync(folder, { recursive: true, force: true });
const options = [
    "--noEmit",
    "false",
    "--declaration",
    "--emitDeclarationOnly",
    "--stripInternal",
    "--rootDir",
    "src",
    "--outDir",
    "types",
];
execFileSync(
    process.execPath,
    [join(WEB, "node_modules/typescript/bin/tsc"), ...options, "-p", "tsconfig.types.json"],
    { cwd: WEB, stdio: "inherit" },
);
for (const name of readdirSync(folder).filter((name) => name.endsWith(".d.ts"))) {
    const path = join(folder, name);
    // Node's own resolution wants whole names of files.
    writeFileSync(path, readFileSync(path, "utf8").replace(/(from "|import\(")(\.\/\w+)"/g, '$1$2.js"'));
}
