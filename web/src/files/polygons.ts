/**
 * The contents of mesh files, polygons with columns of attributes, and their conversion to a mesh.
 *
 * This is `bsm.files.formats.polygons` in TypeScript: a file gives the same vertices, triangles, attributes and notes in
 * a page as in Python, and `tests/bsm/files/test_javascript.py` compares them for all files that there are. Polygons become fans from
 * the first corner from which no triangle of them is folded, or else ears are clipped, by the library that Python uses,
 * too. A polygon whose sides cross stays a fan, and a note says so.
 */
import earcut from "earcut";
import { Vector3 } from "three";
import type { AttributeInput, MeshInput } from "../encoding";

export type ColumnValues =
    Int8Array | Uint8Array | Int16Array | Uint16Array | Int32Array | Uint32Array | Float32Array | Float64Array;

/** A value for each point, each polygon, or each corner of the polygons; it may be wrong. */
export interface Column {
    name: string;
    values: ColumnValues;
    components: number;
    domain: "vertex" | "corner" | "face";
    semantic?: AttributeInput["semantic"];
    /** Which value each corner has; undefined: corner i has value i. */
    indices?: ArrayLike<number>;
    /** What the file calls it, if its name is another one. */
    called?: string;
    /** What the file calls its components, if its meaning does not tell. */
    parts?: readonly string[];
    /** Why it cannot be an attribute. */
    fault?: string;
}

/** The points of a file in full precision, and its polygons over them. */
export interface Polygons {
    positions: Float64Array;
    sizes: ArrayLike<number>;
    corners: ArrayLike<number>;
    columns: Column[];
    metadata: Record<string, string | number>;
    notes: string[];
    dropped: string[];
}

export type PlainMesh = MeshInput & { positions: Float32Array | Float64Array; faces: Uint32Array };

export const PLURALS = new Map([
    ["color", "colors"],
    ["normal", "normals"],
    ["texcoord", "texture coordinates"],
]);
const MOST_TURNS = 16; // fans that are tried for a polygon
const MOST_CORNERS = 2 ** 15; // of a polygon whose ears are clipped: that can take the square of it
const SINGLE = 1e-6; // of its range, by which single precision may move a value
const NAMED_APART = 16; // names that have an entry of metadata each

/** A mesh of triangles, and a sentence for each change of the file's contents. */
export function meshOfPolygons(polygons: Polygons): { mesh: PlainMesh; notes: string[]; dropped: string[] } {
    const { positions, sizes, corners, columns, metadata } = polygons;
    const [notes, dropped, count] = [[...polygons.notes], [...polygons.dropped], positions.length / 3];
    const every = Array.from(sizes);
    const why = dropped.length > 0 ? `it has ${dropped.join(", ")}` : "point clouds are not supported";
    if (!every.some((size) => size > 0)) throw new Error(`the file has no faces that can be read; ${why}`);
    for (let i = 0; i < corners.length; i++)
        if (!(corners[i] >= 0 && corners[i] < count))
            throw new Error(`a face refers to vertex ${corners[i]}, outside 0..${count - 1}`);
    requireFinite(positions);
    const [thin, large] = [every.filter((size) => size < 3).length, every.filter((size) => size > 3).length];
    if (thin > 0) dropped.push(`faces with fewer than three corners (${thin})`);
    if (large > 0) notes.push(`polygons were cut into triangles: ${large}`);
    const { places, owners, crossing } = triangulated(positions, every, corners);
    if (crossing > 0) notes.push(`polygons whose sides cross, so that their triangles overlap: ${crossing}`);
    const finite = columns.flatMap((column) => withoutInfinite(column, dropped));
    const rows = { vertex: count, face: every.length };
    const attributes: AttributeInput[] = [];
    const fileNames: Record<string, string> = {};
    const refused: [string, string][] = [];
    for (const column of finite) {
        const { components, domain, semantic = "generic", values } = column;
        const name = unusedName(column.name, domain, new Set(attributes.map((each) => each.name)));
        const wrong = faultOf(column, rows, places);
        if (wrong) {
            refused.push([PLURALS.get(column.name) ?? column.name, wrong]);
            continue;
        }
        const own = domain === "face" ? picked(values, components, owners) : values;
        const indexOf = (place: number): number => column.indices?.[place] ?? place;
        const indices = domain === "corner" ? Int32Array.from(places, indexOf) : undefined;
        attributes.push({ name, values: own, components, domain, semantic, indices });
        const called = column.called ?? (name === column.name ? undefined : column.name);
        if (called) fileNames[`called.${name}`] = called;
        if (column.parts) fileNames[`components.${name}`] = column.parts.join("\n");
    }
    if (dropped.length > 0) notes.push(`left out: ${dropped.join(", ")}`);
    for (const [name, why] of refused) notes.push(`left out: ${name}, because ${why}`);
    const faces = Uint32Array.from(places, (place) => corners[place]);
    if (faces.length === 0) throw new Error("the mesh has no faces; point clouds are not supported");
    const single = Float32Array.from(positions);
    const isSingle = single.every((number, i) => number === positions[i]);
    const own = { positions: isSingle ? single : positions, faces, attributes };
    const mesh = { ...own, metadata: { ...metadata, ...fileNames } };
    return { mesh, notes, dropped: [...dropped, ...refused.map(([name]) => name)] };
}

