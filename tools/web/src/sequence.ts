/** Frames of a sequence, which follow the blocks of its first frame (specification, S). */
import { continued, factorize, reconstruct, solutionCost, type Factor } from "./basis";
import { edgesOf, makeBlock, type Block, type Blocks } from "./blocks";
import { keyDictionary, spendOn, TETHER, type Allowance } from "./chain";
import { Coder, makeBank, unsignedSpan, type Bank } from "./entropy";
import { CorruptError, NumericError } from "./errors";
import type { Header } from "./header";
import type { Doubles, Ints, Memory, Singles } from "./kernels";
import { checkLimit, type Limits } from "./limits";
import { areFinite } from "./numbers";
import { Cursor } from "./packets";
import { columnsOf } from "./reflections";
import type { Course } from "./runs";
import { blockCost, gopCost, partCost, referredCost, shownCost, trackMemory, UNCODED } from "./work";

const LEARNT = 0;
const KEY_FRAMES = 1;
const NEXT_FRAMES = 2;
const LEARNT_NEXT = 3;
/** Added to the method of a GOP that tells of attributes, too (S 10.2). */
const WITH_ATTRIBUTES = 4;
const MOST_EXPONENT = 400;
/** Frames that are reconstructed at a time, so that kernels have columns enough. */
const BATCH = 8;
/** The first byte of a GOP: its method, and so many times its run, counted modulo so many. */
const [METHODS, RUNS] = [8, 32];

const FLATNESS = 2 ** -12;
const SMALLNESS = 2 ** -48;
const SMALLEST_WEIGHT = 2 ** -5;
const LARGEST_WEIGHT = 8;
const BEND = 2 ** -6;

const INPUTS = 6;
const SPAN = unsignedSpan(14) + 5;
/** 2^(-q/4). */
const QUARTERS = [1, 0.8408964152537145, 0.7071067811865476, 0.5946035575013605];
const SLOTS = (5 * 12 * 12 + 12 * 40) * SPAN;
const LEADING = 24;
/** Components of a GOP that those of the next one are predicted from (S 7.1). */
const INHERITED = 24;
/** Forgetting, ridge, noise, what is around, dense rows, renewal (S 6). */
const RULES = [0.985, 0.004, 30, 30, 16n, 8n] as const;
/** How far before the latest frame those lie that help to predict the next ones; positions that are kept, and frames. */
const LAGS = [1, 2, 3, 5, 8, 13, 21, 34];
const [KEPT, MOST_KEPT, LEAST_KEPT] = [2 ** 19, 64, 2];
const SQUARES = 0.5;
const CUBES = 0.3;
const SMALLEST_RADIUS = 2 ** -24;
/** Axes of the squares and cubes of positions, in their order (S 3.7). */
const PRODUCTS = [2, 3].flatMap((degree) => risingAxes(degree).map((axes) => ({ factor: degree === 2 ? SQUARES : CUBES, axes })));
/** Columns of bends. */
const BENDS = 3 + PRODUCTS.length;

/** What a GOP tells of positions, or of an attribute that moves (S 2); a step of 0: nothing (S 10.4). */
interface Field {
    width: number;
    step: number;
    components: number;
    exponents: number[];
    basis: Uint8Array;
    levels: Uint8Array;
    /** How far before them those are that frames start from; 0: all from the latest. */
    back: number;
    brief: boolean;
}

/** The data of a GOP: the fields of positions and of all attributes that move. */
interface Gop {
    method: number;
    frames: number;
    /** Which of the frames that fields tell of each one is (S 2.5). */
    shown: number[];
    fields: Field[];
}

/** An attribute that moves: its number, numbers of a vertex, and what the first frame has beyond vertex 0 (S 10.3). */
export interface Moving {
    number: number;
    width: number;
    start: Float64Array;
}

/** The fields of a frame: of positions, in BSM units, and what attributes differ from the first frame by. */
export type Fields = Float64Array[];

/** What GOPs build upon: the first frame, and what key frames are added to, around each part and of it (S 7.2, S 10.3). */
interface Track {
    width: number;
    /** Frames that low-delay frames may refer to. */
    kept: number;
    bends: Bends[];
    first: Float64Array[];
    start: Float64Array[];
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
    starts: Ints;
    /** Vertices that it hangs on, ascending, and which of them each spring goes to. */
    around: Int32Array;
    outer: Ints;
    stiffness: Doubles;
    factor: Factor;
    basis: Singles;
}

