/** A server of the loopback interface, with what was built, three.js, vectors, and a page of one script. */
import { readFileSync } from "node:fs";
import { createServer, type Server } from "node:http";
import type { AddressInfo } from "node:net";
import { extname, join, normalize } from "node:path";
import { VECTORS, WEB } from "./shared";

const TYPES: Record<string, string> = {
    ".js": "text/javascript",
    ".html": "text/html",
    ".wasm": "application/wasm",
    ".glb": "model/gltf-binary",
};
/** What three.js is called, and nothing but files of one's own: no eval, no blob, no script in the page but the map. */
const MAP =
    '{"imports":{"three":"/three/build/three.module.js","three/addons/":"/three/examples/jsm/","bsm":"/bsm/main.js","bsm/three":"/bsm/three.js","@babylonjs/loaders/glTF/2.0/glTFLoaderExtensionRegistry.js":"/babylon.js"}}';
const MAP_HASH = "sha256-" + (await import("node:crypto")).createHash("sha256").update(MAP).digest("base64");
export const POLICY = `default-src 'none'; connect-src 'self'; script-src 'self' 'wasm-unsafe-eval' '${MAP_HASH}'; worker-src 'self'`;
const FOLDERS: Record<string, string> = {
    bsm: join(WEB, "built"),
    three: join(WEB, "node_modules/three"),
    "three-oldest": join(WEB, "node_modules/three-oldest"),
    bvh: join(WEB, "node_modules/three-mesh-bvh"),
    stream: VECTORS,
};

export interface Site {
    address: string;
    /** What is served beside the folders: a page at "/" with the script at "/script.js", and whatever else there is. */
    extra: Map<string, string | Uint8Array>;
    /** Headers of all answers. */
    headers: Record<string, string>;
    close(): void;
}

export async function serveSite(): Promise<Site> {
    const extra = new Map<string, string | Uint8Array>();
    const headers: Record<string, string> = {};
    const server: Server = createServer((request, response) => {
        const path = normalize(new URL(request.url ?? "/", "http://localhost").pathname);
        const [, folder, ...rest] = path.split("/");
        try {
            const page = `<!doctype html><script type="importmap">${MAP}</script><body></body><script type="module" src="/script.js"></script>`;
            const content = path === "/" ? page : (extra.get(path) ?? readFileSync(join(FOLDERS[folder], ...rest)));
            response
                .writeHead(200, {
                    "Content-Type": path === "/" ? "text/html" : (TYPES[extname(path)] ?? "application/octet-stream"),
                    ...headers,
                })
                .end(content);
        } catch {
            response.writeHead(404).end();
        }
    });
    await new Promise<void>((ready) => server.listen(0, "127.0.0.1", ready));
    return {
        address: `http://127.0.0.1:${(server.address() as AddressInfo).port}/`,
        extra,
        headers,
        close: () => void server.close(),
    };
}
