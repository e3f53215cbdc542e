/** PLY: a header that declares elements and their properties, then the elements, binary or as text. */
import { colorColumn, meaningOf, PLURALS, type Column, type Polygons, type ColumnValues } from "./polygons";
import { metadataIn, Rows, textOf, wordsOf } from "./text";

type ReadNumber = (view: DataView, at: number, little: boolean) => number;
interface NumberKind {
    size: number;
    read: ReadNumber;
    array: { from(values: ArrayLike<number>): ColumnValues };
}
const big = (value: bigint): number => Number(value);
const KINDS: Record<string, NumberKind> = {
    i1: { size: 1, read: (view, at) => view.getInt8(at), array: Int8Array },
    u1: { size: 1, read: (view, at) => view.getUint8(at), array: Uint8Array },
    i2: { size: 2, read: (view, at, little) => view.getInt16(at, little), array: Int16Array },
    u2: { size: 2, read: (view, at, little) => view.getUint16(at, little), array: Uint16Array },
    i4: { size: 4, read: (view, at, little) => view.getInt32(at, little), array: Int32Array },
    u4: { size: 4, read: (view, at, little) => view.getUint32(at, little), array: Uint32Array },
    i8: { size: 8, read: (view, at, little) => big(view.getBigInt64(at, little)), array: Float64Array },
    u8: { size: 8, read: (view, at, little) => big(view.getBigUint64(at, little)), array: Float64Array },
    f4: { size: 4, read: (view, at, little) => view.getFloat32(at, little), array: Float32Array },
    f8: { size: 8, read: (view, at, little) => view.getFloat64(at, little), array: Float64Array },
};
const TYPES: Record<string, string> = {
    char: "i1",
    uchar: "u1",
    short: "i2",
    ushort: "u2",
    int: "i4",
    uint: "u4",
    float: "f4",
    double: "f8",
    int8: "i1",
    uint8: "u1",
    int16: "i2",
    uint16: "u2",
    int32: "i4",
    uint32: "u4",
    float32: "f4",
    float64: "f8",
    int64: "i8",
    uint64: "u8",
    long: "i8",
    ulong: "u8",
};
const ORDERS = ["ascii", "binary_little_endian", "binary_big_endian"];
/** Properties that are one value together, the first of a meaning and a width. */
const GROUPS: [meaning: "normal" | "color" | "texcoord", names: string[]][] = [
    ["normal", ["nx", "ny", "nz"]],
    ["color", ["red", "green", "blue", "alpha"]],
    ["color", ["red", "green", "blue"]],
    ["color", ["diffuse_red", "diffuse_green", "diffuse_blue"]],
    ["color", ["r", "g", "b"]],
    ["texcoord", ["u", "v"]],
    ["texcoord", ["s", "t"]],
    ["texcoord", ["texture_u", "texture_v"]],
    ["texcoord", ["texture_s", "texture_t"]],
];
const NAMES: Record<string, string> = { texnumber: "material", material_index: "material" };
const MOST_COMPONENTS = 4;
const MOST_HEADER = 2 ** 20;

/** A column of an element: numbers, or lists after their length, of the type `length`. */
interface PlyProperty {
    name: string;
    type: string;
    length?: string;
}

interface PlyElement {
    name: string;
    count: number;
    properties: PlyProperty[];
}

/** The items of a property, those of all rows one after the other, and how many each row has. */
interface ReadProperty {
    sizes: Uint32Array;
    values: number[];
}

interface PlyHeader {
    order: string;
    elements: PlyElement[];
    size: number;
    comments: [kind: string, text: string][];
}

