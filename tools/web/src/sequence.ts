/** Frames of a sequence, which follow the blocks of its first frame (specification, sequence.md). */
import { factorize, reconstruct, solutionCost, solve, cosineColumns, type Factor } from "./basis";
import { edgesOf, makeBlock, type Block, type Blocks } from "./blocks";
import { keyDictionary, spendOn, TETHER, type Allowance } from "./chain";
import { Coder, makeBank, unsignedSpan, type Bank } from "./entropy";
import { CorruptError, NumericError, UnsupportedError } from "./errors";
import type { Header } from "./header";
import type { Doubles, Ints, Memory } from "./kernels";
import { checkLimit, type Limits } from "./limits";
import { areFinite } from "./numbers";
import { Cursor } from "./packets";
import { columnsOf } from "./reflections";
import type { Course } from "./runs";
import { blockCost, partCost, shownCost, UNCODED } from "./work";

const LEARNT = 0;
const KEY_FRAMES = 1;
const NEXT_FRAMES = 2;
const MOST_EXPONENT = 400;
/** The first byte of a GOP: its method, and so many times its run, counted modulo so many. */
const [METHODS, RUNS] = [8, 32];

const FLATNESS = 2 ** -12;
const SMALLNESS = 2 ** -48;
const SMALLEST_WEIGHT = 2 ** -5;
const LARGEST_WEIGHT = 8;
const BEND = 2 ** -6;

const INPUTS = 6;
const SPAN = unsignedSpan(14) + 4;
/** 2^(-q/4). */
const QUARTERS = [1, 0.8408964152537145, 0.7071067811865476, 0.5946035575013605];
const SLOTS = (5 * 12 * 12 + 12 * 40) * SPAN;
const LEADING = 24;
/** Forgetting, ridge, noise, what is around, dense rows, renewal (S 6). */
const RULES = [0.985, 0.0025, 30, 30, 16n, 8n] as const;
const SQUARES = 0.5;
const CUBES = 0.3;
const SMALLEST_RADIUS = 2 ** -24;
/** Axes of the squares and cubes of positions, in their order (S 3.7). */
const PRODUCTS = [2, 3].flatMap((degree) => risingAxes(degree).map((axes) => ({ factor: degree === 2 ? SQUARES : CUBES, axes })));
/** Columns of bends. */
const BENDS = 3 + PRODUCTS.length;

/** The data of a GOP (S 2). */
interface Gop {
    method: number;
    frames: number;
    step: number;
    components: number;
    exponents: number[];
    basis: Uint8Array;
    levels: Uint8Array;
}

/** Rows and columns of levels; kept outside of the kernels' memory. */
interface Levels {
    rows: number;
    values: Int32Array;
}

/** A part of the mesh, what it hangs on, and its dictionary (S 3). */
interface Part {
    block: Block;
    springs: Float64Array;
    total: number;
    starts: Ints;
    /** Vertices that it hangs on, ascending, and which of them each spring goes to. */
    around: Int32Array;
    outer: Ints;
    stiffness: Doubles;
    factor: Factor;
    basis: Doubles;
}

/** What bends a part (S 3.7): differences, and values around it, of `BENDS` columns. */
interface Bends {
    known: Float64Array;
    around: Float64Array;
}

/** What low-delay frames refer to, part by part, and how many came last (S 7.2). */
interface History {
    frames: number;
    levels: Levels[];
    moments: Float64Array[];
    latest: Float64Array[];
    before: Float64Array[];
}

/** Decodes the GOPs of one sequence; what it keeps lies in memory behind all that the first frame has. */
export class Sequence {
    /** Made when a GOP is there, whose frames pay for them (S 8.3). */
    private parts: Part[] = [];
    private first: Float64Array[] = [];
    private bends: Bends[] = [];
    private behindFirst = 0;
    private behindParts = 0;
    private failure?: unknown;
    private bank!: Bank;
    private behindBank = 0;
    private history?: History;
    /** That of the run: of the first, or of one that has its mesh again. */
    private run: Header;

