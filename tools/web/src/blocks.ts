/** Graph, parts and blocks of a mesh, all integers (specification, M 2 to M 6). */
import { CorruptError, LimitError } from "./errors";
import type { Doubles, Ints, Memory, Words } from "./kernels";

const REFINEMENT_PASSES = 2n;
const LEAF = 16n;
const MOST_WORK = 65536;
const FULL = -1;
const TOO_MUCH = -2;

/** An undirected graph in compressed rows. */
export interface Graph {
    size: number;
    offsets: Ints;
    neighbours: Ints;
}

/** Parts that cover a graph: vertices part after part, where each part begins, the part of each vertex. */
export interface Partition {
    parts: number;
    order: Ints;
    bounds: Ints;
    labels: Ints;
}

/** All blocks of a mesh, in the order of their chain. */
export interface Blocks {
    graph: Graph;
    count: number;
    /** Size of the part that each block grew from: the first of its members. */
    cores: Int32Array;
    starts: Float64Array;
    members: Ints;
}

/** One block: its vertices row after row, and the graph among them. */
export interface Block {
    size: number;
    vertices: Ints;
    offsets: Ints;
    neighbours: Ints;
    fronts: Fronts;
    /** Of the entries of `neighbours`; without them all are 1. */
    weights?: Doubles;
}

/** How matrices with the pattern of a block are factorised; in the order of the kernels' structure. */
export interface Fronts {
    parts: readonly (Words | Doubles)[];
    /** Doubles that the fronts' matrices take. */
    size: number;
    /** Operations of a factorisation, and entries that a solution goes through. */
    work: number;
    entries: number;
}

export function makeGraph(memory: Memory, faces: Ints, size: number): Graph {
    const offsets = memory.ints(size + 1);
    const room = memory.ints(2 * faces.length);
    const kept = memory.scratch(() => memory.call("collect_edges", faces, offsets, memory.ints(size), room));
    return { size, offsets, neighbours: memory.enlarged(room, kept) };
}

/** The partition that a stream tells by labels, numbered by first appearance. */
export function groupLabels(memory: Memory, labels: Ints, parts: number): Partition {
    const order = memory.ints(labels.length);
    const bounds = memory.ints(parts + 1);
    memory.run("group_by_label", labels, bounds, order);
    return { parts, order, bounds, labels };
}

/** The partition that follows from the graph alone (M 4). */
export function derivePartition(memory: Memory, graph: Graph, parts: number): Partition {
    const labels = memory.ints(graph.size);
    memory.scratch(() => {
        const order = memory.ints(graph.size);
        const bounds = memory.ints(parts + 1);
        const scratch = memory.words(13 * graph.size + 5);
        if (!memory.run("bisect", graph.offsets, graph.neighbours, order, bounds, scratch)) {
            throw new CorruptError(`${graph.size} vertices cannot be cut into ${parts} parts`);
        }
        const [part, vertices, ends] = [labels.view, order.view, bounds.view];
        for (let p = 0; p < parts; p++) for (let i = ends[p]; i < ends[p + 1]; i++) part[vertices[i]] = p;
        const { offsets, neighbours } = graph;
        memory.run("refine_partition", offsets, neighbours, labels, REFINEMENT_PASSES, memory.longs(parts), memory.ints(parts));
    });
    return groupLabels(memory, labels, parts);
}

/** Size of the largest part. */
export function largestPart(partition: Partition): number {
    const bounds = partition.bounds.view;
    let largest = 0;
    for (let p = 0; p < partition.parts; p++) largest = Math.max(largest, bounds[p + 1] - bounds[p]);
    return largest;
}

/** Put the parts into a chain and grow each to at most `size` vertices (M 5). */
export function growBlocks(memory: Memory, graph: Graph, partition: Partition, size: number): Blocks {
    const { parts, order, bounds } = partition;
    const room = memory.ints(parts * Math.min(size, graph.size));
    const { starts, cores, count } = memory.scratch(() => {
        const chain = chainParts(memory, graph, partition);
        const places = memory.longs(parts + 1);
        const seen = memory.ints(graph.size);
        const { offsets, neighbours } = graph;
        const count = memory.call("grow_blocks", offsets, neighbours, order, bounds, chain, BigInt(size), seen, places, room);
        const ends = bounds.view;
        const cores = Int32Array.from(chain.view, (part) => ends[part + 1] - ends[part]);
        return { starts: Float64Array.from(places.view, Number), cores, count };
    });
    return { graph, count: parts, cores, starts, members: memory.enlarged(room, count) };
}