function headerOf(bytes: Uint8Array): PlyHeader {
    const head = new TextDecoder("latin1").decode(bytes.subarray(0, MOST_HEADER));
    const begin = /^ply[ \t]*[\r\n]/.exec(head);
    if (!begin) throw new Error("this is not a PLY file: it does not begin with ply");
    const end = /[\r\n][ \t]*end_header[ \t]*(?:\r?\n|\r|$)/.exec(head);
    if (!end) throw new Error(`the PLY header has no end_header in its first ${MOST_HEADER} bytes`);
    // Where all lines before end in \r, \n after the last one is the first byte of the body.
    const inBody = end[0].endsWith("\r\n") && !head.slice(0, end.index + 1).includes("\n");
    const size = end.index + end[0].length - (inBody ? 1 : 0);
    const [elements, comments]: [PlyElement[], PlyHeader["comments"]] = [[], []];
    let order = "";
    for (const line of textOf(bytes.slice(begin[0].length, end.index)).split(/[\r\n]+/)) {
        const [keyword = "", ...words] = wordsOf(line);
        const wrong = (): never => {
            throw new Error(`the PLY header has an invalid line: '${line.slice(0, 80)}'`);
        };
        if (keyword === "format") order = ORDERS.includes(words[0]) ? words[0] : wrong();
        else if (keyword === "element" && words.length === 2 && /^\d{1,18}$/.test(words[1]))
            elements.push({ name: words[0], count: Number(words[1]), properties: [] });
        else if (keyword === "property") {
            const [name = "", type = "", length = ""] = words.toReversed();
            const isList = words[0] === "list";
            if (words.length !== (isList ? 4 : 2) || !TYPES[type] || (isList && !TYPES[length]) || !elements.length)
                wrong();
            elements.at(-1)!.properties.push({ name, type: TYPES[type], ...(isList && { length: TYPES[length] }) });
        } else if (keyword === "element") wrong();
        else if (keyword !== "") {
            const isOwn = keyword === "comment" || keyword === "obj_info";
            comments.push([
                isOwn ? keyword : "comment",
                isOwn ? line.trim().slice(keyword.length).trim() : line.trim(),
            ]);
        }
    }
    if (order === "") throw new Error("the PLY header names no format, or too many elements");
    return { order, elements, size, comments };
}

/** The metadata in comments; images are those of materials. */
function metadataOf(comments: PlyHeader["comments"]): Polygons["metadata"] {
    const isImage = (text: string): boolean => text.startsWith("TextureFile ");
    const images = comments.filter(([, text]) => isImage(text)).map(([, text]) => text.slice(12).trim());
    const found = metadataIn(comments.map(([, text]) => text));
    for (const kind of ["comment", "obj_info"]) {
        const own = comments.filter(([each, text]) => each === kind && text && !isImage(text));
        const said = own.map(([, text]) => text).filter((text) => Object.keys(metadataIn([text])).length === 0);
        if (said.length > 0) found[kind] ??= said.join("\n");
    }
    const entries = Object.entries(found);
    const shown = entries
        .filter(([key]) => /^material\.\d+\.(map_\w+|norm|\w+Texture)$/.test(key))
        .map(([, image]) => image);
    images.forEach((image, place) => {
        const known = entries.find(([key, name]) => /^image\.\d+\.name$/.test(key) && name === image);
        const number = known ? Number(known[0].split(".")[1]) : place;
        found[`image.${number}.name`] = image;
        if (!shown.includes(number))
            Object.assign(found, { [`material.${number}.name`]: image, [`material.${number}.map_Kd`]: number });
    });
    return found;
}

/** Where numbers come from: bytes, or the words of a text. */
type NextNumber = (kind: string) => number;

/** All properties of an element, which is at least as long as its numbers and the lengths of its lists. */
function readElement(
    { count, properties }: PlyElement,
    next: NextNumber,
    left: (least: number) => number,
): ReadProperty[] {
    const least = properties.reduce((sum, { type, length }) => sum + left0(length ?? type, left), 0);
    const missing = count * least - left(-1);
    if (properties.length > 0 && missing > 0)
        throw new Error(`the PLY file is cut short: its header claims ${missing} bytes more than there are`);
    const found = properties.map((): ReadProperty => ({
        sizes: new Uint32Array(properties.length > 0 ? count : 0).fill(1),
        values: [],
    }));
    for (let row = 0; row < (properties.length > 0 ? count : 0); row++)
        properties.forEach(({ type, length }, p) => {
            const size = length ? next(length) : 1;
            if (size < 0 || size !== Math.floor(size)) throw new Error(`row ${row} has a list of ${size} items`);
            found[p].sizes[row] = size;
            for (let i = 0; i < size; i++) found[p].values.push(next(type));
        });
    return found;
}

const left0 = (kind: string, left: (least: number) => number): number => left(KINDS[kind].size);

