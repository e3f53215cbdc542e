/** The desk of the decoder of light grids. */
import { openDesk as opened, serveWith, Teller, type Desk, type Say, type Start } from "./desk";
import { Decoder } from "./grids";
import type { Kernels } from "./kernels";

function open(start: Start, kernels: Kernels, say: Say): Pick<Desk, "take"> {
    const teller = new Teller(new Decoder(kernels, start.limits), start, say);
    return {
        take(data) {
            teller.take(data);
            teller.tell();
        },
    };
}

/** Decode a stream in this thread, as another one would. */
export function openDesk(start: Start, say: Say): Desk {
    return opened(open, start, say);
}

/** Be a thread that decodes. */
export function serve(): void {
    serveWith(open);
}
