/** Threads as parts of the script, and kernels where the page says: beside it, for who asks, or in it. */
import { bsm, openDesk } from "../index";
import { once } from "../fetched";
import type { Build } from "../peek";
import { creaseOf } from "../pool";
import type { Source } from "../source";
import { started } from "../threads";

/** Bytes, or their address, or in base64. */
export interface Inlined {
    url?: string;
    data?: string;
    bytes?: Uint8Array;
}

/** What `bsm.viewer.page` says before the script. */
declare const KERNELS: Record<"kernels", Inlined> &
    Partial<Record<"grid" | "encoder", Inlined>> & { presets: string[]; creaseAngle?: number };

/** The script of the thread that encodes, where no server does; whether `bsm view` serves the page, and can encode. */
export const encoder = KERNELS.encoder?.url;
export const served = KERNELS.kernels.url !== undefined && !encoder;
export const offered = KERNELS.presets; // what the server encodes with
export const crease = creaseOf(KERNELS.creaseAngle);

export async function fetched(url: string, start?: RequestInit): Promise<Response> {
    const response = await fetch(url, start);
    if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
    return response;
}

export async function bytesOf({ url, data, bytes }: Inlined): Promise<Uint8Array<ArrayBuffer>> {
    if (bytes) return bytes.slice(); // the decoder takes them
    if (data !== undefined) return Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
    return new Uint8Array(await (await fetched(url!)).arrayBuffer());
}

export const load = once(async (build: Build) =>
    WebAssembly.compile(await bytesOf((build === "grid" && KERNELS.grid) || KERNELS.kernels)),
);

export const inlined: Source = {
    worker() {
        const url = URL.createObjectURL(new Blob([`(${bsm})().serve()`], { type: "text/javascript" }));
        const worker = started(() => new Worker(url, { name: "BSM" }));
        URL.revokeObjectURL(url);
        return worker;
    },
    kernels: (build) => load(build === "grid" && KERNELS.grid ? build : "whole"),
    local: () => Promise.resolve({ openDesk }),
};
