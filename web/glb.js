/**
 * A decoded mesh, with its materials and images, or a sequence, each frame a morph target, as GLB; what `bsm decode`
 * writes has the same places.
 */
import { drawnFaces, linearOf, numbersOf } from "bsm-decoder";

const [FLOAT, UINT] = [5126, 5125];
const TYPES = ["", "SCALAR", "VEC2", "VEC3", "VEC4"];
const [HALF, FAR, MOST_FRAMES] = [Math.SQRT1_2, 16, 2048]; // FAR: diagonals from the origin, where single precision is too coarse
const UNITS = { meters: 1, decimeters: 0.1, centimeters: 0.01, millimeters: 0.001, inches: 0.0254, feet: 0.3048 };
const TURNS = { x: [0, 0, HALF, HALF], z: [-HALF, 0, 0, HALF] }; // quaternions
const IMAGES = [
    [/^\x89PNG/, "image/png"],
    [/^\xff\xd8/, "image/jpeg"],
    [/^RIFF....WEBP/s, "image/webp"],
];
const TEXTURES = {
    baseColorTexture: "map_Kd",
    emissiveTexture: "map_Ke",
    normalTexture: "norm",
    occlusionTexture: "",
    metallicRoughnessTexture: "",
};
const WORDS = [
    "name",
    "baseColorFactor",
    "metallicFactor",
    "roughnessFactor",
    "emissiveFactor",
    "alphaMode",
    "alphaCutoff",
    "doubleSided",
    "Kd",
    "Ke",
    "Pm",
    "Pr",
    "d",
    ...Object.entries(TEXTURES).flat(),
];

/** The JSON and the bytes of a scene that grows. */
class Scene {
    json = { asset: { version: "2.0", generator: "bsm-decoder" }, scene: 0, scenes: [{ nodes: [] }] };
    parts = [];
    size = 0;

    add(list, value) {
        return (this.json[list] ??= []).push(value) - 1;
    }

    use(extension, list) {
        this.json[list] = [...new Set([...(this.json[list] ?? []), extension])];
    }

    view({ buffer, byteOffset, byteLength }) {
        const view = this.add("bufferViews", { buffer: 0, byteOffset: this.size, byteLength });
        this.parts.push(Buffer.from(buffer, byteOffset, byteLength), Buffer.alloc(-byteLength & 3));
        this.size += byteLength + (-byteLength & 3);
        return view;
    }

    numbers(values, width, isBound = false) {
        const [min, max] = [Math.min, Math.max].map((most, which) =>
            Array.from({ length: width }, (_, d) => {
                let found = which ? -Infinity : Infinity;
                for (let i = d; i < values.length; i += width) found = most(found, values[i]);
                return found;
            }),
        );
        const componentType = values instanceof Uint32Array ? UINT : FLOAT;
        return this.add("accessors", {
            bufferView: this.view(values),
            componentType,
            count: values.length / width,
            type: TYPES[width],
            ...(isBound && { min, max }),
        });
    }

    /** Zeros but for ones at some places, whose bytes alone are stored. */
    ones(places, count) {
        const [indices, values] = [Uint32Array.from(places), new Float32Array(places.length).fill(1)].map((array) =>
            this.view(array),
        );
        return this.add("accessors", {
            componentType: FLOAT,
            count,
            type: "SCALAR",
            sparse: {
                count: places.length,
                indices: { bufferView: indices, componentType: UINT },
                values: { bufferView: values },
            },
        });
    }

    whole() {
        this.json.buffers = [{ byteLength: this.size }];
        const text = Buffer.from(JSON.stringify(this.json));
        const json = Buffer.concat([text, Buffer.alloc(-text.length & 3, " ")]);
        const chunk = (kind, { length }) => Buffer.from(Uint32Array.of(length, kind).buffer);
        const head = Uint32Array.of(0x46546c67, 2, 28 + json.length + this.size);
        return Buffer.concat([
            Buffer.from(head.buffer),
            chunk(0x4e4f534a, json),
            json,
            chunk(0x004e4942, { length: this.size }),
            ...this.parts,
        ]);
    }
}

