/** What a mesh carries beside its shape. */
export const SEMANTICS = ["generic", "color", "normal", "texcoord"] as const;
export const DOMAINS = ["vertex", "corner", "face"] as const;
export const KINDS = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"] as const;

/** An attribute of a mesh, whole. */
export interface Attribute {
    name: string;
    /** Colors are sRGB, as in PLY files; those called `COLOR_0` are linear, as in glTF. */
    semantic: (typeof SEMANTICS)[number];
    /** What has a value: each vertex, each corner by way of `indices`, or each face. */
    domain: (typeof DOMAINS)[number];
    kind: (typeof KINDS)[number];
    components: number;
    /** `components` numbers for each value. */
    values: Float64Array;
    /** The value of each corner. */
    indices?: Int32Array;
}
