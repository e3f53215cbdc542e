/** The bytes of a stream that have arrived, and how many of them are decoded; the settings stop or slow the stream. */
import type { BSMGeometry } from "../geometry";
import type { StreamDecoding } from "../pool";
import { counted, spent } from "./facts";
import type { Form } from "./form";

export class Arrival {
    length = 0;
    whole = false;
    fed = 0;
    /** Milliseconds from the beginning to the first faces and to the end. */
    first?: number;
    complete?: number;
    private stream = new Uint8Array(0); // with room for more
    private ended = false;
    private started = 0;
    private readonly cut: HTMLInputElement;
    private readonly rate: HTMLInputElement;

    constructor(private readonly form: Form) {
        [this.cut, this.rate] = [form.control("cut"), form.control("rate")];
    }

    clear(): void {
        [this.stream, this.length, this.whole] = [new Uint8Array(0), 0, false];
        this.cut.max = this.cut.value = "0";
    }

    receive(bytes: Uint8Array): void {
        const length = this.length + bytes.length;
        if (length > this.stream.length) {
            const stream = new Uint8Array(Math.max(length, 2 * this.stream.length));
            stream.set(this.bytes);
            this.stream = stream;
        }
        this.stream.set(bytes, this.length);
        const all = this.cut.value === this.cut.max;
        this.length = length;
        this.cut.max = String(length);
        if (all) this.cut.value = this.cut.max;
    }

    get bytes(): Uint8Array {
        return this.stream.subarray(0, this.length);
    }

    /** Decode from the first byte on. */
    restart(): void {
        [this.fed, this.ended, this.started] = [0, false, performance.now()];
        this.first = this.complete = undefined;
    }

    /** Whether the stream is cut before bytes that are decoded already. */
    get isCut(): boolean {
        return Number(this.cut.value) < this.fed;
    }

    get passed(): number {
        return performance.now() - this.started;
    }

    feed(decoding: StreamDecoding | undefined, over: boolean): void {
        const rate = Number(this.rate.value);
        const allowed = Math.floor(Math.min(Number(this.cut.value), rate > 0 ? (rate * this.passed) / 8e-3 : Infinity));
        if (!over && this.fed < allowed) {
            decoding?.receiveData(this.stream.subarray(this.fed, allowed));
            this.fed = allowed;
        }
        if (!this.whole || this.ended || this.fed < this.length) return;
        this.ended = true;
        decoding?.receiveEof();
    }

    report(geometry: BSMGeometry, missed: number): void {
        const { form, fed, length, first, complete } = this;
        const share = length ? Math.round((100 * fed) / length) : 0;
        const more = this.whole ? "" : ", more to come";
        form.say("bytes", `${counted(fed)} of ${counted(length)} bytes (${share} %)${more}`);
        form.say("status", statusOf(geometry, missed));
        const after = (what: string, time?: number): string[] =>
            time === undefined ? [] : [`${what} after ${spent(time)}`];
        form.say("times", [...after("first faces", first), ...after("complete", complete)].join("; "));
        form.root.dataset.blocks = String(geometry.blocks);
    }
}

function statusOf({ header, blocks, carried }: BSMGeometry, missed: number): string {
    if (!header) return "";
    const parts = header.blocks ? `${blocks} of ${header.blocks} blocks` : `${blocks} chunks of a grid`;
    const entered = missed > 0 ? `, entered at frame ${missed + 1}` : "";
    const frames = header.gopFrames > 0 ? `, ${header.frames || "any number of"} frames${entered}` : "";
    const attributes = header.attributes > 0 ? `, ${carried.length} of ${header.attributes} attributes` : "";
    return `${parts}, ${counted(header.vertices)} vertices${frames}${attributes}`;
}
