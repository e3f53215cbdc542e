/** Decodes some of the chains of a stream beside a decoder, which has the others: chains know nothing of each other. */
import { begun } from "./begun";
import { Allowance, type DecodedBlock } from "./chain";
import { BsmError, type Described } from "./errors";
import type { Header } from "./header";
import type { Kernels, Memory } from "./kernels";
import { DEFAULT_LIMITS, type Limits } from "./limits";
import { END_OF_STREAM, Reader, type Damaged, type Packet, type Signal } from "./reader";
import { chainOf, Structure, type Chains } from "./structure";
import { TolerantReader } from "./tolerant";

/** A block that a helper has decoded, or what is wrong with it. */
export interface SharedBlock {
    index: number;
    block?: DecodedBlock;
    problem?: Described;
}

/** Which of those that share the chains of a stream has which: chain c is that of number c % `among`; 0 is the decoder. */
export interface Share {
    number: number;
    among: number;
}

/** Whether a block is in a chain of this share. */
export function isMine(header: Header, index: number, { number, among }: Share): boolean {
    return chainOf(header, index) % among === number;
}

/** Takes the whole stream, as the decoder does, and gives the blocks of its share. */
export class Helper {
    private readonly limits: Limits;
    private readonly reader: Reader;
    private readonly memory: Memory;
    private readonly allowance: Allowance;
    private header?: Header;
    private structure?: Structure;
    private chains?: Chains;
    private over = false;

    constructor(
        private readonly kernels: Kernels,
        private readonly share: Share,
        limits: Partial<Limits> = {},
        private readonly tolerant = false,
    ) {
        this.limits = { ...DEFAULT_LIMITS, ...limits };
        this.memory = kernels.instantiate(this.limits.memory);
        this.allowance = new Allowance(this.limits);
        const spend = this.allowance.spend.bind(this.allowance);
        this.reader = tolerant ? new TolerantReader(this.limits, spend) : new Reader(this.limits, spend);
    }

    receiveData(data: Uint8Array): void {
        this.reader.receiveData(data);
    }

    receiveEof(): void {
        this.reader.receiveEof();
    }

    /** Leave the memory to the next decoder; this one is not to be asked for anything more. */
    release(): void {
        this.kernels.take(this.memory);
    }

    /** The next block of the share, `NEED_DATA`, or `END_OF_STREAM` if no more will come. */
    nextBlock(): SharedBlock | Signal {
        try {
            while (!this.over) {
                const packet = this.reader.nextPacket();
                if (typeof packet === "string") return packet;
                const shared = this.accept(packet);
                if (shared) return shared;
            }
        } catch (error) {
            // What is wrong with more than a block is found by the decoder as well.
            if (!(error instanceof BsmError)) throw error;
            this.over = true;
        }
        return END_OF_STREAM;
    }

    private accept(packet: Packet | Damaged): SharedBlock | undefined {
        const { memory, header, structure, limits, allowance } = this;
        if (packet.type === "header") {
            this.over = header !== undefined; // of later runs the decoder has all chains
            this.header = packet.header;
            this.structure = new Structure(memory, packet.header, limits, allowance);
        } else if (packet.type === "connectivity") begun(structure).accept(packet.data);
        else if (packet.type === "partition") begun(structure).acceptPartition(packet.data);
        else if (packet.type === "block" && isMine(begun(header), packet.index, this.share)) return this.decode(packet);
        return undefined;
    }

    private decode({ index, coefficients, data }: Extract<Packet, { type: "block" }>): SharedBlock {
        this.chains ??= begun(this.structure).chains;
        try {
            return { index, block: this.chains.decode(index, coefficients, data) };
        } catch (error) {
            if (!(error instanceof BsmError)) throw error;
            this.over = !this.tolerant;
            return { index, problem: error.located({ offset: this.reader.position, block: index }).described };
        }
    }
}
