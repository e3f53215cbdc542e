/** Threads that are none: their messages wait in lines, and a seeded draw says which line is delivered next. */
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { isLight } from "../src/peek";
import type { Build, Source } from "../src/pool";
import * as fast from "../src/workerFast";
import * as full from "../src/workerFull";
import * as small from "../src/workerSmall";
import { WEB } from "./shared";

/** Numbers in [0, 1), the same in every run (Park and Miller, 1988). */
export function drawing(seed: number): (count: number) => number {
    let state = (seed * 16807 + 11) % 2147483647;
    return (count) => {
        state = (state * 48271) % 2147483647;
        return Math.floor((state / 2147483647) * count);
    };
}

/** Lines of deliveries; each line keeps its order, and all lines are mixed. */
export class Lines {
    private readonly lines: (() => void)[][] = [];
    private time = 0;

    constructor(private readonly draw: (count: number) => number) {}

    open(): (delivery: () => void) => void {
        const line: (() => void)[] = [];
        this.lines.push(line);
        return (delivery) => void line.push(delivery);
    }

    get now(): number {
        return this.time;
    }

    /** Deliver until it is over, or nothing is left and no promise brings more for a while. */
    async run(isOver = (): boolean => false): Promise<void> {
        for (let quiet = 0; quiet < 8 && !isOver();) {
            await new Promise(setImmediate);
            const waiting = this.lines.filter(({ length }) => length > 0);
            quiet = waiting.length > 0 ? 0 : quiet + 1;
            if (waiting.length === 0) continue;
            this.time += this.draw(50); // pictures of a mesh that grows come every 30 ms at most
            waiting[this.draw(waiting.length)].shift()!();
        }
    }
}

/** One end of a line; what is sent is copied, or moved, as between threads. */
class End {
    private listener: ((event: MessageEvent) => void) | null = null;
    onerror: ((event: ErrorEvent) => void) | null = null;
    other?: End;
    private closed = false;
    private readonly early: unknown[] = [];

    constructor(private readonly send: (delivery: () => void) => void) {}

    postMessage(message: object, moved: Transferable[] = []): void {
        const { other } = this;
        if (this.closed || !other) return;
        const isPort = "help" in message || "start" in message;
        const copy: unknown = isPort
            ? message
            : structuredClone(message, { transfer: moved.filter((one) => one instanceof ArrayBuffer) });
        this.send(() => {
            if (!other.closed) other.hear(copy);
        });
    }

    /** As of a port: what came before somebody listens is heard then. */
    set onmessage(listener: ((event: MessageEvent) => void) | null) {
        this.listener = listener;
        for (const data of this.early.splice(0)) this.hear(data);
    }

    private hear(data: unknown): void {
        if (this.listener) this.listener({ data } as MessageEvent);
        else this.early.push(data);
    }

    terminate(): void {
        this.closed = true;
        if (this.other) this.other.closed = true;
    }

    close(): void {
        // What was sent before is still delivered.
        const { other } = this;
        this.send(() => other && (other.closed = true));
    }
}

const KERNELS: Record<Build, Promise<WebAssembly.Module>> = Object.fromEntries(
    ["kernels", "small", "grid", "blocks", "moving", "quick", "parts"].map((name) => [
        name === "kernels" ? "whole" : name,
        WebAssembly.compile(readFileSync(join(WEB, `built/${name}.wasm`))),
    ]),
) as never;
await Promise.all(Object.values(KERNELS)); // nothing may come of itself

/** Have everything that a pool takes from its machine come from lines; returns what puts it back. */
export function staged(
    lines: Lines,
    files: Map<string, Uint8Array> = new Map(),
): { source: Source; restore: () => void } {
    const pair = (): [End, End] => {
        const [a, b] = [new End(lines.open()), new End(lines.open())];
        [a.other, b.other] = [b, a];
        return [a, b];
    };
    const [served, timed] = [lines.open(), lines.open()];
    const changed = {
        MessageChannel: class {
            readonly port1: End;
            readonly port2: End;
            constructor() {
                [this.port1, this.port2] = pair();
            }
        },
        Worker: class {},
        setTimeout: (act: () => void) => timed(act),
        navigator: { hardwareConcurrency: 4 },
        fetch: (url: string, { headers = {} }: { headers?: { Range?: string } } = {}) =>
            new Promise((keep) => {
                const [from, to] = (/(\d+)-(\d+)/.exec(headers.Range ?? "") ?? []).slice(1).map(Number);
                const bytes = files.get(url)!;
                const found =
                    from === undefined
                        ? new Response(Uint8Array.from(bytes))
                        : new Response(Uint8Array.from(bytes.subarray(from, to + 1)), { status: 206 });
                served(() => keep(found));
            }),
        crypto: {
            subtle: {
                digest: async (_: string, bytes: ArrayBuffer) =>
                    Uint8Array.from(createHash("sha256").update(new Uint8Array(bytes)).digest()).buffer,
            },
        },
    };
    const before = Object.keys(changed).map(
        (name) => [name, Object.getOwnPropertyDescriptor(globalThis, name)] as const,
    );
    const { now } = performance;
    for (const [name, value] of Object.entries(changed))
        Object.defineProperty(globalThis, name, { value, configurable: true, writable: true });
    performance.now = () => lines.now;
    const source: Source = {
        worker: (thread) => {
            const [page, end] = pair();
            Object.defineProperty(globalThis, "self", { value: end, configurable: true, writable: true });
            (thread === "whole" ? full : small).serve();
            return page as unknown as Worker;
        },
        kernels: (build) => KERNELS[build],
        local: async (build) => (isLight(build) ? fast : full),
    };
    const restore = (): void => {
        performance.now = now;
        for (const [name, old] of before)
            old ? Object.defineProperty(globalThis, name, old) : delete (globalThis as Record<string, unknown>)[name];
    };
    return { source, restore };
}
