/** Threads that help a decoder: each decodes some of the chains of the stream. */
import type { Header } from "./header";
import type { SharedBlock } from "./share";
import type { Reply, Order, Start } from "./worker";
import { processors, WORTHWHILE } from "./threads";

const MOST = 3;
/** A team has a line of its own to each thread, with one stream on it. */
const TASK = 0;

/** How many helpers have something to do; none for blocks of fewer vertices than are worthwhile. */
export function helpersFor(header: Header, worthwhile = WORTHWHILE): number {
    if (header.blocks * header.blockSize < worthwhile) return 0;
    const chains = Math.ceil(header.blocks / (header.keyInterval || header.blocks)); // M 10.1
    return Math.max(0, Math.min(chains, processors(), MOST + 1) - 1);
}

/** Lines to threads that run `serve`, with which a stream is shared: each takes all of its bytes. */
export class Team {
    private busy: number;

    constructor(
        private readonly members: MessagePort[],
        start: Omit<Start, "share" | "helpers">,
        private readonly listener: { onBlock: (shared: SharedBlock) => void; onOver: (why: string) => void },
    ) {
        this.busy = members.length;
        members.forEach((member, k) => {
            const share = { number: k + 1, among: 1 + members.length };
            member.onmessage = ({ data }: MessageEvent<Reply>) => this.hear(data);
            member.postMessage({ task: TASK, start: { ...start, share } } satisfies Order);
        });
    }

    take(data: Uint8Array | null): void {
        for (const member of this.members) member.postMessage({ task: TASK, data } satisfies Order);
    }

    close(): void {
        for (const member of this.members) {
            member.postMessage({ task: TASK, stop: true } satisfies Order);
            member.close();
        }
    }

    private hear(answer: Reply): void {
        if ("fault" in answer) {
            this.close();
            this.listener.onOver(answer.fault);
        } else if ("shared" in answer) this.listener.onBlock(answer.shared);
        else if (("through" in answer || "problem" in answer) && --this.busy === 0)
            this.listener.onOver("a block does not come");
    }
}
