/** The page of `bsm view`, and the widget of notebooks: one module that is either, by where it finds itself. */
import { Pool } from "../pool";
import { inlined, type Place } from "./inlined";
import { View, type Content, type Rival } from "./view";

declare const LICENCES: string;

/** A stream of the page; the original in single precision, least byte first. */
interface Source extends Place {
    name: string;
    live?: boolean;
    /** The folder of a mesh in tiles. */
    tiles?: string;
    original?: Place;
    draco?: Rival;
}

/** What a widget knows of its other half in Python (https://anywidget.dev/en/afm). */
interface Model {
    get(name: string): unknown;
    on(event: string, listener: () => void): void;
    off(event: string, listener: () => void): void;
}

async function responseOf(name: string, { url, data }: Place): Promise<Response> {
    const response = await fetch(url ?? `data:application/octet-stream;base64,${data}`);
    if (!response.ok) throw new Error(`${name}: ${response.status} ${response.statusText}`);
    return response;
}

async function contentOf({ name, live, original, draco }: Source): Promise<Content> {
    const bytes = original && new Uint8Array(await (await responseOf(name, original)).arrayBuffer());
    return { name, live, original: bytes && floats(bytes), draco };
}

function floats(bytes: Uint8Array): Float32Array {
    return new Float32Array(bytes.slice().buffer);
}

/** Fill the page with the streams that are listed in it. */
async function fillPage(list: HTMLElement): Promise<void> {
    const sources = JSON.parse(list.textContent!) as Source[];
    const view = new View(document.body, new Pool(inlined), LICENCES);
    let turns = 0;
    const open = async (index: number): Promise<void> => {
        const turn = ++turns;
        try {
            const { name, tiles } = sources[index];
            if (tiles !== undefined) return await view.openTiles(name, tiles);
            const content = await contentOf(sources[index]);
            const reader = (await responseOf(content.name, sources[index])).body!.getReader();
            if (turn === turns) view.open(content);
            for (;;) {
                const { done, value } = await reader.read();
                if (turn !== turns) return void reader.cancel();
                if (done) return view.finish();
                view.receive(value);
            }
        } catch (error) {
            if (turn === turns) view.fail(`The stream could not be fetched. ${error instanceof Error ? error.message : error}`);
        }
    };
    view.offer(sources.map(({ name }) => name), open);
    await open(0);
}

/** Draw a widget into an element; returns what takes it away. */
async function render({ model, el }: { model: Model; el: HTMLElement }): Promise<() => void> {
    const root = el.appendChild(document.createElement("div"));
    root.style.height = `${model.get("height")}px`;
    const view = new View(root, new Pool(inlined), LICENCES);
    const bytes = (name: string): Uint8Array => {
        const { buffer, byteOffset, byteLength } = model.get(name) as DataView<ArrayBuffer>;
        return new Uint8Array(buffer, byteOffset, byteLength);
    };
    const open = (): void => {
        const original = bytes("original");
        view.open({ name: String(model.get("name")), original: original.length > 0 ? floats(original) : undefined });
        view.receive(bytes("stream"));
        view.finish();
    };
    model.on("change:stream", open);
    open();
    return () => {
        model.off("change:stream", open);
        view.close();
    };
}

export default { render };

const list = document.getElementById("bsm-streams");
if (list) void fillPage(list);
