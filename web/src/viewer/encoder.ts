/** A thread of a page without a server: it reads a mesh file with the loaders of three.js, and encodes it. */
import { encodeHere } from "../encode";
import type { EncodeOptions } from "../encoding";
import { carried, readMesh } from "../reading";

/** The page sends a `Job`, and gets reports: of progress, then of the result or an error. */
export interface Job {
    file: File;
    preset: string;
}
export interface Result {
    original: Uint8Array;
    stream: Uint8Array;
    notes: string[];
    less: boolean;
}
export type Status = { stage: string; share: number } | { error: string } | Result;

async function work({ file, preset }: Job, report: (report: Status) => void): Promise<void> {
    report({ stage: "reading", share: 0 });
    const { mesh, ...told } = await readMesh(file.name, await file.arrayBuffer());
    const encode = (from: number) => (options: EncodeOptions) => encodeHere(mesh, { ...options, onProgress: (part) => report({ stage: "encoding", share: from + part / 2 }) });
    const exact = preset === "lossless";
    const stream = await (exact ? carried(encode(0)) : encode(0)({ bits: parseInt(preset) }));
    report({ original: exact ? stream : await carried(encode(0.5)), stream, ...told });
}

self.onmessage = ({ data }: MessageEvent<Job>): void => {
    const report = (report: Status): void => self.postMessage(report);
    work(data, report).catch((error: unknown) => report({ error: error instanceof Error ? error.message : String(error) }));
};
