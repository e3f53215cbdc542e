/** Positions on a light grid (specification, V 1, V 12, V 15). */
import { Coder } from "./entropy";
import { CorruptError, NumericError } from "./errors";
import type { Changes } from "./events";
import type { Header } from "./header";
import type { Argument, Doubles, Ints, Memory } from "./memory";
import { upTo } from "./numbers";

const LIGHT_SLOTS = 24 * 151;

/** Vertices in the order of their numbers. */
function numbered(memory: Memory, size: number): Ints {
    const rank = memory.ints(size);
    rank.view.set(upTo(size));
    return rank;
}

/** The structure Corners of the kernels: corners at each vertex, and those beyond edges. */
function linkCorners(memory: Memory, faces: Ints, size: number, rank: Ints): Argument {
    const starts = memory.ints(size + 1);
    const corners = memory.ints(faces.length);
    const opposite = memory.ints(faces.length);
    const linked = [faces, starts, corners, opposite, rank];
    memory.scratch(() => memory.call("link_corners", linked, memory.ints(size + faces.length)));
    return linked;
}

function zeros(place: Ints): Ints {
    place.view.fill(0);
    return place;
}

/** Decode the next vertices of a field by its kernel. */
function decodeChunk(memory: Memory, kernel: string, state: Argument[], payload: Uint8Array, first: number, count: number): void {
    memory.scratch(() => {
        const coder = new Coder(memory, payload);
        const done = memory.call(kernel, coder.parts, ...state, BigInt(first), BigInt(count));
        if (coder.overran || done < count) throw coder.nonsense(`vertex ${done} of ${count} has a value out of range`);
        coder.finish();
    });
}

/** Positions on a light grid, chunk by chunk (V 7 to V 9, V 12, V 15). */
export class Grid {
    private readonly order: Ints;
    private readonly state: Argument[];
    private readonly values: Ints;
    private readonly places: Doubles;
    private readonly frame: Doubles;
    private coded = 0;

    constructor(private readonly memory: Memory, faces: Ints, private readonly header: Header) {
        const { vertices: size, corner, center, scale } = header;
        this.places = memory.doubles(3 * size, 3);
        this.places.view.fill(0);
        const frame = [...(corner.length > 0 ? corner : [0, 0, 0]), ...center, scale];
        this.frame = memory.doubles(frame.length);
        this.frame.view.set(frame);
        const largest = memory.ints(3);
        largest.view.set(header.grid);
        this.values = zeros(memory.ints(3 * size, 3));
        const gaps = zeros(memory.ints(3 * size, 3));
        this.order = numbered(memory, size);
        const corners = linkCorners(memory, faces, size, this.order);
        const slots = memory.words(LIGHT_SLOTS);
        slots.view.fill(2 ** 31);
        this.state = [corners, [largest, this.values, gaps, slots]];
    }

    decode(first: number, count: number, payload: Uint8Array): Changes {
        const { memory, header, places, order } = this;
        if (first !== this.coded) throw new CorruptError(`positions from number ${this.coded} on are missing; others depend on them`);
        decodeChunk(memory, "code_light", this.state, payload, first, count);
        this.coded += count;
        return memory.scratch(() => {
            const [cells, points] = header.lattice.length > 0 ? header.lattice.map(BigInt) : [0n, 0n];
            const vertices = order.part(first, count);
            const moved = memory.doubles(3 * count, 3);
            const finite = memory.call("place_values", this.values, vertices, cells, points, this.frame, moved, places);
            if (!finite) throw new NumericError("positions are not finite in the unit of the mesh");
            return { vertices: vertices.view.slice(), positions: moved.view.slice(), final: new Uint8Array(count).fill(1) };
        });
    }

    /** In the unit of the mesh, as vertices are numbered in the decoded faces. */
    get positions(): Float64Array {
        return this.places.view.slice();
    }
}