/** The parts in the order in which they are visited. */
function chainParts(memory: Memory, graph: Graph, partition: Partition): Ints {
    const { parts, labels } = partition;
    const [offsets, neighbours, label] = [graph.offsets.view, graph.neighbours.view, labels.view];
    let crossing = 0;
    const visit = (found: (pair: number) => void): void => {
        for (let v = 0; v < graph.size; v++) {
            const here = label[v];
            for (let i = offsets[v]; i < offsets[v + 1]; i++) {
                if (label[neighbours[i]] !== here) found(here * parts + label[neighbours[i]]);
            }
        }
    };
    visit(() => crossing++);
    const pairs = new Float64Array(crossing);
    let filled = 0;
    visit((pair) => (pairs[filled++] = pair));
    pairs.sort();
    const [starts, ends, edges]: [number[], number[], number[]] = [[], [], []];
    for (let i = 0; i < crossing; ) {
        const first = i;
        while (i < crossing && pairs[i] === pairs[first]) i++;
        const from = Math.floor(pairs[first] / parts);
        while (starts.length <= from) starts.push(ends.length);
        ends.push(pairs[first] - from * parts);
        edges.push(i - first);
    }
    while (starts.length <= parts) starts.push(ends.length);

    const chain = memory.ints(parts);
    memory.scratch(() => {
        const rows = memory.longs(parts + 1);
        const columns = memory.ints(ends.length);
        const shared = memory.longs(edges.length);
        rows.view.set(starts.map(BigInt));
        columns.view.set(ends);
        shared.view.set(edges.map(BigInt));
        const [sums, seen, trail, visited] = [memory.longs(parts), memory.longs(parts), memory.ints(parts), memory.bytes(parts)];
        memory.run("chain_parts", rows, columns, shared, sums, seen, trail, visited, chain);
    });
    return chain;
}

/** Vertices of a block in the order in which they were found. */
export function membersOf(blocks: Blocks, index: number): Ints {
    return blocks.members.part(blocks.starts[index], blocks.starts[index + 1] - blocks.starts[index]);
}

/** Order the rows of a block of these vertices (M 6). */
export function makeBlock(memory: Memory, graph: Graph, rows: Ints): Block {
    const { offsets: around, neighbours: beside } = graph;
    const size = rows.length;
    const vertices = memory.ints(size);
    const offsets = memory.ints(size + 1);
    let neighbours = memory.ints(8 * size);
    for (;;) {
        const room = neighbours;
        const ends = memory.scratch(() => {
            const scratch = memory.words(memory.call("order_scratch", BigInt(size), BigInt(room.length)));
            return memory.call("order_block", around, beside, rows, vertices, offsets, room, scratch);
        });
        neighbours = memory.enlarged(room, ends);
        if (ends <= room.length) return { size, vertices, offsets, neighbours, fronts: findFronts(memory, offsets, neighbours) };
    }
}

/** Which rows are eliminated when. */
function findFronts(memory: Memory, offsets: Ints, neighbours: Ints): Fronts {
    const n = offsets.length - 1;
    const rows = memory.words(n);
    const found = memory.words(n + 1);
    const count = memory.scratch(() => memory.call("dissect", offsets, neighbours, LEAF, memory.ints(n), rows, found));
    const firsts = found.part(n - count, count + 1);
    const [steps, owners] = [memory.words(n), memory.words(n)];
    const [starts, places] = [memory.words(count + 1), memory.words(count + 1)];
    const work = MOST_WORK * n;
    const scratch = memory.words(n + 2 * count);
    let borders = memory.words(16 * n + 64);
    let size = FULL;
    while ((size = memory.call("find_borders", offsets, neighbours, rows, firsts, work, scratch, steps, owners, starts, borders, places)) === FULL) {
        borders = memory.enlarged(borders, 4 * borders.length);
    }
    if (size === TOO_MUCH) throw new LimitError(`the faces of a block of ${n} vertices are too entangled`);
    borders = memory.enlarged(borders, size);
    const sums = cost(firsts, starts);
    const told = memory.doubles(2);
    told.view.set([sums.entries, sums.work]);
    return { parts: [rows, steps, owners, firsts, starts, borders, places, told], size: places.view[count], ...sums };
}

function cost(firsts: Words, starts: Words): { work: number; entries: number } {
    const [own, border] = [firsts.view, starts.view];
    let [work, entries] = [0, 0];
    for (let f = 0; f + 1 < own.length; f++) {
        const steps = own[f + 1] - own[f];
        const width = steps + border[f + 1] - border[f];
        work += steps * width * width;
        entries += steps * width;
    }
    return { work, entries };
}
