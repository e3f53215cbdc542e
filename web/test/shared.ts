/** What tests share: kernels, vectors, and how a stream is decoded in pieces. */
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { TestContext } from "node:test";
import { pathToFileURL } from "node:url";
import { inflateSync } from "node:zlib";
import { chromium, type Browser, type Page } from "playwright-core";
import { crc16, crc32 } from "./checksums";
import { isLight, type Build } from "../src/peek";
import { parseVarint } from "../src/varint";
import {
    decode,
    Decoder,
    END_OF_STREAM,
    Kernels,
    NEED_DATA,
    type Attribute,
    type Event,
    type Limits,
    type Mesh,
    type Wishes,
} from "../src/index";

export const WEB = process.cwd();
const SPEC = join(WEB, "../spec/vectors");
export const VECTORS = join(SPEC, "1.0");
/** Of all versions. */
export const FOLDERS = readdirSync(SPEC)
    .filter((name) => name.startsWith("1."))
    .map((name) => join(SPEC, name));
export const VIEWER = join(WEB, "../src/bsm/viewer");

export const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
export const FIREFOX = process.env.FIREFOX ?? "/usr/bin/firefox-esr";
export const FLAGS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
];

/** Milliseconds that a test waits for a page: a slow machine that does other things as well draws by software. */
export const PATIENCE = 120_000;

/** A Chromium without a window, until a test ends. */
export async function chromiumFor(context: TestContext, ...flags: string[]): Promise<Browser> {
    const browser = await chromium.launch({ executablePath: CHROMIUM, headless: true, args: [...FLAGS, ...flags] });
    context.after(() => browser.close());
    return browser;
}

/** A build of less than all, as the decoder that tests of the sources take. */
export async function lesserDecode(build: Exclude<Build, "whole">): Promise<(data: Uint8Array) => Mesh> {
    const script = isLight(build) ? "quick" : "small";
    const lesser = (await import(pathToFileURL(join(WEB, `built/${script}.js`)).href)) as {
        decode: typeof decode;
        Decoder: typeof Decoder;
        Kernels: typeof Kernels;
    };
    const kernels = new lesser.Kernels(await WebAssembly.compile(readFileSync(join(WEB, `built/${build}.wasm`))));
    if (build === "moving") return (data) => meshOfEvents(eventsOf(kernels, data, data.length, {}, {}, lesser.Decoder));
    return (data) => lesser.decode(kernels, data);
}

/** Those of everything. */
export const kernels = new Kernels(await WebAssembly.compile(readFileSync(join(WEB, "built/kernels.wasm"))));

/** All events of a stream that comes in pieces of `size` bytes; the error is thrown behind them. */
export function* eventsOf(
    kernels: Kernels,
    data: Uint8Array,
    size: number,
    limits: Partial<Limits> = {},
    wishes: Wishes = {},
    Type = Decoder,
): Generator<Event> {
    const decoder = new Type(kernels, limits, wishes);
    for (let at = 0; at < data.length || at === 0; at += Math.max(size, 1)) {
        decoder.receiveData(data.subarray(at, at + size));
        for (let event; (event = decoder.nextEvent()) !== NEED_DATA;) yield event as Event;
    }
    decoder.receiveEof();
    for (let event; (event = decoder.nextEvent()) !== END_OF_STREAM;) yield event as Event;
    decoder.release(); // so that the next test finds what this one leaves in memory
}

/** The mesh that block events add up to; of a sequence all its frames, one after the other. */
export function meshOfEvents(events: Iterable<Event>): Mesh {
    let positions: Float64Array = new Float64Array(0);
    let faces = new Int32Array(0);
    const frames: Float64Array[] = [];
    let attributes: Attribute[] = [];
    const moved: Attribute[] = [];
    for (const event of events) {
        if (event.type === "header") attributes.length = moved.length = 0;
        if (event.type === "connectivity") {
            faces = Int32Array.from([...faces, ...event.faces]); // of all runs
            positions = new Float64Array(3 * event.vertices).fill(NaN);
            event.loose.vertices.forEach((v, i) =>
                positions.set(event.loose.positions.subarray(3 * i, 3 * i + 3), 3 * v),
            );
        }
        if (event.type === "attribute") attributes.push(event);
        if (event.type === "end" && event.positions) positions = event.positions;
        if (event.type === "frame") {
            frames.push(event.positions);
            moved.push(...event.attributes);
        }
        if (event.type === "block" || event.type === "refinement")
            event.vertices.forEach((v, i) => positions.set(event.positions.subarray(3 * i, 3 * i + 3), 3 * v));
    }
    // Of an attribute that moves, the values in all frames of the last run, one after the other.
    attributes = attributes.map((one) => {
        const own = moved.filter(({ name }) => name === one.name);
        return own.length ? { ...one, values: Float64Array.from(own.flatMap(({ values }) => [...values])) } : one;
    });
    return {
        positions: frames.length ? Float64Array.from(frames.flatMap((frame) => [...frame])) : positions,
        faces,
        attributes,
    };
}

