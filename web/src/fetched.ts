/** WebAssembly from an address. */

/** What is said of an answer that is a page where something else was asked for. */
export const PAGE = "the server sent an HTML page; is the address right?";

export function isPage(bytes: Uint8Array): boolean {
    return /^\s*<(!|html)/i.test(new TextDecoder().decode(bytes.subarray(0, 64)));
}

export async function compiled(url: URL): Promise<WebAssembly.Module> {
    if (url.protocol === "file:") {
        const { readFile } = process.getBuiltinModule("node:fs/promises");
        return WebAssembly.compile(await readFile(url));
    }
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}; the decoder's files must lie there`);
    const bytes = await response.arrayBuffer();
    return WebAssembly.compile(bytes).catch((error: Error) => {
        throw new Error(`${url}: ${isPage(new Uint8Array(bytes)) ? PAGE : error.message}`);
    });
}
