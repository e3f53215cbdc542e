/** Scenes of glTF whose geometry is BSM streams (EXT_bsm_compression), in Babylon.js: an extension of its loader. */
import type { GLTFLoader, IBufferView, IGLTFLoaderExtension } from "@babylonjs/loaders/glTF/2.0/index.js";
import { registerGLTFExtension } from "@babylonjs/loaders/glTF/2.0/glTFLoaderExtensionRegistry.js";
import type { Shape } from "./index";
import { Pool } from "./pool";
import { bytesOf, EXTENSION, type Coded } from "./views";

/** Streams are decoded in threads, each once; of meshes that move the first frame is shown. */
class BabylonBSMExtension implements IGLTFLoaderExtension {
    readonly name = EXTENSION;
    enabled = true;
    private readonly shapes = new Map<number, Promise<Shape>>();

    constructor(
        private readonly loader: GLTFLoader,
        private readonly pool: Pool,
    ) {}

    dispose(): void {
        this.shapes.clear();
    }

    /** The bytes of a bufferView that a stream holds; null: it is a plain one. */
    loadBufferViewAsync(context: string, { extensions, byteLength, index }: IBufferView): Promise<ArrayBufferView> | null {
        const coded = extensions?.[EXTENSION] as Coded | undefined;
        return coded ? this.decoded(context, coded, byteLength, index) : null;
    }

    private async decoded(context: string, coded: Coded, byteLength: number, index: number): Promise<ArrayBufferView> {
        const { stream } = coded;
        const shape = this.shapes.get(stream) ?? this.decode(context, stream);
        this.shapes.set(stream, shape);
        return new Uint8Array(bytesOf(await shape, coded, byteLength, index));
    }

    private async decode(context: string, stream: number): Promise<Shape> {
        const view = this.loader.gltf.bufferViews?.[stream];
        if (!view) throw new Error(`${context}: there is no bufferView ${stream}`);
        const { buffer, byteOffset, byteLength } = await this.loader.loadBufferViewAsync(`/bufferViews/${stream}`, view);
        return new Promise((keep, fail) => {
            const decoding = this.pool.open(
                {
                    onPicture: (picture) => {
                        if (picture.type !== "whole") return;
                        keep(picture.shape);
                        decoding.close();
                    },
                    onEnd: () => fail(new Error(`${context}: bufferView ${stream} is a stream without a mesh`)),
                    onError: fail,
                },
                { drawing: "whole" },
            );
            decoding.receiveData(new Uint8Array(buffer.slice(byteOffset, byteOffset + byteLength) as ArrayBuffer));
            decoding.receiveEof();
        });
    }
}

/** Let Babylon.js load scenes whose geometry is streams, with threads of one's own if any. */
export function registerBSM(pool = new Pool()): void {
    registerGLTFExtension(EXTENSION, true, (loader) => new BabylonBSMExtension(loader, pool));
}
