/** OBJ: lines of text, each with a keyword. */
import { colorColumn, compact, grouped, PLURALS, polygonNormal, type Column, type Polygons } from "./polygons";
import { metadataIn, numberIn, Rows, textOf, trimmed, wordsOf } from "./text";

/** The attribute of faces after a keyword. */
const STATES: Record<string, string> = { usemtl: "material", g: "group", o: "object", s: "smoothing" };
const OF_CORNERS = { vt: "texcoord", vn: "normal" } as const;
const [MOST_NAMED, MOST_NUMBERS] = [8, 3];
const MOST_TEXT = 2 ** 13; // characters of a comment
/** Comments amid the data that exporters write. */
const OF_EXPORTERS = /^\W*(\d+ |object|group|mesh|material|vert|texture|normal|face|end|total|smooth|$)/i;

/** The numbers of a corner, written v, v/vt, v//vn or v/vt/vn; 0: not there. */
function cornerOf(word: string, corner: number): number[] {
    if (word.startsWith("/")) throw new Error("a face has a corner without a vertex");
    const numbers = word.split("/").map((part) => (part === "" ? 0 : numberIn(part, `corner ${corner}`)));
    if (numbers.length > 3) throw new Error("a corner of a face has more than three numbers");
    if (!numbers.every(Number.isInteger)) throw new Error(`a vertex index is ${word}, not a whole number`);
    if (numbers[0] === 0) throw new Error("a face refers to vertex 0, but OBJ files count from 1");
    return numbers;
}

