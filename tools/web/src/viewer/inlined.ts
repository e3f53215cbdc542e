/** Threads as parts of the script, and kernels where the page says: beside it, for who asks, or in it. */
import { bsm, openDesk } from "../index";
import { compiled, once, type Source } from "../source";
import { hasVectors } from "../threads";

/** Bytes at an address, or in base64. */
export interface Place {
    url?: string;
    data?: string;
}

/** What `bsm.viewer.page` says before the script. */
declare const KERNELS: { kernels: Place; "kernels-scalar": Place; small?: Place };

const load = once((build) => {
    const { url, data } = (build === "small" && KERNELS.small) || KERNELS[hasVectors() ? "kernels" : "kernels-scalar"];
    return data === undefined ? compiled(new URL(url!, location.href)) : WebAssembly.compile(Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)));
});

export const inlined: Source = {
    worker() {
        const url = URL.createObjectURL(new Blob([`(${bsm})().serve()`], { type: "text/javascript" }));
        try {
            return new Worker(url, { name: "BSM" });
        } catch {
            return undefined; // the page's policy forbids it
        } finally {
            URL.revokeObjectURL(url);
        }
    },
    kernels: (build) => load(build === "small" && hasVectors() && KERNELS.small ? build : "whole"),
    local: () => Promise.resolve({ openDesk }),
};
