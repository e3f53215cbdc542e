/** Attributes: seams, values, and how the user is given them (specification, D, A). */
import { begun } from "./begun";
import { Cursor } from "./packets";
import { BITS, CORNER, FACE, isByVertex, LEVELS, OCTAHEDRAL, RANGES, RECOMPUTED, scaleOf, TEXCOORD, VERTEX, wordsOf, type Declaration } from "./declaration";
import { Coder, makeBank } from "./entropy";
import { CorruptError, NumericError } from "./errors";
import { makeLearners, makeModel } from "./fields";
import { decodeChunk, linkCorners, zeros } from "./grid";
import type { Header } from "./header";
import type { Argument, Ints, Memory } from "./kernels";
import type { Allowance } from "./chain";
import { checkLimit, type Limits } from "./limits";
import type { Numbering } from "./numbering";
import { areFinite } from "./numbers";
import type { Moving } from "./sequence";
import { DECLARED, fieldCost, seamsCost, valuesCost, valuesMemory } from "./work";

const SEAM = 1;
const SEAMS = { inputs: 4, others: 9, slots: 32 * 32 + 9 * 16 + 256 + 9 };
const MOST_WHOLE = 2 ** 20 - 1;
const PIECE = 65536;
const MOST_COMPONENTS = 4;
const [BASES, VALENCES] = [4, 6];
const FACE_CONTEXTS = 257;
const FLOAT32 = 6;
const FLOAT64 = 7;
const SEMANTICS = ["generic", "color", "normal", "texcoord"] as const;
const KINDS = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"] as const;

/** An attribute of a mesh, whole. */
export interface Attribute {
    name: string;
    semantic: (typeof SEMANTICS)[number];
    /** What has a value: each vertex, each corner by way of `indices`, or each face. */
    domain: "vertex" | "corner" | "face";
    kind: (typeof KINDS)[number];
    components: number;
    /** `components` numbers for each value. */
    values: Float64Array;
    /** The value of each corner. */
    indices?: Int32Array;
}

/** Decoded positions, as vertices are coded; on a grid also the coded values. */
export interface Solid {
    positions: Float64Array;
    places?: Int32Array;
}

/** Which corners share a value: the seams, and how many values there are. */
interface Joins {
    seams: Uint8Array;
    count: number;
}

/** The values of an attribute as vertices of a mesh of their own; -1 for the vertex of what no face uses. */
interface Surface {
    faces: Int32Array;
    vertices: Int32Array;
}

/** An attribute while its values come. */
interface Valued {
    declaration: Declaration;
    joins?: Joins;
    surface?: Surface;
    /** One for each group of pieces. */
    coders?: { kernel: string; state: Argument[]; values: Ints; order?: Ints; columns: number }[];
    values: Float64Array;
    coded: number;
}

