/** The page of `bsm view`. */
import { inlinedKernels } from "../inlined";
import { View, type Content, type Rival } from "./view";

/** A stream beside the page, or in it in base64; the original likewise, as single precision. */
interface Source {
    name: string;
    url?: string;
    data?: string;
    original?: { url?: string; data?: string };
    draco?: Rival;
}

declare const LICENCES: string;

async function bytesOf(name: string, { url, data }: { url?: string; data?: string }): Promise<Uint8Array> {
    const response = await fetch(url ?? `data:application/octet-stream;base64,${data}`);
    if (!response.ok) throw new Error(`${name}: ${response.status} ${response.statusText}`);
    return new Uint8Array(await response.arrayBuffer());
}

async function contentOf(source: Source): Promise<Content> {
    const stream = await bytesOf(source.name, source);
    const original = source.original && new Float32Array((await bytesOf(source.name, source.original)).buffer);
    return { stream, original, draco: source.draco };
}

async function start(): Promise<void> {
    const sources = JSON.parse(document.getElementById("streams")!.textContent!) as Source[];
    const view = new View(document.body, await inlinedKernels(), LICENCES);
    sources.forEach((source, i) => view.streams.add(new Option(source.name, String(i))));
    const open = async (): Promise<void> => {
        try {
            view.open(await contentOf(sources[Number(view.streams.value)]));
        } catch (error) {
            view.fail(`The stream could not be fetched. ${error instanceof Error ? error.message : error}`);
        }
    };
    view.streams.addEventListener("change", open);
    await open();
}

void start();
