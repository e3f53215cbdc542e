/**
 * The decoder in C: its calls, and what lies in its memory.
 *
 * Bytes go in by `push`, `next` reports one event at a time, and the arrays of an event are asked for by its kind. All
 * that is handed out is copied: the memory of WebAssembly moves when it grows, and belongs to the next stream later. C
 * answers with the address of a struct that it keeps until the next call, so a struct is read before anything else is
 * called. What has no fixed layout in JavaScript comes by name: the fields of a header by their keys in the format
 * (`constants.json`, which Python writes), attributes by the struct of bsmdec.h. If a struct of library/wasm/page.c
 * changes, the offsets here change with it; `test/vectors.test.ts` decodes all vectors through them.
 */
import { HEADER_KEYS } from "./constants.json";
import { DOMAINS, KINDS, SEMANTICS, type Attribute } from "./attributes";
import { BsmError, errorLike } from "./errors";
import type { Changes, Loose, Metadata } from "./events";
import type { Header } from "./header";
import type { Kernels } from "./kernels";
import type { Limits } from "./limits";
import { errorName, Memory, type ViewType } from "./memory";
import type { Share, SharedBlock } from "./share";

/** Events in the order of library/bsmdec.h, and one of decoders with helpers. */
export const enum Raw {
    NEED,
    HEADER,
    METADATA,
    CONNECTIVITY,
    BLOCK,
    REFINEMENT,
    ATTRIBUTE,
    FRAME,
    LOSS,
    END,
    OVER,
    FAILED,
    AWAITED = 13,
}

const VIEWS: ViewType<ArrayLike<number>>[] = [
    Uint8Array,
    Int8Array,
    Uint16Array,
    Int16Array,
    Uint32Array,
    Int32Array,
    Float32Array,
    Float64Array,
];
const WHOLE = 1;
const NUMBER = 2;
const TEXT = 3;
const TEXTS = new TextDecoder("utf-8", { ignoreBOM: true });
const LAST_ATTRIBUTE = 255;
const ENTRY_BYTES = 48;
const ATTRIBUTE_BYTES = 56;
/** The record of a header in C: numbers of each key, and how many they are. */
const KEYS = 1 + Math.max(...Object.values(HEADER_KEYS));
const MOST_LIST = 8;

/** Fields of a header that are one number. */
const NUMBERS = [
    "vertices",
    "faces",
    "blocks",
    "blockSize",
    "coefficients",
    "keyInterval",
    "step",
    "scale",
    "smoothing",
    "attributes",
    "light",
    "congruence",
] as const;

/** The fields of a header by their names: the record in C has them by their keys. */
type FieldLists = Record<keyof typeof HEADER_KEYS, number[]>;

/** An event as the decoder in C reports it, with the numbers of vertices and faces once they are known. */
export type RawEvent = Record<"type" | "index" | "count" | "vertices" | "faces", number>;

export class Engine extends Memory {
    constructor(
        kernels: Kernels,
        limits: Partial<Limits>,
        tolerant: boolean,
        { number, among }: Share = { number: 0, among: 0 },
    ) {
        super(kernels, limits, "page_open", tolerant ? 1 : 0, number, among);
    }

    push(data: Uint8Array): void {
        if (data.length === 0) return;
        this.held([data], (at) => this.invoke("bsmdec_push", this.decoder, at, data.length));
    }

    finish(): void {
        this.invoke("bsmdec_finish", this.decoder);
    }

    /** Let helpers have the chains that are not the decoder's own. */
    share(among: number): void {
        this.invoke("page_share", among);
    }

    next(): RawEvent {
        const at = this.invoke("page_next");
        const view = new DataView(this.buffer, at);
        const [index, count, vertices, faces] = [8, 16, 24, 32].map((at) => Number(view.getBigInt64(at, true)));
        return { type: view.getInt32(0, true), index, count, vertices, faces };
    }

    /** The first error of the stream; the loss that was reported last. */
    error(isLoss = false): BsmError {
        const at = this.invoke("page_error", isLoss ? 1 : 0);
        const view = new DataView(this.buffer, at);
        const [offset, frame, block] = [8, 16, 24]
            .map((place) => Number(view.getBigInt64(place, true)))
            .map((value) => (value < 0 ? undefined : value));
        return errorLike({
            name: errorName(view.getInt32(0, true)),
            problem: this.text(at + 32),
            place: { offset, frame, block },
        });
    }

    /** Bytes that were made use of, work that was charged, vertices that the faces so far have. */
    get state(): readonly [position: number, work: number, vertices: number] {
        return [...this.doubles(this.invoke("page_state"), 3)] as [number, number, number];
    }

    header(): Header {
        const at = this.invoke("page_header");
        const record = this.doubles(at, KEYS * MOST_LIST);
        const counts = this.copied(Int32Array, at + 8 * KEYS * MOST_LIST, KEYS);
        const listOf = (key: number): number[] => [...record.subarray(MOST_LIST * key, MOST_LIST * key + counts[key])];
        const lists = Object.fromEntries(
            Object.entries(HEADER_KEYS).map(([name, key]) => [name, listOf(key)]),
        ) as FieldLists;
        const { center, corner, grid, lattice, refinement } = lists;
        const numbers = Object.fromEntries(NUMBERS.map((name) => [name, lists[name][0]])) as Pick<
            Header,
            (typeof NUMBERS)[number]
        >;
        const [[bits = 0], [frames = 0, gopFrames = 0], [run = 0, again]] = [lists.paper, lists.sequence, lists.run];
        return { ...numbers, bits, center, corner, grid, lattice, refinement, frames, gopFrames, run, again };
    }