/** The attributes of one mesh. */
export class Attributes {
    private readonly valued = new Map<number, Valued>();
    private current = -1;
    private mark?: number;

    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
        private readonly faces: Ints,
        private readonly limits: Limits,
        private readonly allowance: Allowance,
    ) {}

    /** Take a declaration, and its seams. */
    declare(index: number, declaration: Declaration, seams: Uint8Array): void {
        this.allowance.spend(DECLARED);
        const all = [...this.valued.values()].map((one) => one.declaration);
        checkLimit(this.limits, "attributeValues", [...all, declaration].reduce((sum, one) => sum + this.numbersOf(one), 0));
        this.valued.set(index, { declaration, joins: this.joinsOf(index, declaration, seams), values: new Float64Array(0), coded: 0 });
    }

    /** What its values cost, before their bytes are counted. */
    costOf(index: number): number {
        const { rows = 0, components = 0 } = this.valued.get(index)?.declaration ?? {};
        return valuesCost(rows, this.header.faces) + fieldCost(rows, this.header.faces, components);
    }

    /** How many values it has. */
    valuesOf(index: number): number {
        return this.valued.get(index)?.declaration.rows ?? 0;
    }

    /** Decode a chunk of values; the attribute, if it is whole now. */
    decode(index: number, first: number, count: number, data: Uint8Array, numbering: Numbering, solid: () => Solid | undefined): Attribute | undefined {
        const one = this.valued.get(index);
        if (!one) throw new CorruptError(`attribute ${index} is not declared`);
        const { declaration } = one;
        if (index !== this.current) this.start(index, one, numbering, solid);
        if (first !== one.coded || !one.coders) throw new CorruptError(`attribute "${declaration.name}" lacks the values before ${first}`);
        const cursor = new Cursor(data);
        const several = one.coders.length > 1;
        let rows = Int32Array.from({ length: count }, (_, i) => first + i);
        for (const { kernel, state, order } of one.coders) {
            const part = several ? cursor.take(cursor.varint()) : cursor.rest();
            decodeChunk(this.memory, kernel, state, part, first, count);
            if (order) rows = order.view.slice(first, first + count);
        }
        const pieces = one.coders.map(({ values, columns }) => ({ values: values.view, columns }));
        cursor.finish();
        restore(declaration, rows, pieces, one.values);
        one.coded += count;
        return isWhole(one) ? this.given(one, numbering) : undefined;
    }

    /** Attributes that follow from positions. */
    recomputed(numbering: Numbering, solid: () => Solid | undefined): Attribute[] {
        const recomputed = [...this.valued.values()].filter(({ declaration }) => declaration.coding === RECOMPUTED);
        return recomputed.flatMap((one) => {
            const found = solid();
            if (!found) return [];
            one.surface = this.surfaceOf(one, numbering);
            one.values = normalsOf(one.surface, found.positions);
            if (one.declaration.kind === FLOAT32) one.values.forEach((value, i, all) => (all[i] = Math.fround(value)));
            const given = this.given(one, numbering);
            one.surface = undefined;
            return [given];
        });
    }

    /** Those that move; of one that is not whole nothing is known. */
    moving(): Moving[] {
        return [...this.valued].flatMap(([number, one]) => {
            const { components: width, rows, moves } = one.declaration;
            if (moves && rows !== this.header.vertices) throw new CorruptError("an attribute that moves has values of what no face uses");
            const start = new Float64Array(rows * width);
            if (isWhole(one)) start.forEach((_, i) => (start[i] = one.values[i] - one.values[i % width]));
            return moves ? [{ number, width, start }] : [];
        });
    }

    /** Whether all that is needed of those that move has come. */
    get canMove(): boolean {
        return [...this.valued.values()].every((one) => !one.declaration.moves || isWhole(one));
    }

    /** One that moves, in a frame that differs from the first one by `change` (S 10.4, S 10.5); nothing if it is not whole. */
    moved(number: number, change: Float64Array, { source }: Numbering): Attribute[] {
        const one = this.valued.get(number);
        if (!one || !isWhole(one)) return [];
        const { declaration } = one;
        const [low, high] = RANGES[declaration.kind] ?? [];
        const values = change.map((difference, i) => {
            const value = one.values[i] + difference;
            if (declaration.kind === FLOAT32) return Math.fround(value);
            return low === undefined ? value : Math.min(Math.max(roundEven(value), low), high);
        });
        if (!areFinite(values)) throw new NumericError(`values of "${declaration.name}" are not finite`);
        return [{ ...shapeOf(declaration), domain: "vertex", values: source ? taken(values, source, declaration.components) : values }];
    }

    /** Check the number of rows of all attributes (D 1.2). */
    check(numbering: Numbering): void {
        for (const one of this.valued.values()) {
            const { declaration } = one;
            const expected = this.rowsOf(one, numbering);
            if (declaration.coding !== RECOMPUTED && declaration.rows !== expected) {
                throw new CorruptError(`attribute "${declaration.name}" has ${declaration.rows} values where ${expected} belong`);
            }
        }
    }

    /** Take note of what all of them are kept in. */
    begin(numbering: Numbering): void {
        this.check(numbering);
        for (const one of this.valued.values()) {
            this.allowance.keep(valuesMemory(this.rowsOf(one, numbering), this.header.faces, one.declaration.components));
        }
    }

    private rowsOf({ declaration, joins }: Valued, numbering: Numbering): number {
        if (declaration.domain === FACE) return this.header.faces;
        return (joins ? joins.count : this.header.vertices) + looseOf(declaration, numbering);
    }

    private numbersOf(declaration: Declaration): number {
        const rows = declaration.coding === RECOMPUTED ? this.faces.length : declaration.rows;
        return rows * Math.max(wordsOf(declaration), declaration.components);
    }

    private joinsOf(index: number, declaration: Declaration, seams: Uint8Array): Joins | undefined {
        const { memory, faces, header, valued, allowance } = this;
        if (declaration.domain !== CORNER) return undefined;
        if (declaration.seamsOf) {
            const shared = valued.get(declaration.seamsOf - 1)?.joins;
            if (!shared) throw new CorruptError(`the seams of "${declaration.name}" are those of an attribute that is missing`);
            return shared;
        }
        if (valued.size < index) throw new CorruptError(`the seams of "${declaration.name}" depend on an attribute that is missing`);
        const earlier = [...valued.values()].flatMap((one) => (one.joins && !one.declaration.seamsOf ? [one.joins.seams] : []));
        allowance.keep(faces.length, seams.length);
        allowance.spend(seamsCost(header.vertices, header.faces, seams.length), seams.length);
        return memory.scratch(() => {
            const corners = linkCorners(memory, faces, header.vertices);
            const coder = new Coder(memory, seams);
            const bank = makeBank(memory, { slots: SEAMS.slots, selectors: SEAMS.others, inputs: SEAMS.inputs });
            const [edges, others] = [memory.bytes(faces.length), memory.bytes(faces.length)];
            edges.view.fill(0);
            const known = others.view.fill(0);
            earlier.slice(-2).reverse().forEach((one, k) => one.forEach((seam, edge) => (known[edge] += (k ? 1 : 3) * (1 + Number(seam === SEAM)))));
            memory.call("code_edges", coder.parts, bank, corners, edges, others, memory.ints(3 * header.vertices, 3));
            coder.finish();
            const count = memory.call("join_corners", corners, edges, memory.ints(faces.length), memory.ints(faces.length));
            return { seams: edges.view.slice(), count };
        });
    }

    /** The value of each corner, and the first corner of each value. */
    private joined({ seams, count }: Joins): { faces: Int32Array; first: Int32Array } {
        const { memory, faces, header } = this;
        return memory.scratch(() => {
            const corners = linkCorners(memory, faces, header.vertices);
            const [edges, joined, first] = [memory.bytes(seams.length), memory.ints(seams.length), memory.ints(seams.length)];
            edges.view.set(seams);
            memory.call("join_corners", corners, edges, joined, first);
            return { faces: joined.view.slice(), first: first.view.slice(0, count) };
        });
    }

    private surfaceOf({ declaration, joins }: Valued, numbering: Numbering): Surface {
        const faces = this.faces.view.slice();
        if (declaration.domain === FACE) return { faces, vertices: new Int32Array(0) };
        const joined = joins && this.joined(joins);
        const size = joins ? joins.count : this.header.vertices;
        const vertices = new Int32Array(size + looseOf(declaration, numbering)).fill(-1);
        for (let row = 0; row < size; row++) vertices[row] = joined ? faces[joined.first[row]] : row;
        return { faces: joined ? joined.faces : faces, vertices };
    }

    /** The state of an attribute takes the place of that of the one before. */
    private start(index: number, one: Valued, numbering: Numbering, solid: () => Solid | undefined): void {
        const { memory } = this;
        const { declaration } = one;
        const before = this.valued.get(this.current);
        if (before) before.surface = before.coders = undefined;
        one.surface = this.surfaceOf(one, numbering);
        one.values = new Float64Array(declaration.rows * declaration.components);
        const geometry = declaration.leans ? this.geometryOf(one.surface, solid()) : new Int32Array(0);
        this.mark ??= memory.mark();
        memory.release(this.mark);
        this.current = index;
        const largest = piecesOf(declaration);
        one.coders = [];
        for (let start = 0; start < largest.length; start += MOST_COMPONENTS) {
            one.coders.push(this.makeCoder(declaration, one.surface, largest.slice(start, start + MOST_COMPONENTS), geometry));
        }
    }

    private makeCoder(declaration: Declaration, surface: Surface, largest: number[], geometry: Int32Array): NonNullable<Valued["coders"]>[number] {
        const { memory, header } = this;
        const columns = largest.length;
        const top = memory.ints(columns);
        top.view.set(largest);
        const faces = memory.ints(surface.faces.length, 3);
        faces.view.set(surface.faces);
        const field = (rows: number, width: number): Ints => zeros(memory.ints(rows * width, width));
        const model = makeModel(memory);
        if (declaration.domain === FACE) {
            const values = field(declaration.rows, columns);
            const corners = linkCorners(memory, faces, header.vertices);
            const state = [top, values, field(declaration.rows, columns), field(columns, FACE_CONTEXTS)];
            return { kernel: "code_faces", state: [model, corners, state], values, columns };
        }
        const size = surface.vertices.length;
        const kind = kindOf(declaration);
        const corners = linkCorners(memory, faces, size);
        const order = memory.ints(size);
        memory.scratch(() => {
            const scratch = memory.ints(3 * size, size);
            scratch.view.fill(-1);
            memory.call("order_vertices", corners, order, scratch);
        });
        const twin = memory.ints(size);
        twin.view.set(ringOfTwins(surface.vertices));
        const known = memory.ints(geometry.length, 3);
        known.view.set(geometry);
        const values = field(size, columns);
        const words = Math.floor(Math.max(...largest) / 64) + 1;
        const [sums, seen] = [memory.longs((columns + 1) * size, columns + 1), memory.longs(columns * words, words)];
        sums.view.fill(0n);
        seen.view.fill(0n);
        const guesses = (kind === "plain" ? MOST_COMPONENTS : 2) * BASES * VALENCES;
        const starts = { plain: [16384, 16384], texcoord: [8192], normal: [] }[kind];
        const learners = makeLearners(memory, guesses + guesses / VALENCES, (k) => (k < guesses ? starts : [40000, 8192]));
        const directions = field(kind === "normal" ? size : 0, 12);
        const chart = memory.longs(2);
        chart.view.set([0n, BigInt(16 * largest[0])]);
        const state: Argument = [top, order, twin, known, values, field(size, columns), sums, seen, learners, directions, chart];
        if (kind === "normal") memory.call("expect_normals", corners, state);
        const kernel = { plain: "code_scalars", texcoord: "code_texcoords", normal: "code_normals" }[kind];
        return { kernel, state: [model, corners, state], values, order, columns };
    }

    /** Where rows are, in whole numbers (D 5). */
    private geometryOf(surface: Surface, solid?: Solid): Int32Array {
        const places = solid?.places;
        if (!places) throw new CorruptError("positions are missing that attributes are predicted from");
        const geometry = new Int32Array(3 * surface.vertices.length);
        surface.vertices.forEach((vertex, row) => vertex >= 0 && geometry.set(places.subarray(3 * vertex, 3 * vertex + 3), 3 * row));
        return geometry;
    }

    /** As the user knows it (D 4.5). */
    private given({ declaration, surface, values }: Valued, numbering: Numbering): Attribute {
        const { components } = declaration;
        const { corners, source, faces, isSplit } = numbering;
        const rows = values.length / components;
        const shape = shapeOf(declaration);
        const chosen = (from: Int32Array): Float64Array => taken(values, from, components);
        if (declaration.domain === FACE) {
            const from = Int32Array.from({ length: rows }, (_, face) => (corners ? Math.floor(corners[3 * face] / 3) : face));
            return { ...shape, domain: "face", values: chosen(from) };
        }
        const indices = corners ? corners.map((corner) => begun(surface).faces[corner]) : begun(surface).faces;
        if (!isByVertex(declaration) || (declaration.domain !== VERTEX && !isSplit)) return { ...shape, domain: "corner", values, indices };
        if (!source) return { ...shape, domain: "vertex", values };
        let loose = rows - numbering.loose.vertices.length;
        let found = source;
        if (declaration.domain === CORNER) {
            found = new Int32Array(source.length);
            for (let i = faces.length - 1; i >= 0; i--) found[faces[i]] = indices[i];
        }
        return { ...shape, domain: "vertex", values: chosen(source.map((vertex, i) => (vertex < 0 ? loose++ : found[i]))) };
    }
}

