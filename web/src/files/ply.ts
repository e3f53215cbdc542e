/** PLY: a header that declares elements and their properties, then the elements, binary or as text. */
import { colorColumn, meaningOf, PLURALS, type Column, type Polygons, type ColumnValues } from "./polygons";
import { latinOf, metadataIn, Rows, textOf, trimmed, wordsOf } from "./text";

/** Numbers by the names of the methods by which a DataView reads them: their arrays, and what headers call them. */
const KINDS = {
    Int8: [Int8Array, "int8", "char"],
    Uint8: [Uint8Array, "uint8", "uchar"],
    Int16: [Int16Array, "int16", "short"],
    Uint16: [Uint16Array, "uint16", "ushort"],
    Int32: [Int32Array, "int32", "int"],
    Uint32: [Uint32Array, "uint32", "uint"],
    Float32: [Float32Array, "float32", "float"],
    Float64: [Float64Array, "float64", "double"],
    BigInt64: [Int32Array, "int64", "long"],
    BigUint64: [Int32Array, "uint64", "ulong"],
} as const;
type NumberKind = keyof typeof KINDS;
type Read = (this: DataView, at: number, little: boolean) => number | bigint;
const TYPES = new Map(
    Object.entries(KINDS).flatMap(([kind, [, ...names]]) => names.map((name) => [name as string, kind as NumberKind])),
);
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
/** The first properties of groups that are written without their names, which everybody knows. */
const USUAL = ["nx", "red", "s"];
const TEXTURE = "texnumber"; // the number of the image of a face, by OpenMVS, MeshLab and VCG
const MATERIALS = [TEXTURE, "material_index", "material"];
const WEDGES = "texcoord"; // the list of texture coordinates of corners, by MeshLab, OpenMVS and VTK
const MOST_COMPONENTS = 4;
const MOST_HEADER = 2 ** 20;

/** A column of an element: numbers, or lists after their length, of the type `length`. */
interface PlyProperty {
    name: string;
    type: NumberKind;
    length?: NumberKind;
}

interface PlyElement {
    name: string;
    count: number;
    properties: PlyProperty[];
}

/** A property and its items, those of all rows one after the other, and how many each row has. */
interface ReadProperty extends PlyProperty {
    sizes: Uint32Array;
    values: ColumnValues;
}

interface PlyHeader {
    order: string;
    elements: PlyElement[];
    size: number;
    comments: [kind: string, text: string][];
}

function headerOf(bytes: Uint8Array): PlyHeader {
    const head = latinOf(bytes.subarray(0, MOST_HEADER));
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
            const [name, ...kinds] = words.toReversed();
            const isList = words[0] === "list";
            const [type, length] = kinds.slice(0, isList ? 2 : 1).map((kind) => TYPES.get(kind) ?? wrong());
            if (words.length !== (isList ? 4 : 2) || !elements.length) wrong();
            elements.at(-1)!.properties.push({ name, type, length });
        } else if (keyword === "element") wrong();
        else if (keyword !== "") {
            const isOwn = keyword === "comment" || keyword === "obj_info";
            comments.push([isOwn ? keyword : "comment", trimmed(isOwn ? trimmed(line).slice(keyword.length) : line)]);
        }
    }
    if (order === "") throw new Error("the PLY header names no format, or too many elements");
    return { order, elements, size, comments };
}

const isImage = (text: string): boolean => text.startsWith("TextureFile ");

/** The names of images by their numbers, in the order of the file. */
function imagesOf(comments: PlyHeader["comments"]): Map<number, string> {
    const names = comments.filter(([, text]) => isImage(text)).map(([, text]) => trimmed(text.slice(12)));
    const remarks = Object.entries(metadataIn(comments.map(([, text]) => text)));
    const numbered = remarks.flatMap(([key, name]): [string, number][] => {
        const number = /^image\.(\d{1,9})\.name$/.exec(key)?.[1];
        return number && typeof name === "string" ? [[name, Number(number)]] : [];
    });
    const numbers = new Map(numbered.sort(([, a], [, b]) => a - b));
    return new Map(names.map((name, place) => [numbers.get(name) ?? place, name]));
}

