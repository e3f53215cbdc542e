/** What all blocks of a mesh share: its faces, their graph, and which vertices each block has (specification, M 2 to M 5). */
import { begun } from "./begun";
import { derivePartition, groupLabels, growBlocks, largestPart, makeGraph, type Blocks, type Graph, type Partition } from "./blocks";
import { chainLength, ChainDecoder, type Allowance, type DecodedBlock } from "./chain";
import { decodeConnectivity, decodeLabels } from "./connectivity";
import { CorruptError } from "./errors";
import type { Header } from "./header";
import type { Ints, Memory } from "./kernels";
import type { Limits } from "./limits";
import { labelsCost, meshCost, partitionCost } from "./work";

/** Made of the packets in front of the blocks. */
export class Structure {
    private known?: Ints;
    private made?: Graph;
    private partition?: Partition;
    private grown?: Blocks;

    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
        private readonly limits: Limits,
        private readonly allowance: Allowance,
    ) {}

    /** Whether the faces are there. */
    get begun(): boolean {
        return this.known !== undefined;
    }

    get faces(): Ints {
        return begun(this.known);
    }

    accept(data: Uint8Array): void {
        const { memory, header, limits, allowance } = this;
        this.known = decodeConnectivity(memory, data, header, limits);
        allowance.grant(header.vertices);
        allowance.spend(meshCost(header.vertices, header.faces, data.length), data.length);
    }

    /** The graph of the faces, made when it is first asked for. */
    private get graph(): Graph {
        return (this.made ??= makeGraph(this.memory, this.faces, this.header.vertices));
    }

    acceptPartition(data: Uint8Array): void {
        const { size, offsets, neighbours } = this.graph;
        this.allowance.spend(labelsCost(size, neighbours.length, data.length), data.length);
        const labels = decodeLabels(this.memory, data, offsets, neighbours, this.header.blocks);
        this.partition = groupLabels(this.memory, labels, this.header.blocks);
    }

    /** The blocks, built when they are first asked for. */
    get blocks(): Blocks {
        if (this.grown) return this.grown;
        const { memory, header, graph, allowance } = this;
        const { blocks, blockSize } = header;
        allowance.spend(partitionCost(graph.size, graph.neighbours.length, blocks, blocks * Math.min(blockSize, graph.size)));
        const partition = this.partition ?? derivePartition(memory, graph, blocks);
        const largest = largestPart(partition);
        if (largest > blockSize) throw new CorruptError(`a part of ${largest} vertices in blocks of ${blockSize}`);
        return (this.grown = growBlocks(memory, graph, partition, blockSize));
    }

    /** Chains of these blocks, in memory from here on. */
    get chains(): Chains {
        const { memory, header, blocks, allowance } = this;
        return new Chains(memory, header, blocks, allowance);
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
    ) {
        this.behind = memory.mark();
    }

    decode(index: number, coefficients: number, data: Uint8Array): DecodedBlock {
        const { memory, header, blocks, allowance } = this;
        const number = chainOf(header, index);
        if (this.number !== number) {
            memory.release(this.behind);
            this.chain = new ChainDecoder(memory, header, blocks, allowance);
            this.number = number;
            this.next = number * chainLength(header);
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

/** The number of the chain that a block is in. */
export function chainOf(header: Header, index: number): number {
    return Math.floor(index / chainLength(header));
}