export function requireFinite(positions: Float32Array | Float64Array): void {
    const infinite = positions.findIndex((number) => !Number.isFinite(number));
    if (infinite >= 0)
        throw new Error(`vertex ${Math.floor(infinite / 3)} has a coordinate that is not finite; remove or repair it`);
}

/** Why a column cannot be an attribute of triangles whose corners are those at some places; undefined: it can. */
function faultOf(
    { name, components, domain, fault, indices, values }: Column,
    rows: { vertex: number; face: number },
    places: Uint32Array,
): string | undefined {
    const there = values.length / components;
    if (fault) return `the values of the attribute '${name}' ${fault}`;
    if (Array.prototype.some.call(values, (value: number) => !Number.isFinite(value)))
        return `a value of the attribute '${name}' is not finite`;
    if (domain !== "corner")
        return there === rows[domain] ? undefined : `there are ${there} of them for ${rows[domain]}`;
    const corners = indices?.length ?? there;
    const most = places.reduce((high, place) => Math.max(high, place), -1);
    if (most >= corners) return `there are ${corners} of them for ${most + 1} corners`;
    const outside = places.find((place) => !((indices?.[place] ?? place) >= 0 && (indices?.[place] ?? place) < there));
    return outside === undefined ? undefined : `a corner refers to value ${indices?.[outside] ?? outside}`;
}

/** A column with the median of the others for values that are not finite, and one that marks these. */
function withoutInfinite(column: Column, dropped: string[]): Column[] {
    const { name, values, components, domain, indices } = column;
    const lost = isFloat(values) ? countOf(values) : 0;
    if (lost === 0 || lost === values.length) return [column];
    const called = PLURALS.get(name) ?? name;
    dropped.push(`values of ${called} that are not numbers (${lost}); ${name}.none marks them`);
    const floats = values as Float64Array;
    const usual = medianOf(floats.filter(Number.isFinite));
    const kept = floats.map((value) => (Number.isFinite(value) ? value : usual));
    const marks = new Uint8Array(values.length / components);
    floats.forEach((value, i) => {
        if (!Number.isFinite(value)) marks[Math.floor(i / components)] = 1;
    });
    return [
        { ...column, values: kept },
        { name: `${name}.none`, values: marks, components: 1, domain, indices },
    ];
}

/** The middle of floats, or the mean of the two in the middle, in their own precision. */
function medianOf(values: Float32Array | Float64Array): number {
    const [sorted, half] = [values.slice().sort(), Math.floor(values.length / 2)];
    if (values.length % 2 === 1) return sorted[half];
    const sum = sorted[half - 1] + sorted[half];
    return (values instanceof Float32Array ? Math.fround(sum) : sum) / 2;
}

const isFloat = (values: ColumnValues): values is Float32Array | Float64Array =>
    values instanceof Float32Array || values instanceof Float64Array;

const countOf = (values: Float32Array | Float64Array): number =>
    (values as Float64Array).reduce((count, value) => count + Number(!Number.isFinite(value)), 0);

export function unusedName(name: string, domain: string, taken: Set<string>): string {
    const longer = name.startsWith(domain) ? name : `${domain}_${name}`;
    for (const candidate of [name, longer]) if (!taken.has(candidate)) return candidate;
    for (let number = 2; ; number++) if (!taken.has(`${name}${number}`)) return `${name}${number}`;
}

/** Rows of a table, by their numbers. */
export function picked<Table extends ColumnValues>(values: Table, width: number, rows: ArrayLike<number>): Table {
    const found = new (values.constructor as new (size: number) => Table)(width * rows.length);
    for (let i = 0; i < found.length; i++) found[i] = values[width * rows[Math.floor(i / width)] + (i % width)];
    return found;
}

