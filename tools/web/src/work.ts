/** What all but dictionaries costs, in nanoseconds of a processor core (specification, M 14.3). */
const BLOCK = 1.45e5;
const [GOP, FIELD, PART, ANOTHER] = [3.5e5, 1e5, 1.3e5, 4.5e4];
const [ROW, LOOK, LEVEL, LOOP, AROUND, INHERITED_LOOP, INHERITED_AROUND, REFERRED] = [600, 25, 90, 66, 10, 90, 10, 1.1];
/** Of a byte of coded values. */
const CODED = 800;
/** By which a part of a sequence is cheaper than a block, before it has its dictionary. */
export const UNCODED = 4e4;
/** Bytes of a block's frame besides its levels, at least. */
export const FRAME = 5;

/** Of faces and graph; what meets at more vertices than a closed surface has is sewn together. */
export function meshCost(vertices: number, faces: number, received: number): number {
    return 140 * vertices + 85 * faces + 700 * Math.max(0, faces / 2 - vertices) + 400 * received;
}

export function orderCost(vertices: number, faces: number, received: number): number {
    return 500 * vertices + 750 * faces + 100 * received;
}

/** Of cutting so many vertices and their ends of edges into parts, and of growing these to so many copies. */
export function partitionCost(vertices: number, ends: number, blocks: number, copies: number): number {
    return (vertices + ends) * (4 * (32 - Math.clz32(blocks)) + 20) + 2 * vertices + 100 * blocks + 30 * copies;
}

export function labelsCost(vertices: number, ends: number, received: number): number {
    return 300 * vertices + 30 * ends + 100 * received;
}

/** Of all of a block but its dictionary, with so many edges in the mesh. */
export function blockCost(rows: number, edges: number, levels: number): number {
    return BLOCK + ROW * rows + LOOK * edges + LEVEL * levels;
}

/** Of a grid before its bytes are counted, and of each of its frames. */
export interface GridCost {
    whole(vertices: number, faces: number): number;
    frame(received: number): number;
}

export const GRID_COST: GridCost = {
    whole: (vertices, faces) => 1650 * vertices + 150 * faces,
    frame: (received) => 3.5e4 + CODED * received,
};

/** Of a grid with floats, whose largest axis has so many values. */
export function exactCost(largest: number): GridCost {
    return { ...GRID_COST, whole: (vertices, faces) => GRID_COST.whole(vertices, faces) + 400 * vertices + 4 * largest };
}

export const LIGHT_COST: GridCost = {
    whole: (vertices, faces) => 200 * vertices + 40 * faces,
    frame: (received) => 5e4 + 120 * received,
};

/** Of refinement or an attribute, before its bytes are counted. */
export function fieldCost(vertices: number, faces: number, axes: number): number {
    return vertices * (400 + 230 * axes) + 130 * faces;
}

/** Of the declaration of an attribute. */
export const DECLARED = 6e5;

/** Of the seams of an attribute, and of joining corners between them. */
export function seamsCost(vertices: number, faces: number, received: number): number {
    return 5e4 + 10 * vertices + 120 * faces + CODED * received;
}

/** Bytes that an attribute is kept in. */
export function valuesMemory(values: number, faces: number, components: number): number {
    return (16 * components + 12) * values + 12 * faces;
}

/** Of an attribute, besides what it costs as a field. */
export function valuesCost(values: number, faces: number): number {
    return 4e5 + 150 * values + 60 * faces;
}

/** Of a frame of refinement, or of an attribute of so many values. */
export function chunkCost(received: number, values = 0): number {
    return 8e4 + CODED * received + 2 * values;
}

/** Of a part in a GOP of r components and so many fields, with so many vertices around it, besides the solution of so many columns. */
export function partCost(rows: number, around: number, width: number, components: number, fields: number, inherited: boolean): number {
    const [loop, begun] = inherited ? [LOOP + INHERITED_LOOP, AROUND + INHERITED_AROUND] : [LOOP, AROUND];
    return PART + ANOTHER * (fields - 1) + components * (width * (LEVEL + loop) + around * begun) + rows * (width * (1 + 0.1 * components) + 20 * components);
}

/** Of a run of a sequence, which may bring a mesh. */
export function runCost(mesh: boolean): number {
    return 5e5 + (mesh ? 2e6 : 0);
}

/** Bytes that all GOPs know of an attribute that moves. */
export function trackMemory(vertices: number, parts: number, width: number): number {
    return 3000 * parts + 40 * width * vertices;
}

/** Of so many columns that are known of low-delay frames, in so many rows of parts and vertices around them. */
export function referredCost(rows: number, known: number[]): number {
    return REFERRED * rows * known.reduce((sum, count) => sum + count * count, 0);
}

/** Of a GOP that tells of so many fields, before its parts. */
export function gopCost(fields: number): number {
    return GOP + FIELD * (fields - 1);
}

/** Of showing the frames of a GOP, of fields of so many numbers and components, to a user of so many vertices as given. */
export function shownCost(vertices: number, given: number, frames: number, fields: { width: number; components: number }[]): number {
    const each = fields.map(({ width, components }) => width * (components * (10 + 2 * components) + (11 / 3) * given + (vertices * components) / 15));
    return each.reduce((sum, cost) => sum + frames * (cost + 2.5e4), 0);
}
