/** A reader that goes on behind damage (specification, F 8). */
import { BsmError } from "./errors";
import type { Limits } from "./limits";
import type { Kind } from "./packets";
import { END_OF_STREAM, frameOf, kinds, NEED_DATA, Reader, type Damaged, type Packet, type Signal, type Spend } from "./reader";
import { parseVarint } from "./varint";

const SCAN_BYTES = 2 ** 20;
const SCAN_FACTOR = 64;
/** Places that are looked at before they are paid for again. */
const STRIDE = 4096;
/** Nanoseconds of looking for a frame at one place, and of looking into one whose checksum is right. */
const [PLACE, MAP] = [4e3, 6e5];

/** Bytes that cannot be read, at the buffer's start, while what follows them is looked for. */
interface Damage {
    reason: string;
    kind?: Damaged["kind"];
    /** Places from which to look, the last one first, and whether frames should stand there one behind the other. */
    ways: [place: number, sure: boolean][];
    place: number;
    sure: boolean;
}

/**
 * Gives `Damaged` where a `Reader` throws, and goes on with what depends on nothing that is lost.
 *
 * Damage to the preamble or to the header is still thrown. The checksums computed while frames are searched for cover at
 * most so many bytes plus so many times the bytes received; a candidate beyond that is passed over.
 */
export class TolerantReader extends Reader {
    private damage?: Damage;
    private scanWork = 0;
    private behindDamage = false;
    private refused?: BsmError;

    constructor(limits: Limits, spend: Spend) {
        super(limits, spend, true);
    }

    protected override pay(work: number, received: number): void {
        try {
            super.pay(work, received);
        } catch (error) {
            if (error instanceof BsmError) this.refused = error;
            throw error;
        }
    }

    protected override next(): Packet | Damaged | Signal {
        if (this.behindDamage && this.eof && this.begin === this.end) return END_OF_STREAM;
        if (!this.damage) {
            try {
                const packet = super.next();
                this.behindDamage &&= packet === NEED_DATA;
                return packet;
            } catch (error) {
                if (!(error instanceof BsmError) || !this.grammar.header || error === this.refused) throw error;
                this.damage = this.inspect(error);
            }
        }
        return this.recover(this.damage);
    }

    private inspect(error: BsmError): Damage {
        this.damaged = true;
        this.grammar.lose();
        const seen = this.tagAt(0);
        const ways: Damage["ways"] = [[1, false]];
        if (seen && seen.size <= this.end - this.begin) ways.push([seen.size, true]);
        return { reason: error.problem, kind: seen?.kind, ways, place: 0, sure: true };
    }

    /** Report the damage once it is known how far it reaches. */
    private recover(damage: Damage): Damaged | Signal {
        const length = this.reach(damage);
        if (length === undefined) return NEED_DATA;
        this.damage = undefined;
        this.behindDamage = true;
        const found: Damaged = { type: "damaged", kind: length > 0 ? damage.kind : "end", offset: this.position, length, reason: damage.reason };
        this.skip(length);
        return found;
    }

    /** Bytes up to where reading goes on, or to the end of the data; undefined if more data must come first. */
    private reach(damage: Damage): number | undefined {
        const available = this.end - this.begin;
        while (!this.grammar.ended && (damage.ways.length > 0 || damage.place < available)) {
            if (damage.place % STRIDE === 1) this.pay(PLACE * STRIDE, STRIDE);
            const step = this.step(damage.place, damage.sure);
            if (step === undefined) return undefined;
            if (step === 0) return damage.place;
            if (step > 1) {
                damage.place += step;
                damage.ways = [];
            } else [damage.place, damage.sure] = damage.ways.pop() ?? [damage.place + 1, false];
        }
        return this.eof || this.grammar.ended ? available : undefined;
    }

    /** Bytes of the frame at `place`; 0: reading goes on there, 1: there is none, undefined: more data must come first. */
    private step(place: number, sure: boolean): number | undefined {
        const available = this.end - this.begin;
        const expects = (kind?: Kind): boolean => kind !== undefined && this.grammar.expected.includes(kind);
        try {
            const seen = this.tagAt(place);
            if (seen) {
                const budget = SCAN_BYTES + SCAN_FACTOR * (this.position + available);
                if (this.scanWork + seen.size > budget || !(sure || expects(seen.kind))) return 1;
                if (place + seen.size <= available) this.scanWork += seen.size;
            }
            const frame = this.frame(place);
            if (!frame) return this.eof ? 1 : undefined;
            if (place === 0 || !expects(kinds[frame.type])) return frame.size;
            this.pay(MAP, 0);
            try {
                this.parse(frame.type, frame.payload);
                return 0;
            } catch (error) {
                if (error instanceof BsmError) return frame.size;
                throw error;
            }
        } catch (error) {
            if (!(error instanceof BsmError) || error === this.refused) throw error;
            return 1;
        }
    }

    /** What the tag of the frame `ahead` bytes from here says, if it can be read: kind and bytes of the whole frame. */
    private tagAt(ahead: number): { kind?: Kind; size: number } | undefined {
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
}
