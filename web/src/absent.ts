/** What the decoder of light grids leaves out: it takes the place of `parting.ts`, as `scripts/build.mjs` says. */
export function drawnFaces(): never {
    throw new TypeError("this build draws no attributes");
}

export const movedAttributes = drawnFaces;
