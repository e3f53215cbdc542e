/** BSM streams in three.js: a loader that is used as DRACOLoader is, and one of whole scenes. */
import { type Group, Loader } from "three";
import { BsmError, errorLike } from "./errors";
import { messageOf } from "./fetched";
import { fetchPieces } from "./flights";
import { BSMGeometry, type Progress } from "./geometry";
import type { Limits } from "./index";
import { creaseOf, placeOf, Pool, type Build, type StreamDecoding } from "./pool";
import { BSMSequence, type SequenceEvents } from "./sequences";

export { BSMGeometry, BSMSequence, placeOf, Pool, type Progress, type SequenceEvents };

type OnProgress = (event: ProgressEvent) => void;

/** An event of a load; Node has none of this kind. */
function progressOf(loaded: number, total: number): ProgressEvent {
    const more = { lengthComputable: total > 0, loaded, total };
    if (globalThis.ProgressEvent) return new ProgressEvent("progress", more);
    return Object.assign(new Event("progress"), more) as unknown as ProgressEvent;
}

/**
 * Loads BSM streams; everything is done in threads of their own, which are kept for the next stream. The geometry of a
 * sequence is that of its first frame; `frames` and `showFrame` have the others, and `BSMSequence` plays them.
 */
export class BSMLoader extends Loader<BSMGeometry> {
    /**
     * Degrees that faces may turn at an edge before it is sharp: normals are not smooth across it. Undefined: 40 in meshes with
     * clearly sharp edges, as CAD models have, and 180 in others. It does not count where the stream has normals.
     */
    creaseAngle?: number;
    private place?: string;
    private used?: Pool;
    private threads?: number;
    private limits: Partial<Limits> = {};
    private aborting = new AbortController();

    /** Take the decoder's files (`*-worker.js`, `*.wasm`, and what they import) from a folder of one's own. */
    setDecoderPath(path: string): this {
        this.leave();
        this.place = path;
        return this;
    }

    /** Use at most this many threads, as do all loaders with the same decoder's path, which share them. */
    setWorkerLimit(limit: number): this {
        this.threads = limit;
        return this;
    }

    /** Refuse streams that ask for more. */
    setLimits(limits: Partial<Limits>): this {
        this.limits = limits;
        return this;
    }

    /** Have a thread and a decoder ready before there is a stream: of all meshes, static ones, sequences, or `--quick`. */
    preload(build: Build = "small"): this {
        this.pool.preload(build).catch((error) => console.error(error));
        return this;
    }

    /** Stop the loads of this loader; threads end with the last loader that shares them, or after some seconds without work. */
    dispose(): this {
        this.abort();
        this.leave();
        return this;
    }

    /** Stop the loads that have begun: they fail. */
    override abort(): this {
        this.aborting.abort(new DOMException("the load was stopped", "AbortError"));
        this.aborting = new AbortController();
        return this;
    }

    override load(
        url: string,
        onLoad: (geometry: BSMGeometry) => void,
        onProgress?: OnProgress,
        onError: (error: unknown) => void = console.error,
        progress?: Progress,
    ): void {
        this.tell(url, this.fetched(url, onProgress, progress), onLoad, onError);
    }

    override loadAsync(url: string, onProgress?: OnProgress, progress?: Progress): Promise<BSMGeometry> {
        return new Promise((keep, fail) => this.load(url, keep, onProgress, fail, progress));
    }

    /** The geometry of a stream that is there. */
    parse(
        data: ArrayBuffer | Uint8Array,
        onLoad: (geometry: BSMGeometry) => void,
        onError: (error: unknown) => void = console.error,
    ): void {
        this.parseAsync(data).then(onLoad).catch(onError);
    }

    parseAsync(data: ArrayBuffer | Uint8Array, progress?: Progress): Promise<BSMGeometry> {
        return this.decoded(progress, async (stream) => {
            stream.receiveData(new Uint8Array(data instanceof Uint8Array ? data : new Uint8Array(data)));
            stream.receiveEof();
        });
    }

    /** A group of meshes, one for each part and material, with their textures; y is up. */
    loadScene(url: string, onProgress?: OnProgress, progress?: Progress): Promise<Group> {
        const loading = this.fetched(url, onProgress, { guess: "whole", ...progress });
        const both = Promise.all([loading, import("./scene")]);
        const scene = both.then(([geometry, { sceneOf }]) => sceneOf(geometry));
        return new Promise((keep, fail) => this.tell(url, scene, keep, fail));
    }

