/** WebAssembly from an address. */

/** What a caught error, or whatever was thrown, says. */
export const messageOf = (error: unknown): string => (error instanceof Error ? error.message : `${error}`);

/** What is said of an answer that is a page where something else was asked for. */
export const PAGE = "the server sent an HTML page; is the address right?";

export function isPage(bytes: Uint8Array): boolean {
    return /^\s*<(!|html)/i.test(new TextDecoder().decode(bytes.subarray(0, 64)));
}

/** An address as pages write them. */
export const resolved = (url: string | URL): URL =>
    new URL(url, globalThis.document?.baseURI ?? globalThis.location?.href);

/** The bytes at an address, of a file where files can be read. */
async function bytesAt(url: URL): Promise<ArrayBuffer | Uint8Array<ArrayBuffer>> {
    const builtin = globalThis.process?.getBuiltinModule?.bind(globalThis.process);
    if (url.protocol === "file:" && builtin)
        return new Uint8Array(await builtin("node:fs/promises").readFile(builtin("node:url").fileURLToPath(url.href)));
    const isOld = url.protocol === "file:" && !globalThis.document;
    const without = (error: Error): never => {
        throw isOld ? new Error("Node 20.16 or later is needed", { cause: error }) : error;
    };
    return (await answered(url).catch(without)).arrayBuffer();
}

async function answered(url: URL): Promise<Response> {
    const response = await fetch(url);
    if (!response.ok)
        throw new Error(`${url}: ${response.status} ${response.statusText}; the decoder's files must lie there`);
    return response;
}

/** WebAssembly that is compiled while it comes, where the server says that it is that. */
export async function compiled(url: URL): Promise<WebAssembly.Module> {
    const response = /^http/.test(url.protocol) ? await answered(url) : undefined;
    if (response && /^application\/wasm\b/.test(response.headers.get("content-type") ?? ""))
        // After a complete read, the error can be named.
        return WebAssembly.compileStreaming(response).catch(async () => ofBytes(url, await bytesAt(url)));
    return ofBytes(url, await (response?.arrayBuffer() ?? bytesAt(url)));
}

function ofBytes(url: URL, bytes: ArrayBuffer | Uint8Array<ArrayBuffer>): Promise<WebAssembly.Module> {
    return WebAssembly.compile(bytes).catch((error: Error) => {
        throw new Error(`${url}: ${isPage(new Uint8Array(bytes)) ? PAGE : error.message}`);
    });
}

/** A promise for each key, asked for once; a failed one is asked for again. */
export function once<Key, Value>(load: (key: Key) => Promise<Value>): (key: Key) => Promise<Value> {
    const loading = new Map<Key, Promise<Value>>();
    return (key) => {
        const found = loading.get(key) ?? load(key);
        loading.set(key, found);
        found.catch(() => loading.delete(key));
        return found;
    };
}
