/** Scenes of glTF whose geometry is BSM streams (EXT_bsm_compression), in three.js: a plug-in of GLTFLoader. */
import { Mesh } from "three";
import type { GLTF, GLTFLoaderPlugin, GLTFParser } from "three/addons/loaders/GLTFLoader.js";
import type { Picture, Shape } from "./index";
import type { StreamDecoding } from "./pool";
import { BSMGeometry, BSMSequence, Pool } from "./three";
import { CodedViews, EXTENSION, placeOf, type Coded } from "./views";

/**
 * A plug-in: `new GLTFLoader().register((parser) => new GLTFBSMExtension(parser))`. Streams are decoded in threads, each once.
 * Meshes that move are `gltf.userData.sequences`, each a `BSMSequence` that is to be updated for every picture.
 */
export class GLTFBSMExtension implements GLTFLoaderPlugin {
    readonly name = EXTENSION;
    private readonly streams = new CodedViews<Promise<Shape>>();
    /** Sequences by the places of their streams. */
    private readonly sequences = new Map<string, BSMSequence>();

    constructor(
        private readonly parser: GLTFParser,
        private readonly pool: Pool = Pool.at(),
    ) {}

    /** The bytes of a bufferView that a stream holds; null: it is a plain one. */
    loadBufferView(index: number): Promise<ArrayBuffer> | null {
        const { extensions, byteLength } = this.parser.json.bufferViews[index];
        const coded = extensions?.[EXTENSION] as Coded | undefined;
        if (!coded) return null;
        const from = this.parser.json.bufferViews[coded.stream];
        return this.streams.made(from, coded, byteLength, index, () => this.decode(coded.stream));
    }

    /** Meshes that say so show the frames of their stream. */
    afterRoot(gltf: GLTF): null {
        for (const [object, place] of this.parser.associations) {
            const meshes = (place as typeof place | undefined)?.meshes; // of a texture that was not found there is none
            const extensions = meshes === undefined ? {} : this.parser.json.meshes[meshes].extensions;
            const moving = extensions?.[EXTENSION] as { stream: number } | undefined;
            const sequence = moving && this.sequences.get(placeOf(this.parser.json.bufferViews[moving.stream]));
            if (!sequence || !(object instanceof Mesh)) continue;
            object.geometry = sequence.geometry;
        }
        gltf.userData.sequences = [...this.sequences.values()];
        return null;
    }

    private async decode(stream: number): Promise<Shape> {
        const data = new Uint8Array((await this.parser.getDependency("bufferView", stream)) as ArrayBuffer).slice();
        const geometry = new BSMGeometry();
        let sequence: BSMSequence | undefined;
        const take = (picture: Picture, decoding: StreamDecoding): void => {
            geometry.accept(picture);
            if (picture.type !== "frame" || sequence) return;
            this.sequences.set(placeOf(this.parser.json.bufferViews[stream]), (sequence = new BSMSequence(geometry)));
            sequence.addEventListener("dispose", () => decoding.close());
        };
        const end = (error?: unknown): unknown =>
            error ? sequence?.fail(error) : sequence && (sequence.complete = true);
        return this.streams.decode(this.pool, data, `bufferView ${stream}`, take, end);
    }
}