/** The metadata in comments; images are those of materials. */
function metadataOf(comments: PlyHeader["comments"], images: Map<number, string>): Polygons["metadata"] {
    const found = metadataIn(comments.map(([, text]) => text));
    for (const kind of ["comment", "obj_info"]) {
        const own = comments.filter(([each, text]) => each === kind && text && !isImage(text));
        const said = own.map(([, text]) => text).filter((text) => Object.keys(metadataIn([text])).length === 0);
        if (said.length > 0) found[kind] ??= said.join("\n");
    }
    const entries = Object.entries(found);
    const isTexture = (key: string): boolean =>
        /^material\.\d+\.(map_\w+|bump|disp|decal|norm|refl|.*Texture)$/.test(key);
    const shown = entries.flatMap(([key, image]) => (isTexture(key) ? image : []));
    images.forEach((image, number) => {
        found[`image.${number}.name`] = image;
        if (!shown.includes(number))
            Object.assign(found, { [`material.${number}.name`]: image, [`material.${number}.map_Kd`]: number });
    });
    return found;
}

/** Where numbers come from, bytes or the words of a text: the next one, how many units are left, and those of a kind. */
interface Supply {
    next: (kind: NumberKind) => number;
    left: () => number;
    size: (kind: NumberKind) => number;
}
const CUT = "the PLY file is cut short:";

/** All properties of an element, which is at least as long as its numbers and the lengths of its lists. */
function readElement({ count, properties }: PlyElement, { next, left, size }: Supply): ReadProperty[] {
    const missing = properties.reduce((sum, { type, length }) => sum + count * size(length ?? type), -left());
    if (properties.length > 0 && missing > 0)
        throw new Error(`${CUT} its header claims ${missing} bytes more than there are`);
    const found = properties.map((own) => ({ ...own, sizes: new Uint32Array(count).fill(1), values: [] as number[] }));
    for (let row = 0; properties.length > 0 && row < count; row++)
        for (const { type, length, sizes, values } of found) {
            const items = length ? next(length) : 1;
            if (items < 0 || items !== Math.floor(items)) throw new Error(`row ${row} has a list of ${items} items`);
            sizes[row] = items;
            for (let i = 0; i < items; i++) values.push(next(type));
        }
    return found.map((own) => ({ ...own, values: typed(own.values, own.type) }));
}

/** The rows of all elements, by the names of these. */
function tablesOf({ elements, order, size }: PlyHeader, bytes: Uint8Array): Map<string, ReadProperty[]> {
    const readAll = (source: Supply): Map<string, ReadProperty[]> =>
        new Map(elements.map((element) => [element.name, readElement(element, source)]));
    let at = 0;
    const most = (end: number): void => {
        if (at > end) throw new Error(`${CUT} a list runs over its end`);
    };
    if (order !== "ascii") {
        const view = new DataView(bytes.buffer, bytes.byteOffset + size, bytes.byteLength - size);
        const isLittle = order === "binary_little_endian";
        const [reads, sizes] = [{} as Record<NumberKind, Read>, {} as Record<NumberKind, number>];
        for (const kind of Object.keys(KINDS) as NumberKind[])
            [reads[kind], sizes[kind]] = [view[`get${kind}`], Number(/\d+/.exec(kind)) / 8];
        const next = (kind: NumberKind): number => {
            const from = at;
            at += sizes[kind];
            most(view.byteLength);
            return Number(reads[kind].call(view, from, isLittle));
        };
        return readAll({ next, left: () => view.byteLength - at, size: (kind) => sizes[kind] });
    }
    const rows = new Rows("row");
    for (const line of textOf(bytes.slice(size)).split(/\r\n|\r|\n/)) {
        const words = wordsOf(line);
        if (words.length > 0) rows.add(words);
    }
    const { counts, values } = rows;
    const claimed = elements.reduce((sum, { count }) => sum + count, 0);
    const short = `its header claims ${claimed} vertices and faces, ${counts.length} follow`;
    if (counts.length < claimed) throw new Error(`the file is cut short: ${short}`);
    const next = (): number => {
        most(values.length - 1);
        return values[at++];
    };
    const tables = readAll({ next, left: () => values.length - at, size: () => 1 });
    if (at < values.length)
        throw new Error(`the rows of this PLY file have ${values.length - at} numbers more than its header says`);
    return tables;
}