function shapeOf({ name, semantic, kind, components }: Declaration): Pick<Attribute, "name" | "semantic" | "kind" | "components"> {
    return { name, semantic: SEMANTICS[semantic], kind: KINDS[kind], components };
}

function taken(values: Float64Array, rows: Int32Array, components: number): Float64Array {
    const found = new Float64Array(components * rows.length);
    for (let i = 0, at = 0; i < rows.length; i++) for (let d = 0; d < components; d++) found[at++] = values[components * rows[i] + d];
    return found;
}

function isWhole({ declaration, coded }: Valued): boolean {
    return coded === declaration.rows;
}

/** The nearest whole number, of two the even one. */
function roundEven(value: number): number {
    const near = Math.round(value);
    return near - value === 0.5 && near % 2 !== 0 ? near - 1 : near;
}

/** How many values there are for vertices that no face uses. */
function looseOf(declaration: Declaration, numbering: Numbering): number {
    return isByVertex(declaration) ? numbering.loose.vertices.length : 0;
}

/** How numbers are predicted (D 3.4). */
function kindOf({ coding, semantic, largest }: Declaration): "plain" | "texcoord" | "normal" {
    if (coding === OCTAHEDRAL) return "normal";
    const small = coding === LEVELS && Math.max(...largest) <= MOST_WHOLE;
    return small && semantic === TEXCOORD && largest.length === 2 ? "texcoord" : "plain";
}