/** The rows of all elements, by the names of these. */
function tablesOf({ elements, order, size }: PlyHeader, bytes: Uint8Array): Map<string, ReadProperty[]> {
    if (order !== "ascii") {
        const view = new DataView(bytes.buffer, bytes.byteOffset + size, bytes.byteLength - size);
        const little = order === "binary_little_endian";
        let at = 0;
        const next = (kind: string): number => {
            const { read, size } = KINDS[kind];
            if (at + size > view.byteLength) throw new Error("the PLY file is cut short: a list runs over its end");
            at += size;
            return read(view, at - size, little);
        };
        const left = (least: number): number => (least < 0 ? view.byteLength - at : least);
        return new Map(elements.map((element) => [element.name, readElement(element, next, left)]));
    }
    const [rows, lines] = [
        new Rows("row"),
        textOf(bytes.slice(size))
            .split(/\r\n|\r|\n/)
            .map(wordsOf),
    ];
    for (const words of lines) if (words.length > 0) rows.add(words);
    const claimed = elements.reduce((sum, { count }) => sum + count, 0);
    if (rows.counts.length < claimed)
        throw new Error(
            `the file is cut short: its header claims ${claimed} vertices and faces, ${rows.counts.length} follow`,
        );
    let at = 0;
    const next = (): number => {
        if (at >= rows.values.length) throw new Error("the PLY file is cut short: a list runs over its end");
        return rows.values[at++];
    };
    const left = (least: number): number => (least < 0 ? rows.values.length - at : 1);
    const tables = new Map(elements.map((element) => [element.name, readElement(element, next, left)]));
    if (at < rows.values.length)
        throw new Error(`the rows of this PLY file have ${rows.values.length - at} numbers more than its header says`);
    return tables;
}

/** Numbers in the type that the header declares, if they fit into it, as those of a text may not. */
function typed(values: number[], type: string): ColumnValues {
    const made = KINDS[type].array.from(values);
    return type.startsWith("f") || values.every((value, i) => made[i] === value) ? made : Float64Array.from(values);
}

/** ReadProperty a PLY with points and faces, of any byte order, and whatever numbers they have. */
export function readPly(data: ArrayBuffer): Polygons {
    const bytes = new Uint8Array(data);
    const header = headerOf(bytes);
    const names = header.elements.map(({ name }) => name);
    if (names.includes("tristrips"))
        throw new Error("this PLY file holds triangle strips; convert it to faces (MeshLab does when it saves)");
    const twice = ["vertex", "face"].find((name) => names.indexOf(name) !== names.lastIndexOf(name));
    if (twice) throw new Error(`this PLY file has the element ${twice} several times; save it with one`);
    const [vertex, face] = ["vertex", "face"].map((name) => header.elements.find((each) => each.name === name));
    if (names.includes("range_grid") && !face)
        throw new Error("this PLY file is a range grid; mesh it first, for instance with MeshLab");
    if (!vertex || !face) throw new Error("this PLY file has no faces; point clouds are not supported");
    const tables = tablesOf(header, bytes);
    const [points, polygons] = [tables.get("vertex")!, tables.get("face")!];
    const axes = ["x", "y", "z"].map((name) => vertex.properties.findIndex((each) => each.name === name));
    if (axes.some((place) => place < 0 || vertex.properties[place].length))
        throw new Error("the vertices of this PLY file have no numbers x, y and z");
    const positions = together(
        axes.map((place) => Float64Array.from(typed(points[place].values, vertex.properties[place].type))),
    ) as Float64Array;
    const list = face.properties.findIndex(({ name }) => name === "vertex_indices" || name === "vertex_index");
    if (list < 0 || !face.properties[list].length)
        throw new Error("the faces of this PLY file have no list vertex_indices");
    const { sizes, values: corners } = polygons[list];
    const broken = corners.find((corner) => corner !== Math.floor(corner));
    if (broken !== undefined) throw new Error(`a vertex index is ${broken}, not a whole number`);
    const [notes, dropped]: [string[], string[]] = [[], []];
    const wedges = wedgesOf(face.properties, polygons, list, notes, dropped);
    const columns = [...columnsOf(vertex, points, "vertex"), ...columnsOf(face, polygons, "face"), ...wedges];
    for (const { name, length } of vertex.properties) if (length) dropped.push(`the list ${name} of vertices`);
    for (const { properties } of [vertex, face]) {
        const all = properties.map(({ name }) => name);
        const repeated = new Set(all.filter((name, i) => all.indexOf(name) !== i));
        for (const name of repeated) dropped.push(`the first ${name}, of which there are several`);
    }
    for (const { name, count } of header.elements)
        if (name !== "vertex" && name !== "face" && count > 0) dropped.push(name);
    return { positions, sizes, corners, columns, metadata: metadataOf(header.comments), notes, dropped };
}

