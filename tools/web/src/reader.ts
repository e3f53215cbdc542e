/** Bytes to packets, without input or output of its own (specification, F 2, F 3, F 5). */
import { FOLLOWERS, FOLLOWERS_IN_SECTIONS, KINDS, PREAMBLE, SHORT } from "./constants";
import { crc16, crc32 } from "./checksums";
import { BsmError, CorruptError, FormatError, TruncatedError, UnsupportedError } from "./errors";
import { CORNER, parseDeclaration, RECOMPUTED, wordsOf, type Declaration } from "./declaration";
import { parseHeader, sectionsOf, type Header, type Section } from "./header";
import { checkLimit, type Limits } from "./limits";
import { parseMap } from "./maps";
import { parseVarint } from "./varint";

/** Nanoseconds of a processor core for reading a frame, whatever it is, and for each of its bytes (M 14.3). */
const [FRAME, BYTE] = [8e3, 8];

/** Is told of work, and of the bytes that ask for it, and may refuse it. */
export type Spend = (work: number, received: number) => void;

export const NEED_DATA = "need data";
export const END_OF_STREAM = "end of stream";
export type Signal = typeof NEED_DATA | typeof END_OF_STREAM;

/** What the author says of a mesh, by names. */
export type Metadata = Map<string, string | number | bigint | Uint8Array>;

export type Packet =
    | { type: "header"; header: Header }
    | { type: "metadata"; entries: Metadata }
    | { type: "connectivity" | "partition" | "order"; data: Uint8Array }
    | { type: "block"; index: number; coefficients: number; data: Uint8Array }
    | { type: "gop"; index: number; data: Uint8Array }
    | { type: "grid"; first: number; count: number; data: Uint8Array }
    | { type: "refinement"; layer: number; first: number; count: number; data: Uint8Array }
    | { type: "attribute"; index: number; declaration: Declaration; seams: Uint8Array }
    | { type: "values"; attribute: number; first: number; count: number; data: Uint8Array }
    | { type: "end"; frames: number; crc: number };

/** Bytes that a tolerant reader skipped: where, how many, what kind of frame they seem to be, and why. */
export interface Damaged {
    type: "damaged";
    kind?: Kind;
    offset: number;
    length: number;
    reason: string;
}

type Kind = Packet["type"];

const MAGIC_SIZE = 4;
const BLOCK_TAG = 6;

type Followers = Record<Kind | "start", readonly Kind[]>;

const ALONE: Followers = FOLLOWERS;
const IN_SECTIONS: Followers = FOLLOWERS_IN_SECTIONS;
const kinds: Record<number, Kind> = KINDS;
const preamble = Uint8Array.from(PREAMBLE);

/** Reads a payload from front to back; what it lacks or has too much is a `CorruptError`. */
export class Cursor {
    private at = 0;

    constructor(private readonly payload: Uint8Array) {}

    varint(): number {
        const parsed = parseVarint(this.payload, this.at, this.payload.length);
        if (!parsed) throw new CorruptError("a payload ends inside a varint");
        this.at = parsed.end;
        return parsed.value;
    }

    take(count: number): Uint8Array {
        if (count > this.payload.length - this.at) throw new CorruptError(`a payload lacks ${count} bytes`);
        this.at += count;
        return this.payload.subarray(this.at - count, this.at);
    }

    rest(): Uint8Array {
        return this.take(this.payload.length - this.at);
    }

    get ended(): boolean {
        return this.at === this.payload.length;
    }

    finish(): void {
        if (this.at !== this.payload.length) throw new CorruptError("a payload has bytes too many");
    }
}