/** The page with streams in it, as `bsm view --save` writes it. */
export function savedPage(
    folder: string,
    streams: Record<string, Uint8Array>,
    more: object = {},
    told: object = {},
): string {
    const list = Object.entries(streams).map(([name, bytes]) => ({ ...contentOf(name, bytes), ...more }));
    const slot = '<script type="application/json" id="bsm-streams">';
    const path = join(folder, "page.html");
    const page = readFileSync(join(VIEWER, "page.html"), "utf8");
    writeFileSync(
        path,
        page
            .replace(`${slot}[]`, () => slot + JSON.stringify(list))
            .replace("<!-- script -->", () => viewerScript(told)),
    );
    return pathToFileURL(path).href;
}

/** What the page knows of a stream that stands alone. */
export function contentOf(
    name: string,
    bytes: Uint8Array,
): { name: string; main: number; facts: object; layers: object[] } {
    return {
        name,
        main: 0,
        facts: {},
        layers: [{ title: "BSM", detail: "", size: bytes.length, data: base64(bytes) }],
    };
}

/** The page's module with kernels in it, and with what else Python tells it. */
export function viewerScript(told: object = {}): string {
    const kernels = { data: base64(readFileSync(join(WEB, "built/kernels.wasm"))) };
    return `const KERNELS=${JSON.stringify({ kernels, ...told })};${readFileSync(join(VIEWER, "viewer.js"), "utf8")}`;
}

/** Drop files on a page. */
export function drop(page: Page, files: Record<string, Uint8Array>): Promise<void> {
    return page.evaluate(
        (files) => {
            const transfer = new DataTransfer();
            for (const [name, data] of files)
                transfer.items.add(new File([Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))], name));
            document.body.dispatchEvent(
                new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }),
            );
        },
        Object.entries(files).map(([name, bytes]) => [name, base64(bytes)] as const),
    );
}

/** The rows of the table on a page, by their names. */
export function tableOf(page: Page): Promise<Record<string, string>> {
    return page
        .locator("[data-part=facts]")
        .evaluate((list) =>
            Object.fromEntries(
                [...list.querySelectorAll("dt")].map((name) => [
                    name.textContent!,
                    name.nextElementSibling!.textContent!,
                ]),
            ),
        );
}

export function base64(bytes: Uint8Array): string {
    return Buffer.from(bytes).toString("base64");
}

/** The stream with the right checksum in every frame, so that damage reaches what is behind it. */
export function mended(stream: Uint8Array): Uint8Array {
    const view = new DataView(stream.buffer, stream.byteOffset, stream.byteLength);
    for (let at = 5; at < stream.length;) {
        let tag;
        try {
            tag = parseVarint(stream, at, stream.length);
        } catch {
            return stream;
        }
        if (!tag) return stream;
        const end = tag.end + Math.floor(tag.value / 16);
        const type = tag.value % 16;
        const size = type === 6 || tag.value < 16 * 128 ? 2 : 4;
        if (end + size > stream.length) return stream;
        if (type === 15 && end - tag.end > 4) view.setUint32(end - 4, crc32(stream.subarray(0, at)), true);
        if (size === 2) view.setUint16(end, crc16(stream.subarray(at, end)), true);
        else view.setUint32(end, crc32(stream.subarray(at, end)), true);
        at = end + size;
    }
    return stream;
}

/** Rows of an 8-bit PNG, and how wide its pixels are. */
export function* rowsOf(
    png: Buffer,
): Generator<{ row: Uint8Array; channels: number; y: number; width: number; height: number }> {
    const [width, height, channels] = [png.readUInt32BE(16), png.readUInt32BE(20), png[25] === 6 ? 4 : 3];
    const parts: Buffer[] = [];
    for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
        if (png.toString("latin1", at + 4, at + 8) === "IDAT")
            parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
    }
    const rows = inflateSync(Buffer.concat(parts));
    const stride = width * channels;
    let above = new Uint8Array(stride);
    for (let y = 0; y < height; y++) {
        const filter = rows[y * (stride + 1)];
        const row = Uint8Array.from(rows.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1)));
        for (let i = 0; i < stride; i++) {
            const [a, b, c] = [i < channels ? 0 : row[i - channels], above[i], i < channels ? 0 : above[i - channels]];
            const paeth = [a, b, c].sort((p, q) => Math.abs(a + b - c - p) - Math.abs(a + b - c - q))[0];
            row[i] += [0, a, b, (a + b) >> 1, paeth][filter];
        }
        yield { row, channels, y, width, height };
        above = row;
    }
}

/** Share of the pixels that differ from the corner, and where their middle is. */
export function silhouette(png: Buffer): { share: number; x: number; y: number } {
    let [count, sumX, sumY, size] = [0, 0, 0, [1, 1]];
    let corner: Uint8Array | undefined;
    for (const { row, channels, y, width, height } of rowsOf(png)) {
        corner ??= row.slice(0, 3);
        size = [width, height];
        for (let x = 0; x < width; x++) {
            if ([0, 1, 2].some((d) => Math.abs(row[x * channels + d] - corner![d]) > 8))
                [count, sumX, sumY] = [count + 1, sumX + x, sumY + y];
        }
    }
    const [width, height] = size;
    return { share: count / (width * height), x: sumX / count / width, y: sumY / count / height };
}
