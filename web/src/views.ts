/** BufferViews of glTF whose bytes a stream holds, as `spec/EXT_bsm_compression.md` defines them. */
import type { Shape } from "./drawing";

export const EXTENSION = "EXT_bsm_compression";

/** Constructors by the component types of glTF. */
const KINDS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array } as const;
const SETS: Record<string, string> = { TEXCOORD_0: "uv", TEXCOORD_1: "uv1", COLOR_0: "color" };

/** What the extension says of a bufferView. */
export interface Coded {
    stream: number;
    attribute: string;
    componentType?: keyof typeof KINDS;
}

/** The bytes of a bufferView, of what is drawn of its stream; it says how many these are. */
export function bytesOf(shape: Shape, { attribute, componentType }: Coded, byteLength: number, index: number): ArrayBuffer {
    const values = valuesOf(shape, attribute);
    const Kind = KINDS[componentType ?? (attribute === "indices" ? 5125 : 5126)];
    if (!values || !Kind) throw new Error(`bufferView ${index}: its stream has no ${attribute} of such a type`);
    const bytes = Kind.from(values as ArrayLike<number>).buffer as ArrayBuffer;
    if (bytes.byteLength !== byteLength) throw new Error(`bufferView ${index}: ${attribute} has ${bytes.byteLength} bytes, not ${byteLength}`);
    return bytes;
}

/** The numbers that the extension calls so. */
function valuesOf({ index, positions, normals, attributes }: Shape, name: string): ArrayLike<number> | undefined {
    if (name === "indices") return index;
    if (name === "POSITION") return positions;
    if (name === "NORMAL") return normals;
    return attributes.find((attribute) => attribute.name === (SETS[name] ?? name))?.values;
}
