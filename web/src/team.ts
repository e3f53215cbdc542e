/** Threads that help a decoder: each decodes some of the chains of the stream. */
import type { Header } from "./header";
import { chainOf, type SharedBlock } from "./share";
import type { Answer, Endpoint, Order, Start } from "./worker";
import { processors, WORTHWHILE } from "./threads";

const MOST = 3;

export interface TeamListener {
    onBlock: (shared: SharedBlock) => void;
    onOver: (why: string) => void;
}

/** How many helpers have something to do; none for fewer vertices than are worthwhile. */
export function helpersFor(header: Header, worthwhile = WORTHWHILE): number {
    if (header.vertices < worthwhile) return 0;
    return Math.max(0, Math.min(chainOf(header, header.blocks - 1) + 1, processors(), MOST + 1) - 1);
}

/** A line to a thread, and what closes it. */
export interface Member extends Endpoint {
    onerror?: ((event: ErrorEvent) => void) | null;
    terminate?: () => void;
    close?: () => void;
}

/** Threads, or lines to them, that run `serve`; one stream after the other is shared with them. */
export class Team {
    private readonly members: Member[];
    private listener?: TeamListener;
    private task = 0;
    private busy = 0;

    constructor(members: Member[]) {
        this.members = [...members];
        for (const member of members) {
            member.onmessage = ({ data }: MessageEvent<Answer>) => this.hear(data);
            member.onerror = ({ message }) => this.fail(message ?? "a helper could not be started");
        }
    }

    /** Begin with another stream: `count` helpers at most, who take all of its bytes; how many they are. */
    begin(start: Omit<Start, "share" | "helpers">, count: number, listener: TeamListener): number {
        const among = 1 + Math.min(count, this.members.length);
        for (const member of this.members) this.say(member, { task: this.task, stop: true });
        this.listener = listener;
        this.task++;
        this.busy = among - 1;
        this.members.forEach((member, k) => {
            if (k + 1 < among) this.say(member, { task: this.task, start: { ...start, share: { number: k + 1, among } } });
        });
        return among - 1;
    }

    receiveData(data: Uint8Array): void {
        for (const member of this.members) this.say(member, { task: this.task, data });
    }

    receiveEof(): void {
        for (const member of this.members) this.say(member, { task: this.task, data: null });
    }

    close(): void {
        for (const member of this.members) {
            this.say(member, { task: this.task, stop: true });
            member.terminate?.();
            member.close?.();
        }
        this.members.length = 0;
    }

    private say(member: Member, order: Order): void {
        member.postMessage(order, []);
    }

    private hear(answer: Answer): void {
        if (!("task" in answer) || answer.task !== this.task) return;
        if ("fault" in answer) this.fail(answer.fault);
        else if ("shared" in answer) this.listener?.onBlock(answer.shared);
        else if (("through" in answer || "problem" in answer) && --this.busy === 0) this.listener?.onOver("all helpers are through");
    }

    private fail(problem: string): void {
        this.close();
        this.listener?.onOver(problem);
    }
}