    /** `firstFrame` holds the positions that the blocks add up to, in BSM units. */
    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
        private readonly course: Course,
        private readonly blocks: Blocks,
        private readonly limits: Limits,
        private readonly faces: Ints,
        private readonly firstFrame: Float64Array,
        /** How many vertices the user has. */
        private readonly given: number,
        private readonly allowance: Allowance,
    ) {
        this.run = header;
    }

    /** Keep only what a later run of this mesh cannot do without. */
    suspend(): void {
        this.forget();
        if (this.parts.length > 0) this.memory.release(this.behindFirst);
        this.parts = [];
    }

    /** Another run of this mesh begins. */
    resume(header: Header): void {
        const { vertices, faces } = this.header;
        if (header.vertices !== vertices || header.faces !== faces) throw new CorruptError(`run ${header.run} has another mesh than the run that it names`);
        this.run = header;
    }

    /** No frame refers to one that has come. */
    forget(): void {
        this.history = undefined;
    }

    /** Make the parts; what is wrong with them is so for every GOP. */
    private begin(): void {
        if (this.failure) throw this.failure;
        if (this.parts.length > 0) return;
        const { memory, blocks, allowance } = this;
        this.behindFirst = memory.mark();
        try {
            const frame = memory.copy(this.firstFrame, 3);
            const weights = this.edgeWeights(this.faces, frame);
            const rank = memory.ints(blocks.graph.size);
            for (let index = 0; index < blocks.count; index++) for (const vertex of core(blocks, index).view) rank.view[vertex] = index;
            const parts = Array.from({ length: blocks.count }, (_, index) => this.makePart(index, weights, rank, allowance));
            this.bends = parts.map((part) => this.bendsOf(part));
            this.first = this.bends.map(({ known }) => known.filter((_, i) => i % BENDS < 3));
            this.parts = parts;
            this.behindParts = memory.mark();
        } catch (error) {
            this.failure = error;
            throw error;
        }
    }

    /** Frames of the GOP from frame `index` on, each made when it is called; valid until the next GOP. */
    decode(index: number, data: Uint8Array): (() => Float64Array)[] {
        const { header, run, course } = this;
        if (index !== course.next) throw new CorruptError(`frame ${index} where frame ${course.next} must follow`);
        const gop = parseGop(data, run);
        const { components, method } = gop;
        const left = method === LEARNT ? 0 : 4 * header.vertices * components + this.blocks.count * momentsOf(9, components) * 8;
        checkLimit(this.limits, "sequenceBytes", components * (16 * header.vertices + 120 * gop.frames + 24 * components) + left);
        const last = index + gop.frames;
        if (run.frames > 0 && last > run.frames) throw new CorruptError(`frame ${last - 1} of ${run.frames}`);
        const frames = this.paidFor(gop, data.length);
        course.next = last;
        return frames;
    }

    /** The frames of a GOP, if its frames and bytes pay for them. */
    private paidFor(gop: Gop, received: number): (() => Float64Array)[] {
        const { header, allowance } = this;
        allowance.show(header.vertices * gop.frames);
        try {
            this.begin();
            const parts = this.parts.reduce(
                (sum, { block, around, basis }) => sum + partCost(block.size, around.length, basis.width, gop.components) + solutionCost(block, gop.components),
                0,
            );
            allowance.spend(parts + shownCost(header.vertices, this.given, gop.frames, gop.components), received);
            return gop.method === LEARNT ? this.transformed(gop) : this.following(gop);
        } catch (error) {
            allowance.show(-header.vertices * gop.frames);
            throw error;
        }
    }

    /** Weight of each entry of the graph (S 3.1). */
    private edgeWeights(faces: Ints, frame: Doubles): Doubles {
        const { memory } = this;
        const { offsets, neighbours } = this.blocks.graph;
        const weights = memory.doubles(neighbours.length);
        weights.view.fill(0);
        memory.run("cotangents", offsets, neighbours, faces, frame, FLATNESS, SMALLNESS, weights);
        const { view } = weights;
        if (!areFinite(view)) throw new NumericError("the first frame is too large for weights of its edges");
        view.forEach((sum, i) => {
            const positive = (sum + Math.sqrt(sum * sum + BEND)) / 2;
            view[i] = SMALLEST_WEIGHT + (LARGEST_WEIGHT * positive) / (LARGEST_WEIGHT + positive);
        });
        return weights;
    }

    private makePart(index: number, weights: Doubles, rank: Ints, allowance: Allowance): Part {
        const { memory, header } = this;
        const { graph } = this.blocks;
        const binary = makeBlock(memory, graph, core(this.blocks, index));
        const { size, vertices, offsets, neighbours } = binary;
        const room = edgesOf(graph, vertices);
        const [inner, held] = [memory.doubles(neighbours.length), memory.doubles(size)];
        const [starts, outer, stiffness] = [memory.ints(size + 1), memory.ints(room), memory.doubles(room)];
        memory.run(
            "hold", graph.offsets, graph.neighbours, weights, rank, vertices, offsets, neighbours, inner, held, starts, outer, stiffness,
        );
        const ends = outer.view.subarray(0, starts.view[size]);
        const around = Int32Array.from(new Set(ends)).sort();
        const places = new Map(Array.from(around, (vertex, place) => [vertex, place]));
        ends.forEach((vertex, i) => (ends[i] = places.get(vertex)!));
        const block = { ...binary, weights: inner };
        const springs = held.view.slice();
        const columns = Math.min(header.coefficients, size);
        allowance.spend(blockCost(size, room, 0) - UNCODED);
        spendOn(allowance, header, block, columns, false);
        const factor = factorize(memory, block, springs.map((spring) => spring + TETHER));
        const total = springs.reduce((sum, spring) => sum + spring, 0);
        const basis = memory.keep(() => keyDictionary(memory, header, block, springs, columns, allowance));
        return { block, springs, total, starts, around, outer, stiffness, factor, basis };
    }

    /** What bends a part (S 3.7). */
    private bendsOf(part: Part): Bends {
        const { firstFrame } = this;
        const vertices = part.block.vertices.view;
        const centre = [0, 1, 2].map((axis) => vertices.reduce((sum, vertex) => sum + firstFrame[3 * vertex + axis], 0) / vertices.length);
        const far = vertices.reduce((sum, vertex) => sum + centre.reduce((squares, middle, axis) => squares + (firstFrame[3 * vertex + axis] - middle) ** 2, 0), 0);
        const radius = Math.sqrt(far / vertices.length + SMALLEST_RADIUS);
        const columns = (of: Int32Array): Float64Array => {
            const rows = new Float64Array(of.length * BENDS);
            of.forEach((vertex, row) => {
                const place = [0, 1, 2].map((axis) => firstFrame[3 * vertex + axis]);
                const own = place.map((value, axis) => (value - centre[axis]) / radius);
                rows.set(place, row * BENDS);
                rows.set(PRODUCTS.map(({ factor, axes }) => axes.reduce((product, axis) => product * own[axis], factor * radius)), row * BENDS + 3);
            });
            return rows;
        };
        const around = columns(part.around);
        return { known: this.coefficients(part, columns(vertices), around, BENDS), around };
    }

    /** P: rows that continue a field of `width` columns, of which `ends` is what it is around (S 3.4). */
    private extend(part: Part, ends: Float64Array, width: number): Float64Array {
        const { memory } = this;
        const { block, springs, total } = part;
        if (total === 0) return new Float64Array(block.size * width);
        return memory.scratch(() => {
            const pulls = memory.doubles(block.size * width, width);
            memory.run("pull", part.starts, part.outer, part.stiffness, memory.copy(ends, width), pulls);
            const { view } = pulls;
            const mean = new Float64Array(width);
            const eachEntry = (work: (i: number, row: number, column: number) => void): void => {
                for (let row = 0, i = 0; row < block.size; row++) for (let column = 0; column < width; column++) work(i++, row, column);
            };
            eachEntry((i, _, column) => (mean[column] += view[i] / total));
            eachEntry((i, row, column) => (view[i] -= springs[row] * mean[column]));
            const rows = solve(memory, block, part.factor, pulls).view.slice();
            eachEntry((i, _, column) => (rows[i] += mean[column]));
            return rows;
        });
    }

    /** D of a field that is known here, in `rows`, and around (S 3.5). */
    private coefficients(part: Part, rows: Float64Array, ends: Float64Array, width: number): Float64Array {
        const { memory } = this;
        const rest = this.extend(part, ends, width).map((value, i) => rows[i] - value);
        return memory.scratch(() => {
            const coefficients = memory.doubles(part.basis.width * width, width);
            memory.run("project", part.basis, memory.copy(rest, width), coefficients);
            return coefficients.view.slice();
        });
    }

    /** What a field is at the vertices around a part. */
    private endsOf(part: Part, field: Doubles): Float64Array {
        const { width, view } = field;
        const ends = new Float64Array(part.around.length * width);
        part.around.forEach((vertex, i) => ends.set(view.subarray(vertex * width, (vertex + 1) * width), i * width));
        return ends;
    }

    /** Fill a part of a field (S 3.5). */
    private place(part: Part, field: Doubles, ends: Float64Array, difference: Float64Array): void {
        const width = field.width;
        const rows = this.extend(part, ends, width);
        const own = reconstruct(this.memory, part.basis, difference, width);
        const [values, vertices] = [field.view, part.block.vertices.view];
        for (let row = 0, i = 0; row < vertices.length; row++) {
            for (let at = vertices[row] * width, end = at + width; at < end; at++, i++) values[at] = rows[i] + own[i];
        }
    }

    /** A model that has learnt nothing (S 4.1); what lies behind the parts is given back. */
    private startModel(): void {
        this.memory.release(this.behindParts);
        this.bank = makeLevelBank(this.memory);
        this.behindBank = this.memory.mark();
    }

    /**
     * Matrices of levels of so many rows, one behind the other; `references` has one for each, or none: the one before;
     * of a basis of `width` of them, fewer columns are coded of the first rows (S 4.2).
     */
    private readLevels(data: Uint8Array, rows: number[], columns: number, references?: Levels[], width?: number): Levels[] {
        const { memory } = this;
        return memory.scratch(() => {
            const coder = new Coder(memory, data);
            const slow = memory.longs(columns);
            const read: Levels[] = [];
            for (const count of rows) {
                const reference = references ? references[read.length] : (read.at(-1) ?? { rows: 0, values: new Int32Array(0) });
                const [lead, stair] = width ? [Math.min(read.length + 1, columns), Math.min(width, columns)].map(BigInt) : [BigInt(columns), 0n];
                const values = memory.scratch(() => {
                    const [levels, known] = [memory.ints(count * columns, columns), memory.ints(reference.values.length, columns)];
                    levels.view.fill(0);
                    known.view.set(reference.values);
                    memory.call("code_matrix", coder.parts, this.bank, shaped(memory, levels, count), shaped(memory, known, reference.rows), 0n, lead, stair, slow);
                    return levels.view.slice();
                });
                if (coder.overran) break;
                read.push({ rows: count, values });
            }
            coder.finish();
            return read;
        });
    }

    /** What levels stand for, in half steps (S 4.4). */
    private points(values: Int32Array): Int32Array {
        const { memory } = this;
        return memory.scratch(() => {
            const [levels, points] = [memory.ints(values.length, 1), memory.ints(values.length, 1)];
            levels.view.set(values);
            memory.run("points_of_levels", levels, points);
            return points.view.slice();
        });
    }

    /** What a closed loop makes of levels (S 6); `moments` is updated. */
    private follow(known: Float64Array, count: number, levels: Levels, columns: number, moments: Float64Array, step: number): Float64Array {
        const { memory } = this;
        const width = count + columns;
        return memory.scratch(() => {
            const given = memory.ints(levels.values.length, columns);
            given.view.set(levels.values);
            const decoded = memory.doubles(levels.values.length, columns);
            const state = memory.copy(moments, width);
            const factor = memory.copy(new Float64Array(moments.length), width);
            memory.run(
                "follow_rows", memory.copy(known, count), given, decoded, state, step, RULES, factor,
                memory.doubles(width), memory.doubles(width),
            );
            moments.set(state.view);
            const values = decoded.view.slice();
            if (areFinite(values)) return values;
            throw new NumericError("the levels reconstruct to coefficients that are not finite");
        });
    }

    /** What a loop begins with (S 6.6). */
    private learntAround(known: Float64Array, field: Float64Array, columns: number, step: number): Float64Array {
        const { memory } = this;
        const width = BENDS + columns;
        return memory.scratch(() => {
            const moments = memory.copy(emptyMoments(BENDS, columns), width);
            memory.run(
                "learn_around", memory.copy(known, BENDS), memory.copy(field, columns), moments, step, RULES, memory.doubles(width), memory.doubles(width),
            );
            return moments.view.slice();
        });
    }

    private emptyField(columns: number): Doubles {
        const field = this.memory.doubles(this.header.vertices * columns, columns);
        field.view.fill(0);
        return field;
    }

    /** Frames of method 0 (S 7.1). */
    private transformed(gop: Gop): (() => Float64Array)[] {
        const { parts, bends } = this;
        const columns = gop.components;
        this.history = undefined;
        this.startModel();
        const basis = this.learntBasis(gop);
        this.startModel();
        const levels = this.readLevels(gop.levels, parts.map((part) => part.basis.width), columns);
        if (columns === 0) return Array.from({ length: gop.frames }, () => () => new Float64Array(3 * this.header.vertices));
        const field = this.emptyField(columns);
        parts.forEach((part, k) => {
            const { known, around } = bends[k];
            const ends = this.endsOf(part, field);
            const moments = this.learntAround(around, ends, columns, gop.step);
            this.place(part, field, ends, this.follow(known, BENDS, levels[k], columns, moments, gop.step));
        });
        return Array.from({ length: gop.frames }, (_, t) => () => this.frameOf(field, basis, gop.frames, t));
    }

    /** Frame t of components over a temporal basis. */
    private frameOf(field: Doubles, basis: Float64Array, frames: number, t: number): Float64Array {
        const { memory, header } = this;
        const columns = field.width;
        return memory.scratch(() => {
            const weights = memory.doubles(3 * columns, 3);
            for (let d = 0; d < 3; d++) {
                for (let i = 0, from = (d * frames + t) * columns; i < columns; i++) weights.view[3 * i + d] = basis[from + i];
            }
            const positions = memory.doubles(3 * header.vertices, 3);
            memory.run("reconstruct", field, weights, positions);
            return positions.view.slice();
        });
    }

    /** B, 3 T rows (S 5.2). */
    private learntBasis({ frames, components, exponents, basis }: Gop): Float64Array {
        const steps = exponents.map(fineness);
        const matrices = this.readLevels(basis, [frames, frames, frames], components, undefined, 3);
        const columns = new Float64Array(3 * frames * components);
        if (components === 0) return columns;
        const points = matrices.map(({ values }) => this.points(values));
        const place = (d: number, i: number): number => 3 * i - 2 * (i % components) + d * components;
        points.forEach((own, d) => own.forEach((point, i) => (columns[place(d, i)] = 0.5 * point * steps[i % components])));
        const turned = columnsOf(this.memory, columns, components);
        const cosines = temporalCosines(this.memory, frames);
        points.forEach((own, d) => {
            const spectrum = Float64Array.from(own, (_, i) => turned[place(d, i)]);
            columns.set(reconstruct(this.memory, cosines, spectrum, components), d * frames * components);
        });
        return columns;
    }

    /** Frames of methods 1 and 2 (S 7.2). */
    private following(gop: Gop): (() => Float64Array)[] {
        const { memory, parts, first } = this;
        const { frames, components: columns } = gop;
        if (gop.method === KEY_FRAMES) {
            this.startModel();
            this.history = { frames: 0, levels: [], moments: [], latest: first, before: first };
        }
        let { history } = this;
        if (!history) throw new CorruptError("a frame refers to one that is not there");
        memory.release(this.behindBank);
        if (history.frames !== frames) {
            const levels = parts.map(({ basis: { width: rows } }) => ({ rows, values: new Int32Array(rows * columns) }));
            history = { ...history, levels, moments: first.map(() => emptyMoments(9, columns)) };
        }
        const { moments, latest, before } = history;
        const levels = this.readLevels(gop.levels, parts.map((part) => part.basis.width), columns, history.levels);
        const field = this.emptyField(columns);
        const cosines = memory.scratch(() => temporalCosines(memory, frames).view.slice());
        let held = 0;
        for (let t = 0; t < frames; t++) held += cosines[t * frames];
        const told = parts.map((part, k) => {
            const [start, now, earlier] = [first[k], latest[k], before[k]];
            const known = new Float64Array(3 * now.length);
            now.forEach((value, i) => {
                const at = 9 * Math.floor(i / 3) + (i % 3);
                [known[at], known[at + 3], known[at + 6]] = [start[i], value, value - earlier[i]];
            });
            const differences = this.follow(known, 9, levels[k], columns, moments[k], gop.step);
            now.forEach((value, i) => (differences[columns * Math.floor(i / 3) + (i % 3)] += held * value));
            this.place(part, field, this.endsOf(part, field), differences);
            return differences;
        });
        const at = (values: Float64Array, t: number): Float64Array => overTime(values, cosines, frames, t);
        const shown = (t: number): Float64Array[] => told.map((differences) => at(differences, t));
        this.history = { frames, levels, moments, latest: shown(frames - 1), before: frames > 1 ? shown(frames - 2) : latest };
        return Array.from({ length: frames }, (_, t) => () => at(field.view, t));
    }
}

