/** The grammar of meshes on light grids. */
import { CorruptError } from "./errors";
import type { Header } from "./header";
import type { Kind, Packet } from "./packets";

/** What may follow a packet of each kind, metadata aside. */
const FOLLOWERS: Partial<Record<Kind | "start", readonly Kind[]>> = {
    start: ["header"],
    header: ["connectivity"],
    connectivity: ["grid", "end"],
    grid: ["grid", "end"],
};

/** Which packet may follow which, and what it must have to agree with the header. */
export class Grammar {
    header?: Header;
    private last: Kind | "start" = "start";
    private readonly entryNames = new Set<string>();
    private nextVertex = 0;

    get ended(): boolean {
        return this.last === "end";
    }

    /** Record a packet, or throw an error if it may not come here. */
    accept(packet: Packet): void {
        const { header, nextVertex, entryNames } = this;
        const may = packet.type === "metadata" ? header : FOLLOWERS[this.last]?.includes(packet.type);
        if (!may) throw new CorruptError(`unexpected section ${packet.type}`);
        if (packet.type === "metadata") {
            for (const name of packet.entries.keys()) {
                if (entryNames.has(name)) throw new CorruptError(`duplicate metadata name "${name}"`);
                entryNames.add(name);
            }
            return;
        }
        this.last = packet.type;
        if (packet.type === "header") this.header = packet.header;
        if (packet.type === "grid") {
            const { first, count } = packet;
            if (first !== nextVertex) throw new CorruptError(`vertices begin at ${first}, expected ${nextVertex}`);
            if (count === 0 || count > header!.vertices - first)
                throw new CorruptError(`${count} vertices from ${first} on`);
            this.nextVertex = first + count;
        }
        if (packet.type === "end" && nextVertex < header!.vertices)
            throw new CorruptError(`the positions end at vertex ${nextVertex} of ${header!.vertices}`);
    }
}
