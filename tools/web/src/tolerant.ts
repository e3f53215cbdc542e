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

/** What is known of the damage at the buffer's start while its end is looked for. */
interface Damage {
    reason: string;
    kind?: Damaged["kind"];
    /** Bytes of the frame by its tag, if that can be read. */
    size?: number;
    /** Whether the checksum is right, and so the length in the tag too. */
    whole: boolean;
    /** Offset before which no frame begins; 0 while the length in the tag is not refuted. */
    scanned: number;
}

/**
 * Gives `Damaged` where a `Reader` throws, and goes on with the next frame that is whole.
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
        this.lose();
        const seen = this.tagAt(0);
        let whole = false;
        try {
            whole = this.frame() !== undefined;
        } catch (problem) {
            if (!(problem instanceof BsmError)) throw problem;
        }
        return { reason: error.problem, kind: seen?.kind, size: seen?.size, whole, scanned: 0 };
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

    /** Bytes up to the next whole frame or the end of the data; undefined if more data must come first. */
    private reach(damage: Damage): number | undefined {
        const available = this.end - this.begin;
        if (this.grammar.ended) return available;
        if (damage.size !== undefined && damage.size <= available && damage.scanned === 0) {
            if (damage.whole) return damage.size;
            const fits = this.fits(damage.size);
            if (fits !== false) return fits ? damage.size : undefined;
        }
        for (let start = Math.max(damage.scanned, 1); start < available; start++) {
            if (start % STRIDE === 1) this.pay(PLACE * STRIDE, STRIDE);
            damage.scanned = start;
            const fits = this.fits(start);
            if (fits !== false) return fits ? start : undefined;
        }
        return this.eof ? available : undefined;
    }

    /** Whether a whole frame that may come here begins at `start`; undefined if more data must come first. */
    private fits(start: number): boolean | undefined {
        const available = this.end - this.begin;
        try {
            const seen = this.tagAt(start);
            if (seen) {
                const budget = SCAN_BYTES + SCAN_FACTOR * (this.position + available);
                if (!seen.kind || !this.grammar.expected.includes(seen.kind) || this.scanWork + seen.size > budget) return false;
                if (start + seen.size <= available) this.scanWork += seen.size;
            }
            const frame = this.frame(start);
            if (frame) {
                this.pay(MAP, 0);
                this.parse(frame.type, frame.payload);
                return true;
            }
        } catch (error) {
            if (!(error instanceof BsmError) || error === this.refused) throw error;
            return false;
        }
        return this.eof ? false : undefined;
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

    /** Take note that an unknown number of frames is missing here. */
    private lose(): void {
        this.damaged = true;
        this.grammar.lose();
    }
}
