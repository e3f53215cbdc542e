// `npm run examples`: the examples with the package as `npm pack` makes it, built by Vite, and looked at in Chromium
// where there is one.
// PYTHON names a Python that has bsm; with -- FOLDER the pictures are kept there.
import { execFileSync } from "node:child_process";
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { chromium } from "playwright-core";
import { WEB } from "./kernels.mjs";

const PAGES = {
    first: "textured",
    vanilla: "textured",
    r3f: "textured",
    gltf: "textured",
    babylon: "textured",
    sequence: "plain",
};
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
const FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
const SEEN = 0.03;
/** Lines from the package to a textured mesh. */
const MOST_LINES = 8;

const folder = mkdtempSync(join(tmpdir(), "bsm-examples-"));
const run = (program, ...args) => execFileSync(program, args, { cwd: folder, stdio: ["ignore", "inherit", "inherit"] });
const [pictures] = process.argv.slice(2);
try {
    cpSync(join(WEB, "examples"), folder, { recursive: true });
    run(process.env.PYTHON ?? "python3", "make.py", "public");
    const lines = readFileSync(join(folder, "first/main.ts"), "utf8").trim().split("\n").length;
    if (lines > MOST_LINES) throw new Error(`a first textured mesh takes ${lines} lines, more than ${MOST_LINES}`);
    console.log(`a first textured mesh takes ${lines} lines`);
    const [{ filename }] = JSON.parse(
        execFileSync("npm", ["pack", "--json", "--silent", "--pack-destination", folder], {
            cwd: WEB,
            encoding: "utf8",
        }),
    );
    run("npm", "install", "--no-audit", "--no-fund", "--silent", "--prefer-offline", join(folder, filename));
    run("npm", "run", "--silent", "check");
    run("npm", "run", "--silent", "build", "--", "--logLevel", "warn");
    if (existsSync(CHROMIUM)) await look();
    else console.log(`examples build; they are not looked at: no Chromium at ${CHROMIUM}`);
} finally {
    rmSync(folder, { recursive: true, force: true });
}

async function look() {
    const server = createServer((request, response) => {
        const { pathname } = new URL(request.url, "http://localhost");
        const path = ["dist", "."]
            .map((root) => join(folder, root, pathname.endsWith("/") ? `${pathname}index.html` : pathname))
            .find(existsSync);
        if (!path) return response.writeHead(404).end();
        response
            .writeHead(200, { "Content-Type": TYPES[extname(path)] ?? "application/octet-stream" })
            .end(readFileSync(path));
    });
    await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
    const browser = await chromium.launch({ executablePath: CHROMIUM, headless: true, args: FLAGS });
    try {
        for (const [name, kind] of Object.entries(PAGES)) {
            const page = await browser.newPage({ viewport: { width: 400, height: 300 } });
            const wrong = [];
            page.on("pageerror", (error) => wrong.push(error.message));
            page.on(
                "console",
                (message) =>
                    message.type() === "error" &&
                    !message.location().url.endsWith("/favicon.ico") &&
                    wrong.push(message.text()),
            );
            await page.goto(`http://127.0.0.1:${server.address().port}/${name}/`);
            await page.waitForFunction(() => document.title === "loaded", undefined, { timeout: 30_000 });
            await page.evaluate(() => new Promise((drawn) => setTimeout(drawn, 500)));
            const picture = await page.screenshot();
            if (pictures) mkdirSync(pictures, { recursive: true });
            if (pictures) writeFileSync(join(pictures, `${name}.png`), picture);
            const { drawn, red, blue } = await page.evaluate(
                colored,
                `data:image/png;base64,${picture.toString("base64")}`,
            );
            await page.close();
            if (drawn < SEEN || (kind === "textured" && Math.min(red, blue) < SEEN / 3))
                wrong.push(`only ${drawn} of it is drawn, ${red} red, ${blue} blue`);
            if (wrong.length > 0) throw new Error(`example ${name}: ${wrong.join("; ")}`);
            console.log(`example ${name}: ${(100 * drawn).toFixed(0)} % of the page is drawn on`);
        }
    } finally {
        await browser.close();
        server.close();
    }
}

/** Shares of the pixels that are not black, and of those that are red and blue. */
async function colored(url) {
    const image = new Image();
    image.src = url;
    await image.decode();
    const context = Object.assign(document.createElement("canvas"), {
        width: image.width,
        height: image.height,
    }).getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let [drawn, red, blue] = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4) {
        drawn += data[at] + data[at + 1] + data[at + 2] > 40 ? 1 : 0;
        red += data[at] > 1.5 * data[at + 2] && data[at] > 60 ? 1 : 0;
        blue += data[at + 2] > 1.5 * data[at] && data[at + 2] > 60 ? 1 : 0;
    }
    const all = data.length / 4;
    return { drawn: drawn / all, red: red / all, blue: blue / all };
}