/** Coordinates in frame t of rows that hold x, y and z of cosine after cosine (S 7.2). */
function overTime(values: Float64Array, cosines: Float64Array, frames: number, t: number): Float64Array {
    const shown = new Float64Array(values.length / frames);
    for (let row = 0, from = 0; row < shown.length; row += 3) {
        for (let f = 0; f < frames; f++) for (let d = 0; d < 3; d++) shown[row + d] += values[from++] * cosines[t * frames + f];
    }
    return shown;
}

/** 2^(-e/4): powers with fractions are not the same in all browsers. */
function fineness(exponent: number): number {
    return QUARTERS[exponent & 3] * 2 ** -(exponent >> 2);
}

/** A model of levels that has learnt nothing (S 4.1). */
export function makeLevelBank(memory: Memory): Bank {
    return makeBank(memory, { slots: SLOTS, selectors: 3 * SPAN, inputs: INPUTS, limit: 400, rate: 10 });
}

function core({ members, starts, cores }: Blocks, index: number): Ints {
    return members.part(starts[index], cores[index]);
}

/** A matrix as kernels take it, of any number of columns, none included. */
function shaped(memory: Memory, place: Ints, rows: number): Ints | readonly [Ints, bigint] {
    return place.width > 0 ? place : [memory.ints(rows), 0n];
}