const numbersIn = (value) =>
    String(value ?? "")
        .split(/\s+/)
        .filter(Boolean)
        .map(Number);

/** Rows of numbers, one for each of `rows`, or as they are. */
function spread(values, width, rows) {
    return rows
        ? Float64Array.from(
              { length: width * rows.length },
              (_, i) => values[width * rows[Math.floor(i / width)] + (i % width)],
          )
        : values;
}

/** Normals of vertices: the mean of those of their faces, by their areas. */
function normalsOf(points, faces) {
    const normals = new Float32Array(points.length);
    for (let i = 0; i < faces.length; i += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => 3 * faces[i + k]);
        const [u, v] = [b, c].map((to) => [0, 1, 2].map((d) => points[to + d] - points[a + d]));
        for (const to of [a, b, c])
            for (let d = 0; d < 3; d++)
                normals[to + d] += u[(d + 1) % 3] * v[(d + 2) % 3] - u[(d + 2) % 3] * v[(d + 1) % 3];
    }
    return unitOf(normals);
}

function unitOf(vectors) {
    for (let i = 0; i < vectors.length; i += 3) {
        const length = Math.hypot(vectors[i], vectors[i + 1], vectors[i + 2]);
        if (length > 1e-30) for (let d = i; d < i + 3; d++) vectors[d] /= length;
        else vectors.set([0, 0, 1], i);
    }
    return vectors;
}

/** The material of some words, by its number; without any, a matte one. */
function addMaterial(scene, words, images, isClear) {
    const isMtl = !["baseColorFactor", "baseColorTexture", "metallicFactor", "roughnessFactor"].some((name) =>
        words.has(name),
    );
    const found = Object.entries(TEXTURES).flatMap(([name, mtl]) => {
        const texture = images.get(Number(words.get(name) ?? words.get(mtl) ?? NaN));
        return texture === undefined ? [] : [[name, { index: texture }]];
    });
    const { baseColorTexture, metallicRoughnessTexture, ...textures } = Object.fromEntries(found);
    const kd = numbersIn(words.get("Kd")).map(linearOf);
    const [r = 1, g = 1, b = 1, a = 1] = words.has("baseColorFactor")
        ? numbersIn(words.get("baseColorFactor"))
        : baseColorTexture && !kd.some(Boolean)
          ? []
          : kd; // programs write black beside an image
    const opacity = a * Number(words.get("d") ?? 1);
    const light = words.has("emissiveFactor")
        ? numbersIn(words.get("emissiveFactor"))
        : numbersIn(words.get("Ke")).map(linearOf);
    const emissive = textures.emissiveTexture && !light.some(Boolean) ? [1, 1, 1] : light;
    const most = Math.max(1, ...emissive);
    if (most > 1) scene.use("KHR_materials_emissive_strength", "extensionsUsed");
    const mode = words.get("alphaMode") ?? (opacity < 1 || isClear ? "BLEND" : "OPAQUE");
    const share = (value) => Math.min(Math.max(value, 0), 1);
    const [metal, rough] = [
        words.get("metallicFactor") ?? words.get("Pm") ?? Number(!isMtl),
        words.get("roughnessFactor") ?? words.get("Pr") ?? (words.size > 0 ? 1 : 0.9),
    ];
    return scene.add("materials", {
        ...(words.has("name") && { name: String(words.get("name")) }),
        pbrMetallicRoughness: {
            baseColorFactor: [r, g, b, opacity].map(share),
            metallicFactor: share(Number(metal)),
            roughnessFactor: share(Number(rough)),
            ...(baseColorTexture && { baseColorTexture }),
            ...(metallicRoughnessTexture && { metallicRoughnessTexture }),
        },
        ...textures,
        ...(emissive.some(Boolean) && { emissiveFactor: emissive.map((value) => value / most) }),
        ...(most > 1 && { extensions: { KHR_materials_emissive_strength: { emissiveStrength: most } } }),
        ...(mode !== "OPAQUE" && { alphaMode: mode }),
        ...(mode === "MASK" && words.has("alphaCutoff") && { alphaCutoff: Number(words.get("alphaCutoff")) }),
        ...(Number(words.get("doubleSided") ?? 0) && { doubleSided: true }),
    });
}

