/** Which packets there are, and which may follow which (specification, F 5). */
import { FOLLOWERS } from "./constants";
import { CorruptError } from "./errors";
import { CORNER, parseDeclaration, RECOMPUTED, wordsOf, type Declaration } from "./declaration";
import type { Header } from "./header";
import { checkLimit } from "./limits";
import { checkChunk, checkNames, checkWhole, COMMON, type Kind, type Packet, type Parsers } from "./packets";

/** Kinds of packets that may follow one of a kind. */
const AFTER: Record<Kind | "start", readonly Kind[]> = FOLLOWERS;

export const PARSERS: Parsers = {
    ...COMMON,
    partition: (payload) => ({ type: "partition", data: payload.rest() }),
    block: (payload) => ({ type: "block", index: payload.varint(), coefficients: payload.varint(), data: payload.rest() }),
    gop: (payload) => ({ type: "gop", index: payload.varint(), data: payload.rest() }),
    refinement: (payload) => {
        const [first, count] = [payload.varint(), payload.varint()];
        return { type: "refinement", first, count, data: payload.rest() };
    },
    attribute: (payload, limits) => {
        const index = payload.varint();
        const declaration = parseDeclaration(payload.take(payload.varint()));
        checkLimit(limits, "attributeValues", declaration.rows * Math.max(1, wordsOf(declaration)));
        return { type: "attribute", index, declaration, seams: payload.rest() };
    },
    values: (payload) => {
        const [attribute, first, count] = [payload.varint(), payload.varint(), payload.varint()];
        return { type: "values", attribute, first, count, data: payload.rest() };
    },
};

/** What reading may go on with behind damage (F 8.2), if it depends on nothing that is lost. */
const RESUMING: readonly Kind[] = ["block", "gop", "grid", "refinement", "header", "end"];

/** Everything that may come at any distance behind a packet of a kind. */
function reachable(kind: Kind | "start"): Kind[] {
    const found = new Set<Kind>();
    const pending = [...AFTER[kind]];
    for (let next; (next = pending.pop()); ) {
        if (found.has(next)) continue;
        found.add(next);
        pending.push(...AFTER[next]);
    }
    return [...found];
}

/** Which packet may follow which, and what it must have to agree with the header. */
export class Grammar {
    header?: Header;
    /** Whether an unknown number of frames was lost since the run began. */
    lossy = false;
    private resuming = false;
    /** Whether the stream began with a run that was not the first. */
    joined = false;
    private last: Kind | "start" = "start";
    private allowed = AFTER.start;
    /** Names of metadata. */
    private readonly told = new Set<string>();
    private nextBlock = 0;
    private nextFrame = 0;
    private nextVertex = 0;
    private declared = new Map<number, Declaration>();
    private valued = 0;
    private nextValue = 0;

    /** `joining`: whether the first run that comes may be any. */
    constructor(private readonly joining: boolean) {}

    /** Whether the header announces frames of a kind that it must announce (F 3.6). */
    announces(kind: Kind): boolean {
        if (kind === "grid") return !this.header || this.header.grid.length > 0;
        if (kind === "attribute" || kind === "values") return !this.header || this.header.attributes > 0;
        return kind !== "refinement" || !this.header || this.header.refinement.length > 0;
    }

    get ended(): boolean {
        return this.last === "end";
    }

    /** The kinds of packets that may come next. */
    get expected(): readonly Kind[] {
        return this.header && !this.ended && !this.resuming ? [...this.allowed, "metadata"] : this.allowed;
    }

    /** Take note that an unknown number of frames is missing here: what does not depend on them may come now. */
    lose(): void {
        this.allowed = reachable(this.last).filter((kind) => RESUMING.includes(kind));
        this.lossy = this.resuming = true;
    }

    /** Throw what is wrong with a packet that comes here. */
    check(packet: Packet): void {
        if (!this.expected.includes(packet.type)) throw new CorruptError(`${packet.type} may not come here`);
        const { header } = this;
        if (packet.type === "header") return this.checkRun(packet.header);
        if (!header) return;
        if (packet.type === "metadata") checkNames(packet.entries, this.told);
        if (["block", "gop", "grid", "values", "end"].includes(packet.type) && this.declared.size < header.attributes && !this.lossy) {
            throw new CorruptError(`${this.declared.size} of ${header.attributes} attributes are declared`);
        }
        if (packet.type === "attribute") this.checkAttribute(packet, header);
        if (packet.type === "values") this.checkValues(packet);
        if (packet.type === "end" && !this.lossy) this.checkComplete();
        if (packet.type === "block") this.checkBlock(packet.index, packet.coefficients, header);
        if (packet.type === "gop") this.checkGop(packet.index, header);
        if (packet.type === "grid" || packet.type === "refinement") checkChunk(packet, this.nextVertex, header);
        if (packet.type === "partition" && header.grid.length > 0) throw new CorruptError("parts where there are no blocks");
        if (packet.type === "end" && header.grid.length > 0 && !this.lossy) checkWhole(this.nextVertex, header);
    }