/** The first vertex that is where each one is in every frame, of which there are `size` numbers, by a table of their bits. */
export function firstsOf(positions: Float32Array | Float64Array, size = positions.length): Int32Array {
    const bits = new Uint32Array(Float64Array.from(positions.subarray(0, size), (number) => number + 0).buffer); // -0 is 0
    const table = new Int32Array(2 ** Math.ceil(Math.log2(size + 2))).fill(-1);
    const isSame = (a: number, b: number): boolean => {
        for (let i = 0; i < positions.length; i += size)
            for (let d = 0; d < 3; d++) if (positions[i + 3 * a + d] !== positions[i + 3 * b + d]) return false;
        return true;
    };
    return new Int32Array(size / 3).map((_, vertex) => {
        let hash = 0;
        for (let k = 6 * vertex; k < 6 * vertex + 6; k++) hash = Math.imul(hash ^ bits[k] ^ (hash >>> 15), 0x9e3779b1);
        let slot = (hash ^ (hash >>> 13)) & (table.length - 1);
        while (table[slot] >= 0 && !isSame(table[slot], vertex)) slot = (slot + 1) & (table.length - 1);
        if (table[slot] < 0) table[slot] = vertex;
        return table[slot];
    });
}

/** Floats in single precision where that moves none by more than a millionth of their range. */
export function compact(values: Float64Array, width: number): Float32Array | Float64Array {
    const low = new Float64Array(width).fill(Infinity);
    const high = new Float64Array(width).fill(-Infinity);
    let off = 0;
    for (let i = 0; i < values.length; i++) {
        const d = i % width;
        low[d] = Math.min(low[d], values[i]);
        high[d] = Math.max(high[d], values[i]);
        off = Math.max(off, Math.abs(Math.fround(values[i]) - values[i]));
    }
    const range = Math.hypot(...high.map((most, d) => most - low[d]));
    return values.length > 0 && Number.isFinite(range) && off <= SINGLE * range ? Float32Array.from(values) : values;
}

/** Colors as a file has them: bytes, or floats from 0 to 1; numbers beyond that mean nothing known. */
export function colorColumn(values: ColumnValues, components: number, domain: Column["domain"]): Column {
    const column = { name: "color", values, components, domain };
    if (values instanceof Uint8Array || values instanceof Uint16Array) return { ...column, semantic: "color" };
    if (!isFloat(values)) return { ...column, semantic: "generic" };
    if (values.length === 0) return column;
    if (countOf(values) > 0) return partlyColored(values, column);
    const floats = values as Float64Array;
    const exact = floats.some((value) => value > 1) ? floats : floats.map((value) => 255 * value);
    const isWhole = (value: number): boolean => {
        const byte = Math.round(value);
        return byte >= 0 && byte <= 255 && Math.abs(byte - value) <= 255e-6;
    };
    if (exact.every(isWhole)) return { ...column, values: Uint8Array.from(exact, Math.round), semantic: "color" };
    const plain = values instanceof Float64Array ? compact(values, components) : values;
    const isShare = floats.every((value) => value >= 0 && value <= 1);
    return { ...column, values: plain, semantic: isShare ? "color" : "generic" };
}

/** Floats of which some rows are no colors: the others tell what they are. */
function partlyColored(values: Float32Array | Float64Array, column: Column): Column {
    const { components, domain } = column;
    const isWhole = (row: number): boolean => countOf(values.subarray(components * row, components * (row + 1))) === 0;
    const rows = Array.from({ length: values.length / components }, (_, row) => row).filter(isWhole);
    if (rows.length === 0) return column;
    const whole = picked(values, components, rows);
    const { values: made, semantic } = colorColumn(whole, components, domain);
    const isBytes = made instanceof Uint8Array && (whole as Float64Array).some((value) => value > 1);
    return { ...column, values: isBytes ? (values as Float64Array).map((value) => value / 255) : values, semantic };
}

/** The meaning of values by their name, if as many components can mean that. */
export function meaningOf(name: string, components: number): Column["semantic"] {
    const widths = { color: [3, 4], normal: [3], texcoord: [2, 3] };
    const found = /^(?:(?:vertex|corner|face)_)?(color|normal|texcoord)s?(?![a-z])/.exec(name.toLowerCase());
    const meaning = found?.[1] as keyof typeof widths | undefined;
    return meaning && widths[meaning].includes(components) ? meaning : "generic";
}

/** The metadata that call the things 0, 1, ... so: an entry each, or, of many, one text. */
export function named(names: string[], what: string): Record<string, string> {
    if (names.length <= NAMED_APART)
        return Object.fromEntries(names.map((name, number) => [`${what}.${number}.name`, name]));
    return { [`${what}.names`]: names.map((name) => name.replace(/[\0-\x1f\x7f]/g, " ")).join("\n") };
}

/** The groups of faces: numbers if there are several, and their names as metadata; `ofFace` counts the names so far. */
export function grouped(what: string, names: string[], ofFace: number[]): Pick<Polygons, "columns" | "metadata"> {
    const used = [...new Set(ofFace)].sort((a, b) => a - b);
    const numbers = new Map<string, number>();
    for (const change of used) if (!numbers.has(names[change])) numbers.set(names[change], numbers.size);
    const values = Int32Array.from(ofFace, (change) => numbers.get(names[change])!);
    const own = [...numbers.keys()];
    return {
        columns: own.length > 1 ? [{ name: what, values, components: 1, domain: "face" }] : [],
        metadata: own.some(Boolean) ? named(own, what) : {},
    };
}