    /** Entries of metadata, from number `from` on. */
    metadata(from: number, to: number): Metadata {
        const entries: Metadata = new Map();
        this.lent(ENTRY_BYTES, (at) => {
            for (let index = from; index < to; index++) {
                this.invoke("page_metadata", index, at);
                const view = new DataView(this.buffer, at);
                const type = view.getInt32(4, true);
                const bytes = this.copied(Uint8Array, view.getUint32(24, true), view.getUint32(28, true));
                const whole = view.getBigInt64(8, true);
                const integer = whole >= -(2n ** 31n) && whole < 2n ** 32n ? Number(whole) : whole;
                const value =
                    type === WHOLE
                        ? integer
                        : type === NUMBER
                          ? view.getFloat64(16, true)
                          : type === TEXT
                            ? TEXTS.decode(bytes)
                            : bytes;
                entries.set(this.text(view.getUint32(0, true)), value);
            }
        });
        return entries;
    }

    faces(raw: RawEvent): Int32Array {
        return this.filled(Int32Array, 3 * raw.faces, "bsmdec_faces");
    }

    loose(): Loose {
        const { vertices, positions } = this.changes("page_loose");
        return { vertices, positions };
    }

    positions(vertices: number): Float64Array {
        return this.filled(Float64Array, 3 * vertices, "bsmdec_positions");
    }

    changes(name = "page_changes"): Changes {
        const [count, vertices, positions, final] = this.rows(name);
        return {
            vertices: this.copied(Int32Array, vertices, count),
            positions: this.doubles(positions, 3 * count),
            final: this.copied(Uint8Array, final, count),
        };
    }

    /** Vertices without a position, and those that are less exact than they were encoded. */
    losses(): { missing: Int32Array; degraded: Int32Array } {
        const [count, missing, degraded, others] = this.rows("page_losses");
        return {
            missing: this.copied(Int32Array, missing, count),
            degraded: this.copied(Int32Array, degraded, this.doubles(others, 1)[0]),
        };
    }

    /** An attribute, if it is whole, and moves where that is asked for. */
    attribute(index: number, moving = false): Attribute | undefined {
        return this.lent(ATTRIBUTE_BYTES, (at) => {
            if (this.invoke("bsmdec_attribute_at", this.decoder, index, at) !== 0) return undefined;
            const view = new DataView(this.buffer, at);
            const [domain, semantic, kind, components] = [4, 8, 12, 16].map((place) => view.getInt32(place, true));
            const [rows, corners] = [24, 32].map((place) => Number(view.getBigInt64(place, true)));
            if (moving && view.getInt32(40, true) === 0) return undefined;
            const name = this.text(view.getUint32(0, true));
            const bytes = this.filled(
                Uint8Array,
                rows * components * VIEWS[kind].BYTES_PER_ELEMENT,
                "bsmdec_attribute_values",
                index,
            );
            const indices =
                corners > 0 ? this.filled(Int32Array, corners, "bsmdec_attribute_indices", index) : undefined;
            const values = new VIEWS[kind](bytes.buffer, 0, rows * components);
            return {
                name,
                semantic: SEMANTICS[semantic],
                domain: DOMAINS[domain],
                kind: KINDS[kind],
                components,
                values: Float64Array.from(values),
                indices,
            };
        });
    }

    /** All attributes that are whole, or those of them that move. */
    attributes(moving = false): Attribute[] {
        return Array.from({ length: LAST_ATTRIBUTE + 1 }, (_, index) => this.attribute(index, moving)).filter(
            (attribute) => attribute !== undefined,
        );
    }

    handed(index: number): SharedBlock {
        const [count, vertices, positions, weights] = this.rows("page_handed");
        return {
            index,
            block: {
                vertices: this.copied(Int32Array, vertices, count),
                positions: this.doubles(positions, 3 * count),
                weights: this.doubles(weights, count),
            },
        };
    }

    add({ index, block }: SharedBlock): void {
        if (!block) return void this.invoke("page_lose", index);
        const [, vertices, positions, weights] = this.rows("page_room", block.vertices.length);
        new Int32Array(this.buffer, vertices).set(block.vertices);
        new Float64Array(this.buffer, positions).set(block.positions);
        new Float64Array(this.buffer, weights).set(block.weights);
        if (!this.invoke("page_add", index)) throw new RangeError("a block of another mesh");
    }

    /** Leave the memory to the next decoder. */
    release(): void {
        this.end("page_close");
    }

    /** A count and three places; without them the error of the stream is thrown. */
    private rows(name: string, ...args: number[]): Uint32Array {
        const at = this.invoke(name, ...args);
        if (at === 0) throw this.error();
        return new Uint32Array(this.buffer, at, 4).slice();
    }

    private text(at: number): string {
        const bytes = new Uint8Array(this.buffer, at);
        return TEXTS.decode(bytes.slice(0, bytes.indexOf(0)));
    }

    /** An array that a function fills, which takes the decoder, `given`, the place and the size. */
    private filled<View>(kind: ViewType<View>, count: number, name: string, ...given: number[]): View {
        return this.lent(Math.max(1, count) * kind.BYTES_PER_ELEMENT, (at) => {
            if (this.invoke(name, this.decoder, ...given, at, count) !== 0) throw this.error();
            return this.copied(kind, at, count);
        });
    }
}
