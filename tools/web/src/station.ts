/** A decoder that says what it decodes, and has helpers where that is worthwhile. */
import { Decoder, END_OF_STREAM, NEED_BLOCK, NEED_DATA } from "./decoder";
import type { Desk, Say, Start } from "./desk";
import type { Header } from "./header";
import type { SharedBlock } from "./helper";
import { Kernels } from "./kernels";
import { helpersFor, Team } from "./team";

export class DecodersDesk implements Desk {
    private readonly decoder: Decoder;
    private taken = 0;
    /** All pieces, until the header tells whether there will be helpers. */
    private pieces?: (Uint8Array | null)[] = [];
    private team?: Team;
    /** Why no more blocks come. */
    private over?: string;

    constructor(
        private readonly start: Start,
        private readonly say: Say,
        private readonly guarded: (work: () => void) => void,
    ) {
        const { kernels, limits, tolerant } = start;
        this.decoder = new Decoder(new Kernels(kernels), limits, { tolerant, helpers: (header) => this.findHelpers(header) });
    }

    take(data: Uint8Array | null): void {
        this.pieces?.push(data);
        this.pass(data);
        if (data) this.decoder.receiveData(data);
        else this.decoder.receiveEof();
        this.taken += data?.length ?? 0;
        this.tell();
    }

    private findHelpers(header: Header): number {
        const pieces = this.pieces!;
        const count = helpersFor(header, this.start.worthwhile);
        this.pieces = undefined;
        if (count === 0) return 0;
        this.team = new Team(count);
        const onBlock = (shared: SharedBlock): void =>
            this.guarded(() => {
                this.decoder.receiveBlock(shared);
                this.tell();
            });
        const onOver = (why: string): void =>
            this.guarded(() => {
                this.over = why;
                this.tell();
            });
        const found = this.team.begin(this.start, count, { onBlock, onOver });
        for (const piece of pieces) this.pass(piece);
        return found;
    }

    private pass(data: Uint8Array | null): void {
        if (data) this.team?.receiveData(data);
        else this.team?.receiveEof();
    }

    /** Say everything that is known now. */
    private tell(): void {
        for (let event; (event = this.decoder.nextEvent()) !== NEED_BLOCK; ) {
            if (event === NEED_DATA || event === END_OF_STREAM) {
                if (event === END_OF_STREAM) this.team?.close();
                return this.say({ taken: this.taken });
            }
            if (event.type === "frame") {
                const positions = Float32Array.from(event.positions);
                this.say({ event: { ...event, positions } }, [positions.buffer]);
            } else this.say({ event });
        }
        if (this.over !== undefined) throw new Error(`a block does not come: ${this.over}`);
    }
}
