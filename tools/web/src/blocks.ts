/** Graph, parts and blocks of a mesh, all integers (specification, M 2 to M 6). */
import { CorruptError, LimitError } from "./errors";
import type { Doubles, Ints, Memory, Words } from "./kernels";

const REFINEMENT_PASSES = 2n;
const LEAF = 8n;
const CHAIN_SCRATCH = 7; // numbers for each part
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

/** Edges that vertices have in the mesh, all together. */
export function edgesOf({ offsets }: Graph, vertices: Ints): number {
    const ends = offsets.view;
    return vertices.view.reduce((sum, vertex) => sum + ends[vertex + 1] - ends[vertex], 0);
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
    const { parts, order, bounds, labels } = partition;
    const room = memory.ints(parts * Math.min(size, graph.size));
    const { starts, cores, count } = memory.scratch(() => {
        const { offsets, neighbours } = graph;
        const pairs = Math.min(neighbours.length, parts * (parts - 1));
        const [links, shares, scratch] = [memory.ints(pairs), memory.longs(pairs), memory.longs(CHAIN_SCRATCH * parts)];
        const [seen, chain, places, edges] = [memory.ints(graph.size), memory.ints(parts), memory.longs(parts + 1), memory.longs(parts)];
        const count = memory.call(
            "chain_blocks", offsets, neighbours, order, bounds, labels, BigInt(size), links, shares, scratch, seen, chain, places, edges, room,
        );
        const ends = bounds.view;
        const cores = chain.view.map((part) => ends[part + 1] - ends[part]);
        return { starts: Float64Array.from(places.view, Number), cores, count };
    });
    return { graph, count: parts, cores, starts, members: memory.enlarged(room, count) };
}

/** Vertices of a block in the order in which they were found. */
export function membersOf(blocks: Blocks, index: number): Ints {
    const [start, end] = blocks.starts.subarray(index);
    return blocks.members.part(start, end - start);
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
    const [rows, steps, owners] = [memory.words(n), memory.words(n), memory.words(n)];
    const [firsts, starts, places] = [memory.words(n + 1), memory.words(n + 1), memory.words(n + 1)];
    const [scratch, sums] = [memory.words(3 * n), memory.doubles(2)];
    let borders = memory.words(16 * n + 64);
    let count = FULL;
    while ((count = memory.call("find_fronts", offsets, neighbours, LEAF, MOST_WORK * n, scratch, rows, steps, owners, firsts, starts, borders, places, sums)) === FULL) {
        borders = memory.enlarged(borders, 4 * borders.length);
    }
    if (count === TOO_MUCH) throw new LimitError(`the faces of a block of ${n} vertices are too entangled`);
    borders = memory.enlarged(borders, starts.view[count]);
    const [first, start, place] = [firsts, starts, places].map((ends) => ends.part(0, count + 1));
    const [entries, work] = sums.view;
    return { parts: [rows, steps, owners, first, start, borders, place, sums], size: places.view[count], work, entries };
}
