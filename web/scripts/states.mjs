// Pictures of the page of `bsm view` in every state and size, dark and light: `npm run states -- FOLDER PAGE...` takes
// saved pages,
// and addresses of served ones; empty ones, too. Says how much of each mesh cards and buttons cover, and whether
// anything is cut
// off or lies over another control, and presses the buttons of panels twice; the exit code is 1 if anything is wrong.
import { mkdirSync } from "node:fs";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { inflateSync } from "node:zlib";
import { chromium } from "playwright-core";

const SIZES = [
    [1280, 800],
    [390, 780],
    [844, 390],
    [780, 390],
    [320, 568],
];
const FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const MOST = 0.05; // of the mesh that may be covered
const BARE = ".bsm-ui > * { opacity: 0 !important } .bsm-stage { background: #0f0 !important }";
const PATIENCE = 120_000;

const LEAST_PANEL = 120; // pixels
const [PHONE, FINGER] = [1000, 44]; // pixels: what is narrower is touched, and what is touched is not lower

async function middleOf(page, name) {
    const { x, y, width, height } = await page.locator(`[name=${name}]`).boundingBox();
    return [x + width / 2, y + height / 2];
}

/** What can be touched and is lower than a finger. */
function lowOnes(finger) {
    const controls = [
        ...document.querySelectorAll(
            ".bsm-ui button, .bsm-ui select, .bsm-ui summary, .bsm-ui label, .bsm-ui input[type=range]:not(.bsm-wipe), .bsm-ui input[type=number]",
        ),
    ];
    return controls
        .filter((each) => !each.matches("label:has(input[type=range], input[type=number])"))
        .map((each) => [each, each.getBoundingClientRect()])
        .filter(([, { width, height }]) => width * height > 0 && Math.min(width, height) < finger - 0.5)
        .map(([each, { width, height }]) => `low: ${each.name || each.textContent.trim()} ${width} x ${height}`);
}

/** The pixels of a PNG of 8 bits without interlacing, as rows of colors. */
function pixelsOf(png) {
    let [at, width, height, channels] = [8, 0, 0, 0];
    const parts = [];
    while (at < png.length) {
        const length = png.readUInt32BE(at);
        const type = png.toString("latin1", at + 4, at + 8);
        const data = png.subarray(at + 8, at + 8 + length);
        if (type === "IHDR")
            [width, height, channels] = [data.readUInt32BE(0), data.readUInt32BE(4), data[9] === 6 ? 4 : 3];
        if (type === "IDAT") parts.push(data);
        at += 12 + length;
    }
    const raw = inflateSync(Buffer.concat(parts));
    const rows = [];
    let above = new Uint8Array(width * channels);
    for (let y = 0; y < height; y++) {
        const [filter, row] = [
            raw[y * (width * channels + 1)],
            Uint8Array.from(raw.subarray(y * (width * channels + 1) + 1, (y + 1) * (width * channels + 1))),
        ];
        for (let i = 0; i < row.length; i++) {
            const [a, b, c] = [row[i - channels] ?? 0, above[i], above[i - channels] ?? 0];
            const p = a + b - c;
            const paeth =
                Math.abs(p - a) <= Math.abs(p - b) && Math.abs(p - a) <= Math.abs(p - c)
                    ? a
                    : Math.abs(p - b) <= Math.abs(p - c)
                      ? b
                      : c;
            row[i] += [0, a, b, (a + b) >> 1, paeth][filter];
        }
        rows.push(row);
        above = row;
    }
    return { width, height, at: (x, y) => rows[y].subarray(x * channels, x * channels + 3) };
}

const [folder, ...pages] = process.argv
    .slice(2)
    .map((path) => (/^https?:/.test(path) ? path : resolve(process.env.INIT_CWD ?? ".", path)));
