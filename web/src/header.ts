/** The header: fields, legal values, contradictions (specification, F 4). */
import { HEADER_FIELDS, PAPER_FIELDS } from "./constants";
import { CorruptError, UnsupportedError } from "./errors";
import { checkLimit, type Limits } from "./limits";
import { parseFields, same, type Fields } from "./record";

/** The fields as they are stored. */
type Stored = Record<"vertices" | "faces" | "blocks" | "blockSize" | "coefficients" | "keyInterval" | "step" | "scale" | "smoothing" | "attributes" | "light", number> &
    Record<"center" | "refinement" | "grid" | "lattice" | "corner" | "sequence" | "run" | "paper", number[]>;

/** How blocks are coded; only the paper's codec has other than the law's constants (F 4). */
export type Paper = Readonly<Record<keyof typeof PAPER_FIELDS, number>>;

const LAW = Object.fromEntries(Object.entries(PAPER_FIELDS).map(([name, field]) => [name, field.default])) as unknown as Paper;

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

const FIELDS: Fields<keyof Stored> = HEADER_FIELDS;

/** Bytes of a header (F 4.9). */
const MOST_HEADER = 2 ** 16;
const LIMITED = ["vertices", "faces", "attributes"] as const;
const OF_A_GRID = ["vertices", "faces", "center", "scale", "attributes", "grid", "lattice", "corner", "light"] as const;
const LIGHT = 1;

/** The header of a light grid in a payload; its counts are checked against `limits`. */
export function parseHeader(payload: Uint8Array, limits: Limits): Header {
    if (payload.length > MOST_HEADER) throw new CorruptError(`a header of ${payload.length} bytes, where ${MOST_HEADER} are legal`);
    const stored = parseFields(payload, FIELDS, "header") as unknown as Stored;
    const { sequence, run: _, paper: __, ...fields } = stored;
    if (fields.grid.length === 0 || fields.light !== LIGHT || fields.attributes > 0 || sequence.length > 0) throw new UnsupportedError("this build decodes light grids alone, which this is not; small.js and bsm.js decode more");
    const header = { ...fields, frames: 0, gopFrames: 0, run: 0, again: undefined, paper: LAW };
    refuse("more vertices than the corners of its faces", header.vertices > 3 * header.faces);
    checkGrid(header, Object.entries(stored).some(([name, content]) => !OF_A_GRID.includes(name as (typeof OF_A_GRID)[number]) && !same(content, FIELDS[name as keyof Stored].default)));
    for (const name of LIMITED) checkLimit(limits, name, header[name]);
    return header;
}

/** Throw what is wrong with a header, if it is so. */
function refuse(what: string, isSo: boolean): void {
    if (isSo) throw new CorruptError(`the header contradicts itself: ${what}`);
}

/** F 4.6, of a grid; `more`: it has fields of blocks. */
function checkGrid({ center, corner, grid, lattice }: Header, more: boolean): void {
    const [cells, points] = lattice.length === 2 ? lattice : [0, 0];
    refuse("a grid of other than three axes", grid.length !== 3);
    refuse("a lattice that is not cells and points", lattice.length === 1);
    refuse("a lattice with fewer points than the grid has values", points > 0 && points < Math.max(...grid));
    refuse("a lattice of more points than cells", points > cells);
    refuse("a corner of other than three axes", corner.length % 3 !== 0);
    refuse("a corner and a center", corner.length > 0 && !same(center, FIELDS.center.default));
    refuse("a grid, and fields of blocks", more);
}