const leastOf = (type: NumberKind): number => (type === "BigUint64" ? 0 : -Infinity);

/** Numbers in the type that the header declares, if they fit into it, as those of a text may not. */
function typed(values: number[], type: NumberKind): ColumnValues {
    const isWide = type.startsWith("Big") && values.some((value) => value >= 2 ** 31);
    const made: ColumnValues = (isWide ? Uint32Array : KINDS[type][0]).from(values);
    const fits = (value: number, i: number): boolean => made[i] === value && value >= leastOf(type);
    return type.startsWith("F") || values.every(fits) ? made : Float64Array.from(values);
}

/** Read a PLY with points and faces, of any byte order, and whatever numbers they have. */
export function readPly(bytes: Uint8Array): Polygons {
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
    const axes = ["x", "y", "z"].map((name) => points.find((each) => each.name === name));
    if (!axes.every((axis) => axis && !axis.length))
        throw new Error("the vertices of this PLY file have no numbers x, y and z");
    const positions = together(axes.map((axis) => Float64Array.from(axis!.values))) as Float64Array;
    const list = polygons.find(({ name }) => name === "vertex_indices" || name === "vertex_index");
    if (!list?.length) throw new Error("the faces of this PLY file have no list vertex_indices");
    const { sizes, values: corners } = list;
    const broken = (corners as Float64Array).find((corner) => corner !== Math.floor(corner));
    if (broken !== undefined) throw new Error(`a vertex index is ${broken}, not a whole number`);
    const [notes, dropped]: [string[], string[]] = [[], []];
    const images = imagesOf(header.comments);
    const isTextured = images.size > 0;
    const wedges = wedgesOf(polygons, list, isTextured, notes, dropped);
    const ofFaces = columnsOf(polygons, "face", isTextured);
    const found = [...columnsOf(points, "vertex", isTextured), ...ofFaces, ...wedges];
    const metadata = metadataOf(header.comments, images);
    const columns = withoutTextures(found, metadata, [...images.keys()]);
    for (const { name, length } of points) if (length) dropped.push(`the list ${name} of vertices`);
    for (const element of [points, polygons]) {
        const all = element.map(({ name }) => name);
        const repeated = new Set(all.filter((name, i) => all.indexOf(name) !== i));
        for (const name of repeated) dropped.push(`the first ${name}, of which there are several`);
    }
    for (const { name, count } of header.elements)
        if (name !== "vertex" && name !== "face" && count > 0) dropped.push(name);
    return { positions, sizes, corners, columns, metadata, notes, dropped };
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
function columnsOf(properties: ReadProperty[], domain: "vertex" | "face", isTextured: boolean): Column[] {
    const needed = domain === "vertex" ? ["x", "y", "z"] : [];
    const left = new Map<string, ReadProperty>();
    for (const own of properties) if (!own.length && !needed.includes(own.name)) left.set(own.name, own);
    const tableOf = (names: readonly string[]): ColumnValues => {
        const found = names.map((name) => left.get(name)!.values);
        const isOne = found.every((each) => each.constructor === found[0].constructor);
        return together(isOne ? found : found.map((each) => Float64Array.from(each)));
    };
    const typeOf = (name: string): NumberKind => left.get(name)!.type;
    const columns: Column[] = [];
    for (const [semantic, names] of GROUPS) {
        if (!names.every((name) => left.has(name)) || new Set(names.map(typeOf)).size > 1) continue;
        const [values, components] = [tableOf(names), names.length];
        const plain = { name: semantic, values, components, domain, semantic };
        const column = semantic === "color" ? colorColumn(narrowed(values), components, domain) : plain;
        if (column.semantic !== semantic) continue; // numbers that are not colors keep their names
        for (const name of names) left.delete(name);
        const isUsual = USUAL.includes(names[0]) && !(isTextured && semantic === "texcoord");
        columns.push(isUsual ? column : { ...column, parts: names });
    }
    const others = new Set(left.keys());
    while (left.size > 0) {
        const [name] = left.keys();
        const stem = name.replace(/_0$/, "");
        const run = [];
        for (let i = 0; left.has(`${stem}_${i}`) && typeOf(`${stem}_${i}`) === typeOf(name); i++)
            run.push(`${stem}_${i}`);
        const isRun = name.endsWith("_0") && run.length >= 2 && run.length <= MOST_COMPONENTS;
        const own = isRun ? run : [name];
        const called = isRun ? stem : name;
        const type = typeOf(name);
        const values = tableOf(own);
        for (const each of own) left.delete(each);
        const isDeclared = (value: number): boolean => Number.isInteger(value) && value >= leastOf(type);
        const isTooLong = type.startsWith("Big") && values instanceof Float64Array && values.every(isDeclared);
        const fault = isTooLong ? "do not fit into 32 bits" : undefined;
        const isSecond = called === TEXTURE && MATERIALS.some((each) => each !== TEXTURE && others.has(each));
        const known = MATERIALS.includes(called) && !isSecond ? "material" : called;
        const column: Column = { name: known, values, components: own.length, domain, fault };
        columns.push(known === called ? column : { ...column, called });
    }
    return columns;
}

/** Whole numbers as bytes or words if all of them fit: other programs show colors of any type of integers. */
function narrowed(colors: ColumnValues): ColumnValues {
    if (colors instanceof Float32Array || colors instanceof Float64Array || colors.length === 0) return colors;
    let [least, most] = [Infinity, -Infinity];
    for (const color of colors) [least, most] = [Math.min(least, color), Math.max(most, color)];
    if (least < 0 || most > 0xffff) return colors;
    return most > 0xff ? Uint16Array.from(colors) : Uint8Array.from(colors);
}

/** Columns without the numbers of images that `bsm` writes, which follow from the materials. */
function withoutTextures(columns: Column[], metadata: Polygons["metadata"], images: number[]): Column[] {
    const ofFaces = (name: string): Column | undefined =>
        columns.findLast((column) => column.name === name && column.domain === "face");
    const [materials, textures] = [ofFaces("material"), ofFaces(TEXTURE)];
    if (!materials || !textures) return columns;
    const imageOf = (material: number): unknown =>
        ["baseColorTexture", "map_Kd"].map((word) => metadata[`material.${material}.${word}`]).find(Number.isInteger);
    const count = materials.values.length / materials.components;
    for (let face = 0; face < count; face++) {
        const image = imageOf(materials.values[face * materials.components]);
        if (textures.values[face * textures.components] !== images.indexOf(image as number)) return columns;
    }
    return columns.filter(({ name }) => name !== TEXTURE);
}

/** Values of corners: lists as long as that of the vertices, or twice, and so on; the lists that are not; and notes. */
function wedgesOf(
    polygons: ReadProperty[],
    list: ReadProperty,
    isTextured: boolean,
    notes: string[],
    dropped: string[],
): Column[] {
    const most = (sizes: Uint32Array): number => sizes.reduce((high, size) => Math.max(high, size), 0);
    const { sizes, values: corners } = list;
    return polygons.flatMap((own): Column[] => {
        const { name, length, sizes: lengths, values: made } = own;
        if (!length || own === list) return [];
        const width = name === WEDGES ? 2 : Math.floor(most(lengths) / Math.max(most(sizes), 1));
        const present = Array.from(lengths, (each, i) => each === width * sizes[i]);
        const isFit = width >= 1 && width <= MOST_COMPONENTS && present.some(Boolean);
        if (!isFit || !present.every((is, i) => is || lengths[i] === 0)) return (dropped.push(name), []);
        const rows = new (made.constructor as new (size: number) => ColumnValues)(width * corners.length);
        let [from, to] = [0, 0];
        sizes.forEach((size, i) => {
            if (present[i]) for (let k = 0; k < width * size; k++) rows[to + k] = made[from++];
            to += width * size;
        });
        const lacking = present.filter((is) => !is).length;
        if (lacking > 0) notes.push(`faces without ${PLURALS.get(name) ?? name} were given zeros: ${lacking}`);
        const called = name === WEDGES && !isTextured ? name : undefined;
        return [{ name, values: rows, components: width, domain: "corner", semantic: meaningOf(name, width), called }];
    });
}
