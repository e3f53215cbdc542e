/** Scenes of glTF whose geometry is BSM streams (EXT_bsm_compression), in Babylon.js: an extension of its loader. */
import type { AbstractMesh } from "@babylonjs/core/Meshes/abstractMesh.js";
import type * as glTF from "@babylonjs/loaders/glTF/2.0/index.js";
import { registerGLTFExtension } from "@babylonjs/loaders/glTF/2.0/glTFLoaderExtensionRegistry.js";
import type { Picture, PictureOf, Shape } from "./index";
import { Playback } from "./playback";
import { Pool, type StreamDecoding } from "./pool";
import { CodedViews, EXTENSION, placeOf, type Coded } from "./views";

const MOST_NORMAL = 32767;
/** What Babylon.js calls what vertices have. */
const KINDS: Record<string, string> = { uv: "uv", uv1: "uv2", color: "color" };

/** The frames of a stream, played on meshes of a scene: `mesh.metadata.sequence` of each. */
export type BabylonSequence = Pick<Played, "complete" | "shown" | "frames" | "playback" | "seek">;

class Played {
    /** Whether all frames are there. */
    complete = false;
    /** The frame that is shown. */
    shown = 0;
    readonly frames: { picture: PictureOf<"frame">; shape: Shape }[] = [];
    /** What it says of time: `playing`, `loop`, `frame`. */
    readonly playback: Playback;
    private before = 0;
    private readonly worn = new Map<AbstractMesh, Shape>();

    constructor(
        rate: number,
        private readonly decoding: StreamDecoding,
    ) {
        this.playback = new Playback(rate, true);
    }

    /** Show the frames on a mesh, which has the first one, as long as there is the mesh. @internal */
    playOn(mesh: AbstractMesh): void {
        const scene = mesh.getScene();
        const watch = scene.onBeforeRenderObservable.add(() => this.step(performance.now() / 1000));
        mesh.alwaysSelectAsActiveMesh = true; // the bounds are those of the first frame
        mesh.metadata = { ...mesh.metadata, sequence: this };
        this.worn.set(mesh, this.frames[0].shape);
        mesh.onDisposeObservable.add(() => {
            scene.onBeforeRenderObservable.remove(watch);
            this.worn.delete(mesh);
            if (this.worn.size === 0) this.decoding.close();
        });
    }

    /** Show a frame, or the last of those that are there. */
    seek(frame: number): this {
        this.playback.seek(Math.min(Math.max(0, Math.floor(frame)), this.frames.length - 1));
        this.show(this.playback.frame);
        return this;
    }

    private step(now: number): void {
        this.playback.step(now - this.before, this.frames.length, this.complete);
        this.before = now;
        this.show(this.playback.frame);
    }

    private show(index: number): void {
        if (index === this.shown || index >= this.frames.length) return;
        this.shown = index;
        const { picture, shape } = this.frames[index];
        for (const [mesh, before] of this.worn) {
            if (before !== shape) mesh.setIndices(shape.index, shape.positions.length / 3);
            mesh.setVerticesData("position", picture.positions, true);
            const normals = Float32Array.from(picture.normals, (normal) => normal / MOST_NORMAL);
            mesh.setVerticesData("normal", normals, true);
            const stays = before === shape ? [] : shape.attributes;
            for (const { name, values } of [...stays, ...picture.attributes])
                if (KINDS[name]) mesh.setVerticesData(KINDS[name], Float32Array.from(values), true);
            this.worn.set(mesh, shape);
        }
    }
}

type Loading = glTF.GLTFLoader["_loadMeshPrimitiveAsync"];

/** Streams are decoded in threads, each once; meshes that say so play the frames of theirs. */
class BabylonBSMExtension implements glTF.IGLTFLoaderExtension {
    readonly name = EXTENSION;
    enabled = true;
    private streams = new CodedViews<Promise<Shape>>();
    /** By the places of their streams. */
    private readonly sequences = new Map<string, Played>();

    constructor(
        private readonly loader: glTF.GLTFLoader,
        private readonly pool: Pool,
    ) {}

    dispose(): void {
        this.streams = new CodedViews();
        this.sequences.clear();
    }

    /** A mesh, which plays if it says so; null: it does not. */
    _loadMeshPrimitiveAsync(...given: Parameters<Loading>): ReturnType<Loading> | null {
        const [context, , , mesh] = given;
        const moving = mesh.extensions?.[EXTENSION] as { stream: number } | undefined;
        const loading = moving && this.loader._loadMeshPrimitiveAsync(...given);
        const play = (made: AbstractMesh): AbstractMesh => {
            this.sequences.get(placeOf(this.viewOf(context, moving!.stream)))?.playOn(made);
            return made;
        };
        return loading?.then(play) ?? null;
    }

    /** The bytes of a bufferView that a stream holds; null: it is a plain one. */
    loadBufferViewAsync(context: string, view: glTF.IBufferView): Promise<ArrayBufferView> | null {
        const coded = view.extensions?.[EXTENSION] as Coded | undefined;
        return coded ? this.decoded(context, coded, view) : null;
    }

    /** An own function, since what it throws shall reject the promise. */
    private async decoded(context: string, coded: Coded, view: glTF.IBufferView): Promise<ArrayBufferView> {
        const from = this.viewOf(context, coded.stream);
        const made = this.streams.made(from, coded, view.byteLength, view.index, () => this.decode(context, from));
        return new Uint8Array(await made);
    }

    private viewOf(context: string, stream: number): glTF.IBufferView {
        const view = this.loader.gltf.bufferViews?.[stream];
        if (!view) throw new Error(`${context}: there is no bufferView ${stream}`);
        return view;
    }

    private async decode(context: string, view: glTF.IBufferView): Promise<Shape> {
        const loading = this.loader.loadBufferViewAsync(`/bufferViews/${view.index}`, view);
        const { buffer, byteOffset, byteLength } = await loading;
        let [shape, sequence, rate]: [Shape?, Played?, unknown?] = [];
        const take = (picture: Picture, decoding: StreamDecoding): void => {
            if (picture.type === "whole") ({ shape } = picture);
            if (picture.type === "metadata") rate = picture.entries.get("frame_rate") ?? rate;
            if (picture.type !== "frame" || !shape) return;
            if (!sequence) this.sequences.set(placeOf(view), (sequence = new Played(Number(rate ?? 0), decoding)));
            sequence.frames.push({ picture, shape });
        };
        const end = (error?: unknown): void => {
            if (sequence) sequence.complete = true;
            if (error) this.loader.log(`${context}: ${error}`);
        };
        const data = new Uint8Array(buffer.slice(byteOffset, byteOffset + byteLength) as ArrayBuffer);
        return this.streams.decode(this.pool, data, `${context}: bufferView ${view.index}`, take, end);
    }
}

/** Let Babylon.js load scenes whose geometry is streams, with threads of one's own if any. */
export function registerBSM(pool = new Pool()): void {
    registerGLTFExtension(EXTENSION, true, (loader) => new BabylonBSMExtension(loader, pool));
}