function emptyMoments(known: number, columns: number): Float64Array {
    return new Float64Array(momentsOf(known, columns));
}

/** Entries of M (S 6.1). */
function momentsOf(known: number, columns: number): number {
    return (known + Math.min(columns, LEADING)) * (known + columns);
}

/** As many axes in a row as the degree says, none below the one before. */
function risingAxes(degree: number): number[][] {
    if (degree === 0) return [[]];
    return risingAxes(degree - 1).flatMap((axes) => [0, 1, 2].filter((axis) => axis >= (axes.at(-1) ?? 0)).map((axis) => [...axes, axis]));
}

/** The orthonormal cosines over time, a row for each frame (S 5.1). */
function temporalCosines(memory: Memory, frames: number): Doubles {
    const cosines = cosineColumns(memory, frames, frames);
    const { view } = cosines;
    for (let i = 0; i < view.length; i++) view[i] *= Math.sqrt((i % frames ? 2 : 1) / frames);
    return cosines;
}

/** The data of a GOP of a run (S 2, S 9.2). */
function parseGop(data: Uint8Array, { gopFrames: longest, run }: Header): Gop {
    const cursor = new Cursor(data);
    const first = cursor.take(1)[0];
    const method = first % METHODS;
    if ((first - method) / METHODS !== run % RUNS) throw new CorruptError(`a GOP of another run than run ${run}`);
    if (method > NEXT_FRAMES) throw new UnsupportedError(`GOP method ${method} is unknown to this decoder`);
    const frames = cursor.varint();
    if (frames < 1 || frames > longest) throw new CorruptError(`a GOP of ${frames} frames where 1 to ${longest} are legal`);
    const bytes = cursor.take(4);
    const step = new DataView(bytes.buffer, bytes.byteOffset, 4).getFloat32(0, true);
    if (!(step > 0 && step < Infinity)) throw new CorruptError(`a GOP with the step ${step}`);
    const components = method === LEARNT ? cursor.varint() : 3 * frames;
    if (components > 3 * frames) throw new CorruptError(`${components} components for ${frames} frames`);
    const exponents: number[] = [];
    let basis = new Uint8Array(0);
    if (method === LEARNT) {
        for (let exponent = 0; exponents.length < components; exponents.push(exponent)) {
            const code = cursor.varint();
            exponent += code % 2 ? -(code + 1) / 2 : code / 2;
            if (exponent < 0 || exponent > MOST_EXPONENT) throw new CorruptError(`the exponent ${exponent} of a basis`);
        }
        basis = cursor.take(cursor.varint()).slice();
    }
    return { method, frames, step, components, exponents, basis, levels: cursor.rest() };
}
