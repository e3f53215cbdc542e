/** Scenes of glTF whose geometry is BSM streams (EXT_bsm_compression), in glTF-Transform: read, and written. */
import {
    Accessor,
    BufferUtils,
    Extension,
    GLB_BUFFER,
    Primitive,
    PropertyType,
    Root,
    type Buffer,
    type GLTF,
    type ReaderContext,
    type WriterContext,
} from "@gltf-transform/core";
import { EncodeError, encodeWith, loadEncoder } from "./encode";
import type { AttributeInput, EncodeOptions, MeshInput } from "./encode";
import { errorLike, openDesk, type Shape } from "./index";
import { here } from "./pool";
import { CodedViews, EXTENSION, sizeOf, type Coded } from "./views";

/** Makes the pictures of a stream; throws its errors. */
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

export type SceneEncoder = (mesh: MeshInput, keepOrder: boolean) => Uint8Array;

/** What is needed to write, too: `io.registerDependencies({ "bsm.encoder": await loadSceneEncoder({ bits: 12 }) })`. */
export async function loadSceneEncoder(options: EncodeOptions = {}): Promise<SceneEncoder> {
    const module = await loadEncoder(options.wasm);
    return (mesh, keepOrder) => encodeWith(module, mesh, keepOrder ? { ...options, keepOrder } : options);
}

/** A primitive whose geometry a stream holds: the accessors of what the stream has, and what each of them is called. */
interface CodedPrimitive {
    stream: Uint8Array;
    accessors: Record<string, number>;
}

/**
 * An extension for `io.registerExtensions([EXTBSMCompression])`. Reading decodes streams. To write
 * them, call `document.createExtension(EXTBSMCompression)`: each primitive of triangles without morph targets becomes a stream.
 * Other primitives stay as they are, with a warning. Of a moving mesh the first frame is read.
 */
export class EXTBSMCompression extends Extension {
    static override readonly EXTENSION_NAME = EXTENSION;
    override readonly extensionName = EXTENSION;
    override readonly prereadTypes = [PropertyType.BUFFER];
    override readonly prewriteTypes = [PropertyType.ACCESSOR];
    override readonly readDependencies = ["bsm.decoder"];
    override readonly writeDependencies = ["bsm.decoder", "bsm.encoder"];
    /** Without plain geometry beside the streams. */
    protected override required = true;
    private decoder?: SceneDecoder;
    private encoder?: SceneEncoder;
    private readonly coded = new Map<Primitive, CodedPrimitive>();

    override install(key: string, dependency: unknown): this {
        if (key === "bsm.decoder") this.decoder = dependency as SceneDecoder;
        if (key === "bsm.encoder") this.encoder = dependency as SceneEncoder;
        return this;
    }

    override preread({ jsonDoc: { json, resources }, bufferViews }: ReaderContext): this {
        const { decoder } = this;
        if (!decoder) throw new Error(`[${EXTENSION}] needs a dependency, "bsm.decoder": await loadSceneDecoder()`);
        const views = json.bufferViews ?? [];
        const streams = new CodedViews<Shape>();
        for (const { view, index, coded } of codedIn(views)) {
            const { buffer, byteOffset = 0, byteLength } = views[coded.stream];
            const resource = resources[json.buffers?.[buffer].uri ?? GLB_BUFFER];
            const shape = streams.shape(views[coded.stream], () => {
                const made = decoder(BufferUtils.toView(resource, byteOffset, byteLength).slice());
                streams.charge(sizeOf(made));
                return made;
            });
            const bytes = streams.bytes(shape, views[coded.stream], coded, view.byteLength, index);
            bufferViews[index] = new Uint8Array(bytes);
        }
        return this;
    }

