/** The header: fields, legal values, contradictions (specification, F 4). */
import { HEADER_FIELDS, PAPER_FIELDS, PAPER_OF_SEQUENCES } from "./constants";
import { CorruptError } from "./errors";
import { checkLimit, type Limits } from "./limits";
import { checkBlocks, checkAgain, readPaper } from "./rules";
import { parseFields, same, type Fields } from "./record";

/** The fields as they are stored. */
type Stored = Record<"vertices" | "faces" | "blocks" | "blockSize" | "coefficients" | "keyInterval" | "step" | "scale" | "smoothing" | "attributes" | "light", number> &
    Record<"center" | "refinement" | "grid" | "lattice" | "corner" | "sequence" | "run" | "paper", number[]>;

/** How blocks are coded; only the paper's codec has other than the law's constants (F 4). */
export type Paper = Readonly<Record<keyof typeof PAPER_FIELDS, number>>;

const LAW = Object.fromEntries(Object.entries(PAPER_FIELDS).map(([name, field]) => [name, field.default])) as unknown as Paper;
const LAW_OF_SEQUENCES: Paper = { ...LAW, ...PAPER_OF_SEQUENCES };

/** What a decoder must know before anything else; the names are those of the specification. */
export interface Header extends Omit<Stored, "sequence" | "run" | "paper"> {
    /** Of a sequence, 0 if nobody knew; and the most frames of a GOP, 0 for a static mesh. */
    frames: number;
    gopFrames: number;
    run: number;
    /** The run whose mesh this one has; a mesh of its own without one. */
    again?: number;
    paper: Paper;
}

/** `light`: floats in the cells of a grid follow its values (V 16). */
export const EXACT = 2;

const FIELDS: Fields<keyof Stored> = HEADER_FIELDS;

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
    const { sequence, run, paper, ...fields } = parseFields(payload, FIELDS, "header") as unknown as Stored;
    const saysMore = (names: readonly (keyof Stored)[]): boolean => !Object.entries({ sequence, run, paper, ...fields }).every(([name, content]) => names.includes(name as keyof Stored) || same(content, FIELDS[name as keyof Stored].default));
    const [frames = 0, gopFrames = 0] = sequence;
    const law = gopFrames > 0 ? LAW_OF_SEQUENCES : LAW;
    const header = { ...fields, frames, gopFrames, run: run[0] ?? 0, again: run[1], paper: paper.length > 0 ? readPaper(paper, law) : law };
    refuse("more vertices than the corners of its faces", header.vertices > 3 * header.faces);
    refuse("a sequence that is not frames and a length for GOPs", sequence.length > 0 && gopFrames === 0);
    refuse("a run of a static mesh", run.length > 0 && gopFrames === 0);
    refuse("a run that is stored although it is the first", run.length === 1 && run[0] === 0);
    if (header.grid.length > 0) checkGrid(header, saysMore(OF_A_GRID));
    else if (run.length > 1) checkAgain(header, saysMore(OF_A_RUN));
    else checkBlocks(header);
    for (const name of LIMITED) checkLimit(limits, name, header[name]);
    return header;
}

/** Throw what is wrong with a header, if it is so. */
export function refuse(what: string, isSo: boolean): void {
    if (isSo) throw new CorruptError(`the header contradicts itself: ${what}`);
}

const OF_A_RUN = ["vertices", "faces", "sequence", "run"] as const;
const OF_A_GRID = ["vertices", "faces", "center", "scale", "attributes", "grid", "lattice", "corner", "light"] as const;

/** F 4.6, of a grid; `more`: it has fields of blocks. */
function checkGrid({ center, corner, grid, lattice, light }: Header, more: boolean): void {
    const [cells, points] = lattice.length === 2 ? lattice : [0, 0];
    refuse("a grid of other than three axes", grid.length !== 3);
    refuse("a lattice that is not cells and points", lattice.length === 1);
    refuse("a lattice with fewer points than the grid has values", points > 0 && points < Math.max(...grid));
    refuse("a lattice of more points than cells", points > cells);
    refuse("a corner that is not one of three axes", corner.length % 3 !== 0);
    refuse("floats in the cells of a lattice, or of cells that are counted", light === EXACT && lattice.length + corner.length > 0);
    refuse("a corner and a center", corner.length > 0 && !same(center, FIELDS.center.default));
    refuse("a grid, and fields of blocks", more);
}
