/** Faces (specification, C 4 to C 8). */
import { Coder, makeBank, unsignedSpan, type Bank } from "./entropy";
import type { Header } from "./header";
import type { Ints, Memory } from "./memory";
import { checkLimit, checkMemory, type Limits } from "./limits";

const ONE = 65536;
const VALENCE = { contexts: 14, nodes: 16 };
const EVENT = { contexts: 3, size: 4096 };
const RARE_UNARY = 2;
const RARE_KINDS = 6;
const RARE_SPAN = unsignedSpan(RARE_UNARY);
const RARE_COUNTS = 5 * RARE_SPAN;
const FRONT = { columns: 8, buckets: 8, heads: 18, made: 8, alive: 9 };
const TALLIES = { size: 7, dummies: 3, turns: 4, steps: 5 };
const [NONSENSE, NO_ROOM] = [1, 2];
/** Bytes that decoding, and the graph that follows, take at most for each; only fans count that are sewn together. */
const [FACE, VERTEX, FAN] = [100, 400, 240];

type Models = readonly [valence: Bank, event: Bank, rare: Bank, bits: bigint];

function makeModels(memory: Memory, vertices: number): Models {
    const bits = Math.min(Math.max(32 - Math.clz32(vertices) - 2, 6), 12);
    const { contexts, nodes } = VALENCE;
    return [
        makeBank(memory, { slots: (contexts << bits) * nodes, selectors: nodes, inputs: contexts, limit: 1023, rate: 16 }),
        makeBank(memory, {
            slots: EVENT.contexts * EVENT.size,
            selectors: 1,
            inputs: EVENT.contexts,
            limit: 1023,
            rate: 16,
            probability: ONE - Math.floor(ONE / 500),
            trust: 30,
        }),
        makeBank(memory, { slots: RARE_KINDS * RARE_SPAN, selectors: RARE_KINDS * RARE_SPAN, inputs: 1 }),
        BigInt(bits),
    ];
}

/** The faces of a mesh, shape (m, 3) (C 4). */
export function decodeConnectivity(memory: Memory, payload: Uint8Array, header: Header, limits: Limits): Ints {
    const faces = memory.ints(3 * header.faces, 3);
    memory.scratch(() => {
        const coder = new Coder(memory, payload);
        const models = makeModels(memory, header.vertices);
        const [degenerate, lonely, surplus, loops] = [0, 1, 2, 3].map(() => readCount(memory, coder, models));
        const proper = header.faces - degenerate;
        const regular = header.vertices - lonely;
        const fans = regular + surplus;
        if (proper < 0 || regular < 0 || lonely > 3 * degenerate || fans > 3 * proper || loops > 3 * proper) {
            throw coder.nonsense("the counts at its start contradict each other");
        }
        checkLimit(limits, "vertices", fans + loops);
        checkMemory(limits, FACE * header.faces + VERTEX * header.vertices + FAN * (surplus + loops), header.vertices, payload.length);
        const surface = faces.part(0, 3 * proper, 3);
        conquer(memory, coder, models, surface, fans, loops);
        const known = surplus > 0 ? joinFans(memory, coder, surface, fans) : fans;
        const corners = faces.part(surface.length, faces.length - surface.length);
        if (known !== regular || memory.call("code_degenerate", coder.parts, corners, BigInt(known)) !== header.vertices) {
            throw coder.nonsense(`it does not make ${header.vertices} vertices`);
        }
        coder.finish();
    });
    return faces;
}

function readCount(memory: Memory, coder: Coder, models: Models): number {
    return memory.scratch(() => {
        const context = memory.longs(1);
        context.view[0] = 0n;
        return memory.call("code_one_unsigned", coder.parts, models[2], context, 0n, BigInt(RARE_UNARY), 0n, BigInt(RARE_COUNTS));
    });
}

/** The conquest (C 6) of faces that do not repeat a corner, with more memory for its front each time it asks. */
function conquer(memory: Memory, coder: Coder, models: Models, surface: Ints, fans: number, loops: number): void {
    const heads = memory.ints(FRONT.heads);
    heads.view.fill(-1);
    heads.view[FRONT.made] = heads.view[FRONT.alive] = 0;
    const tallies = memory.longs(TALLIES.size);
    tallies.view.fill(0n);
    tallies.view[TALLIES.dummies] = BigInt(loops);
    tallies.view[TALLIES.turns] = BigInt(4 * surface.rows);
    tallies.view[TALLIES.steps] = BigInt(65536 + 16 * surface.rows);
    const vertices = memory.longs(2 * (fans + loops), 2);
    let nodes = memory.ints(FRONT.columns * (fans + 16), FRONT.columns);
    for (;;) {
        const end = memory.call("conquer_surface", coder.parts, models, [nodes, heads, vertices, surface, tallies]);
        if (end === NONSENSE) throw coder.nonsense(`it does not make ${surface.rows} triangles`);
        if (end !== NO_ROOM) return;
        const before = nodes;
        nodes = memory.ints(2 * before.length, FRONT.columns);
        nodes.view.set(before.view);
    }
}

/** Which fans are the same vertex (C 7): corners become vertices; returns how many vertices there are. */
function joinFans(memory: Memory, coder: Coder, faces: Ints, fans: number): number {
    const after = memory.ints(fans);
    const before = memory.ints(fans);
    after.view.fill(-1);
    before.view.fill(-1);
    memory.scratch(() => findBorders(memory, faces, after, before));
    const known = memory.ints(fans);
    known.view.fill(-1);
    const vertex = memory.ints(fans);
    const seams = [vertex, after, before, memory.ints(fans), memory.ints(fans)];
    const count = memory.call("code_fans", coder.parts, makeBank(memory, { slots: 32, selectors: 1, inputs: 1 }), known, seams);
    if (count >= 0) {
        const names = vertex.view;
        const corners = faces.view;
        for (let i = 0; i < corners.length; i++) corners[i] = names[corners[i]];
    }
    return count;
}

/** The fans after and before each fan along the boundary (C 7.1). */
function findBorders(memory: Memory, faces: Ints, after: Ints, before: Ints): void {
    const size = faces.length;
    const origin = faces.part(0, size);
    const starts = memory.longs(after.length + 1);
    const twin = memory.ints(size);
    memory.run("match_halfedges", origin, starts, memory.ints(size), memory.ints(size), twin);
    const [corners, twins, next, last] = [origin.view, twin.view, after.view, before.view];
    for (let i = 0; i < size; i++) {
        if (twins[i] < 0) next[corners[i]] = corners[i % 3 === 2 ? i - 2 : i + 1];
    }
    for (let fan = 0; fan < next.length; fan++) {
        if (next[fan] >= 0) last[next[fan]] = fan;
    }
}
