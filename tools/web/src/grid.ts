/** Positions on a grid, and what they share with other fields of integers (specification, V 1, V 2, V 12, V 15). */
import { NOT_FINITE, type Changes } from "./assembly";
import { Coder } from "./entropy";
import { CorruptError, NumericError } from "./errors";
import { Floats } from "./floats";
import { EXACT, type Header } from "./header";
import type { Argument, Doubles, Ints, Memory } from "./kernels";
import { upTo } from "./numbers";
import { Cursor } from "./packets";

const LIGHT_SLOTS = 24 * 151;

/** Vertices in the order of their numbers. */
function numbered(memory: Memory, size: number): Ints {
    const rank = memory.ints(size);
    rank.view.set(upTo(size));
    return rank;
}

/** The structure Corners of the kernels: corners at each vertex, and those beyond edges; `rank` may still be filled. */
export function linkCorners(memory: Memory, faces: Ints, size: number, rank = numbered(memory, size)): Argument {
    const starts = memory.ints(size + 1);
    const corners = memory.ints(faces.length);
    const opposite = memory.ints(faces.length);
    const linked = [faces, starts, corners, opposite, rank];
    memory.scratch(() => memory.call("link_corners", linked, memory.ints(size + faces.length)));
    return linked;
}

export function zeros(place: Ints): Ints {
    place.view.fill(0);
    return place;
}

/** Decode the next vertices of a field by its kernel. */
export function decodeChunk(memory: Memory, kernel: string, state: Argument[], payload: Uint8Array, first: number, count: number): void {
    memory.scratch(() => {
        const coder = new Coder(memory, payload);
        const done = memory.call(kernel, coder.parts, ...state, BigInt(first), BigInt(count));
        if (coder.overran || done < count) throw coder.nonsense(`vertex ${done} of ${count} has a value out of range`);
        coder.finish();
    });
}

/** What decodes values: a kernel, all that it takes beside a payload, and the order in which it decodes vertices. */
export interface GridKernel {
    name: string;
    state: Argument[];
    order: Ints;
}

/** The arrays that kernels of grids have in common: the largest values, values, and how far these were from guesses. */
export type Gridded = readonly [largest: Ints, values: Ints, gaps: Ints];

/** The kernel of light grids, and the little that it learns (V 15). */
export function lightKernel(memory: Memory, { vertices }: Header, faces: Ints, gridded: Gridded): GridKernel {
    const order = numbered(memory, vertices);
    const corners = linkCorners(memory, faces, vertices, order);
    const slots = memory.words(LIGHT_SLOTS);
    slots.view.fill(2 ** 31);
    return { name: "code_light", state: [corners, [...gridded, slots]], order };
}

/** Positions on a grid, chunk by chunk (V 7 to V 9, V 12, V 15). */
export class Grid {
    private readonly kernel: GridKernel;
    private readonly values: Ints;
    private readonly places: Doubles;
    private readonly frame: Doubles;
    private readonly floats?: Floats;
    private coded = 0;

    constructor(
        private readonly memory: Memory,
        faces: Ints,
        private readonly header: Header,
        makeKernel: (memory: Memory, header: Header, faces: Ints, gridded: Gridded) => GridKernel,
    ) {
        const { vertices: size, corner, center, scale } = header;
        this.places = memory.doubles(3 * size, 3);
        this.places.view.fill(0);
        this.frame = memory.copy([...(corner.length > 0 ? corner : [0, 0, 0]), ...center, scale]);
        const largest = memory.ints(3);
        largest.view.set(header.grid);
        this.values = zeros(memory.ints(3 * size, 3));
        if (header.light === EXACT) this.floats = new Floats(memory, header);
        this.kernel = makeKernel(memory, header, faces, [largest, this.values, zeros(memory.ints(3 * size, 3))]);
    }

    decode(first: number, count: number, payload: Uint8Array): Changes {
        const { memory, header, places, kernel } = this;
        if (first !== this.coded) throw new CorruptError(`positions from number ${this.coded} on are missing; others depend on them`);
        const cursor = new Cursor(payload);
        const values = this.floats ? cursor.take(cursor.varint()) : payload;
        decodeChunk(memory, kernel.name, kernel.state, values, first, count);
        this.coded += count;
        if (this.floats) return this.placed(kernel.order.part(first, count).view.slice(), this.floats, cursor.rest());
        return memory.scratch(() => {
            const [cells, points] = header.lattice.length > 0 ? header.lattice.map(BigInt) : [0n, 0n];
            const vertices = kernel.order.part(first, count);
            const moved = memory.doubles(3 * count, 3);
            const finite = memory.call("place_values", this.values, vertices, cells, points, this.frame, moved, places);
            if (!finite) throw new NumericError(NOT_FINITE);
            return { vertices: vertices.view.slice(), positions: moved.view.slice(), final: new Uint8Array(count).fill(1) };
        });
    }

    /** Vertices at the floats that a payload tells (V 16). */
    private placed(vertices: Int32Array, floats: Floats, payload: Uint8Array): Changes {
        const values = this.values.view;
        const own = Int32Array.from({ length: 3 * vertices.length }, (_, i) => values[3 * vertices[Math.floor(i / 3)] + (i % 3)]);
        const positions = floats.decode(payload, own);
        const places = this.places.view; // memory may have grown
        vertices.forEach((vertex, row) => places.set(positions.subarray(3 * row, 3 * row + 3), 3 * vertex));
        return { vertices, positions, final: new Uint8Array(vertices.length).fill(1) };
    }

    /** In the unit of the mesh, as vertices are numbered in the decoded faces. */
    get positions(): Float64Array {
        return this.places.view.slice();
    }

    /** Coded values, as vertices are numbered in the decoded faces. */
    get coordinates(): Int32Array {
        return this.values.view.slice();
    }

    /** Vertices without a position. */
    get missing(): Int32Array {
        return this.kernel.order.view.slice(this.coded);
    }
}
