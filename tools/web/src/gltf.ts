/** Scenes of glTF whose geometry is BSM streams (EXT_bsm_compression), in three.js: a plug-in of GLTFLoader. */
import type { GLTFLoaderPlugin, GLTFParser } from "three/addons/loaders/GLTFLoader.js";
import type { Shape } from "./index";
import { Pool } from "./pool";

const NAME = "EXT_bsm_compression";
/** Constructors by the component types of glTF. */
const KINDS = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array } as const;
const SETS: Record<string, string> = { TEXCOORD_0: "uv", TEXCOORD_1: "uv1", COLOR_0: "color" };

/** What the extension says of a bufferView. */
interface Coded {
    stream: number;
    attribute: string;
    componentType: keyof typeof KINDS;
}

let shared: Pool | undefined;

/**
 * A plug-in: `new GLTFLoader().register((parser) => new GLTFBSMExtension(parser))`. Streams are decoded in threads, each once.
 */
export class GLTFBSMExtension implements GLTFLoaderPlugin {
    readonly name = NAME;
    private readonly shapes = new Map<number, Promise<Shape>>();

    constructor(
        private readonly parser: GLTFParser,
        private readonly pool: Pool = (shared ??= new Pool()),
    ) {}

    /** The bytes of a bufferView that a stream holds; null: it is a plain one. */
    loadBufferView(index: number): Promise<ArrayBuffer> | null {
        const { extensions, byteLength } = this.parser.json.bufferViews[index];
        const coded = extensions?.[NAME] as Coded | undefined;
        return coded ? this.decoded(coded, byteLength, index) : null;
    }

    private async decoded({ stream, attribute, componentType }: Coded, byteLength: number, index: number): Promise<ArrayBuffer> {
        const shape = this.shapes.get(stream) ?? this.decode(stream);
        this.shapes.set(stream, shape);
        const values = valuesOf(await shape, attribute);
        const Kind = KINDS[componentType];
        if (!values || !Kind) throw new Error(`bufferView ${index}: its stream has no ${attribute} of type ${componentType}`);
        const bytes = Kind.from(values as ArrayLike<number>).buffer as ArrayBuffer;
        if (bytes.byteLength !== byteLength) throw new Error(`bufferView ${index}: ${attribute} has ${bytes.byteLength} bytes, not ${byteLength}`);
        return bytes;
    }

    private async decode(stream: number): Promise<Shape> {
        const data = new Uint8Array((await this.parser.getDependency("bufferView", stream)) as ArrayBuffer);
        return new Promise((keep, fail) => {
            let shape: Shape | undefined;
            const decoding = this.pool.open(
                {
                    onPicture: (picture) => picture.type === "whole" && (shape = picture.shape),
                    onEnd: () => (shape ? keep(shape) : fail(new Error(`bufferView ${stream} is a stream without a mesh`))),
                    onError: fail,
                },
                { drawing: "whole" },
            );
            decoding.receiveData(data.slice());
            decoding.receiveEof();
        });
    }
}

/** The numbers that the extension calls so. */
function valuesOf({ index, positions, normals, attributes }: Shape, name: string): ArrayLike<number> | undefined {
    if (name === "indices") return index;
    if (name === "POSITION") return positions;
    if (name === "NORMAL") return normals;
    return attributes.find((one) => one.name === (SETS[name] ?? name))?.values;
}
