/** Scenes of glTF whose geometry is BSM streams (EXT_bsm_compression), in glTF-Transform: read as plain geometry. */
import { BufferUtils, Extension, GLB_BUFFER, PropertyType, type Buffer, type GLTF, type ReaderContext } from "@gltf-transform/core";
import { errorLike, openDesk, type Shape } from "./index";
import { here } from "./pool";
import { bytesOf, EXTENSION, type Coded } from "./views";

/** Makes what is drawn of a stream; throws what is wrong with it. */
export type SceneDecoder = (stream: Uint8Array) => Shape;

/** What `EXTBSMCompression` needs: `io.registerDependencies({ "bsm.decoder": await loadSceneDecoder() })`. */
export async function loadSceneDecoder(): Promise<SceneDecoder> {
    const kernels = await here.kernels("whole");
    return (stream) => {
        let shape: Shape | undefined;
        let wrong: Error | undefined;
        const worker = openDesk({ kernels, limits: {}, drawing: "whole" }, (report) => {
            if ("picture" in report && report.picture.type === "whole") ({ shape } = report.picture);
            else if ("problem" in report) wrong = errorLike(report.problem);
            else if ("fault" in report) wrong = new Error(report.fault);
        });
        worker.take(stream);
        worker.take(null);
        if (wrong) throw wrong;
        if (!shape) throw new Error(`[${EXTENSION}] a stream without a mesh`);
        return shape;
    };
}

/**
 * An extension for `io.registerExtensions([EXTBSMCompression])`. What it reads is decoded, and no longer compressed: a document is written
 * plain, and `bsm glb` compresses that again. Of meshes that move the first frame is read.
 */
export class EXTBSMCompression extends Extension {
    static override readonly EXTENSION_NAME = EXTENSION;
    override readonly extensionName = EXTENSION;
    /** @hidden */
    override readonly prereadTypes = [PropertyType.BUFFER];
    /** @hidden */
    override readonly readDependencies = ["bsm.decoder"];
    private decoder?: SceneDecoder;

    /** @hidden */
    override install(key: string, dependency: unknown): this {
        if (key === "bsm.decoder") this.decoder = dependency as SceneDecoder;
        return this;
    }

    /** @hidden */
    override preread({ jsonDoc: { json, resources }, bufferViews }: ReaderContext): this {
        const { decoder } = this;
        if (!decoder) throw new Error(`[${EXTENSION}] needs a dependency, "bsm.decoder": await loadSceneDecoder()`);
        const views = json.bufferViews ?? [];
        const shapes = new Map<number, Shape>();
        views.forEach((view, index) => {
            const coded = codedOf(view);
            if (!coded) return;
            const { buffer, byteOffset = 0, byteLength } = views[coded.stream];
            const resource = resources[json.buffers?.[buffer].uri ?? GLB_BUFFER];
            const shape = shapes.get(coded.stream) ?? decoder(BufferUtils.toView(resource, byteOffset, byteLength).slice());
            shapes.set(coded.stream, shape);
            bufferViews[index] = new Uint8Array(bytesOf(shape, coded, view.byteLength, index));
        });
        return this;
    }

    /** @hidden */
    override read({ jsonDoc: { json }, buffers, bufferViewBuffers }: ReaderContext): this {
        const views = json.bufferViews ?? [];
        const replaced = new Set<Buffer>();
        views.forEach((view, index) => {
            const coded = codedOf(view);
            if (!coded) return;
            const [filled, kept] = [buffers[view.buffer], buffers[views[coded.stream].buffer]];
            bufferViewBuffers[index] = kept;
            for (const accessor of this.document.getRoot().listAccessors()) if (accessor.getBuffer() === filled) accessor.setBuffer(kept);
            replaced.add(filled);
        });
        for (const buffer of replaced) buffer.dispose();
        for (const mesh of json.meshes ?? []) delete mesh.extensions?.[EXTENSION];
        this.dispose();
        return this;
    }

    /** @hidden */
    override write(): this {
        return this;
    }
}

function codedOf(view: GLTF.IBufferView): Coded | undefined {
    return view.extensions?.[EXTENSION] as Coded | undefined;
}