/** Twice the areas of triangles, along their normals. */
function areasOf(points: Float64Array, corners: ArrayLike<number>, cut: number[]): Vector3[] {
    return Array.from({ length: cut.length / 3 }, (_, i) => {
        const [a, b, c] = [0, 1, 2].map((k) => new Vector3().fromArray(points, 3 * corners[cut[3 * i + k]]));
        return b.sub(a).cross(c.sub(a));
    });
}

const sumOf = (vectors: Vector3[]): Vector3 => vectors.reduce((sum, each) => sum.add(each), new Vector3());

/** The triangles of a polygon from one corner on. */
const fanOf = (size: number, turn = 0): number[] =>
    Array.from({ length: size - 2 }, (_, i) => [turn, (i + 1 + turn) % size, (i + 2 + turn) % size]).flat();

/** The unit normal of a polygon; zeros without one. */
export function polygonNormal(positions: Float64Array, corners: ArrayLike<number>): number[] {
    const sum = sumOf(areasOf(positions, corners, fanOf(corners.length))).toArray();
    const length = Math.hypot(...sum);
    return sum.map((part) => (length > 0 ? part / length : 0));
}

/** Cut polygons into triangles, in the order of the polygons: the corners of each, and whose they are. */
function triangulated(
    positions: Float64Array,
    sizes: number[],
    corners: ArrayLike<number>,
): { places: Uint32Array; owners: Uint32Array; crossing: number } {
    const most = positions.reduce((far, number) => Math.max(far, Math.abs(number)), 1e-300);
    const scaled = positions.map((number) => number / most); // so that no product overflows
    const count = sizes.reduce((sum, size) => sum + Math.max(size - 2, 0), 0);
    const [places, owners] = [new Uint32Array(3 * count), new Uint32Array(count)];
    let [first, at, crossing] = [0, 0, 0];
    sizes.forEach((size, polygon) => {
        owners.fill(polygon, at, at + Math.max(size - 2, 0));
        const { cut, crosses } = cutOf(scaled, Array.prototype.slice.call(corners, first, first + size));
        crossing += Number(crosses);
        for (let i = 0; i < cut.length; i++) places[3 * at + i] = first + cut[i];
        at += Math.max(size - 2, 0);
        first += size;
    });
    return { places, owners, crossing };
}

/** The triangles of one polygon: a fan from the first corner from which none is folded, or ears. */
function cutOf(points: Float64Array, corners: number[]): { cut: number[]; crosses: boolean } {
    const size = corners.length;
    if (size < 3) return { cut: [], crosses: false };
    if (size === 3) return { cut: [0, 1, 2], crosses: false };
    const normal = sumOf(areasOf(points, corners, fanOf(size)));
    for (let turn = 0; turn < Math.min(size, MOST_TURNS); turn++) {
        const cut = fanOf(size, turn);
        if (!areasOf(points, corners, cut).some((area) => area.dot(normal) < 0)) return { cut, crosses: false };
    }
    if (size > MOST_CORNERS)
        throw new Error(`a polygon that is not convex has ${size} corners; cut it into triangles before`);
    const ears = earsOf(points, corners, normal.toArray());
    return ears.length === 3 * (size - 2) ? { cut: ears, crosses: false } : { cut: fanOf(size), crosses: true };
}

/** Clip the ears of a polygon that is not convex; one whose sides cross gets too few or many. */
function earsOf(points: Float64Array, corners: number[], normal: number[]): number[] {
    const [size, sizes] = [corners.length, normal.map(Math.abs)];
    const axis = sizes.indexOf(Math.max(...sizes));
    const [u, v] = [0, 1, 2].filter((d) => d !== axis);
    const sign = normal[axis] < 0 !== (axis === 1) ? -1 : 1; // counterclockwise as seen from there
    const found = earcut(corners.flatMap((corner) => [sign * points[3 * corner + u], points[3 * corner + v]]));
    if (found.length >= 3 * (size - 2)) return found;
    // Corners on a straight line between others are left out; faces beside it may have them.
    const sides = new Map<number, [number, number]>();
    for (let i = 0; i < found.length; i += 3)
        for (let k = 0; k < 3; k++) {
            const [a, b] = [found[i + k], found[i + ((k + 1) % 3)]];
            sides.set(a * size + b, [a, b]);
        }
    for (const [a, b] of [...sides.values()])
        if (!sides.has(b * size + a))
            for (let k = 1; k < (b - a + size) % size; k++) found.push(a, (a + k) % size, (a + k + 1) % size);
    return found;
}
