/** Threads that help a decoder: each decodes some of the chains of the stream. */
import { decode, Decoder, NEED_BLOCK, type Mesh } from "./decoder";
import type { Header } from "./header";
import { chainOf, type SharedBlock } from "./share";
import type { Kernels } from "./kernels";
import type { Limits } from "./limits";
import type { Answer, Endpoint, Order, Start } from "./worker";
import { processors } from "./threads";

const MOST = 3;
/** Vertices from which on more is won than threads cost. */
export const WORTHWHILE = 8192;

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
    private last: Promise<unknown> = Promise.resolve();

    constructor(members: Member[], private readonly worthwhile = WORTHWHILE) {
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

    /** Decode a complete stream in this thread and its helpers; in this one alone where there are none. Streams wait for each other. */
    decode(kernels: Kernels, data: Uint8Array, limits: Partial<Limits> = {}): Promise<Mesh> {
        const mesh = this.last.then(() => this.decodeNow(kernels, data, limits));
        this.last = mesh.catch(() => {});
        return mesh;
    }

    close(): void {
        for (const member of this.members) {
            this.say(member, { task: this.task, stop: true });
            member.terminate?.();
            member.close?.();
        }
        this.members.length = 0;
    }

    private async decodeNow(kernels: Kernels, data: Uint8Array, limits: Partial<Limits>): Promise<Mesh> {
        const arrived: SharedBlock[] = [];
        let over = false;
        let wake = (): void => {};
        const onBlock = (shared: SharedBlock): void => {
            arrived.push(shared);
            wake();
        };
        const onOver = (): void => {
            over = true;
            wake();
        };
        const helpers = (header: Header): number => {
            const count = this.begin({ kernels: kernels.module, limits }, helpersFor(header, this.worthwhile), { onBlock, onOver });
            if (count > 0) this.receiveData(data);
            return count;
        };
        const decoder = new Decoder(kernels, limits, { helpers });
        decoder.receiveData(data);
        for (;;) {
            const mesh = decoder.advance();
            if (mesh !== NEED_BLOCK) return mesh;
            while (arrived.length === 0 && !over) await new Promise<void>((go) => (wake = go));
            if (arrived.length === 0) return decode(kernels, data, limits); // a page may learn only now that it may have no threads
            for (const shared of arrived.splice(0)) decoder.receiveBlock(shared);
        }
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
