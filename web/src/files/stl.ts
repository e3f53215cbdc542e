/** STL: triangles without common vertices, binary or text. */
import { firstsOf, named, picked, type Column, type Polygons } from "./polygons";
import { Rows, textOf, wordsOf } from "./text";

const [HEAD, RECORD] = [84, 50]; // bytes before the first triangle, and of one
const UNKNOWN = [0, 0xffffffff]; // numbers of triangles by programs that did not know it yet
const trimmed = (bytes: Uint8Array): string => new TextDecoder("latin1").decode(bytes).replace(/[\0 ]+$/, "");

/** Whether an STL is text; binary files that begin with "solid" have zeros or the right size. */
function isText(bytes: Uint8Array, claimed: number): boolean {
    const head = bytes.subarray(0, 1024);
    if (bytes.length === HEAD + RECORD * claimed || head.includes(0)) return false;
    return /^\s*solid|\b(facet\s+normal|outer\s+loop|vertex)\b/i.test(textOf(head.slice()));
}

/** Read a binary or a text STL; corners with equal coordinates are one vertex, in order of appearance. */
export function readStl(data: ArrayBuffer): Polygons {
    const bytes = new Uint8Array(data);
    const view = new DataView(data);
    const claimed = bytes.length >= HEAD ? view.getUint32(HEAD - 4, true) : -1;
    const read = isText(bytes, claimed) ? ofText(textOf(bytes)) : ofBytes(bytes, view, claimed);
    const { soup, columns = [], metadata = {}, dropped = [] } = read;
    const firsts = firstsOf(soup);
    const own = firsts.filter((first, corner) => first === corner);
    const ranks = new Int32Array(firsts.length);
    own.forEach((first, rank) => (ranks[first] = rank));
    const [corners, positions] = [firsts.map((first) => ranks[first]), picked(soup, 3, own)];
    const notes = [
        `STL knows no vertices: ${corners.length} corners with equal coordinates were joined to ${own.length} vertices`,
    ];
    return { positions, sizes: new Uint8Array(corners.length / 3).fill(3), corners, columns, metadata, notes, dropped };
}

type Soup = { soup: Float64Array } & Partial<Pick<Polygons, "columns" | "metadata" | "dropped">>;

function ofBytes(bytes: Uint8Array, view: DataView, claimed: number): Soup {
    if (bytes.length < HEAD)
        throw new Error(`this is not an STL file: it has ${bytes.length} bytes, and the header alone has ${HEAD}`);
    const [held, rest] = [Math.floor((bytes.length - HEAD) / RECORD), (bytes.length - HEAD) % RECORD];
    const isKnown = !UNKNOWN.includes(claimed);
    if (held < claimed && isKnown)
        throw new Error(`the STL file is cut short (or is not one): it has ${held} of ${claimed} triangles`);
    const count = isKnown && rest ? claimed : held === claimed ? claimed : held;
    const beyond = bytes.length - HEAD - RECORD * count;
    const dropped =
        count === claimed
            ? beyond > 0
                ? [`${beyond} bytes after the last triangle`]
                : []
            : [`the number of triangles in the header (${claimed}; by its size, the file has ${held})`];
    const [soup, colors] = [new Float64Array(9 * count), new Uint16Array(count)];
    for (let i = 0; i < count; i++) {
        const at = HEAD + RECORD * i;
        for (let k = 0; k < 9; k++) soup[9 * i + k] = view.getFloat32(at + 12 + 4 * k, true);
        colors[i] = view.getUint16(at + 48, true);
    }
    const header = trimmed(bytes.subarray(0, HEAD - 4));
    const said = header.startsWith("bsm ") ? "provenance" : "stl_header";
    return {
        soup,
        dropped,
        metadata: header.replace(/[\0 ]/g, "") ? { [said]: header } : {},
        columns: colors.some(Boolean) ? [{ name: "attribute", values: colors, components: 1, domain: "face" }] : [],
    };
}

/** The corners of a text, and its solids as groups, of which several may have the same name. */
function ofText(given: string): Soup {
    let text = given.replace(/\r\n?/g, "\n").replace(/\bend[ \t]+(solid|facet|loop)\b/gi, "end$1");
    if (/\b(outer[ \t]+loop[ \t]+vertex|endloop[ \t]+endfacet)\b/i.test(text))
        // lines of several words
        text = text.replace(/(?<=[ \t])((?:end)?facet|outer|(?:end)?loop|vertex)(?=\s)/gi, "\n$1");
    const corners = new Rows("corner");
    for (const [, line] of text.matchAll(/^[ \t]*vertex[ \t]+([^\n]*)/gim)) corners.add(wordsOf(line));
    const [names, facets] = [[""], [] as number[]];
    for (const [, end, name] of text.matchAll(/^[ \t]*(?:(endfacet)|solid\b([^\n]*))/gim)) {
        if (end) facets.push(names.length - 1);
        else names.push(name.trim());
    }
    const isWhole = /endfacet[^\n]*\s+endsolid[^\n]*\s*$/i.test(text);
    if (facets.length > 0 && corners.counts.length > 3 * facets.length && isWhole)
        throw new Error(`${facets.length} facets have ${corners.counts.length} corners; cut them into triangles`);
    if (corners.counts.length !== 3 * facets.length || (facets.length === 0 && !/endsolid/i.test(text)))
        throw new Error(
            `the STL file is cut short: ${corners.counts.length} corners in ${facets.length} finished triangles`,
        );
    const used = [...new Set(facets)].sort((a, b) => a - b);
    const values = Int32Array.from(facets, (solid) => used.indexOf(solid));
    const columns: Column[] = used.length > 1 ? [{ name: "group", values, components: 1, domain: "face" }] : [];
    const called = used.map((solid) => names[solid]);
    return { soup: corners.columns(0, 3), columns, metadata: called.some(Boolean) ? named(called, "group") : {} };
}