    /** Take note of a packet that nothing is wrong with. */
    advance(packet: Packet): void {
        if (packet.type === "metadata") {
            for (const name of packet.entries.keys()) this.told.add(name);
            return;
        }
        if (packet.type === "header") this.begin(packet.header);
        if (packet.type === "block") this.nextBlock = packet.index + 1;
        if (packet.type === "gop") this.nextFrame = packet.index + 1;
        if (packet.type === "attribute") this.declared.set(packet.index, packet.declaration);
        if (packet.type === "values") [this.valued, this.nextValue] = [packet.attribute, packet.first + packet.count];
        if (packet.type === "grid" || packet.type === "refinement") this.nextVertex = packet.first + packet.count;
        this.last = packet.type;
        this.resuming = false;
        this.allowed = packet.type === "header" && packet.header.again !== undefined ? ["gop"] : AFTER[packet.type];
    }

    /** Forget what belongs to the mesh of the run before. */
    private begin(header: Header): void {
        this.joined ||= !this.header && header.run > 0;
        this.header = header;
        [this.nextBlock, this.nextVertex, this.valued, this.nextValue] = [0, 0, 0, 0];
        this.declared = new Map();
        this.lossy = false;
    }

    private checkRun({ run, frames, gopFrames }: Header): void {
        const before = this.header;
        if (!before) {
            if (run > 0 && !this.joining) throw new CorruptError("the stream begins within a sequence; a tolerant decoder joins it there");
            return;
        }
        if (before.gopFrames * gopFrames === 0) throw new CorruptError("a second header of a static mesh");
        if (run <= before.run || (run > before.run + 1 && !this.lossy)) throw new CorruptError(`run ${run} where run ${before.run + 1} must follow`);
        if (frames !== before.frames) throw new CorruptError(`a run of a sequence of ${frames} frames in one of ${before.frames}`);
        if (!this.lossy) this.checkComplete();
    }

    private checkAttribute({ index, declaration, seams }: Extract<Packet, { type: "attribute" }>, header: Header): void {
        const others = [...this.declared.values()];
        const following = this.declared.size;
        if (index !== following || index >= header.attributes) {
            throw new CorruptError(`attribute ${index} of ${header.attributes}, where attribute ${following} must follow`);
        }
        const { name, domain, seamsOf, leans, coding } = declaration;
        if (others.some((other) => other.name === name)) throw new CorruptError(`a second attribute is called "${name}"`);
        if (seams.length > 0 && (domain !== CORNER || seamsOf)) throw new CorruptError("seams of an attribute that has none of its own");
        if (seamsOf) {
            const shared = this.declared.get(seamsOf - 1);
            if (!shared) throw new CorruptError(`the seams of attribute ${seamsOf - 1}, which does not come before`);
            if (shared.domain !== CORNER || shared.seamsOf) throw new CorruptError(`the seams of attribute ${seamsOf - 1}, which has none of its own`);
        }
        if (leans && header.grid.length === 0) throw new CorruptError("an attribute that leans on positions which are on no grid");
        if (header.gopFrames > 0 && coding === RECOMPUTED) throw new CorruptError("an attribute of a sequence that is recomputed from positions");
    }

    private checkValues({ attribute, first, count }: Extract<Packet, { type: "values" }>): void {
        const declared = this.declared.get(attribute);
        if (!declared) throw new CorruptError(`values of attribute ${attribute}, which is not declared`);
        if (attribute < this.valued) throw new CorruptError(`values of attribute ${attribute} come behind those of ${this.valued}; they must ascend`);
        const following = attribute === this.valued ? this.nextValue : 0;
        if (first !== following) throw new CorruptError(`values from ${first} on where those from ${following} on must follow`);
        if (count === 0 || count > declared.rows - first) throw new CorruptError(`${count} values from ${first} on, of ${declared.rows}`);
        if (attribute > this.valued) this.checkComplete(attribute);
    }

    /** Check that the values of all attributes are there, or of those before one. */
    private checkComplete(before = Infinity): void {
        for (const [index, { rows }] of this.declared) {
            const done = index < this.valued ? rows : index === this.valued ? this.nextValue : 0;
            if (index < before && done < rows) throw new CorruptError(`the values of attribute ${index} end at ${done} of ${rows}`);
        }
    }

    private checkBlock(index: number, coefficients: number, header: Header): void {
        if (index < this.nextBlock) throw new CorruptError("the indices of blocks must ascend");
        if (index >= header.blocks) throw new CorruptError(`block ${index} of ${header.blocks}`);
        if (this.resuming && index % (header.keyInterval || header.blocks) > 0) throw new CorruptError(`block ${index} depends on one that is lost`);
        if (coefficients > header.coefficients) throw new CorruptError(`${coefficients} coefficients are too many`);
    }

    private checkGop(index: number, header: Header): void {
        if (index < this.nextFrame) throw new CorruptError("the indices of GOPs must ascend");
        if (header.gopFrames === 0) throw new CorruptError("a GOP in the stream of a static mesh");
        if (header.frames > 0 && index >= header.frames) throw new CorruptError(`a GOP from frame ${index} on`);
    }
}
