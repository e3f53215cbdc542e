/** What the build for grids leaves out, and what it keeps of the same modules: it takes their place, see `scripts/build.mjs`. */
import { UnsupportedError } from "./errors";

export { Allowance } from "./chain";
export { inMeshUnits } from "./assembly";
export { Grid } from "./fields";

/** All that is made of blocks begins with this. */
export function makeGraph(): never {
    throw new UnsupportedError("this build decodes no blocks, only grids; small.js and bsm.js do");
}

export {
    makeGraph as Assembly,
    makeGraph as ChainDecoder,
    makeGraph as Refinement,
    makeGraph as chainLength,
    makeGraph as derivePartition,
    makeGraph as groupLabels,
    makeGraph as growBlocks,
    makeGraph as isMine,
    makeGraph as largestPart,
    makeGraph as lastOf,
};