/** Columns of the same kind as one table of rows. */
function together(columns: ColumnValues[]): ColumnValues {
    const made = new (columns[0].constructor as new (size: number) => ColumnValues)(columns.length * columns[0].length);
    columns.forEach((column, d) => {
        for (let i = 0; i < column.length; i++) made[i * columns.length + d] = column[i];
    });
    return made;
}

/** The properties that are numbers, those together that are one value. */
function columnsOf({ properties }: PlyElement, tables: ReadProperty[], domain: "vertex" | "face"): Column[] {
    const needed = domain === "vertex" ? ["x", "y", "z"] : [];
    const places = new Map<string, number>();
    properties.forEach(({ name, length }, place) => !length && !needed.includes(name) && places.set(name, place));
    const take = (names: string[]): ColumnValues => {
        const found = names.map((name) => typed(tables[places.get(name)!].values, properties[places.get(name)!].type));
        const isOne = found.every((each) => each.constructor === found[0].constructor);
        for (const name of names) places.delete(name);
        return together(isOne ? found : found.map((each) => Float64Array.from(each)));
    };
    const typeOf = (name: string): string => properties[places.get(name)!].type;
    const columns: Column[] = [];
    for (const [semantic, names] of GROUPS) {
        if (!names.every((name) => places.has(name)) || new Set(names.map(typeOf)).size > 1) continue;
        const [values, components] = [take(names), names.length];
        columns.push(
            semantic === "color"
                ? colorColumn(values, components, domain)
                : { name: semantic, values, components, domain, semantic },
        );
    }
    while (places.size > 0) {
        const [name] = places.keys();
        const stem = name.replace(/_0$/, "");
        const run = [];
        for (let i = 0; places.has(`${stem}_${i}`) && typeOf(`${stem}_${i}`) === typeOf(name); i++)
            run.push(`${stem}_${i}`);
        const isRun = name.endsWith("_0") && run.length >= 2 && run.length <= MOST_COMPONENTS;
        const own = isRun ? run : [name];
        const called = isRun ? stem : name;
        columns.push({ name: NAMES[called] ?? called, values: take(own), components: own.length, domain });
    }
    return columns;
}

/** ColumnValues of corners: lists as long as that of the vertices, or twice, and so on; the lists that are not; and notes. */
function wedgesOf(
    properties: PlyProperty[],
    tables: ReadProperty[],
    list: number,
    notes: string[],
    dropped: string[],
): Column[] {
    const most = (sizes: Uint32Array): number => sizes.reduce((high, size) => Math.max(high, size), 0);
    const { sizes, values: corners } = tables[list];
    return properties.flatMap(({ name, length, type }, place): Column[] => {
        if (!length || place === list) return [];
        const { sizes: lengths, values } = tables[place];
        const width = name === "texcoord" ? 2 : Math.floor(most(lengths) / Math.max(most(sizes), 1));
        const present = Array.from(lengths, (each, i) => each === width * sizes[i]);
        const isFit = width >= 1 && width <= MOST_COMPONENTS && present.some(Boolean);
        if (!isFit || !present.every((is, i) => is || lengths[i] === 0)) return (dropped.push(name), []);
        const made = typed(values, type);
        const rows = new (made.constructor as new (size: number) => ColumnValues)(width * corners.length);
        let [from, to] = [0, 0];
        sizes.forEach((size, i) => {
            if (present[i]) for (let k = 0; k < width * size; k++) rows[to + k] = made[from++];
            to += width * size;
        });
        const lacking = present.filter((is) => !is).length;
        if (lacking > 0) notes.push(`faces without ${PLURALS[name] ?? name} were given zeros: ${lacking}`);
        return [{ name, values: rows, components: width, domain: "corner", semantic: meaningOf(name, width) }];
    });
}