mkdirSync(folder, { recursive: true });
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    args: FLAGS,
});
let [states, wrong] = [0, 0];
for (const path of pages) {
    for (const dark of [false, true]) {
        for (const [width, height] of SIZES) {
            const page = await browser.newPage({
                viewport: { width, height },
                isMobile: width < PHONE,
                hasTouch: width < PHONE,
                colorScheme: dark ? "dark" : "light",
                reducedMotion: "reduce",
            });
            await page.goto(/^https?:/.test(path) ? path : pathToFileURL(path).href);
            await page.waitForSelector("body:is([data-state=complete], [data-state=empty])", { timeout: PATIENCE });
            const empty = await page.evaluate(() => document.body.dataset.state === "empty");
            const layers = await page.locator("[name=layer]").count();
            if (layers > 1) await page.waitForSelector(`body[data-layers="${layers}"]`, { timeout: PATIENCE });
            await page.waitForTimeout(1200); // edges become smooth
            const name = `${empty ? "empty" : basename(path, ".html")}-${width}x${height}${dark ? "-dark" : ""}`;
            await page.screenshot({ path: join(folder, `${name}.png`) });
            const boxes = await page.evaluate(() =>
                [
                    ...document.querySelectorAll(
                        ".bsm-card, .bsm-tools > *, .bsm-dock > *, .bsm-panel, .bsm-scale, .bsm-ruler, [role=alert]",
                    ),
                ]
                    .map((element) => element.getBoundingClientRect())
                    .filter((box) => box.width * box.height > 0)
                    .map(({ left, top, right, bottom }) => ({ left, top, right, bottom })),
            );
            const over = await page.evaluate(() => {
                const parts = [
                    ...document.querySelectorAll(
                        ".bsm-card, .bsm-tools > *, .bsm-dock > *, .bsm-note, .bsm-scale, .bsm-ruler, .bsm-tag, [role=alert]",
                    ),
                ]
                    .map((element) => [element, element.getBoundingClientRect()])
                    .filter(([, box]) => box.width * box.height > 0);
                return parts.flatMap(([one, a], i) =>
                    parts
                        .slice(i + 1)
                        .filter(
                            ([, b]) =>
                                a.left < b.right - 1 &&
                                b.left < a.right - 1 &&
                                a.top < b.bottom - 1 &&
                                b.top < a.bottom - 1,
                        )
                        .map(
                            ([other]) =>
                                `${one.dataset.part ?? one.className} over ${other.dataset.part ?? other.className}`,
                        ),
                );
            });
            const outside = await page.evaluate(() =>
                [
                    ...document.querySelectorAll(
                        ".bsm-ui button, .bsm-ui select, .bsm-ui label, .bsm-card, .bsm-tag, .bsm-note",
                    ),
                ]
                    .filter((element) => {
                        const box = element.getBoundingClientRect();
                        return (
                            box.width * box.height > 0 &&
                            (box.left < -1 ||
                                box.top < -1 ||
                                box.right > innerWidth + 1 ||
                                box.bottom > innerHeight + 1)
                        );
                    })
                    .map((element) => element.getAttribute("aria-label") ?? element.textContent.trim()),
            );
            for (const panel of ["panel", "keys"]) {
                for (const open of [true, false]) {
                    await page.mouse.click(...(await middleOf(page, panel)));
                    const found = await page.evaluate((panel) => {
                        const [part, button] = [
                            document.querySelector(`[data-part=${panel}]`).getBoundingClientRect(),
                            document.querySelector(`[name=${panel}]`).getBoundingClientRect(),
                        ];
                        return {
                            height: part.height,
                            hit: Boolean(
                                document
                                    .elementFromPoint(button.x + button.width / 2, button.y + button.height / 2)
                                    ?.closest(`[name=${panel}]`),
                            ),
                        };
                    }, panel);
                    if (width < PHONE) outside.push(...(await page.evaluate(lowOnes, FINGER)));
                    if (!found.hit) over.push(`${panel} over its button`);
                    if (open !== found.height > LEAST_PANEL)
                        over.push(`${panel} is ${found.height} px high where it is ${open ? "open" : "closed"}`);
                }
            }
            await page.addStyleTag({ content: BARE });
            const picture = pixelsOf(await page.screenshot());
            let [all, covered, edge] = [0, 0, 0];
            for (let y = 0; y < picture.height; y++) {
                for (let x = 0; x < picture.width; x++) {
                    const [r, g, b] = picture.at(x, y);
                    if (g > 1.4 * r && g > 1.4 * b) continue; // background, or the shadow on it
                    all++;
                    if (boxes.some((box) => x >= box.left && x < box.right && y >= box.top && y < box.bottom))
                        covered++;
                    if (x === 0 || y === 0 || x === picture.width - 1 || y === picture.height - 1) edge++;
                }
            }
            const share = covered / Math.max(all, 1);
            const bad = (all === 0 && !empty) || share > MOST || edge > 0 || outside.length + over.length > 0;
            states++;
            wrong += bad;
            const found = [
                `${(100 * share).toFixed(1)} % covered`,
                `mesh ${((100 * all) / picture.width / picture.height).toFixed(1)} % of the page`,
                ...(edge > 0 ? ["cut off"] : []),
                ...outside.map((what) => `outside: ${what}`),
                ...over,
            ];
            console.log(`${bad ? "WRONG" : "right"} ${name}: ${found.join(", ")}`);
            await page.close();
        }
    }
}
await browser.close();
console.log(`${states - wrong} of ${states} states right`);
process.exitCode = wrong > 0 ? 1 : 0;
