/** The header: fields, legal values, contradictions (specification, F 4). */
import { HEADER_FIELDS } from "./constants";
import { CorruptError } from "./errors";
import { checkLimit, type Limits } from "./limits";
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

/** F 4.6: the rules of a grid, or those of blocks. */
function checkContradictions(header: Header): void {
    const rules = header.grid.length > 0 ? gridRules(header) : header.again > 0 ? againRules(header) : blockRules(header);
    const broken = rules.find(([, broken]) => broken);
    if (broken) throw new CorruptError(`the header contradicts itself: ${broken[0]}`);
}

const OF_A_GRID: (keyof Header)[] = ["vertices", "faces", "center", "scale", "grid", "lattice", "attributes", "corner", "light"];

function gridRules(header: Header): [string, boolean][] {
    const { vertices, faces, center, corner, grid, lattice } = header;
    const [cells, points] = lattice.length === 2 ? lattice : [0, 0];
    const others = (Object.keys(FIELDS) as (keyof Header)[]).filter((name) => !OF_A_GRID.includes(name));
    return [
        ["more vertices than the corners of its faces", vertices > 3 * faces],
        ["a grid of other than three axes", grid.length !== 3],
        ["a lattice that is not cells and points", lattice.length === 1],
        ["a lattice with fewer points than the grid has values", points > 0 && points < Math.max(...grid)],
        ["a lattice of more points than cells", points > cells],
        ["a corner that is not one of three axes", corner.length % 3 !== 0],
        ["floats in the cells of a lattice, or of cells that are counted", header.light === EXACT && lattice.length + corner.length > 0],
        ["a corner and a center", corner.length > 0 && !same(center, FIELDS.center.default)],
        ["a grid, and fields of blocks", others.some((name) => !same(header[name], FIELDS[name].default))],
    ];
}

const OF_A_RUN: (keyof Header)[] = ["vertices", "faces", "frames", "gopFrames", "run", "again"];

function againRules(header: Header): [string, boolean][] {
    const others = (Object.keys(FIELDS) as (keyof Header)[]).filter((name) => !OF_A_RUN.includes(name));
    return [
        ["more vertices than the corners of its faces", header.vertices > 3 * header.faces],
        ["the mesh of a run that has not been", header.again > header.run],
        ["no length for GOPs", header.gopFrames === 0],
        ["the mesh of another run, and fields of its own", others.some((name) => !same(header[name], FIELDS[name].default))],
    ];
}

function blockRules(header: Header): [string, boolean][] {
    const { vertices, faces, blocks, blockSize, coefficients, details, detailStep, frames, gopFrames, sections } = header;
    const steps = header.refinements.filter((_, i) => i % 2 === 0);
    const before = sectionsOf(header).at(-2) ?? { blocks: 0, faces: 0 };
    const ratios = header.refinements.filter((_, i) => i % 2 === 1);
    return [
        ["neither blocks nor a grid", blocks * blockSize * coefficients === 0],
        ["a lattice without a grid", header.lattice.length > 0],
        ["a corner without a grid", header.corner.length > 0],
        ["light values without a grid", header.light > 0],
        ["more vertices than the corners of its faces", vertices > 3 * faces],
        ["more blocks than vertices", blocks > vertices],
        ["blocks larger than the mesh", blockSize > vertices],
        ["blocks too small to cover the mesh", blocks * blockSize < vertices],
        ["blocks that overlap too much", blocks * blockSize > mostCopies(vertices)],
        ["more coefficients than a block has vertices", coefficients > blockSize],
        ["more details than a block has vertices", details > blockSize],
        ["details without a step, or a step without details", details > 0 !== detailStep > 0],
        ["frames without a length for GOPs", frames > 0 && gopFrames === 0],
        ["a run of a static mesh", header.run > 0 && gopFrames === 0],
        ["refinements that are not pairs of step and ratio", steps.length !== ratios.length],
        ["a step of a refinement out of its range", !steps.every((step) => step >= 2 ** -40 && step <= 1)],
        ["a ratio of a refinement out of its range", !ratios.every((ratio) => ratio === 0 || ratio >= 1 / 16)],
        ["borders without refinements", header.borders > 0 && steps.length === 0],
        ["refinements of a sequence", steps.length > 0 && gopFrames > 0],
        ["sections that are not pairs of faces and blocks", sections.length % 2 > 0],
        ["no faces or no blocks for the last section", sections.length > 0 && (before.blocks >= blocks || before.faces >= faces)],
        ["sections of a sequence", sections.length > 0 && gopFrames > 0],
    ];
}