/** Largest value of each number that is coded (D 3.2). */
function piecesOf({ largest }: Declaration): number[] {
    return largest.flatMap((most) => (most <= MOST_WHOLE ? [most] : [Math.floor(most / PIECE), PIECE - 1]));
}

/** For each row the next one at the same vertex, in a ring. */
function ringOfTwins(vertices: Int32Array): Int32Array {
    const last = new Map<number, number>();
    const first = new Map<number, number>();
    const twin = Int32Array.from(vertices.keys());
    vertices.forEach((vertex, row) => {
        if (vertex < 0) return;
        const before = last.get(vertex);
        if (before === undefined) first.set(vertex, row);
        else twin[before] = row;
        last.set(vertex, row);
    });
    for (const [vertex, row] of last) twin[row] = begun(first.get(vertex));
    return twin;
}

/** Values of rows from their pieces (D 3.2, D 4). */
function restore(declaration: Declaration, rows: Int32Array, groups: { values: Int32Array; columns: number }[], into: Float64Array): void {
    const { coding, kind, components, largest } = declaration;
    const { offsets, steps } = scaleOf(declaration);
    const bits = new DataView(new ArrayBuffer(8));
    const words = new Float64Array(largest.length);
    for (const row of rows) {
        const pieces = groups.flatMap(({ values, columns }) => [...values.subarray(row * columns, row * columns + columns)]);
        let at = 0;
        largest.forEach((most, w) => {
            words[w] = pieces[at++];
            if (most > MOST_WHOLE) words[w] = PIECE * words[w] + pieces[at++];
            if (words[w] > most) throw new CorruptError(`a level of attribute "${declaration.name}" is above ${most}`);
        });
        const value = into.subarray(row * components, row * components + components);
        if (coding === OCTAHEDRAL) value.set(unfolded(words[0], words[1], largest[0] / 2));
        else if (coding === BITS) value.forEach((_, i) => (value[i] = kind === FLOAT64 ? ofBits(bits, words[2 * i] + offsets[2 * i], words[2 * i + 1] + offsets[2 * i + 1]) : ofBits(bits, words[i] + offsets[i])));
        else value.forEach((_, i) => (value[i] = offsets[i] + steps[i] * words[i]));
        if (kind === FLOAT32) value.forEach((number, i) => (value[i] = Math.fround(number)));
    }
}

