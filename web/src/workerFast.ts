/** The worker of the decoder of light grids. */
import { deskOf, Reporter } from "./worker";
import { GridDecoder } from "./grids";

// Not taken apart in one step: bundlers would lose what `serve` does.
const desk = deskOf((start, kernels, say) => {
    const reporter = new Reporter(new GridDecoder(kernels, start.limits), start, say);
    return {
        close: () => reporter.close(),
        take(data) {
            reporter.take(data);
            reporter.report();
        },
    };
});
export const openDesk = desk.openDesk;
export const serve = desk.serve;
