/** The header: what a decoder must know before anything else (specification, F 4). */
import { GRID_FIELDS } from "./constants.json";
import { UnsupportedError } from "./errors";
import { checkLimit, type Limits } from "./limits";
import { parseMap, type Value } from "./maps";
import { demand } from "./varint";

type OfAll = "vertices" | "faces" | "scale" | "attributes" | "light" | "congruence" | "bits";
type OfBlocks = "blocks" | "blockSize" | "coefficients" | "keyInterval" | "step" | "smoothing";
type Numbers = Record<OfAll | OfBlocks, number>;
type Lists = Record<"center" | "refinement" | "grid" | "lattice" | "corner", number[]>;

/** The names are those of the specification. */
export interface Header extends Numbers, Lists {
    /** Of a sequence, 0 if unknown; and the most frames of a GOP, 0 for a static mesh. */
    frames: number;
    gopFrames: number;
    run: number;
    /** The run whose mesh this one has; a mesh of its own without one. */
    again?: number;
}

/** A field in the header of a light grid: its key and its legal values; a list also has legal `lengths`. */
export interface Field {
    key: number;
    type: "int" | "float";
    low: number;
    high: number;
    default?: number | readonly number[];
    lengths?: readonly [number, number];
}

type Fields = Pick<Numbers, "vertices" | "faces" | "scale" | "light" | "congruence"> &
    Pick<Lists, "center" | "grid" | "lattice" | "corner">;

const FIELDS = Object.entries(GRID_FIELDS as unknown as Record<string, Field>);
/** Bytes of a header (F 4.9). */
const MOST_HEADER = 2 ** 16;
const LIGHT = 1;
/** What light grids have no fields of. */
const ABSENT = {
    ...{ blocks: 0, blockSize: 0, coefficients: 0, keyInterval: 0, step: 2 ** -8, smoothing: 0 },
    ...{ attributes: 0, refinement: [], frames: 0, gopFrames: 0, run: 0, bits: 0 },
};

/** The header of a light grid in a payload; its counts are checked against `limits`. */
export function parseHeader(payload: Uint8Array, limits: Limits): Header {
    demand(payload.length <= MOST_HEADER);
    const entries = new Map(parseMap(payload).map(([key, value]) => [key.value, value]));
    const { light, grid } = GRID_FIELDS;
    const isOther = [...entries.keys()].some((key) => !FIELDS.some(([, field]) => field.key === key));
    if (isOther || entries.get(light.key)?.value !== LIGHT || !entries.has(grid.key)) throw new UnsupportedError("");
    const contents = FIELDS.map(([name, field]) => [name, contentOf(field, entries.get(field.key))]);
    const header = { ...ABSENT, ...(Object.fromEntries(contents) as Fields) };
    check(header);
    checkLimit(limits, "vertices", header.vertices);
    checkLimit(limits, "faces", header.faces);
    return header;
}

function contentOf(field: Field, value?: Value): Field["default"] {
    const { type, low, high, lengths } = field;
    demand(value !== undefined || field.default !== undefined);
    if (!value) return field.default;
    demand(!lengths || value.type === "array");
    const items = value.type === "array" && lengths ? value.value : [value];
    const list = items.map((item) => (item.type === type ? Number(item.value) : NaN));
    demand(!lengths || (list.length >= lengths[0] && list.length <= lengths[1]));
    demand(list.every((number) => number >= low && number <= high));
    demand(`${list}` !== `${field.default}`);
    return lengths ? list : list[0];
}

/** F 4.6. */
function check({ vertices, faces, center, corner, grid, lattice }: Header): void {
    const [cells, points] = lattice.length === 2 ? lattice : [0, 0];
    demand(vertices <= 3 * faces);
    demand(grid.length === 3);
    demand(lattice.length !== 1 && (points === 0 || points >= Math.max(...grid)) && points <= cells);
    demand(corner.length % 3 === 0 && !(corner.length > 0 && center.some((place) => place !== 0)));
}