/** The direction of a place on the unfolded octahedron (D 4.2). */
function unfolded(first: number, second: number, size: number): number[] {
    let [u, v] = [first - size, second - size];
    const w = size - Math.abs(u) - Math.abs(v);
    if (w < 0) [u, v] = [(u < 0 ? -1 : 1) * (size - Math.abs(v)), (v < 0 ? -1 : 1) * (size - Math.abs(u))];
    const length = Math.sqrt(u * u + v * v + w * w);
    return [u / length, v / length, w / length];
}

/** The number of bits that ascend with it, in one word or two (D 4.3). */
function ofBits(view: DataView, high: number, low?: number): number {
    const flip = high >= 2 ** 31 ? 2 ** 31 : 2 ** 32 - 1;
    view.setUint32(0, (high ^ flip) >>> 0);
    if (low !== undefined) view.setUint32(4, (high >= 2 ** 31 ? low : ~low) >>> 0);
    const value = low === undefined ? view.getFloat32(0) : view.getFloat64(0);
    return Number.isFinite(value) ? value : 0;
}

/** Normals of rows: those of the faces around, by area (D 4.4). */
function normalsOf({ faces, vertices }: Surface, positions: Float64Array): Float64Array {
    const normals = new Float64Array(3 * vertices.length);
    for (let f = 0; f < faces.length; f += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => 3 * vertices[faces[f + k]]);
        const [ux, uy, uz] = [0, 1, 2].map((d) => positions[b + d] - positions[a + d]);
        const [vx, vy, vz] = [0, 1, 2].map((d) => positions[c + d] - positions[a + d]);
        const across = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
        for (let k = 0; k < 3; k++) for (let d = 0; d < 3; d++) normals[3 * faces[f + k] + d] += across[d];
    }
    for (let row = 0; row < normals.length; row += 3) {
        const length = Math.sqrt(normals[row] ** 2 + normals[row + 1] ** 2 + normals[row + 2] ** 2);
        if (length > 0) for (let d = 0; d < 3; d++) normals[row + d] /= length;
        else normals.set([0, 0, 1], row);
    }
    return normals;
}

