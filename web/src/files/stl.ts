/** STL: triangles without common vertices, binary or text. */
import { firstsOf, named, picked, type Column, type Polygons } from "./polygons";
import { latinOf, Rows, textOf, trimmed, wordsOf } from "./text";

const [HEAD, RECORD] = [84, 50]; // bytes before the first triangle, and of one
const MOST_UNREAD = 200; // characters
const UNKNOWN = [0, 0xffffffff]; // numbers of triangles by programs that did not know it yet

/** Whether an STL is text; binary files that begin with "solid" have zeros or the right size. */
function isText(bytes: Uint8Array, claimed: number): boolean {
    if (bytes.length === HEAD + RECORD * claimed || bytes.subarray(0, 1024).includes(0)) return false;
    return /^\s*solid|\b(facet\s+normal|outer\s+loop|vertex)\b/i.test(textOf(bytes));
}

/**
 * Number the places of corners anew: closed bodies share none. Vertices connect no faces, but edges of two faces do; at
 * other edges, faces that follow each other are connected, unless an even number of them already are.
 */
function keptApart(places: Int32Array): Int32Array {
    const [size, shells] = [places.length, Int32Array.from({ length: places.length / 3 }, (_, face) => face)];
    const shellOf = (corner: number): number => {
        let face = Math.floor(corner / 3);
        while (shells[face] !== face) face = shells[face] = shells[shells[face]];
        return face;
    };
    const numbered = (a: (corner: number) => number, b: (corner: number) => number): Int32Array => {
        const rows = new Float64Array(3 * size);
        for (let i = 0; i < size; i++) [rows[3 * i], rows[3 * i + 1]] = [a(i), b(i)];
        return firstsOf(rows);
    };
    const nextOf = (corner: number): number => places[corner % 3 === 2 ? corner - 2 : corner + 1];
    const lowest = (corner: number): number => Math.min(places[corner], nextOf(corner));
    const edges = numbered(lowest, (corner) => Math.max(places[corner], nextOf(corner)));
    const [counts, waiting] = [new Int32Array(size), new Int32Array(size).fill(-1)];
    const pairUp = (corner: number): void => {
        const other = waiting[edges[corner]];
        waiting[edges[corner]] = other < 0 ? corner : -1;
        if (other >= 0) shells[shellOf(corner)] = shellOf(other);
    };
    edges.forEach((edge) => counts[edge]++);
    edges.forEach((edge, corner) => counts[edge] === 2 && pairUp(corner));
    const alike = numbered((corner) => edges[corner], shellOf);
    const odd = new Uint8Array(size);
    alike.forEach((which) => (odd[which] ^= 1));
    alike.forEach((which, corner) => odd[which] && pairUp(corner));
    const closed = new Int32Array(size); // the corners of each shell; of an open one less than 0
    for (let corner = 0; corner < size; corner++) {
        const isOpen = waiting[edges[corner]] === corner && places[corner] !== nextOf(corner);
        closed[shellOf(corner)] = isOpen ? -size : closed[shellOf(corner)] + 1;
    }
    const isBody = (corner: number): boolean => closed[shellOf(corner)] > 9; // four faces
    return numbered(
        (corner) => places[corner],
        (corner) => (isBody(corner) ? shellOf(corner) : -1),
    );
}

/** Read a binary or a text STL; corners with equal coordinates are one vertex of each body, in order of appearance. */
export function readStl(bytes: Uint8Array): Polygons {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const claimed = bytes.length >= HEAD ? view.getUint32(HEAD - 4, true) : -1;
    const read = isText(bytes, claimed) ? ofText(textOf(bytes)) : ofBytes(bytes, view, claimed);
    const { soup, columns = [], metadata = {}, dropped = [] } = read;
    const firsts = keptApart(firstsOf(soup));
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
    const count = isKnown && rest ? claimed : held;
    const beyond = bytes.length - HEAD - RECORD * count;
    const dropped = count === claimed && beyond > 0 ? [`${beyond} bytes after the last triangle`] : [];
    if (count !== claimed)
        dropped.push(`the number of triangles in the header (${claimed}; by its size, the file has ${held})`);
    const [soup, colors] = [new Float64Array(9 * count), new Uint16Array(count)];
    for (let i = 0; i < count; i++) {
        const at = HEAD + RECORD * i;
        for (let k = 0; k < 9; k++) soup[9 * i + k] = view.getFloat32(at + 12 + 4 * k, true);
        colors[i] = view.getUint16(at + 48, true);
    }
    const header = latinOf(bytes.subarray(0, HEAD - 4)).replace(/[\0 ]+$/, "");
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
        else names.push(trimmed(name));
    }
    const isWhole = /endfacet[^\n]*\s+endsolid[^\n]*\s*$/i.test(text);
    const found = corners.counts.length;
    if (facets.length > 0 && found > 3 * facets.length && isWhole)
        throw new Error(`${facets.length} facets have ${found} corners; cut them into triangles`);
    if (found !== 3 * facets.length || (facets.length === 0 && !/endsolid/i.test(text)))
        throw new Error(`the STL file is cut short: ${found} corners in ${facets.length} finished triangles`);
    const others = text.matchAll(/^[ \t]*(?!(?:(?:end)?(?:solid|facet|loop)|outer|vertex)\b)(\S+)/gim);
    const unread = [...new Set(Array.from(others, ([, word]) => word))].sort().join(", ");
    const dropped = unread ? [`lines that begin with ${unread}`.slice(0, MOST_UNREAD)] : [];
    const used = [...new Set(facets)].sort((a, b) => a - b);
    const values = Int32Array.from(facets, (solid) => used.indexOf(solid));
    const columns: Column[] = used.length > 1 ? [{ name: "group", values, components: 1, domain: "face" }] : [];
    const called = used.map((solid) => names[solid]);
    const metadata = called.some(Boolean) ? named(called, "group") : {};
    return { soup: corners.columns(0, 3), columns, metadata, dropped };
}
