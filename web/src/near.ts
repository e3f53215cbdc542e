/** A decoder of light grids in the file of the loader: small streams need no other file, and no thread. */
import { once } from "./fetched";
import bytes from "quick.wasm";
import { openDesk } from "./quick";
import { here as beside, type Source } from "./source";

export * from "./source";

const embedded = once(() => WebAssembly.compile(bytes));

export const here: Source = {
    ...beside,
    kernels: (build) => (build === "quick" ? embedded(build) : beside.kernels(build)),
    local: (build) => (build === "quick" ? Promise.resolve({ openDesk }) : beside.local(build)),
    embedded: "quick",
};
embedded("quick").catch(() => {}); // while the page goes on; who decodes hears of it