    /** A sequence that can be played as soon as its first frame is there. */
    loadSequence(url: string, onProgress?: OnProgress, signal?: AbortSignal): Promise<BSMSequence> {
        let sequence: BSMSequence | undefined;
        const stop = new AbortController();
        return new Promise((keep, fail) => {
            const onFrame = (index: number, geometry: BSMGeometry): void => {
                if (index > 0) return;
                keep((sequence = new BSMSequence(geometry)));
                sequence.addEventListener("dispose", () => stop.abort());
            };
            const onLoad = (): unknown =>
                sequence ? (sequence.complete = true) : fail(new Error(`${url}: this stream is no sequence`));
            const onError = (error: unknown): void => (sequence ? sequence.fail(error) : fail(error));
            const either = AbortSignal.any(signal ? [stop.signal, signal] : [stop.signal]);
            this.load(url, onLoad, onProgress, onError, { onFrame, signal: either });
        });
    }

    private get pool(): Pool {
        const pool = (this.used ??= Pool.at(this.place));
        if (this.threads !== undefined) pool.setLimit(this.threads);
        return pool;
    }

    private leave(): void {
        this.used?.leave();
        this.used = undefined;
    }

    /** Pass on what is loaded; the manager hears of its end after that. */
    private tell<Loaded>(
        url: string,
        loading: Promise<Loaded>,
        onLoad: (loaded: Loaded) => void,
        onError: (error: unknown) => void,
    ): void {
        const { manager } = this;
        manager.itemStart(url);
        loading
            .then(onLoad)
            .catch((error) => (onError(error), manager.itemError(url)))
            .finally(() => manager.itemEnd(url));
    }

    private fetched(url: string, onProgress?: OnProgress, progress?: Progress): Promise<BSMGeometry> {
        const rename = (error: unknown): never => {
            if (error instanceof BsmError) throw errorLike({ ...error.described, problem: `${url}: ${error.problem}` });
            const message = `${url}: ${messageOf(error)}`; // what others made stays as it was
            if (error instanceof DOMException) throw new DOMException(message, error.name);
            throw new Error(message, { cause: error });
        };
        const give = async (stream: StreamDecoding, signal: AbortSignal): Promise<void> => {
            const credentials = this.withCredentials ? "include" : "same-origin";
            const address = this.manager.resolveURL(this.path + url);
            await fetchPieces(
                address,
                { headers: this.requestHeader, credentials },
                {
                    signal,
                    onPiece: (piece) => stream.receiveData(piece),
                    onProgress: (loaded, total) => onProgress?.(progressOf(loaded, total)),
                },
            );
            stream.receiveEof();
        };
        return this.decoded(progress, give).catch(rename);
    }

    /** The geometry of a stream that is given its bytes, until somebody or an error stops it. */
    private decoded(
        progress: Progress | undefined,
        give: (stream: StreamDecoding, signal: AbortSignal) => Promise<void>,
    ): Promise<BSMGeometry> {
        const own = new AbortController(); // a signal outlives loads, and keeps none that is over
        const stoppers = [own, this.aborting, this.manager.abortController as AbortController | undefined, progress];
        const signal = AbortSignal.any(stoppers.flatMap((stopper) => stopper?.signal ?? []));
        const found = new Promise<BSMGeometry>((keep, fail) => {
            signal.throwIfAborted();
            const geometry = new BSMGeometry(progress);
            const drawing = progress?.onBlock || progress?.onConnectivity ? "growing" : "whole";
            const stream = this.pool.open(
                { onPicture: (picture) => geometry.accept(picture), onEnd: () => keep(geometry), onError: fail },
                { drawing, limits: this.limits, guess: progress?.guess, crease: creaseOf(this.creaseAngle) },
            );
            const fall = (error: unknown): void => (stream.close(), fail(error));
            signal.onabort = () => fall(signal.reason);
            give(stream, signal).catch(fall);
        });
        return found.finally(() => ((signal.onabort = null), own.abort()));
    }
}

/** Loads streams as groups of meshes, where a loader is to give one thing. */
export class BSMSceneLoader extends Loader<Group> {
    /** What loads the geometry; ask it for threads and paths. */
    readonly geometries = new BSMLoader(this.manager);

    override load(
        url: string,
        onLoad: (group: Group) => void,
        onProgress?: OnProgress,
        onError: (error: unknown) => void = console.error,
    ): void {
        this.geometries.setPath(this.path).setRequestHeader(this.requestHeader);
        this.geometries.setWithCredentials(this.withCredentials);
        this.geometries.loadScene(url, onProgress).then(onLoad).catch(onError);
    }

    /** Stop the loads that have begun: they fail. */
    override abort(): this {
        this.geometries.abort();
        return this;
    }
}

/** A whole geometry as a group of meshes: materials, textures, names of parts, and y up, as its metadata say. */
export async function sceneOf(geometry: BSMGeometry): Promise<Group> {
    return (await import("./scene")).sceneOf(geometry);
}
