/** The worker of all decoders but that of everything, which a pool starts before it knows what a stream needs. Pages import it. */
import { isLight } from "./peek";
import { deskOf } from "./worker";
import { openFast } from "./workerFast";
import { openFull } from "./workerFull";

// Not taken apart in one step: bundlers would lose what `serve` does.
const desk = deskOf((start, ...rest) => (isLight(start.build!) ? openFast : openFull)(start, ...rest));
export const openDesk = desk.openDesk;
export const serve = desk.serve;