/** Read an OBJ; a library of materials that it names is not read. */
export function readObj(bytes: Uint8Array): Polygons {
    const text = textOf(bytes);
    if (text.includes("\0")) throw new Error("this is not an OBJ file: it holds binary data");
    const joined = text.replace(/^([ \t]*#[^\r\n]*)|\\[ \t]*\r?\n/gm, (_, comment: string) => comment ?? " ");
    const rows = { v: new Rows("vertex"), vt: new Rows("texcoord"), vn: new Rows("normal") };
    const names: Record<string, string[]> = Object.fromEntries(Object.keys(STATES).map((keyword) => [keyword, [""]]));
    const ofFace: Record<string, number[]> = Object.fromEntries(Object.keys(STATES).map((keyword) => [keyword, []]));
    const [sizes, unread, libraries] = [[] as number[], new Set<string>(), new Set<string>()];
    const written = { v: [] as number[], vt: [] as number[], vn: [] as number[] }; // of each corner, from 0 on; NaN: none
    for (const line of joined.split(/\r\n|\r|\n/)) {
        const [keyword = ""] = /[^ \t-\r]+/.exec(line) ?? [];
        if (keyword === "" || keyword.startsWith("#")) continue;
        const rest = line.slice(line.indexOf(keyword) + keyword.length);
        if (keyword === "v" || keyword === "vt" || keyword === "vn") rows[keyword].add(wordsOf(rest.split("#", 1)[0]));
        else if (keyword === "f") {
            const corners = wordsOf(rest.split("#", 1)[0]).map((word, i) => cornerOf(word, written.v.length + i));
            sizes.push(corners.length);
            for (const corner of corners)
                (["v", "vt", "vn"] as const).forEach((which, k) => {
                    const number = corner[k] || 0;
                    const present = rows[which].counts.length;
                    written[which].push(number > 0 ? number - 1 : number < 0 ? number + present : NaN);
                });
            for (const state of Object.keys(STATES)) ofFace[state].push(names[state].length - 1);
        } else if (Object.hasOwn(STATES, keyword)) names[keyword].push(trimmed(rest));
        else if (keyword === "mtllib") libraries.add(trimmed(rest));
        else unread.add(keyword);
    }
    const [[fewest, most], { v: corners }, dropped] = [rows.v.range, written, [] as string[]];
    const isColored = fewest >= 6 && fewest === most && most <= 7;
    if (unread.size > 0) dropped.push(`lines that begin with ${[...unread].sort().slice(0, MOST_NAMED).join(", ")}`);
    const more = rows.v.counts.filter((count) => count > 3).length;
    const isWeight = rows.v.counts.every((count, i) => count < 4 || rows.v.values[rows.v.starts[i] + 3] === 1);
    if (most > 3 && !isColored && (most > 4 || !isWeight))
        dropped.push(`numbers after the coordinates (${more} vertices have some)`);
    if (/^#MRGB /m.test(joined)) dropped.push("colors in comments (#MRGB)");
    const positions = rows.v.columns(0, 3);
    const columns = isColored ? [colorColumn(rows.v.columns(3, most - 3), most - 3, "vertex")] : [];
    const notes: string[] = [];
    for (const keyword of ["vt", "vn"] as const) {
        const column = ofCorners(rows[keyword], keyword, written[keyword], { positions, sizes, corners }, notes);
        if (column) columns.push(column);
    }
    const metadata: Polygons["metadata"] = {};
    for (const [keyword, what] of Object.entries(STATES)) {
        const found = grouped(what, names[keyword], ofFace[keyword]);
        columns.push(...found.columns);
        Object.assign(metadata, found.metadata);
    }
    const again = repeatedNames(names.o, ofFace.o).slice(0, MOST_NAMED).join(", ");
    if (again) notes.push(`objects of one name became one: ${again}`);
    if (libraries.size > 0) metadata.mtllib = [...libraries].join("\n");
    Object.assign(metadata, commentsOf(text, dropped));
    return { positions, sizes, corners, columns, metadata, notes, dropped };
}

/** The names that several objects with faces have; `ofFace` counts the names so far. */
function repeatedNames(names: string[], ofFace: number[]): string[] {
    const counts = new Map<string, number>();
    for (const place of new Set(ofFace)) counts.set(names[place], (counts.get(names[place]) ?? 0) + 1);
    return Array.from(counts).flatMap(([name, count]) => (name !== "" && count > 1 ? name : []));
}

/** Metadata in comments: what `bsm` wrote, and the text ahead of the first line of data. */
function commentsOf(text: string, dropped: string[]): Polygons["metadata"] {
    const begin = /^[ \t]*[^#\s]/m.exec(text)?.index ?? Infinity;
    const lines = Array.from(text.matchAll(/^#([^\r\n]*)/gm), ({ index, 1: line }) => ({ index, line: trimmed(line) }));
    const others = lines.filter(({ line }) => line !== "" && !/^(meta|MRGB) /.test(line));
    const ahead = others.flatMap(({ index, line }) => (index < begin ? line : [])).join("\n");
    const behind = text.match(/^[ \t]*(?:v[nt]?|f)[ \t][^\r\n#]*#/gm) ?? []; // numbers
    const amid = others.filter(({ index, line }) => index >= begin && !OF_EXPORTERS.test(line));
    const later = amid.length + behind.length;
    if (later > 0) dropped.push(`comments amid the data (${later})`);
    const own = metadataIn(lines.map(({ line }) => line));
    return ahead.length > 0 && ahead.length < MOST_TEXT ? { comment: ahead, ...own } : own;
}

/** The values of `vt` or `vn` lines for corners; those without get zeros, or the normals of their faces. */
function ofCorners(
    rows: Rows,
    keyword: keyof typeof OF_CORNERS,
    written: number[],
    { positions, sizes, corners }: { positions: Float64Array; sizes: number[]; corners: number[] },
    notes: string[],
): Column | undefined {
    const lacking = written.filter(Number.isNaN).length;
    if (rows.counts.length === 0 || lacking === written.length) return undefined;
    const name = OF_CORNERS[keyword];
    const [table, width] = name === "normal" ? [rows.columns(0, 3), 3] : texcoordsOf(rows);
    const column = { name, components: width, domain: "corner", semantic: name } as const;
    if (lacking === 0) return { ...column, values: compact(table, width), indices: written };
    const [all, indices] = [[...table], [...written]];
    let at = 0;
    sizes.forEach((size, face) => {
        const own = corners.slice(at, at + size);
        const isInside = own.every((corner) => corner >= 0 && corner < positions.length / 3);
        if (name === "normal") all.push(...(isInside ? polygonNormal(positions, own) : [0, 0, 0]));
        for (let i = at; i < at + size; i++)
            if (Number.isNaN(indices[i])) indices[i] = table.length / width + (name === "normal" ? face : 0);
        at += size;
    });
    if (name === "texcoord") all.push(...new Array<number>(width).fill(0));
    const given = name === "normal" ? "those of their faces" : "zeros";
    notes.push(`corners without ${PLURALS.get(name)} were given ${given}: ${lacking}`);
    return { ...column, values: compact(Float64Array.from(all), width), indices };
}

/** Lines of one to three numbers, those that are not there zero; the third only if it is of use. */
function texcoordsOf(rows: Rows): [values: Float64Array, width: number] {
    rows.columns(0, 1); // or it says which has none
    const at = (row: number, d: number): number => (d < rows.counts[row] ? rows.values[rows.starts[row] + d] : 0);
    const width = rows.counts.some((_, row) => at(row, 2) !== 0) ? MOST_NUMBERS : 2;
    const length = width * rows.counts.length;
    return [Float64Array.from({ length }, (_, i) => at(Math.floor(i / width), i % width)), width];
}
