/** Vertices parted where attributes part them, and faces sorted by parts and materials. */
import type { Attribute } from "./attributes";
import { composed, cornersOf, spread, type DrawnAttribute, type DrawnFaces, type Piece } from "./drawn";

/** Attributes of faces that say what belongs together, and are not drawn. */
const LABELS = [["part", "object"], ["material"]]; // by the first of the names that there is
const LINEAR = "COLOR_0"; // what streams in glTF call colors: others are sRGB
const BASES = { texcoord: "uv", color: "color", normal: "normal" } as const;

/** The attributes of a drawn mesh that moved, as they are in a frame. */
export function movedAttributes(
    mesh: { vertices?: Int32Array; attributes: DrawnAttribute[] },
    moved: Attribute[],
): DrawnAttribute[] {
    return moved.flatMap((attribute) => {
        const same = mesh.attributes.find(({ source }) => source === attribute.name);
        return same ? [{ ...same, values: numbersOf(attribute, mesh.vertices) }] : [];
    });
}

/**
 * Faces whose corners all have an origin, which is 0 or more, in order, with all that a mesh carries. `sources`: the
 * vertex of the mesh that each one of the faces is, if they differ; `apart`: each piece has vertices of its own.
 */
export function drawnFaces(
    faces: Int32Array,
    origin: Int32Array,
    carried: Attribute[],
    sources?: Int32Array,
    apart = false,
): DrawnFaces {
    const whole = new Int32Array(faces.length / 3)
        .map((_, face) => face)
        .filter((face) => [0, 1, 2].every((k) => origin[faces[3 * face + k]] >= 0));
    const ofFaces = carried.filter(({ domain, components }) => domain === "face" && components === 1);
    const called = (known: string): Attribute | undefined => ofFaces.find(({ name }) => name === known);
    const labels = LABELS.map((names) => names.map(called).find(Boolean));
    const part = (face: number): number => labels[0]?.values[face] ?? 0;
    const material = (face: number): number => labels[1]?.values[face] ?? 0;
    if (labels.some(Boolean)) whole.sort((a, b) => part(a) - part(b) || material(a) - material(b) || a - b);
    const pieces: Piece[] = [];
    let last: Piece | undefined;
    whole.forEach((face, i) => {
        if (last?.part === part(face) && last.material === material(face)) last.count += 3;
        else {
            last = { part: part(face), material: material(face), start: 3 * i, count: 3, first: 0, vertices: 0 };
            pieces.push(last);
        }
    });
    const drawn = carried.filter((attribute) => !labels.includes(attribute));
    const { index, vertices, rows } = parted(faces, whole, drawn, origin.length, apart ? pieces : []);
    const normal = drawn.find(({ semantic, domain }) => semantic === "normal" && domain !== "face");
    const used = new Map(["position", "normal"].map((name) => [name, 1]));
    const valuesFor = (attribute: Attribute, i: number): Float32Array => {
        const isOfVertices = attribute.domain === "vertex";
        return numbersOf(attribute, isOfVertices ? composed(rows[i], sources) : rows[i]);
    };
    const attributes = drawn.flatMap((attribute, i) => {
        if (attribute === normal) return [];
        const base = attribute.semantic === "generic" ? attribute.name : BASES[attribute.semantic];
        const count = used.get(base) ?? 0;
        used.set(base, count + 1);
        const { name: source, components } = attribute;
        return [{ name: `${base}${count || ""}`, source, components, values: valuesFor(attribute, i) }];
    });
    return { index, vertices, pieces, attributes, own: normal && valuesFor(normal, drawn.indexOf(normal)) };
}

/** The value of each corner of some faces that an attribute has; of faces, equal ones have the number of the first. */
function valuesOf(attribute: Attribute, faces: Int32Array, chosen: Int32Array): Int32Array {
    const { domain, values, components, indices } = attribute;
    const numbers = new Int32Array(3 * chosen.length);
    const first = new Map<string, number>();
    chosen.forEach((face, i) => {
        let ofFace = face;
        if (domain === "face") {
            const key = values.subarray(components * face, components * (face + 1)).join();
            ofFace = first.get(key) ?? face;
            first.set(key, ofFace);
        }
        for (let k = 0; k < 3; k++) {
            const ofCorner = domain === "corner" ? (indices?.[3 * face + k] ?? 0) : faces[3 * face + k];
            numbers[3 * i + k] = domain === "face" ? ofFace : ofCorner;
        }
    });
    return numbers;
}

/**
 * A drawn vertex for all corners of one vertex with the same values, and in one of the pieces, if there are some; `rows`:
 * which value of each attribute it has.
 */
function parted(
    faces: Int32Array,
    chosen: Int32Array,
    attributes: Attribute[],
    size: number,
    pieces: Piece[],
): { index: Uint32Array; vertices?: Int32Array; rows: (Int32Array | undefined)[] } {
    const index = cornersOf(faces, chosen);
    const parting = attributes.filter(({ domain }) => domain !== "vertex");
    if (pieces.length === 1) pieces[0].vertices = size;
    if (parting.length === 0 && pieces.length < 2) return { index, rows: attributes.map(() => undefined) };
    const values = parting.map((attribute) => valuesOf(attribute, faces, chosen));
    // The drawn vertices of each vertex are a chain, from the one met last to the first.
    const [heads, next] = [new Int32Array(size).fill(-1), new Int32Array(index.length)];
    const [vertices, corners] = [new Int32Array(index.length), new Int32Array(index.length)];
    let [count, number, first] = [0, 0, 0]; // drawn vertices; the piece, and its first drawn vertex
    for (let i = 0; i < index.length; i++) {
        if (i === pieces[number + 1]?.start) pieces[++number].first = first = count;
        const vertex = index[i];
        let drawn = heads[vertex];
        while (drawn >= first && !values.every((numbers) => numbers[corners[drawn]] === numbers[i]))
            drawn = next[drawn];
        if (drawn < first) {
            drawn = count++;
            [next[drawn], heads[vertex], vertices[drawn], corners[drawn]] = [heads[vertex], drawn, vertex, i];
        }
        index[i] = drawn;
    }
    for (const [i, piece] of pieces.entries()) piece.vertices = (pieces[i + 1]?.first ?? count) - piece.first;
    const used = vertices.slice(0, count);
    const rows = attributes.map((attribute) => {
        const numbers = values[parting.indexOf(attribute)];
        return numbers ? corners.subarray(0, count).map((corner) => numbers[corner]) : used;
    });
    return { index, vertices: used, rows };
}

/** The linear color of one in sRGB. */
export const linearOf = (share: number): number =>
    share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;

/** Numbers of the drawn vertices; colors are linear, and their integers are shares of their range. */
export function numbersOf({ name, semantic, kind, components, values }: Attribute, rows?: Int32Array): Float32Array {
    const numbers = spread(values, components, rows);
    const most = { uint8: 255, uint16: 65535 }[kind as string] ?? 1;
    if (semantic === "color" && components > 2)
        for (let i = 0; i < numbers.length; i++)
            numbers[i] = name !== LINEAR && i % components < 3 ? linearOf(numbers[i] / most) : numbers[i] / most;
    return numbers;
}
