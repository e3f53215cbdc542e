/** What all blocks of a mesh share: its faces, their graph, and which vertices each block has (specification, M 2 to M 5). */
import { derivePartition, groupLabels, growBlocks, largestPart, makeGraph, type Blocks, type Graph, type Partition } from "./blocks";
import { chainLength, ChainDecoder, type Allowance, type DecodedBlock, type Surface } from "./chain";
import { decodeConnectivity, decodeLabels } from "./connectivity";
import { CorruptError, UnsupportedError } from "./errors";
import type { Header } from "./header";
import type { Ints, Memory } from "./kernels";
import type { Limits } from "./limits";
import { labelsCost, meshCost, partitionCost } from "./work";

const CONNECTIVITY_METHOD = 1;
const PARTITION_METHOD = 0;
/** Copies that blocks may have of each vertex, and besides (F 4.6). */
const [MOST_COPIES, FREE_COPIES] = [16, 2 ** 16];

/** Made of the packets in front of the blocks. */
export class Structure {
    readonly faces: Ints;
    private readonly graph?: Graph;
    private readonly surface?: Surface;
    private partition?: Partition;
    private grown?: Blocks;

    /** Of the packet that has the faces. */
    constructor(
        private readonly memory: Memory,
        private readonly header: Header,
        method: number,
        data: Uint8Array,
        limits: Limits,
        private readonly allowance: Allowance,
    ) {
        const { vertices, faces, grid, details } = header;
        if (method !== CONNECTIVITY_METHOD) throw new UnsupportedError(`connectivity method ${method} is unknown to this decoder`);
        this.faces = decodeConnectivity(memory, data, vertices, faces, limits);
        allowance.grant(vertices);
        allowance.spend(meshCost(vertices, faces, data.length), data.length);
        if (grid.length > 0) return;
        this.graph = makeGraph(memory, this.faces, vertices);
        if (details > 0) this.surface = makeSurface(memory, this.faces, vertices);
    }

    acceptPartition(method: number, data: Uint8Array): void {
        if (method !== PARTITION_METHOD) throw new UnsupportedError(`partition method ${method} is unknown to this decoder`);
        const { size, offsets, neighbours } = this.graph!;
        this.allowance.spend(labelsCost(size, neighbours.length, data.length), data.length);
        const labels = decodeLabels(this.memory, data, offsets, neighbours, this.header.blocks);
        this.partition = groupLabels(this.memory, labels, this.header.blocks);
    }

    /** The blocks, built when they are first asked for. */
    get blocks(): Blocks {
        if (this.grown) return this.grown;
        const { memory, header, graph, allowance } = this;
        const copies = Math.min(header.blocks * header.blockSize, MOST_COPIES * header.vertices + FREE_COPIES);
        allowance.spend(partitionCost(graph!.size, graph!.neighbours.length, header.blocks, copies));
        const partition = this.partition ?? derivePartition(memory, graph!, header.blocks);
        const largest = largestPart(partition);
        if (largest > header.blockSize) throw new CorruptError(`a part of ${largest} vertices in blocks of ${header.blockSize}`);
        return (this.grown = growBlocks(memory, graph!, partition, header.blockSize));
    }

    /** Chains of these blocks, in memory from here on. */
    get chains(): Chains {
        return new Chains(this.memory, this.header, this.blocks, this.allowance, this.surface);
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
        const number = chainOf(header, index);
        if (this.number !== number) {
            memory.release(this.behind);
            this.chain = new ChainDecoder(memory, header, blocks, allowance, surface);
            this.number = number;
            this.next = number * chainLength(header);
        }
        if (this.next !== index) throw new CorruptError(`the block depends on block ${this.next}, which is lost`);
        const block = this.chain!.decode(index, coefficients, data);
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

function makeSurface(memory: Memory, faces: Ints, size: number): Surface {
    const surface = { faces, starts: memory.longs(size + 1), members: memory.ints(faces.length), place: memory.ints(size) };
    surface.place.view.fill(0);
    memory.run("vertex_faces", faces, surface.starts, surface.members);
    return surface;
}
