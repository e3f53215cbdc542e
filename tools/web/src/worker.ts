/** What runs in the thread of a decoder. */
import { Decoder, END_OF_STREAM, NEED_DATA } from "./decoder";
import { BsmError } from "./errors";
import { Kernels } from "./kernels";
import type { Answer, Order } from "./thread";

let decoder: Decoder;
let taken = 0;
let over = false;

function answer(message: Answer, moved: Transferable[] = []): void {
    self.postMessage(message, { transfer: moved });
}

/** Say everything that is known now. */
function tell(): void {
    for (let event; (event = decoder.nextEvent()) !== NEED_DATA && event !== END_OF_STREAM; ) {
        if (typeof event === "string") continue;
        if (event.type === "frame") {
            const positions = Float32Array.from(event.positions);
            answer({ event: { ...event, positions } }, [positions.buffer]);
        } else answer({ event });
    }
    answer({ taken });
}

function obey(order: Order): void {
    if (order === null) decoder.receiveEof();
    else if (order instanceof Uint8Array) {
        decoder.receiveData(order);
        taken += order.length;
    } else {
        decoder = new Decoder(new Kernels(order.kernels), order.limits, order.wishes);
        return;
    }
    tell();
}

self.onmessage = ({ data }: MessageEvent<Order>) => {
    if (over) return;
    try {
        obey(data);
    } catch (error) {
        over = true;
        if (error instanceof BsmError) answer({ problem: error.described });
        else answer({ fault: `${error}` });
    }
};