    override read({ jsonDoc: { json }, buffers, bufferViewBuffers }: ReaderContext): this {
        const views = json.bufferViews ?? [];
        const replaced = new Set<Buffer>();
        for (const { view, index, coded } of codedIn(views)) {
            const [filled, kept] = [buffers[view.buffer], buffers[views[coded.stream].buffer]];
            bufferViewBuffers[index] = kept;
            for (const accessor of this.document.getRoot().listAccessors())
                if (accessor.getBuffer() === filled) accessor.setBuffer(kept);
            replaced.add(filled);
        }
        for (const buffer of replaced) buffer.dispose();
        for (const mesh of json.meshes ?? []) delete mesh.extensions?.[EXTENSION];
        this.dispose();
        return this;
    }

    override prewrite(context: WriterContext): this {
        const { decoder, encoder, coded } = this;
        const needed = '"bsm.decoder" and "bsm.encoder": await loadSceneEncoder()';
        if (!decoder || !encoder) throw new Error(`[${EXTENSION}] needs two dependencies, ${needed}`);
        coded.clear();
        const meshes = this.document.getRoot().listMeshes();
        for (const primitive of meshes.flatMap((mesh) => mesh.listPrimitives())) {
            try {
                if (!coded.has(primitive)) coded.set(primitive, this.codePrimitive(primitive, context));
            } catch (error) {
                if (!(error instanceof EncodeError)) throw error;
                context.logger.warn(`[${EXTENSION}] a primitive stays as it is: ${error.message}`);
            }
        }
        const isCoded = (parent: unknown): boolean =>
            parent instanceof Root || (parent instanceof Primitive && coded.has(parent));
        for (const [primitive, { accessors }] of coded)
            for (const [name, accessor] of [...arraysOf(primitive), ["indices", primitive.getIndices()] as const])
                if (accessor?.listParents().every(isCoded)) context.accessorIndexMap.set(accessor, accessors[name]);
        return this;
    }

    /** Encode a primitive, and declare the accessors of what a decoder makes of it. */
    private codePrimitive(primitive: Primitive, context: WriterContext): CodedPrimitive {
        const stream = this.encoder!(meshOf(primitive), primitive.getAttribute("JOINTS_0") !== null); // joints open faces without area
        const shape = this.decoder!(stream);
        const { json } = context.jsonDoc;
        const accessors: Record<string, number> = {};
        const declare = (name: string, accessor: GLTF.IAccessor): void => {
            accessors[name] = json.accessors!.push(accessor) - 1;
        };
        const { FLOAT, UNSIGNED_INT } = Accessor.ComponentType;
        for (const [name, accessor] of arraysOf(primitive)) {
            const count = shape.positions.length / 3;
            const { componentType, normalized, type } = context.createAccessorDef(accessor);
            const [min, max] = [shape.low, shape.high].map((corner) => corner.map(Math.fround));
            const kind = isFloat(name, accessor) ? { componentType: FLOAT } : { componentType, normalized };
            declare(name, { type, count, ...(name === "POSITION" ? { min, max } : {}), ...kind });
        }
        declare("indices", { type: "SCALAR", count: shape.index.length, componentType: UNSIGNED_INT });
        const buffer = primitive.getAttribute("POSITION")!.getBuffer() ?? this.document.getRoot().listBuffers()[0];
        context.otherBufferViews.set(buffer, [...(context.otherBufferViews.get(buffer) ?? []), stream]);
        return { stream, accessors };
    }

    override write({ jsonDoc: { json }, otherBufferViewsIndexMap }: WriterContext): this {
        const views = json.bufferViews!;
        const buffer = json.buffers!.length;
        let size = 0;
        for (const [at, mesh] of this.document.getRoot().listMeshes().entries())
            for (const [index, primitive] of mesh.listPrimitives().entries()) {
                const coded = this.coded.get(primitive);
                if (!coded) continue;
                const { indices, ...attributes } = coded.accessors;
                Object.assign(json.meshes![at].primitives[index], { attributes, indices });
                const stream = otherBufferViewsIndexMap.get(coded.stream)!;
                for (const [attribute, number] of Object.entries(coded.accessors)) {
                    const accessor = json.accessors![number];
                    if (accessor.bufferView !== undefined) continue; // a mesh's that stands in the scene twice
                    const { componentType, count, type } = accessor;
                    const byteLength = count * Accessor.getElementSize(type) * Accessor.getComponentSize(componentType);
                    const extensions = { [EXTENSION]: { stream, attribute, componentType } };
                    accessor.bufferView = views.push({ buffer, byteOffset: size, byteLength, extensions }) - 1;
                    size += Math.ceil(byteLength / 4) * 4;
                }
            }
        if (size > 0) json.buffers!.push({ byteLength: size, extensions: { [EXTENSION]: { fallback: true } } });
        return this;
    }
}

