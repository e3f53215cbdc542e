/** What all blocks of a mesh share: its faces, their graph, and which vertices each block has (specification, M 2 to M 5). */
import { begun } from "./begun";
import { derivePartition, groupLabels, growBlocks, largestPart, lastOf, makeGraph, type Blocks, type Graph, type Partition } from "./blocks";
import { chainLength, ChainDecoder, type Allowance, type DecodedBlock, type Surface } from "./chain";
import { CONNECTIVITY_METHOD, ConnectivityDecoder, decodeLabels } from "./connectivity";
import { CorruptError, UnsupportedError } from "./errors";
import { sectionsOf, type Header } from "./header";
import type { Ints, Memory } from "./kernels";
import type { Limits } from "./limits";
import { labelsCost, meshCost, partitionCost, type Earlier } from "./work";

const PARTITION_METHOD = 0;
/** Made of the packets in front of the blocks of each section. */
export class Structure {
    readonly connectivity: ConnectivityDecoder;
    /** Faces and vertices of sections before the present one. */
    before: Earlier = { faces: 0, vertices: 0 };
    private made?: Graph;
    private partition?: Partition;
    private grown?: Blocks;

    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
        limits: Limits,
        private readonly allowance: Allowance,
    ) {
        this.connectivity = new ConnectivityDecoder(memory, header, limits);
    }

    /** All faces, that are there or will come. */
    get faces(): Ints {
        return this.connectivity.faces;
    }

    /** Take the faces of the next section; nothing that the memory holds of the one before it is needed any more. */
    accept(method: number, data: Uint8Array): void {
        const { connectivity, allowance } = this;
        if (method !== CONNECTIVITY_METHOD) throw new UnsupportedError(`connectivity method ${method} is unknown to this decoder`);
        this.before = { faces: connectivity.known, vertices: connectivity.vertices };
        connectivity.take(data);
        const { known, vertices } = connectivity;
        allowance.grant(vertices - this.before.vertices);
        allowance.spend(meshCost(vertices, known, data.length, this.before), data.length);
        this.made = this.grown = undefined;
    }

    /** Faces of this section and those before it. */
    private get known(): Ints {
        const { faces, known } = this.connectivity;
        return faces.part(0, 3 * known, 3);
    }

    /** Their graph, made when it is first asked for. */
    private get graph(): Graph {
        return (this.made ??= makeGraph(this.memory, this.known, this.connectivity.vertices));
    }

    /** Check that the faces that so many blocks need are there. */
    expectFaces(blocks: number): void {
        if (blocks > this.connectivity.blocks) throw new CorruptError("the faces of a section are missing");
    }

    acceptPartition(method: number, data: Uint8Array): void {
        if (method !== PARTITION_METHOD) throw new UnsupportedError(`partition method ${method} is unknown to this decoder`);
        const { size, offsets, neighbours } = this.graph;
        this.allowance.spend(labelsCost(size, neighbours.length, data.length), data.length);
        const labels = decodeLabels(this.memory, data, offsets, neighbours, this.header.blocks);
        this.partition = groupLabels(this.memory, labels, this.header.blocks);
    }

    /** The blocks, built when they are first asked for. */
    get blocks(): Blocks {
        if (this.grown) return this.grown;
        const { memory, header, graph, allowance, connectivity, before } = this;
        const { size, offsets, neighbours } = graph;
        const { first, blocks } = connectivity.sections[connectivity.section - 1];
        const count = blocks - first;
        const ends = neighbours.length - offsets.view[before.vertices];
        allowance.spend(partitionCost(size - before.vertices, ends, size, count, count * Math.min(header.blockSize, size)));
        const partition = this.partition ?? derivePartition(memory, lastOf(memory, graph, before.vertices), count);
        const largest = largestPart(partition);
        if (largest > header.blockSize) throw new CorruptError(`a part of ${largest} vertices in blocks of ${header.blockSize}`);
        return (this.grown = growBlocks(memory, graph, partition, header.blockSize, first));
    }

    /** Chains of these blocks, in memory from here on. */
    get chains(): Chains {
        const { memory, header, blocks, allowance } = this;
        const surface = header.details > 0 ? makeSurface(memory, this.known, blocks.graph.size) : undefined;
        return new Chains(memory, header, blocks, allowance, surface);
    }
}

/** Decodes blocks, one chain after the other. */
export class Chains {
    private readonly behind: number;
    private number = -1;
    private next = 0;
    private chain?: ChainDecoder;

    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
        private readonly blocks: Blocks,
        private readonly allowance: Allowance,
        private readonly surface?: Surface,
    ) {
        this.behind = memory.mark();
    }

    decode(index: number, coefficients: number, data: Uint8Array): DecodedBlock {
        const { memory, header, blocks, allowance, surface } = this;
        const { number, first } = chainOf(header, index);
        if (this.number !== number) {
            memory.release(this.behind);
            this.chain = new ChainDecoder(memory, header, blocks, allowance, surface);
            this.number = number;
            this.next = first;
        }
        if (this.next !== index) throw new CorruptError(`the block depends on block ${this.next}, which is lost`);
        const block = begun(this.chain).decode(index, coefficients, data);
        this.next++;
        return block;
    }

    /** Give back what the chains have in memory. */
    release(): void {
        this.memory.release(this.behind);
    }
}

/** The chain that a block is in: its number among those of all sections, and its first block (M 18.4). */
export function chainOf(header: Header, index: number): { number: number; first: number } {
    const length = chainLength(header);
    let before = 0;
    for (const { first, blocks } of sectionsOf(header)) {
        const number = Math.floor((index - first) / length);
        if (index < blocks) return { number: before + number, first: first + number * length };
        before += Math.ceil((blocks - first) / length);
    }
    return { number: before, first: index };
}

function makeSurface(memory: Memory, faces: Ints, size: number): Surface {
    const surface = { faces, starts: memory.longs(size + 1), members: memory.ints(faces.length), place: memory.ints(size) };
    surface.place.view.fill(0);
    memory.run("vertex_faces", faces, surface.starts, surface.members);
    return surface;
}
