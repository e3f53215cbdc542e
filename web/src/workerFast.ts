/** The worker of the decoder of light grids. */
import { deskOf, Reporter } from "./worker";
import { GridDecoder } from "./grids";

export const { openDesk, serve } = deskOf((start, kernels, say) => {
    const reporter = new Reporter(new GridDecoder(kernels, start.limits), start, say);
    return {
        close: () => reporter.close(),
        take(data) {
            reporter.take(data);
            reporter.report();
        },
    };
});
