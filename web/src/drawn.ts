/** What is drawn of faces and attributes. */

/** Faces with one material, of one part: `count` corners from `start` on, and `vertices` drawn ones from `first` on. */
export type Piece = Record<"material" | "part" | "start" | "count" | "first" | "vertices", number>;

/** Numbers of the drawn vertices under one name. */
export interface DrawnAttribute {
    name: string;
    /** The attribute that they are. */
    source: string;
    components: number;
    values: Float32Array;
}

/** Faces as they are drawn; `vertices`: which vertex each drawn one is, if they differ; `own`: normals. */
export interface DrawnFaces {
    index: Uint32Array;
    vertices?: Int32Array;
    pieces: Piece[];
    attributes: DrawnAttribute[];
    own?: Float32Array;
}

type Kind<Numbers> = new (from: number | ArrayLike<number>) => Numbers;

/** Rows of numbers, `width` in each, one for each of `vertices`; without these as they are. */
export function spread<Numbers extends Float32Array | Float64Array = Float32Array>(
    numbers: ArrayLike<number>,
    width: number,
    vertices?: Int32Array,
    type = Float32Array as unknown as Kind<Numbers>,
): Numbers {
    if (!vertices) return new type(numbers);
    const rows = new type(width * vertices.length);
    for (let i = 0; i < vertices.length; i++)
        for (let d = 0; d < width; d++) rows[width * i + d] = numbers[width * vertices[i] + d];
    return rows;
}

/** The sources of some rows, or of all. */
export function composed(rows?: Int32Array, sources?: Int32Array): Int32Array | undefined {
    return rows && sources ? rows.map((row) => sources[row]) : (rows ?? sources);
}

export function cornersOf(faces: Int32Array, chosen: ArrayLike<number>): Uint32Array {
    const corners = new Uint32Array(3 * chosen.length);
    for (let i = 0; i < corners.length; i++) corners[i] = faces[3 * chosen[Math.floor(i / 3)] + (i % 3)];
    return corners;
}
