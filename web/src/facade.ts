/** The package: the decoder, and threads that run it. */
import { Kernels, Team } from "./index";
import { here, type Build, type Source } from "./pool";
import { processors } from "./threads";

export * from "./index";
export * from "./pool";

const MOST_HELPERS = 3;

/** Kernels for a `Decoder` of one's own, compiled once; those of `quick` are for that of `bsm-decoder/quick` alone. */
export async function loadKernels(build: Build = "whole"): Promise<Kernels> {
    return new Kernels(await here.kernels(build));
}

/** Threads that help a decoder in this one; none where there can be none. */
export function startTeam(size = Math.min(processors() - 1, MOST_HELPERS), worthwhile?: number, source: Source = here): Team {
    const workers = Array.from({ length: size }, () => source.worker("whole"));
    return new Team(workers.flatMap((worker) => worker ?? []), worthwhile);
}
