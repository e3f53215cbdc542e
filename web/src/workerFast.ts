/** The worker of the decoder of light grids. */
import { deskOf, Reporter, type Open } from "./worker";
import { GridDecoder } from "./grids";

export const openFast: Open = (start, kernels, say) => {
    const reporter = new Reporter(new GridDecoder(kernels, start.limits), start, say);
    return {
        close: () => reporter.close(),
        take(data) {
            reporter.take(data);
            reporter.report();
        },
    };
};

export const { openDesk } = deskOf(openFast);
