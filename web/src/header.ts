/** The header: what a decoder must know before anything else (specification, F 4). */
import { GRID_FIELDS } from "./constants.json";
import { CorruptError, UnsupportedError } from "./errors";
import { checkLimit, type Limits } from "./limits";
import { parseMap, type Value } from "./maps";

type Numbers = Record<
    | "vertices"
    | "faces"
    | "blocks"
    | "blockSize"
    | "coefficients"
    | "keyInterval"
    | "step"
    | "scale"
    | "smoothing"
    | "attributes"
    | "light"
    | "congruence"
    | "bits",
    number
>;
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
const OTHERS = {
    blocks: 0,
    blockSize: 0,
    coefficients: 0,
    keyInterval: 0,
    step: 2 ** -8,
    smoothing: 0,
    attributes: 0,
    refinement: [],
    frames: 0,
    gopFrames: 0,
    run: 0,
    again: undefined,
    bits: 0,
};

/** The header of a light grid in a payload; its counts are checked against `limits`. */
export function parseHeader(payload: Uint8Array, limits: Limits): Header {
    if (payload.length > MOST_HEADER)
        throw new CorruptError(`a header of ${payload.length} bytes, where ${MOST_HEADER} are legal`);
    const entries = new Map(parseMap(payload).map(([key, value]) => [key.value, value]));
    const { light, grid } = GRID_FIELDS;
    const isOther = [...entries.keys()].some((key) => !FIELDS.some(([, field]) => field.key === key));
    if (isOther || entries.get(light.key)?.value !== LIGHT || !entries.has(grid.key))
        throw new UnsupportedError(
            "this build decodes light grids alone, which this is not; small.js and bsm.js decode more",
        );
    const header = {
        ...OTHERS,
        ...(Object.fromEntries(
            FIELDS.map(([name, field]) => [name, contentOf(name, field, entries.get(field.key))]),
        ) as unknown as Fields),
    };
    check(header);
    checkLimit(limits, "vertices", header.vertices);
    checkLimit(limits, "faces", header.faces);
    return header;
}

function contentOf(name: string, field: Field, value?: Value): Field["default"] {
    const { type, low, high, lengths = [1, 1] } = field;
    if (!value) {
        if (field.default === undefined) throw new CorruptError(`the header lacks ${name}`);
        return field.default;
    }
    const items = field.lengths && value.type === "array" ? value.value : [value];
    const list = items.map((item) => (item.type === type ? Number(item.value) : NaN));
    if (
        list.length < lengths[0] ||
        list.length > lengths[1] ||
        !list.every((number) => number >= low && number <= high) ||
        (field.lengths && value.type !== "array")
    ) {
        throw new CorruptError(`header field ${name} has another type, or is outside its legal range`);
    }
    if (`${list}` === `${field.default}`)
        throw new CorruptError(`header field ${name} is stored with its default value`);
    return field.lengths ? list : list[0];
}

/** F 4.6. */
function check({ vertices, faces, center, corner, grid, lattice }: Header): void {
    const [cells, points] = lattice.length === 2 ? lattice : [0, 0];
    refuse("more vertices than the corners of its faces", vertices > 3 * faces);
    refuse("a grid of other than three axes", grid.length !== 3);
    refuse("a lattice that is not cells and points", lattice.length === 1);
    refuse("a lattice with fewer points than the grid has values", points > 0 && points < Math.max(...grid));
    refuse("a lattice of more points than cells", points > cells);
    refuse("a corner of other than three axes", corner.length % 3 !== 0);
    refuse("a corner and a center", corner.length > 0 && center.some((place) => place !== 0));
}

/** Throw an error with this message if the condition holds. */
function refuse(what: string, isSo: boolean): void {
    if (isSo) throw new CorruptError(`the header contradicts itself: ${what}`);
}