/** The textures of a scene by the numbers of their images, those that glTF takes. */
function addImages(scene, metadata) {
    return new Map(
        [...metadata].flatMap(([key, data]) => {
            const [, number] = /^image\.(\d+)\.data$/.exec(key) ?? [];
            const [, mimeType] =
                IMAGES.find(
                    ([begin]) => number !== undefined && begin.test(Buffer.from(data).toString("latin1", 0, 12)),
                ) ?? [];
            if (!mimeType) return [];
            const source = scene.add("images", { bufferView: scene.view(data), mimeType });
            if (mimeType !== "image/webp") return [[Number(number), scene.add("textures", { source })]];
            for (const list of ["extensionsUsed", "extensionsRequired"]) scene.use("EXT_texture_webp", list);
            return [[Number(number), scene.add("textures", { extensions: { EXT_texture_webp: { source } } })]];
        }),
    );
}

/** What glTF calls the numbers of vertices, and those in its sense. */
function arrayOf({ name, source, components, values }) {
    const [, base, count] = /^(uv|color)(\d*)$/.exec(name) ?? [];
    if (base === "uv")
        return [
            `TEXCOORD_${Number(count)}`,
            Float32Array.from({ length: 2 * (values.length / components) }, (_, i) =>
                i % 2 ? 1 - values[components * (i >> 1) + 1] : values[components * (i >> 1)],
            ),
            2,
        ];
    return [base === "color" && components > 2 ? `COLOR_${Number(count)}` : `_${source}`, values, components];
}

/** The middle of places that single precision, which GLB has, would round visibly; else the origin. */
function middleOf(places) {
    const ends = [0, 1, 2].map((d) =>
        places.reduce(
            ([low, high], x, i) => (i % 3 === d ? [Math.min(low, x), Math.max(high, x)] : [low, high]),
            [Infinity, -Infinity],
        ),
    );
    const far = Math.max(...ends.flat().map(Math.abs)) > FAR * Math.hypot(...ends.map(([low, high]) => high - low));
    return ends.map(([low, high]) => (far ? Math.round((low + high) / 2) : 0));
}

/**
 * A GLB of faces, attributes and metadata, and the names of metadata that it has no place for; `frames` has the
 * positions of each, of one for a mesh, `colors` those that change.
 */
