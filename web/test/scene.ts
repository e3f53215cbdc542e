/** A scene of one stream, by EXT_bsm_compression; with these numbers of vertices and corners. */
export function sceneOf(stream: Uint8Array, vertices: number, corners: number, moves = false): Uint8Array {
    const name = "EXT_bsm_compression";
    const sizes = (
        [
            ["POSITION", "VEC3", 12, vertices],
            ["NORMAL", "VEC3", 12, vertices],
            ["TEXCOORD_0", "VEC2", 8, vertices],
            ["indices", "SCALAR", 4, corners],
        ] as const
    ).filter(([attribute]) => !moves || attribute !== "TEXCOORD_0");
    let at = 0;
    const views = sizes.map(([attribute, , size, count]) => {
        const view = {
            buffer: 1,
            byteOffset: at,
            byteLength: size * count,
            extensions: {
                [name]: { stream: 0, attribute, ...(attribute === "NORMAL" ? { componentType: 5126 } : {}) },
            },
        };
        at += size * count;
        return view;
    });
    const tree = {
        asset: { version: "2.0" },
        extensionsUsed: [name],
        extensionsRequired: [name],
        scene: 0,
        scenes: [{ nodes: [0] }],
        nodes: [{ mesh: 0 }],
        meshes: [
            {
                primitives: [
                    {
                        attributes: { POSITION: 0, NORMAL: 1, ...(moves ? {} : { TEXCOORD_0: 2 }) },
                        indices: sizes.length - 1,
                    },
                ],
                ...(moves ? { extensions: { [name]: { stream: 0 } } } : {}),
            },
        ],
        accessors: sizes.map(([attribute, type, , count], i) => ({
            bufferView: i + 1,
            componentType: attribute === "indices" ? 5125 : 5126,
            count,
            type,
            ...(i === 0 ? { min: [-1, -1, -1], max: [1, 1, 1] } : {}),
        })),
        bufferViews: [{ buffer: 0, byteLength: stream.length }, ...views],
        buffers: [{ byteLength: stream.length }, { byteLength: at, extensions: { [name]: { fallback: true } } }],
    };
    const text = Buffer.from(JSON.stringify(tree));
    const [json, data] = [
        Buffer.alloc(Math.ceil(text.length / 4) * 4, " "),
        Buffer.alloc(Math.ceil(stream.length / 4) * 4),
    ];
    text.copy(json);
    data.set(stream);
    const chunk = (kind: number, content: Buffer): Buffer =>
        Buffer.concat([Buffer.from(Uint32Array.of(content.length, kind).buffer), content]);
    const chunks = Buffer.concat([chunk(0x4e4f534a, json), chunk(0x004e4942, data)]);
    return Buffer.concat([Buffer.from("glTF"), Buffer.from(Uint32Array.of(2, 12 + chunks.length).buffer), chunks]);
}