const PARSERS: Record<Kind, (payload: Cursor, limits: Limits) => Packet> = {
    header: (payload, limits) => ({ type: "header", header: parseHeader(payload.rest(), limits) }),
    metadata: (payload, limits) => {
        const data = payload.rest();
        checkLimit(limits, "metadataBytes", data.length);
        const entries: Metadata = new Map();
        for (const [key, value] of parseMap(data)) {
            if (key.type !== "string" || value.type === "array") throw new CorruptError("metadata of a wrong type");
            entries.set(key.value, value.value);
        }
        return { type: "metadata", entries };
    },
    connectivity: (payload) => ({ type: "connectivity", data: payload.rest() }),
    partition: (payload) => ({ type: "partition", data: payload.rest() }),
    order: (payload) => ({ type: "order", data: payload.rest() }),
    block: (payload) => ({ type: "block", index: payload.varint(), coefficients: payload.varint(), data: payload.rest() }),
    gop: (payload) => ({ type: "gop", index: payload.varint(), data: payload.rest() }),
    grid: (payload) => ({ type: "grid", first: payload.varint(), count: payload.varint(), data: payload.rest() }),
    refinement: (payload) => {
        const [layer, first, count] = [payload.varint(), payload.varint(), payload.varint()];
        return { type: "refinement", layer, first, count, data: payload.rest() };
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
    end: (payload) => {
        const frames = payload.varint();
        const crc = payload.take(4);
        payload.finish();
        return { type: "end", frames, crc: littleEndian(crc) };
    },
};

/** What a tag says, and where the frame's payload and the frame end. */
function frameOf(tag: { value: number; end: number }): { type: number; length: number; sum: number; end: number } {
    const type = tag.value % 16;
    const length = Math.floor(tag.value / 16);
    const sum = tag.end + length;
    return { type, length, sum, end: sum + (type === BLOCK_TAG || length < SHORT ? 2 : 4) };
}

function littleEndian(bytes: Uint8Array): number {
    return bytes.reduceRight((value, byte) => value * 256 + byte, 0);
}

/** Everything that may come at any distance behind a packet of a kind. */
function reachable(followers: Followers, kind: Kind | "start"): Kind[] {
    const found = new Set<Kind>();
    const pending = [...followers[kind]];
    for (let next; (next = pending.pop()); ) {
        if (found.has(next)) continue;
        found.add(next);
        pending.push(...followers[next]);
    }
    return [...found];
}

/** Which packet may follow which, and what it must have to agree with the header. */
class Grammar {
    header?: Header;
    /** Whether an unknown number of frames was lost since the run began. */
    lossy = false;
    /** Whether the stream began with a run that was not the first. */
    joined = false;
    private last: Kind | "start" = "start";
    private allowed: readonly Kind[] = ALONE.start;
    private followers = ALONE;
    /** Names of metadata. */
    private readonly told = new Set<string>();
    private sections: Section[] = [];
    /** Sections whose faces were there. */
    private begun = 0;
    private nextBlock = 0;
    private nextFrame = 0;
    private nextVertex = 0;
    private layer = 0;
    private declared = new Map<number, Declaration>();
    private valued = 0;
    private nextValue = 0;

    /** `joining`: whether the first run that comes may be any. */
    constructor(private readonly joining: boolean) {}

    /** Whether the header announces frames of a kind that it must announce (F 3.6). */
    announces(kind: Kind): boolean {
        if (kind === "grid") return !this.header || this.header.grid.length > 0;
        if (kind === "attribute" || kind === "values") return !this.header || this.header.attributes > 0;
        return kind !== "refinement" || !this.header || this.header.refinements.length > 0;
    }

    get ended(): boolean {
        return this.last === "end";
    }

    /** The kinds of packets that may come next. */
    get expected(): readonly Kind[] {
        return this.header && !this.ended ? [...this.allowed, "metadata"] : this.allowed;
    }

    /** Take note that an unknown number of frames is missing here: everything that can come later may come now. */
    lose(): void {
        this.allowed = reachable(this.followers, this.last);
        this.lossy = true;
    }

    /** Throw what is wrong with a packet that comes here. */
    check(packet: Packet): void {
        if (!this.expected.includes(packet.type)) throw new CorruptError(`${packet.type} may not come here`);
        const { header } = this;
        if (packet.type === "header") return this.checkRun(packet.header);
        if (!header) return;
        if (packet.type === "metadata") {
            for (const name of packet.entries.keys()) if (this.told.has(name)) throw new CorruptError(`metadata speak of "${name}" again`);
        }
        this.checkSection(packet);
        if (this.begun === this.sections.length && ["block", "gop", "grid", "values", "end"].includes(packet.type) && this.declared.size < header.attributes && !this.lossy) {
            throw new CorruptError(`${this.declared.size} of ${header.attributes} attributes are declared`);
        }
        if (packet.type === "attribute") this.checkAttribute(packet, header);
        if (packet.type === "values") this.checkValues(packet);
        if (packet.type === "end" && !this.lossy) this.checkComplete();
        if (packet.type === "block") this.checkBlock(packet.index, packet.coefficients, header);
        if (packet.type === "gop") this.checkGop(packet.index, header);
        if (packet.type === "grid") this.checkChunk(packet.first, packet.count, this.nextVertex, header);
        if (packet.type === "refinement") this.checkRefinement(packet, header);
        if (packet.type === "partition" && header.grid.length > 0) throw new CorruptError("parts where there are no blocks");
        if (packet.type === "end" && header.grid.length > 0 && this.nextVertex < header.vertices && !this.lossy) {
            throw new CorruptError(`the positions end at vertex ${this.nextVertex} of ${header.vertices}`);
        }
    }

    /** Take note of a packet that nothing is wrong with. */
    advance(packet: Packet): void {
        if (packet.type === "metadata") {
            for (const name of packet.entries.keys()) this.told.add(name);
            return;
        }
        if (packet.type === "header") this.begin(packet.header);
        if (packet.type === "connectivity") this.begun++;
        if (packet.type === "block") this.nextBlock = packet.index + 1;
        if (packet.type === "gop") this.nextFrame = packet.index + 1;
        if (packet.type === "refinement") this.layer = packet.layer;
        if (packet.type === "attribute") this.declared.set(packet.index, packet.declaration);
        if (packet.type === "values") [this.valued, this.nextValue] = [packet.attribute, packet.first + packet.count];
        if (packet.type === "grid" || packet.type === "refinement") this.nextVertex = packet.first + packet.count;
        this.last = packet.type;
        this.allowed = packet.type === "header" && packet.header.again > 0 ? ["gop"] : this.followers[packet.type];
    }

    /** Forget what belongs to the mesh of the run before. */
    private begin(header: Header): void {
        this.joined ||= !this.header && header.run > 0;
        this.header = header;
        this.sections = sectionsOf(header);
        if (this.sections.length > 1) this.followers = IN_SECTIONS;
        [this.begun, this.nextBlock, this.nextVertex, this.layer, this.valued, this.nextValue] = [header.again > 0 ? 1 : 0, 0, 0, 0, 0, 0];
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

    /** Refuse what has no place in the present section, or comes where one is not whole. */
    private checkSection(packet: Packet): void {
        const { begun, sections, lossy } = this;
        const { first, blocks } = sections[begun - 1] ?? { first: 0, blocks: 0 };
        const wrong =
            packet.type === "connectivity" ? begun === sections.length || (this.nextBlock < blocks && !lossy)
            : packet.type === "block" ? begun > 0 && (packet.index < first || (packet.index >= blocks && !lossy))
            : begun < sections.length && !lossy && ["attribute", "refinement", "values", "end"].includes(packet.type);
        if (wrong) throw new CorruptError(`${packet.type} may not come in section ${begun} of ${sections.length}`);
    }

    private checkAttribute({ index, declaration, seams }: Extract<Packet, { type: "attribute" }>, header: Header): void {
        const others = [...this.declared.values()];
        const following = Math.max(-1, ...this.declared.keys()) + 1;
        if (index < following || (index > following && !this.lossy) || index >= header.attributes) {
            throw new CorruptError(`attribute ${index} of ${header.attributes}, where attribute ${following} must follow`);
        }
        const { name, domain, seamsOf, leans, coding } = declaration;
        if (others.some((other) => other.name === name)) throw new CorruptError(`a second attribute is called "${name}"`);
        if (seams.length > 0 && (domain !== CORNER || seamsOf)) throw new CorruptError("seams of an attribute that has none of its own");
        if (seamsOf) {
            const shared = this.declared.get(seamsOf - 1);
            if (!shared && !(this.lossy && seamsOf <= index)) throw new CorruptError(`the seams of attribute ${seamsOf - 1}, which does not come before`);
            if (shared && (shared.domain !== CORNER || shared.seamsOf)) throw new CorruptError(`the seams of attribute ${seamsOf - 1}, which has none of its own`);
        }
        if (leans && header.grid.length === 0) throw new CorruptError("an attribute that leans on positions which are on no grid");
        if (header.gopFrames > 0 && coding === RECOMPUTED) throw new CorruptError("an attribute of a sequence that is recomputed from positions");
    }

    private checkValues({ attribute, first, count }: Extract<Packet, { type: "values" }>): void {
        const declared = this.declared.get(attribute);
        if (!declared) throw new CorruptError(`values of attribute ${attribute}, which is not declared`);
        if (attribute < this.valued) throw new CorruptError(`values of attribute ${attribute} come behind those of ${this.valued}; they must ascend`);
        const following = attribute === this.valued ? this.nextValue : 0;
        if (first < following || (first > following && !this.lossy)) throw new CorruptError(`values from ${first} on where those from ${following} on must follow`);
        if (count === 0 || count > declared.rows - first) throw new CorruptError(`${count} values from ${first} on, of ${declared.rows}`);
        if (attribute > this.valued && !this.lossy) this.checkComplete(attribute);
    }

    /** Check that the values of all attributes are there, or of those before one. */
    private checkComplete(before = Infinity): void {
        for (const [index, { rows }] of this.declared) {
            const done = index < this.valued ? rows : index === this.valued ? this.nextValue : 0;
            if (index < before && done < rows) throw new CorruptError(`the values of attribute ${index} end at ${done} of ${rows}`);
        }
    }

    private checkRefinement(packet: Extract<Packet, { type: "refinement" }>, header: Header): void {
        const layers = header.refinements.length / 2;
        if (packet.layer >= layers) throw new CorruptError(`layer ${packet.layer} of ${layers}`);
        if (packet.layer < this.layer) throw new CorruptError("layers must ascend");
        this.checkChunk(packet.first, packet.count, packet.layer > this.layer ? 0 : this.nextVertex, header);
    }

    private checkChunk(first: number, count: number, following: number, header: Header): void {
        if (first < following || (first > following && !this.lossy)) {
            throw new CorruptError(`vertices from ${first} on where those from ${following} on must follow`);
        }
        if (count === 0 || count > header.vertices - first) throw new CorruptError(`${count} vertices from ${first} on`);
    }

    private checkBlock(index: number, coefficients: number, header: Header): void {
        if (index < this.nextBlock) throw new CorruptError("the indices of blocks must ascend");
        if (index >= header.blocks) throw new CorruptError(`block ${index} of ${header.blocks}`);
        if (coefficients > header.coefficients) throw new CorruptError(`${coefficients} coefficients are too many`);
    }

    private checkGop(index: number, header: Header): void {
        if (index < this.nextFrame) throw new CorruptError("the indices of GOPs must ascend");
        if (header.gopFrames === 0) throw new CorruptError("a GOP in the stream of a static mesh");
        if (header.frames > 0 && index >= header.frames) throw new CorruptError(`a GOP from frame ${index} on`);
    }
}

/** Strict: the first thing wrong is thrown, and thrown again by every later call. */
export class Reader {
    protected begin = 0;
    protected end = 0;
    protected eof = false;
    protected readonly grammar: Grammar;
    /** Whether anything was lost. */
    private damaged = false;
    private buffer = new Uint8Array(0);
    private offset = 0;
    private frames = 0;
    private crc = 0;
    /** Bytes of metadata. */
    private told = 0;
    private started = false;
    private error?: BsmError;

    constructor(
        private readonly limits: Limits,
        protected readonly spend: Spend,
        joining = false,
    ) {
        this.grammar = new Grammar(joining);
    }

    /** Take more bytes of the stream, any number of them. */
    receiveData(data: Uint8Array): void {
        if (this.eof) throw new Error("bytes were given to a reader after receiveEof");
        if (this.error || data.length === 0) return;
        if (this.end + data.length > this.buffer.length) this.makeRoom(data.length);
        this.buffer.set(data, this.end);
        this.end += data.length;
    }

    /** Take note that no more bytes will come. */
    receiveEof(): void {
        this.eof = true;
    }

    /** Where the packet given last ended, in bytes of the stream. */
    get position(): number {
        return this.offset;
    }

    /** The next packet, `NEED_DATA`, or `END_OF_STREAM` after END and `receiveEof`. */
    nextPacket(): Packet | Damaged | Signal {
        if (this.error) throw this.error;
        try {
            return this.next();
        } catch (error) {
            if (error instanceof BsmError) {
                this.error = error.located({ offset: this.offset, frame: this.started ? this.frames : undefined });
                this.buffer = new Uint8Array(0);
            }
            throw error;
        }
    }

    private makeRoom(count: number): void {
        const size = this.end - this.begin;
        const grown = size + count > this.buffer.length / 2 ? new Uint8Array(2 * (size + count) + 1024) : this.buffer;
        grown.set(this.buffer.subarray(this.begin, this.end));
        this.buffer = grown;
        this.begin = 0;
        this.end = size;
    }

    protected next(): Packet | Damaged | Signal {
        if (!this.started && !this.start()) return NEED_DATA;
        while (!this.grammar.ended) {
            const frame = this.frame();
            if (!frame) return this.incomplete();
            this.pay(FRAME + BYTE * frame.size, frame.size);
            const packet = this.parse(frame.type, frame.payload);
            if (packet) this.grammar.advance(packet);
            if (packet?.type === "metadata") this.told += frame.payload.length;
            this.crc = crc32(this.buffer.subarray(this.begin, this.begin + frame.size), this.crc);
            this.skip(frame.size);
            if (packet) return packet;
        }
        if (this.end > this.begin) throw new CorruptError("bytes behind END");
        return this.eof ? END_OF_STREAM : NEED_DATA;
    }

    /** Spend; what there is no more work for is no damage. */
    protected pay(work: number, received: number): void {
        this.spend(work, received);
    }

    private start(): boolean {
        const present = this.buffer.subarray(this.begin, Math.min(this.end, this.begin + preamble.length));
        for (let i = 0; i < present.length; i++) {
            if (present[i] === preamble[i]) continue;
            if (i < MAGIC_SIZE) throw new FormatError("not a BSM stream: it does not begin with 89 42 53 4D", { offset: 0 });
            throw new UnsupportedError(`stream version ${present[i]} is not one that this decoder reads`, { offset: i });
        }
        if (present.length < preamble.length) {
            this.incomplete();
            return false;
        }
        this.crc = crc32(preamble);
        this.drop(preamble.length);
        this.started = true;
        return true;
    }

    private incomplete(): Signal {
        if (!this.eof) return NEED_DATA;
        throw new TruncatedError("the stream ends before its END frame; get the rest of it", {
            offset: this.offset + this.end - this.begin,
        });
    }

    /** The frame `ahead` bytes from here; undefined if it is not complete. */
    protected frame(ahead = 0): { type: number; payload: Uint8Array; size: number } | undefined {
        const start = this.begin + ahead;
        const tag = parseVarint(this.buffer, start, this.end);
        if (!tag) return undefined;
        const { type, length, sum, end } = frameOf(tag);
        checkLimit(this.limits, "frameBytes", length);
        if (end > this.end) return undefined;
        const body = this.buffer.subarray(start, sum);
        const expected = end - sum === 2 ? crc16(body) : crc32(body);
        if (littleEndian(this.buffer.subarray(sum, end)) !== expected) {
            throw new CorruptError(`the checksum of a frame of type ${type} and ${length} bytes is wrong`);
        }
        return { type, payload: this.buffer.slice(tag.end, sum), size: end - start };
    }

    /** What the tag of the frame `ahead` bytes from here says, if it can be read: kind and bytes of the whole frame. */
    protected tagAt(ahead: number): { kind?: Kind; size: number } | undefined {
        try {
            const tag = parseVarint(this.buffer, this.begin + ahead, this.end);
            if (!tag) return undefined;
            const { type, end } = frameOf(tag);
            return { kind: kinds[type], size: end - this.begin - ahead };
        } catch (error) {
            if (error instanceof BsmError) return undefined;
            throw error;
        }
    }

    /** The packet in a frame, checked against everything before it; undefined for one to be skipped. */
    protected parse(type: number, payload: Uint8Array): Packet | undefined {
        if (type >= 8 && type <= 11) {
            if (!this.grammar.header) throw new CorruptError("the first frame must be HEADER");
            return undefined;
        }
        const kind = kinds[type];
        if (!kind || !this.grammar.announces(kind)) throw new UnsupportedError(`frame type ${type} is unknown to this decoder`);
        const packet = PARSERS[kind](new Cursor(payload), this.limits);
        this.grammar.check(packet);
        if (kind === "metadata") checkLimit(this.limits, "metadataBytes", this.told + payload.length);
        if (packet.type === "end" && !this.damaged && !this.grammar.joined) {
            if (packet.frames !== this.frames) throw new CorruptError(`END counts ${packet.frames} frames before it`);
            if (packet.crc !== this.crc) throw new CorruptError("the CRC-32 of the whole stream is wrong");
        }
        return packet;
    }

    /** Take note that an unknown number of frames is missing here. */
    protected lose(): void {
        this.damaged = true;
        this.grammar.lose();
    }

    /** Leave one frame, or bytes that cannot be read, behind. */
    protected skip(count: number): void {
        this.frames++;
        this.drop(count);
    }

    private drop(count: number): void {
        this.begin += count;
        this.offset += count;
    }
}