function arraysOf(primitive: Primitive): [string, Accessor][] {
    const names = primitive.listSemantics().sort();
    return names.map((name) => [name, primitive.getAttribute(name)!]);
}

/** Names whose arrays decoders return in single precision. */
const FLOATS = /^(POSITION|NORMAL|TEXCOORD_[01]|COLOR_0)$/;

/** Whether an array is coded in single precision; integers that take no multiple of four bytes are, too. */
function isFloat(name: string, accessor: Accessor): boolean {
    const isWide = (accessor.getElementSize() * accessor.getComponentSize()) % 4 === 0;
    return FLOATS.test(name) || accessor.getComponentType() === Accessor.ComponentType.FLOAT || !isWide;
}

/** Meanings, and qualities, as `bsm glb` has them. */
const MEANINGS: Record<string, Pick<AttributeInput, "semantic" | "quality">> = {
    NORMAL: { semantic: "normal", quality: { bits: 10 } },
    TANGENT: { quality: { bits: 9 } },
    COLOR_0: { semantic: "color", quality: { bits: 8 } },
    TEXCOORD_0: { semantic: "texcoord" },
    TEXCOORD_1: { semantic: "texcoord" },
};

/** A primitive as a mesh; why it is none, is an `EncodeError`. */
function meshOf(primitive: Primitive): MeshInput {
    const positions = primitive.getAttribute("POSITION");
    const indices = primitive.getIndices()?.getArray();
    const refused = (why: string): never => {
        throw new EncodeError(why, 2);
    };
    if (primitive.getMode() !== Primitive.Mode.TRIANGLES || !positions) return refused("no triangles");
    if (primitive.listTargets().length > 0) refused("morph targets");
    // Tangents are turned from normals and texture coordinates, which come first.
    const arrays = arraysOf(primitive).filter(([name]) => name !== "POSITION");
    arrays.sort(([one], [other]) => Number(one === "TANGENT") - Number(other === "TANGENT"));
    const attributes = arrays.map(([name, accessor]): AttributeInput => ({
        ...MEANINGS[name],
        ...(isFloat(name, accessor) ? {} : { quality: "exact" }),
        name,
        values: isFloat(name, accessor) ? floatsOf(accessor) : (accessor.getArray() as AttributeInput["values"]),
        components: accessor.getElementSize(),
    }));
    return {
        positions: floatsOf(positions),
        faces: indices ? Uint32Array.from(indices) : Uint32Array.from({ length: positions.getCount() }, (_, i) => i),
        attributes,
    };
}

/** The numbers of an accessor, of normalized integers those that they stand for. */
function floatsOf(accessor: Accessor): Float32Array {
    const [size, element] = [accessor.getElementSize(), [] as number[]];
    const floats = new Float32Array(size * accessor.getCount());
    for (let i = 0; i < accessor.getCount(); i++) floats.set(accessor.getElement(i, element), size * i);
    return floats;
}

/** BufferViews that streams hold. */
function codedIn(views: GLTF.IBufferView[]): { view: GLTF.IBufferView; index: number; coded: Coded }[] {
    return views.flatMap((view, index) => {
        const coded = view.extensions?.[EXTENSION] as Coded | undefined;
        return coded ? { view, index, coded } : [];
    });
}