/** What is known of a part (S 3.7, S 7.1, S 10.3): differences, and values around it, of so many columns. */
interface Bends {
    count: number;
    known: Float64Array;
    around: Float64Array;
}

/** What low-delay frames refer to, and how many came last (S 7.2): frames around each part and of it, the latest first. */
interface History {
    bank: Bank;
    frames: number;
    levels: Levels[];
    kept: Float64Array[][];
}

/** Decodes the GOPs of one sequence; what it keeps lies in memory behind all that the first frame has. */
export class Sequence {
    /** Made when a GOP is there, whose frames pay for them (S 8.3). */
    private parts: Part[] = [];
    private tracks: Track[] = [];
    private behindFirst = 0;
    private behindParts = 0;
    private failure?: unknown;
    private behindBanks = 0;
    /** Of each track. */
    private histories?: History[];
    /** Of each track, of each part, of the GOP before, if it had a basis. */
    private inherited?: Bends[][];
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
        readonly moving: Moving[],
        private readonly allowance: Allowance,
        private readonly tolerant: boolean,
    ) {
        this.run = header;
        allowance.keep(total(moving.map(({ width }) => trackMemory(header.vertices, blocks.count, width))));
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
        this.histories = undefined;
        this.inherited = undefined;
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
            const fields = [{ width: 3, start: this.firstFrame }, ...this.moving];
            this.tracks = fields.map(({ width, start }, k) => {
                const bends = parts.map((part) => (k === 0 ? this.bendsOf(part) : this.knownOf(part, start, width)));
                const first = bends.map(({ known, around, count }) => joined(around, known).filter((_, i) => i % count < width));
                const kept = k === 0 ? framesKept(this.header.vertices) : LEAST_KEPT;
                return { width, kept, bends, first, start: k === 0 ? first : first.map(({ length }) => new Float64Array(length)) };
            });
            this.parts = parts;
            this.behindParts = memory.mark();
        } catch (error) {
            this.failure = error;
            throw error;
        }
    }

    /** Frames of the GOP from frame `index` on, each made when it is called; valid until the next GOP. */
    decode(index: number, data: Uint8Array): (() => Fields)[] {
        const { header, run, course, allowance } = this;
        if (index !== course.next) throw new CorruptError(`frame ${index} where frame ${course.next} must follow`);
        const gop = parseGop(data, run, this.moving, this.tolerant);
        const bytes = gop.fields.map(({ width, components }) => {
            const columns = width * gop.frames;
            const kept = Math.min(components, INHERITED) + (gop.method === LEARNT_NEXT ? INHERITED : 0);
            const left = hasBasis(gop.method) ? 8 * header.vertices * kept : 4 * header.vertices * columns;
            const shown = 8 * width * header.vertices * (Math.min(BATCH, gop.frames) + 4);
            return components * (16 * header.vertices + 40 * columns + 24 * components) + shown + left;
        });
        const kept = hasBasis(gop.method) ? 0 : 24 * header.vertices * framesKept(header.vertices);
        checkLimit(this.limits, "sequenceBytes", kept + total(bytes));
        allowance.hold(total(bytes.slice(1)));
        const last = index + gop.frames;
        if (run.frames > 0 && last > run.frames) throw new CorruptError(`frame ${last - 1} of ${run.frames}`);
        const frames = this.paidFor(gop, data.length);
        course.next = last;
        return frames;
    }

    /** The frames of a GOP, if its frames and bytes pay for them. */
    private paidFor(gop: Gop, received: number): (() => Fields)[] {
        const { header, allowance } = this;
        const columns = total(gop.fields.map(({ components }) => components));
        const told = gop.fields.filter(({ components }, k) => k === 0 || components > 0).length;
        allowance.show(header.vertices * gop.frames);
        try {
            this.begin();
            const parts = this.parts.reduce(
                (sum, { block, around, basis }) => sum + partCost(block.size, around.length, basis.width, columns, told, gop.method === LEARNT_NEXT) + solutionCost(block, columns),
                0,
            );
            const shown = shownCost(header.vertices, this.given, gop.frames, gop.fields);
            allowance.spend(gopCost(told) + parts + this.referred(gop) + shown, received);
            return hasBasis(gop.method) ? this.transformed(gop) : this.following(gop);
        } catch (error) {
            allowance.show(-header.vertices * gop.frames);
            throw error;
        }
    }

    /** What frames cost besides that refer to others. */
    private referred({ method, fields }: Gop): number {
        if (hasBasis(method)) return 0;
        const rows = total(this.parts.map(({ around, basis }) => around.length + basis.width));
        return referredCost(rows, fields.map(({ width, back, brief }, k) => width * (2 + (brief ? 1 : lags(this.tracks[k].kept).length) + (back > 0 ? 1 : 0))));
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
        const basis = memory.keep(() => keyDictionary(memory, header, block, springs, columns, allowance));
        return { block, springs, starts, around, outer, stiffness, factor, basis };
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
        return { count: BENDS, known: this.coefficients(part, columns(vertices), around, BENDS), around };
    }

    /** What is known of an attribute that moves. */
    private knownOf(part: Part, start: Float64Array, count: number): Bends {
        const around = rowsOf(start, count, part.around);
        return { count, known: this.coefficients(part, rowsOf(start, count, part.block.vertices.view), around, count), around };
    }

    /** P: rows that continue a field of `width` columns, of which `ends` is what it is around (S 3.4). */
    private extend(part: Part, ends: Float64Array, width: number): Float64Array {
        const { memory } = this;
        const { block, springs, factor } = part;
        return memory.scratch(() => {
            const pulls = memory.doubles(block.size * width, width);
            memory.run("pull", part.starts, part.outer, part.stiffness, memory.copy(ends, width), pulls);
            return continued(memory, block, factor, memory.copy(springs), pulls).view.slice();
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
        return rowsOf(field.view, field.width, part.around);
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

    /**
     * Matrices of levels of so many rows, one behind the other, by a model; `references` has one for each, or none: the one before;
     * of a basis of `width` of them, fewer columns are coded of the first rows (S 4.2).
     */
    private readLevels(bank: Bank, data: Uint8Array, rows: number[], columns: number, references?: Levels[], width?: number): Levels[] {
        const { memory } = this;
        return memory.scratch(() => {
            const coder = new Coder(memory, data);
            const slow = memory.longs(columns);
            const read: Levels[] = [];
            for (const count of rows) {
                const reference = references ? references[read.length] : (read.at(-1) ?? { rows: 0, values: new Int32Array(0) });
                const turn = BigInt(width ? count : Math.ceil(count / 3));
                const [lead, stair] = width ? [Math.min(read.length + 1, columns), Math.min(width, columns)].map(BigInt) : [BigInt(columns), 0n];
                const values = memory.scratch(() => {
                    const [levels, known] = [memory.ints(count * columns, columns), memory.ints(reference.values.length, columns)];
                    levels.view.fill(0);
                    known.view.set(reference.values);
                    memory.call("code_matrix", coder.parts, bank, shaped(memory, levels, count), shaped(memory, known, reference.rows), 0n, lead, stair, turn, 0n, slow);
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

    /** What a closed loop makes of levels (S 6). */
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
            const values = decoded.view.slice();
            if (areFinite(values)) return values;
            throw new NumericError("the levels reconstruct to coefficients that are not finite");
        });
    }

    /** What a loop begins with (S 6.6). */
    private learntAround({ count, around }: Pick<Bends, "count" | "around">, field: Float64Array, columns: number, step: number): Float64Array {
        const { memory } = this;
        const width = count + columns;
        return memory.scratch(() => {
            const moments = memory.copy(emptyMoments(count, columns), width);
            memory.run(
                "learn_around", memory.copy(around, count), memory.copy(field, columns), moments, step, RULES, memory.doubles(width), memory.doubles(width),
            );
            return moments.view.slice();
        });
    }

    private emptyField(columns: number): Doubles {
        const field = this.memory.doubles(this.header.vertices * columns, columns);
        field.view.fill(0);
        return field;
    }

    /** Frames of methods 0 and 3 (S 7.1). */
    private transformed({ method, shown, fields }: Gop): (() => Fields)[] {
        const { memory, header } = this;
        const before = method === LEARNT ? fields.map(() => undefined) : this.inherited;
        this.forget();
        if (!before) throw new CorruptError("a GOP refers to one that is not there");
        memory.release(this.behindParts);
        const inherited = fields.map((): Bends[] => []);
        const made = fields.map((field, k) => (field.step > 0 ? this.components(field, this.tracks[k], shown, inherited[k], before[k]) : undefined));
        this.inherited = inherited;
        return shown.map((_, t) => () => made.map((one, k) => one?.(t) ?? new Float64Array(fields[k].width * header.vertices)));
    }

    /** What gives a field of each frame, one after the other: components over a temporal basis. */
    private components(field: Field, { bends }: Track, shown: number[], inherited: Bends[], before?: Bends[]): ((t: number) => Float64Array) | undefined {
        const { memory, parts, header } = this;
        const { width, components, step } = field;
        const frames = mostOf(shown) + 1;
        const basis = memory.scratch(() => this.learntBasis(field, frames));
        const rows = parts.map((part) => part.basis.width);
        const levels = memory.scratch(() => this.readLevels(makeLevelBank(memory), field.levels, rows, components));
        if (components === 0) return undefined;
        const placed = this.emptyField(components);
        parts.forEach((part, k) => {
            const told = before?.[k] ? beside(bends[k], before[k]) : bends[k];
            const ends = this.endsOf(part, placed);
            const moments = this.learntAround(told, ends, components, step);
            const differences = this.follow(told.known, told.count, levels[k], components, moments, step);
            this.place(part, placed, ends, differences);
            const count = Math.min(components, INHERITED);
            const first = (rows: Float64Array): Float64Array => rows.filter((_, i) => i % components < count);
            inherited.push({ count, known: first(differences), around: first(ends) });
        });
        const columns = Math.min(BATCH, shown.length) * width;
        const some = memory.doubles(header.vertices * columns, columns);
        return (t) => {
            const place = t % BATCH;
            if (place === 0) {
                const times = shown.slice(t, t + BATCH);
                const rows = Array.from({ length: columns }, (_, i) => (i % width) * frames + (times[Math.floor(i / width)] ?? 0));
                this.show(placed, basis, rows, some);
            }
            return someColumns(some, place * width, width);
        };
    }

    /** A column for each of some rows of a temporal basis, of all vertices. */
    private show(field: Doubles, basis: Float64Array, rows: number[], shown: Doubles): void {
        const { memory } = this;
        const { width: components } = field;
        memory.scratch(() => {
            const weights = memory.doubles(components * rows.length, rows.length);
            const { view } = weights;
            rows.forEach((row, i) => {
                for (let k = 0; k < components; k++) view[rows.length * k + i] = basis[components * row + k];
            });
            memory.call("multiply_matrices", field, weights, shown);
        });
    }

    /** B, a row for each number of each frame that is told of (S 5.2). */
    private learntBasis({ width, components, exponents, basis }: Field, frames: number): Float64Array {
        const steps = exponents.map(fineness);
        const matrices = this.readLevels(makeLevelBank(this.memory), basis, Array<number>(width).fill(frames), components, undefined, width);
        const columns = new Float64Array(width * frames * components);
        const points = matrices.map(({ values }) => this.points(values));
        const place = (d: number, i: number): number => width * i - (width - 1) * (i % components) + d * components;
        points.forEach((own, d) => own.forEach((point, i) => (columns[place(d, i)] = 0.5 * point * steps[i % components])));
        const turned = columnsOf(this.memory, columns, components);
        const cosines = temporalCosines(this.memory, frames);
        points.forEach((own, d) => {
            const spectrum = Float64Array.from(own, (_, i) => turned[place(d, i)]);
            columns.set(multiplied(this.memory, cosines, spectrum, components), d * frames * components);
        });
        return columns;
    }

    /** Frames of methods 1 and 2 (S 7.2). */
    private following({ method, frames, fields }: Gop): (() => Fields)[] {
        const { memory, tracks } = this;
        this.inherited = undefined;
        if (method === KEY_FRAMES) {
            memory.release(this.behindParts);
            this.histories = tracks.map(({ start }) => ({ bank: makeLevelBank(memory), frames: 0, levels: [], kept: [start] }));
            this.behindBanks = memory.mark();
        }
        const { histories } = this;
        if (!histories) throw new CorruptError("a frame refers to one that is not there");
        memory.release(this.behindBanks);
        const cosines = memory.scratch(() => temporalCosines(memory, frames).view.slice());
        const placed = fields.map((field, k) => this.told(field, tracks[k], histories[k], frames, cosines));
        return Array.from({ length: frames }, (_, t) => () => placed.map((field, k) => overTime(field.view, fields[k].width, cosines, frames, t)));
    }

    /** The field of frames that come without a basis; they become the latest ones. */
    private told({ width, step, levels: data, back, brief }: Field, { first, kept: most }: Track, history: History, frames: number, cosines: Float64Array): Doubles {
        const { parts } = this;
        const columns = width * frames;
        const empty = (): Levels[] => parts.map(({ basis: { width: rows } }) => ({ rows, values: new Int32Array(rows * columns) }));
        if (history.frames !== frames) Object.assign(history, { frames, levels: empty() });
        const { bank, kept } = history;
        if (back > kept.length) throw new CorruptError(`a frame refers to one ${back} before it, where ${kept.length} are kept`);
        const levels = step > 0 ? this.readLevels(bank, data, parts.map((part) => part.basis.width), columns, history.levels) : empty();
        const field = this.emptyField(columns);
        const ages = [0, ...lags(most).slice(0, brief ? 1 : undefined)].map((age) => Math.min(age, kept.length - 1));
        const starts = Array.from({ length: frames }, (_, t) => kept[back > 0 ? back - 1 - t : 0]);
        const told = parts.map((part, k) => {
            const own = kept.map((frame) => frame[k]);
            const changes = ages.slice(1).map((early, i) => apart(own[ages[i]], own[early]));
            const away = back > 0 ? [apart(own[back - 1], own[0])] : [];
            const columnsKnown = [first[k], own[0], ...changes, ...away];
            const [known, count] = [sideBySide(columnsKnown, width), columnsKnown.length];
            const [ends, behind] = [this.endsOf(part, field), part.around.length * width];
            const base = overCosines(starts.map((frame) => frame[k]), width, cosines);
            let differences = base.slice(frames * behind);
            if (step > 0) {
                const around = { count: count * width, around: known.slice(0, count * behind) };
                const moments = this.learntAround(around, ends.map((value, i) => value - base[i]), columns, step);
                const change = this.follow(known.slice(count * behind), count * width, levels[k], columns, moments, step);
                differences = differences.map((value, i) => value + change[i]);
            }
            this.place(part, field, ends, differences);
            return joined(ends, differences);
        });
        const fresh = Array.from({ length: Math.min(frames, most) }, (_, age) =>
            told.map((differences) => overTime(differences, width, cosines, frames, frames - 1 - age)),
        );
        Object.assign(history, { levels, kept: [...fresh, ...kept].slice(0, most) });
        return field;
    }
}

/** Whether GOPs of a method have a temporal basis (S 2.2). */
function hasBasis(method: number): boolean {
    return method === LEARNT || method === LEARNT_NEXT;
}

/** What is known, and beside it components of the GOP before. */
function beside(bends: Bends, before: Bends): Bends {
    const count = bends.count + before.count;
    const rows = (own: Float64Array, more: Float64Array): Float64Array => {
        const both = new Float64Array((own.length / bends.count) * count);
        for (let row = 0, at = 0; at < both.length; row++, at += count) {
            both.set(own.subarray(row * bends.count, (row + 1) * bends.count), at);
            both.set(more.subarray(row * before.count, (row + 1) * before.count), at + bends.count);
        }
        return both;
    };
    return { count, known: rows(bends.known, before.known), around: rows(bends.around, before.around) };
}

/** Rows, and behind them others. */
function joined(before: Float64Array, behind: Float64Array): Float64Array {
    const rows = new Float64Array(before.length + behind.length);
    rows.set(before);
    rows.set(behind, before.length);
    return rows;
}

/** The numbers in frame t of rows that hold those of cosine after cosine (S 7.2). */
function overTime(values: Float64Array, width: number, cosines: Float64Array, frames: number, t: number): Float64Array {
    const shown = new Float64Array(values.length / frames);
    for (let row = 0, from = 0; row < shown.length; row += width) {
        for (let f = 0; f < frames; f++) for (let d = 0; d < width; d++) shown[row + d] += values[from++] * cosines[t * frames + f];
    }
    return shown;
}

/** So many columns from `first` on. */
function someColumns({ view, width: columns, rows }: Doubles, first: number, width: number): Float64Array {
    const values = new Float64Array(rows * width);
    for (let to = 0; to < values.length; first += columns) for (let d = 0; d < width; d++) values[to++] = view[first + d];
    return values;
}

/** What frames are over time as columns of cosine after cosine: the inverse of `overTime`. */
function overCosines(shown: Float64Array[], width: number, cosines: Float64Array): Float64Array {
    const frames = shown.length;
    const values = new Float64Array(frames * shown[0].length);
    for (let row = 0, to = 0; row < shown[0].length; row += width) {
        for (let f = 0; f < frames; f++) {
            for (let d = 0; d < width; d++, to++) for (let t = 0; t < frames; t++) values[to] += shown[t][row + d] * cosines[t * frames + f];
        }
    }
    return values;
}

/** What one has more than another. */
function apart(one: Float64Array, other: Float64Array): Float64Array {
    return one.map((value, i) => value - other[i]);
}

/** Matrices of so many columns, beside each other. */
function sideBySide(matrices: Float64Array[], width: number): Float64Array {
    const joint = new Float64Array(matrices.length * matrices[0].length);
    matrices.forEach((matrix, k) => matrix.forEach((value, i) => (joint[matrices.length * (i - (i % width)) + k * width + (i % width)] = value)));
    return joint;
}

/** 2^(-e/4): powers with fractions are not the same in all browsers. */
function fineness(exponent: number): number {
    return QUARTERS[exponent & 3] * 2 ** -(exponent >> 2);
}

/** A model of levels that has learnt nothing (S 4.1). */
export function makeLevelBank(memory: Memory): Bank {
    return makeBank(memory, { slots: SLOTS, selectors: 3 * SPAN, inputs: INPUTS, limit: 400, rate: 10 });
}

/** How many frames of so many vertices those of low delay may refer to (S 7.3). */
function framesKept(vertices: number): number {
    return Math.min(MOST_KEPT, Math.max(LEAST_KEPT, Math.floor(KEPT / vertices)));
}

/** `LAGS`, where so many frames are kept. */
function lags(kept: number): number[] {
    return LAGS.filter((lag) => lag < kept);
}

function core({ members, starts, cores }: Blocks, index: number): Ints {
    return members.part(starts[index], cores[index]);
}

/** A matrix as kernels take it, of any number of columns, none included. */
function shaped(memory: Memory, place: Ints, rows: number): Ints | readonly [Ints, bigint] {
    return place.width > 0 ? place : [memory.ints(rows), 0n];
}

function emptyMoments(known: number, columns: number): Float64Array {
    return new Float64Array((known + Math.min(columns, LEADING)) * (known + columns));
}

/** As many axes in a row as the degree says, none below the one before. */
function risingAxes(degree: number): number[][] {
    if (degree === 0) return [[]];
    return risingAxes(degree - 1).flatMap((axes) => [0, 1, 2].filter((axis) => axis >= (axes.at(-1) ?? 0)).map((axis) => [...axes, axis]));
}

/** The orthonormal cosines over time, a row for each frame (S 5.1). */
function temporalCosines(memory: Memory, frames: number): Doubles {
    const cosines = memory.doubles(frames * frames, frames);
    memory.scratch(() => memory.run("cosines", memory.doubles(frames + 8), cosines));
    const { view } = cosines;
    for (let i = 0; i < view.length; i++) view[i] *= Math.sqrt((i % frames ? 2 : 1) / frames);
    return cosines;
}

/** A matrix times another of so many columns. */
function multiplied(memory: Memory, left: Doubles, right: Float64Array, width: number): Float64Array {
    return memory.scratch(() => {
        const result = memory.doubles(left.rows * width, width);
        memory.call("multiply_matrices", left, memory.copy(right, width), result);
        return result.view.slice();
    });
}

/** The data of a GOP of a run (S 2, S 9.2, S 10.2). */
function parseGop(data: Uint8Array, { gopFrames: longest, run }: Header, moving: Moving[], tolerant: boolean): Gop {
    const cursor = new Cursor(data);
    const first = cursor.take(1)[0];
    const kind = first % METHODS;
    if ((first - kind) / METHODS !== run % RUNS) throw new CorruptError(`a GOP of another run than run ${run}`);
    const method = kind % WITH_ATTRIBUTES;
    const frames = cursor.varint();
    if (frames < 1 || frames > longest) throw new CorruptError(`a GOP of ${frames} frames where 1 to ${longest} are legal`);
    const shown = parseStretches(cursor, frames, method);
    const own = mostOf(shown) + 1;
    const told = new Map<number, Field>();
    if (kind >= WITH_ATTRIBUTES) {
        const count = cursor.varint();
        if (count === 0) throw new CorruptError("a GOP that tells of no attribute, and says that it does");
        for (let k = 0, before = -1; k < count; k++) {
            const number = cursor.varint();
            const part = cursor.take(cursor.varint());
            const one = moving.find((own) => own.number === number);
            if (number <= before || !(one || tolerant)) throw new CorruptError(`a GOP tells of attribute ${number}, which does not move, or is not the next one`);
            before = number;
            if (one) told.set(number, parseField(part, method, own, one.width));
        }
    }
    const none = new Uint8Array(0);
    const others = moving.map(({ number, width }) => told.get(number) ?? { width, step: 0, components: hasBasis(method) ? 0 : width * frames, exponents: [], basis: none, levels: none, back: 0, brief: false });
    return { method, frames, shown, fields: [parseField(cursor.rest(), method, own, 3), ...others] };
}

/** Which of the frames that fields tell of each one is: all, in order, unless a GOP with a basis says otherwise (S 2.5). */
function parseStretches(cursor: Cursor, frames: number, method: number): number[] {
    const pieces = hasBasis(method) ? cursor.varint() : 0;
    const shown = Array.from({ length: pieces ? 0 : frames }, (_, t) => t);
    const refuse = (): never => {
        throw new CorruptError("stretches of frames that a GOP has not");
    };
    for (let k = 0; k < pieces; k++) {
        const [code, length] = [cursor.varint(), cursor.varint()];
        const way = [1, 0, -1][code % 3];
        const first = (shown.at(-1) ?? -1) + 1 + signed(Math.floor(code / 3));
        const last = first + way * (length - 1);
        if (length < 1 || length > frames - shown.length || Math.min(first, last) < 0 || Math.max(first, last) >= frames) refuse();
        for (let i = 0; i < length; i++) shown.push(first + way * i);
    }
    return shown.length < frames ? refuse() : shown;
}

/** What a zigzag code stands for (S 2.4). */
function signed(code: number): number {
    return code % 2 ? -(code + 1) / 2 : code / 2;
}

function parseField(data: Uint8Array, method: number, frames: number, width: number): Field {
    const cursor = new Cursor(data);
    const bytes = cursor.take(4);
    const step = new DataView(bytes.buffer, bytes.byteOffset, 4).getFloat32(0, true);
    if (!(step > 0 && step < Infinity)) throw new CorruptError(`a GOP with the step ${step}`);
    const components = hasBasis(method) ? cursor.varint() : width * frames;
    if (components > width * frames) throw new CorruptError(`${components} components for ${frames} frames`);
    const exponents: number[] = [];
    let basis = new Uint8Array(0);
    if (hasBasis(method)) {
        for (let exponent = 0; exponents.length < components; exponents.push(exponent)) {
            exponent += signed(cursor.varint());
            if (exponent < 0 || exponent > MOST_EXPONENT) throw new CorruptError(`the exponent ${exponent} of a basis`);
        }
        basis = cursor.take(cursor.varint()).slice();
    }
    const refers = method === NEXT_FRAMES ? cursor.varint() : 0;
    const back = Math.floor(refers / 2);
    if (back > 0 && back < frames) throw new CorruptError(`${frames} frames that start from those ${back} before them`);
    return { width, step, components, exponents, basis, levels: cursor.rest(), back, brief: refers % 2 > 0 };
}

/** Some rows of a field. */
function rowsOf(values: Float64Array, width: number, rows: Int32Array): Float64Array {
    const found = new Float64Array(rows.length * width);
    rows.forEach((row, i) => found.set(values.subarray(row * width, (row + 1) * width), i * width));
    return found;
}

function mostOf(numbers: number[]): number {
    return numbers.reduce((most, number) => Math.max(most, number), 0);
}

function total(numbers: number[]): number {
    return numbers.reduce((sum, number) => sum + number, 0);
}
