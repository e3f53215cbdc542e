/** What lesser builds leave out: it takes the place of the modules that are named in `scripts/build.mjs`. */
import { UnsupportedError } from "./errors";

function absent(what: string): never {
    throw new UnsupportedError(`this build decodes no ${what}; bsm.js does`);
}

export class Sequence {
    constructor() {
        absent("sequences");
    }
}

export class Runs {
    constructor() {
        absent("sequences");
    }
}

export const [CORNER, RECOMPUTED] = [1, 3];

export function parseDeclaration(): never {
    return absent("attributes");
}

export function wordsOf(): never {
    return absent("attributes");
}

export class Attributes {
    constructor() {
        absent("attributes");
    }
}

export function dressed(): never {
    return absent("attributes");
}

export function numbersOf(): never {
    return absent("attributes");
}

export class TolerantReader {
    constructor() {
        absent("damaged streams");
    }
}

export function checkAgain(): never {
    return absent("sequences");
}

export function readPaper(): never {
    return absent("blocks");
}

export function checkBlocks(): never {
    return absent("blocks");
}

export class Floats {
    constructor() {
        absent("floats");
    }
}

export class Refinement {
    constructor() {
        absent("refinements");
    }
}

export class Grid {
    constructor() {
        absent("grids");
    }
}

export function gridKernel(): never {
    return absent("grids");
}

export function lightKernel(): never {
    return absent("grids");
}

export function unpackZstd(): never {
    return absent("packed coefficients");
}

export function split(): never {
    return absent("split vertices");
}
