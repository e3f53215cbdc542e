/** The header: fields, legal values, contradictions (specification, F 4). */
import { HEADER_FIELDS } from "./constants";
import { CorruptError } from "./errors";
import { checkLimit, type Limits } from "./limits";
import { checkAgain, checkBlocks } from "./rules";
import { parseFields, same, type Fields } from "./record";

/** What a decoder must know before anything else; the names are those of the specification. */
export interface Header {
    vertices: number;
    faces: number;
    blocks: number;
    blockSize: number;
    coefficients: number;
    keyInterval: number;
    power: number;
    iterations: number;
    keyIterations: number;
    shift: number;
    coding: number;
    bits: number;
    step: number;
    center: number[];
    scale: number;
    stiffness: number;
    smoothing: number;
    frames: number;
    gopFrames: number;
    detailStep: number;
    details: number;
    coarser: number;
    grid: number[];
    lattice: number[];
    refinements: number[];
    keySeed: number;
    borders: number;
    attributes: number;
    corner: number[];
    sections: number[];
    light: number;
    run: number;
    again: number;
}

/** A section of a mesh: its first block, and the blocks and faces that there are with it and those before it. */
export interface Section {
    first: number;
    blocks: number;
    faces: number;
}

/** The sections that a mesh comes in, one at least (F 3.16). */
export function sectionsOf({ blocks, faces, sections }: Header): Section[] {
    const found: Section[] = [];
    let [first, known] = [0, 0];
    for (let i = 0; i < sections.length; i += 2) {
        found.push({ first, blocks: (first += sections[i + 1]), faces: (known += sections[i]) });
    }
    return [...found, { first, blocks, faces }];
}

/** `light`: floats in the cells of a grid follow its values (V 16). */
export const EXACT = 2;

const FIELDS: Fields<keyof Header> = HEADER_FIELDS;

/** Rows of all blocks together that so many vertices may have (F 4.6). */
export function mostCopies(vertices: number): number {
    return 16 * vertices + 65536;
}

/** Bytes of a header (F 4.9). */
const MOST_HEADER = 2 ** 16;
const LIMITED = ["vertices", "faces", "blocks", "blockSize", "coefficients", "frames", "gopFrames", "attributes"] as const;

/** The header in a payload; its counts are checked against `limits`. */
export function parseHeader(payload: Uint8Array, limits: Limits): Header {
    if (payload.length > MOST_HEADER) throw new CorruptError(`a header of ${payload.length} bytes, where ${MOST_HEADER} are legal`);
    const complete = parseFields(payload, FIELDS, "header") as unknown as Header;
    checkContradictions(complete);
    for (const name of LIMITED) checkLimit(limits, name, complete[name]);
    return complete;
}

/** Throw what is wrong with a header, if it is so. */
export function refuse(what: string, isSo: boolean): void {
    if (isSo) throw new CorruptError(`the header contradicts itself: ${what}`);
}

/** F 4.6: the rules of a grid, or those of blocks. */
function checkContradictions(header: Header): void {
    if (header.grid.length > 0) checkGrid(header);
    else if (header.again > 0) checkAgain(header, saysMore(header, OF_A_RUN));
    else checkBlocks(header);
}

/** Whether fields but those of `names` are other than their defaults. */
function saysMore(header: Header, names: readonly (keyof Header)[]): boolean {
    return (Object.keys(FIELDS) as (keyof Header)[]).some((name) => !names.includes(name) && !same(header[name], FIELDS[name].default));
}

const OF_A_RUN: (keyof Header)[] = ["vertices", "faces", "frames", "gopFrames", "run", "again"];
const OF_A_GRID: (keyof Header)[] = ["vertices", "faces", "center", "scale", "grid", "lattice", "attributes", "corner", "light"];

function checkGrid(header: Header): void {
    const { vertices, faces, center, corner, grid, lattice } = header;
    const [cells, points] = lattice.length === 2 ? lattice : [0, 0];
    refuse("more vertices than the corners of its faces", vertices > 3 * faces);
    refuse("a grid of other than three axes", grid.length !== 3);
    refuse("a lattice that is not cells and points", lattice.length === 1);
    refuse("a lattice with fewer points than the grid has values", points > 0 && points < Math.max(...grid));
    refuse("a lattice of more points than cells", points > cells);
    refuse("a corner that is not one of three axes", corner.length % 3 !== 0);
    refuse("floats in the cells of a lattice, or of cells that are counted", header.light === EXACT && lattice.length + corner.length > 0);
    refuse("a corner and a center", corner.length > 0 && !same(center, FIELDS.center.default));
    refuse("a grid, and fields of blocks", saysMore(header, OF_A_GRID));
}
