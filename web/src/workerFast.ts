/** The worker of the decoder of light grids. */
import { openDesk as opened, serveWith, Reporter, type Open, type StreamWorker, type Say, type Start } from "./worker";
import { Decoder } from "./grids";
import type { Kernels } from "./kernels";

function open(start: Start, kernels: Kernels, say: Say): ReturnType<Open> {
    const reporter = new Reporter(new Decoder(kernels, start.limits), start, say);
    return {
        close: () => reporter.close(),
        take(data) {
            reporter.take(data);
            reporter.report();
        },
    };
}

/** Decode a stream in this thread, as another one would. */
export function openDesk(start: Start, say: Say): StreamWorker {
    return opened(open, start, say);
}

/** Be a thread that decodes. */
export function serve(): void {
    serveWith(open);
}