export function glbOf({ faces, attributes, metadata, frames, colors, rate, isMoving }, stem) {
    if (frames.length > MOST_FRAMES)
        throw new Error(
            `a GLB holds each frame as a morph target, of which viewers take ${MOST_FRAMES}; name a folder, or a .npz, .pc2 or .mdd file`,
        );
    const scene = new Scene();
    const all = Int32Array.from({ length: faces.length / 3 }, (_, face) => face);
    const { index, vertices, pieces, attributes: drawn, own } = drawnFaces(faces, all, attributes);
    const middle = middleOf(frames[0]);
    const places = frames.map((frame) =>
        spread(
            frame.map((x, i) => x - middle[i % 3]),
            3,
            vertices,
        ),
    );
    const arrays = drawn.map(arrayOf);
    const normals = isMoving ? normalsOf(places[0], index) : own && unitOf(own);
    if (normals) arrays.unshift(["NORMAL", normals, 3]);
    const given = {
        POSITION: scene.numbers(Float32Array.from(places[0]), 3, true),
        ...Object.fromEntries(
            arrays.map(([name, values, width]) => [name, scene.numbers(Float32Array.from(values), width)]),
        ),
    };
    const color = arrays.find(([name]) => name === "COLOR_0");
    const targets = places.slice(1).map((place, i) => {
        const delta = (values, before) => Float32Array.from(values, (value, k) => value - before[k]);
        const found = {
            POSITION: scene.numbers(delta(place, places[0]), 3, true),
            NORMAL: scene.numbers(delta(normalsOf(place, index), normals), 3),
        };
        if (!color || !colors[i + 1]) return found;
        return { ...found, COLOR_0: scene.numbers(delta(numbersOf(colors[i + 1], vertices), color[1]), color[2]) };
    });
    const images = addImages(scene, metadata);
    const isClear = drawn.some(
        ({ name, components, values }) =>
            name === "color" && components === 4 && values.some((value, i) => i % 4 === 3 && value < 1),
    );
    const materials = new Map(
        [...new Set(pieces.map(({ material }) => material))].map((number) => {
            const words = new Map(
                [...metadata].flatMap(([key, value]) =>
                    key.startsWith(`material.${number}.`) ? [[key.slice(`material.${number}.`.length), value]] : [],
                ),
            );
            return [number, addMaterial(scene, words, images, isClear)];
        }),
    );
    const up = TURNS[String(metadata.get("up")).toLowerCase()];
    const unit = String(metadata.get("unit") ?? "meters");
    const scale = UNITS[unit] ?? (Number(/^(\S+) meters$/.exec(unit)?.[1]) || 1);
    const [x, y, z] = middle.map((place) => scale * place);
    const translation = up === TURNS.z ? [x, z, -y] : up === TURNS.x ? [-y, x, z] : [x, y, z];
    const placed = {
        ...(up && { rotation: up }),
        ...(scale !== 1 && { scale: [scale, scale, scale] }),
        ...(middle.some(Boolean) && { translation }),
    };
    const names = String(metadata.get("part.names") ?? "").split("\n");
    const taken = new Set();
    const nodes = pieces.map(({ part, material, start, count }, i) => {
        const called = String(
            metadata.get(`part.${part}.name`) ?? (names[part] || (pieces.length === 1 && metadata.get("name")) || stem),
        );
        const name = taken.has(called) ? `${called}_${i}` : called;
        taken.add(name);
        const primitive = {
            attributes: given,
            indices: scene.numbers(index.slice(start, start + count), 1),
            material: materials.get(material),
            ...(targets.length > 0 && { targets }),
        };
        return scene.add("nodes", {
            mesh: scene.add("meshes", {
                name,
                primitives: [primitive],
                ...(targets.length > 0 && { weights: targets.map(() => 0) }),
            }),
            name,
            ...placed,
        });
    });
    scene.json.scenes[0].nodes = nodes;
    if (targets.length > 0) {
        const [input, { length }] = [
            scene.numbers(
                Float32Array.from(frames, (_, i) => i / rate),
                1,
                true,
            ),
            targets,
        ];
        const output = scene.ones(
            targets.map((_, i) => length + i * (length + 1)),
            length * frames.length,
        );
        scene.add("animations", {
            name: "frames",
            samplers: [{ input, output, interpolation: "LINEAR" }],
            channels: nodes.map((node) => ({ sampler: 0, target: { node, path: "weights" } })),
        });
    }
    const isBytes = (value) => typeof value === "bigint" || value instanceof Uint8Array;
    const extras = [...metadata].filter(
        ([key, value]) => !/^(up|unit|part\.|material\.|image\.)/.test(key) && !isBytes(value),
    );
    if (extras.length > 0) scene.json.scenes[0].extras = Object.fromEntries(extras);
    const left = [...metadata].flatMap(([key, value]) => {
        const [, number, word] = /^(?:image\.(\d+)\.data|material\.\d+\.(.+))$/.exec(key) ?? [];
        return (number ? images.has(Number(number)) : word ? WORDS.includes(word) : !isBytes(value)) ? [] : [key];
    });
    return { glb: scene.whole(), left };
}
