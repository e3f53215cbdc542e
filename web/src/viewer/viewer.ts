/** The page of `bsm view`, and the widget of notebooks: one module that is either, by where it finds itself. */
import { messageOf } from "../fetched";
import { Pool } from "../pool";
import type { Job, Status } from "./encoder";
import type { Content } from "./facts";
import { bytesOf, crease, encoder, fetched, inlined, load, offered, served } from "./inlined";
import { bytesIn, contentOf, type Encode, isStream, pathOf } from "./upload";
import { View } from "./view";

declare const LICENSES: string;

const MOST_BYTES = 2 ** 26;
const BITS = ["14 bits", "12 bits", "16 bits", "lossless"]; // what the encoder of pages offers

/** What a widget knows of its other half in Python (https://anywidget.dev/en/afm). */
interface Model {
    get(name: string): unknown;
    on(event: string, listener: () => void): void;
    off(event: string, listener: () => void): void;
}

async function* piecesOf({ body }: Response): AsyncGenerator<Uint8Array> {
    const reader = body!.getReader();
    try {
        for (let piece; !(piece = await reader.read()).done;) yield piece.value;
    } finally {
        reader.cancel().catch(() => {}); // what was aborted has been thrown already
    }
}

/** What the server says while it encodes. */
type Telling = { stage: string; share: number; error?: string; entry?: Content };

/** Have the server encode a file; it stops when its reader cancels. */
const encode: Encode = async (files, preset, report, signal) => {
    const body = new Blob(files);
    if (body.size > MOST_BYTES)
        throw new Error(`More than ${MOST_BYTES >> 20} MiB; use bsm encode, bsm tile, or bsm view --original.`);
    const query = new URLSearchParams({ preset });
    for (const file of files) {
        query.append("name", pathOf(file));
        query.append("size", `${file.size}`);
    }
    const decoder = new TextDecoder();
    let text = "";
    for await (const piece of piecesOf(await fetched(`upload?${query}`, { method: "POST", body, signal }))) {
        text += decoder.decode(piece, { stream: true });
        for (let end; (end = text.indexOf("\n")) >= 0; text = text.slice(end + 1)) {
            const { stage, share, error, entry } = JSON.parse(text.slice(0, end)) as Telling;
            if (error) throw new Error(error);
            if (entry) return entry;
            report(stage, share);
        }
    }
    throw new Error("The server has stopped.");
};

/** Encode a mesh or a sequence, or compare two, in a thread of the page; it ends when its reader cancels. */
const encodeHere: Encode = async (files, preset, report, signal) => {
    if (files.every(isStream)) return contentOf(files, await Promise.all(files.map(bytesIn)), {});
    const named = files.map((file) => new File([file], pathOf(file)));
    const kernels = await load("whole");
    const worker = new Worker(encoder!, { type: "module", name: "BSM encoder" });
    return new Promise<Content>((resolve, fail) => {
        signal.addEventListener("abort", () => fail(signal.reason), { once: true });
        worker.onerror = ({ message }) => fail(new Error(message || "The encoder cannot be loaded."));
        worker.onmessage = ({ data }: MessageEvent<Status>) => {
            if ("error" in data) fail(new Error(data.error));
            else if ("stage" in data) report(data.stage, data.share);
            else resolve(data.content);
        };
        worker.postMessage({ files: named, preset, kernels, crease } satisfies Job);
    }).finally(() => worker.terminate());
};

async function fillPage(list: HTMLElement): Promise<void> {
    const contents = JSON.parse(list.textContent!) as Content[];
    const pool = new Pool(inlined);
    const [own, presets] = encoder ? [encodeHere, BITS] : served ? [encode, offered] : [];
    const view = new View(document.body, pool, LICENSES, own, presets);
    const open = async (index: number): Promise<void> => {
        const mine = view.begin();
        const content = contents[index];
        try {
            if (content.tiles !== undefined) return await view.openTiles(content, index);
            await pool.preload("whole").catch(() => {}); // so that only decoding is timed; errors come from the decoder
            if (!mine()) return;
            const layer = content.layers[content.main];
            const pieces = layer.url === undefined ? [await bytesOf(layer)] : piecesOf(await fetched(layer.url));
            if (mine()) view.open(content, index);
            for await (const piece of pieces) {
                if (!mine()) return;
                view.receive(piece);
            }
            if (mine()) view.finish();
        } catch (error) {
            if (mine()) view.fail(`${content.name} could not be fetched. ${messageOf(error)}`);
        }
    };
    const names = contents.map(({ name }) => name);
    view.offer(names, open);
    if (contents.length > 0) await open(0);
}

async function render({ model, el }: { model: Model; el: HTMLElement }): Promise<() => void> {
    const root = el.appendChild(document.createElement("div"));
    root.style.height = `${model.get("height")}px`;
    const view = new View(root, new Pool(inlined), LICENSES);
    const open = async (): Promise<void> => {
        const content = model.get("content") as Content;
        view.showAll(content, await bytesOf(content.layers[content.main]));
    };
    model.on("change:content", open);
    await open();
    return () => {
        model.off("change:content", open);
        view.close();
    };
}

export default { render };

const list = document.getElementById("bsm-streams");
if (list) void fillPage(list);
