/** What three.js draws, as a mesh for the encoder: `web/README.md` has a table of what is kept, refused and noted. */
import { kindOf, refuse, wholes, type AttributeInput, type MeshInput } from "./encoding";

/** What `BufferAttribute` and `InterleavedBufferAttribute` of three.js have of this. */
interface AttributeLike {
    array: ArrayLike<number>;
    itemSize: number;
    count: number;
    normalized?: boolean;
    offset?: number;
}

/** What `BufferGeometry` has of this. */
export interface GeometryInput {
    index: { array: ArrayLike<number> } | null;
    attributes: Record<string, AttributeLike>;
    groups?: readonly { start: number; count: number; materialIndex?: number }[];
    drawRange?: { start: number; count: number };
    morphAttributes?: object;
}

/** What `Object3D` has of this. */
export interface ObjectInput {
    children: readonly ObjectInput[];
    matrixWorld: { elements: ArrayLike<number> };
    visible: boolean;
    name: string;
    updateWorldMatrix(parents: boolean, children: boolean): void;
}

/** What kinds of objects add to that. */
interface AnyObject extends ObjectInput {
    geometry?: GeometryInput;
    material?: Material | Material[];
    children: readonly AnyObject[];
    [kind: `is${string}`]: boolean | undefined;
}

type Material = { name?: string };
type Values = Float32Array | Float64Array;
type Part = { geometry: GeometryInput; name: string; material?: Material | Material[]; matrix?: ArrayLike<number> };

/** What normalized integers of 1 are. */
const ONES: Record<string, number> = { Uint8Array: 255, Int8Array: 127, Uint16Array: 65535, Int16Array: 32767, Uint32Array: 4294967295, Int32Array: 2147483647 };
const REFUSED = { isSkinnedMesh: "skins", isInstancedMesh: "instances", isBatchedMesh: "batches", isLOD: "levels of detail" } as const;

const semanticOf = (name: string): AttributeInput["semantic"] => (name === "normal" ? "normal" : name.startsWith("color") ? "color" : /^(uv|texcoord)\d*$/.test(name) ? "texcoord" : "generic");

/** One mesh of all that a geometry, or an object with all that is in it, draws; `note` is told what is left out. */
export function meshOf(given: GeometryInput | ObjectInput, note: (text: string) => void = console.warn): MeshInput & { positions: Values; faces: Uint32Array } {
    const left = new Set<string>();
    const parts = "attributes" in given ? [{ geometry: given, name: "" }] : partsOf(given, left);
    if (parts.length === 0) refuse(`there are no meshes with triangles${left.size > 0 ? `, only ${[...left].join(", ")}` : ""}`);
    const materials = [...new Set(parts.flatMap(({ material = [] }: Part) => material))];
    const faces = parts.map((part) => facesOf(part, materials));
    const places = parts.map(({ geometry: { attributes: { position } }, matrix }: Part) => placed(numbersOf(position), matrix));
    const starts = places.map(() => 0);
    places.reduce((sum, { length }, i) => (starts[i] = sum) + length / 3, 0);
    const names = [...new Set(parts.flatMap(({ geometry }) => Object.keys(geometry.attributes)))].filter((name) => name !== "position");
    const attributes = names.flatMap((name): AttributeInput[] => {
        const own = parts.flatMap(({ geometry }) => geometry.attributes[name] ?? []);
        const components = own[0].itemSize;
        if (own.length < parts.length || components > 4 || own.some(({ itemSize }) => itemSize !== components)) return left.add(name), [];
        const kinds = new Set(own.map(({ array, normalized }) => `${kindOf(array)} ${normalized}`));
        const asShares = semanticOf(name) === "color" && kinds.size === 1 && /^Uint(8|16)Array true/.test([...kinds][0]);
        const values = own.map((attribute, i) => directed(numbersOf(attribute, asShares || kinds.size > 1), name, components, (parts[i] as Part).matrix));
        return [{ name, components, semantic: semanticOf(name), values: joined(values) }];
    });
    const labels = ["part", "material"].map((name, which) => ({ name, components: 1, domain: "face" as const, values: Uint16Array.from(faces.flatMap(({ labels }, part) => (which ? labels : labels.map(() => part)))) }));
    const told = labels.filter(({ values }) => values.some((label) => label > 0));
    const named = { ...(parts.length > 1 ? { "part.names": parts.map(({ name }) => name.replaceAll("\n", " ")).join("\n") } : {}), ...(materials.length > 1 ? Object.fromEntries(materials.map(({ name = "" }, i) => [`material.${i}.name`, name])) : {}) };
    if (materials.some((material) => Object.values(material as Record<string, { isTexture?: boolean } | undefined>).some((value) => value?.isTexture))) left.add("textures");
    if (left.size > 0) note(`Left out: ${[...left].join(", ")}.`);
    return { positions: joined(places) as Values, faces: joined(faces.map(({ corners }, i) => corners.map((vertex) => vertex + starts[i]))), attributes: [...attributes, ...told], metadata: named };
}

/** The meshes of an object and of all in it that can be seen. */
function partsOf(object: ObjectInput, left: Set<string>): Part[] {
    object.updateWorldMatrix(true, true);
    const found = (each: AnyObject): Part[] => {
        if (!each.visible) return left.add("what is invisible"), [];
        for (const [kind, what] of Object.entries(REFUSED)) if (each[kind as `is${string}`]) refuse(`no stream has ${what}: encode the geometry, or a mesh of what is drawn`);
        if (each.geometry && !each.isMesh) left.add("points and lines");
        const own = each.geometry && each.isMesh ? [{ geometry: each.geometry, name: each.name, material: each.material, matrix: each.matrixWorld.elements }] : [];
        return [...own, ...each.children.flatMap(found)];
    };
    return found(object as AnyObject).filter(({ geometry }) => (geometry.attributes.position?.count ?? 0) > 0);
}

/** The drawn faces, and the material of each: with several, what is in no group is not drawn. */
function facesOf({ geometry, material, matrix }: Part, materials: Material[]): { corners: Uint32Array; labels: number[] } {
    const { index, attributes: { position }, groups = [], drawRange, morphAttributes = {} } = geometry;
    if (position?.itemSize !== 3) refuse("the geometry has no positions");
    if (Object.keys(morphAttributes).length > 0) refuse("no stream has morph targets: delete geometry.morphAttributes, or encode each shape");
    if ("instanceCount" in geometry) refuse("no stream has instances: encode the geometry without them");
    const all = index ? wholes(index.array, "an index") : Uint32Array.from({ length: position.count }, (_, i) => i);
    const { start, count } = drawRange ?? { start: 0, count: all.length };
    const isGrouped = Array.isArray(material) && groups.length > 0;
    const numberOf = (number: number): number => (material ? Math.max(0, materials.indexOf([material].flat()[number] ?? [material].flat()[0])) : number);
    const inside = new Int32Array(all.length).fill(isGrouped ? -1 : material ? numberOf(0) : 0);
    if (isGrouped || !material) for (const group of groups) inside.fill(numberOf(group.materialIndex ?? 0), group.start, group.start + group.count);
    const firsts = Array.from({ length: Math.floor(Math.min(count, all.length - start) / 3) }, (_, i) => start + 3 * i).filter((first) => inside[first] >= 0);
    const isMirrored = matrix !== undefined && turn(matrix) < 0;
    const corners = Uint32Array.from({ length: 3 * firsts.length }, (_, i) => all[firsts[Math.floor(i / 3)] + (isMirrored ? 2 - (i % 3) : i % 3)]);
    return { corners, labels: firsts.map((first) => inside[first]) };
}

/** The numbers that an attribute stands for; `asIs`: integers that are shares of their range stay that. */
function numbersOf(attribute: AttributeLike, asIs = false): ArrayLike<number> & Iterable<number> {
    const { itemSize, count, normalized, offset = 0 } = attribute;
    const { data, isFloat16BufferAttribute: isHalf, isInstancedBufferAttribute: isInstanced } = attribute as { data?: { array: ArrayLike<number>; stride: number }; isFloat16BufferAttribute?: boolean; isInstancedBufferAttribute?: boolean };
    if (isInstanced) refuse("no stream has instances: encode the geometry without them");
    const array = data?.array ?? attribute.array;
    const kind = kindOf(array);
    const one = normalized && !asIs ? ONES[kind ?? ""] ?? 1 : 1;
    const isPlain = kind !== undefined && one === 1 && !isHalf;
    if (isPlain && !data) return array as Float32Array;
    const values = new (isPlain ? (array.constructor as Float32ArrayConstructor) : Float32Array)(itemSize * count);
    const stride = data?.stride ?? itemSize;
    for (let i = 0; i < values.length; i++) {
        const number = array[stride * Math.floor(i / itemSize) + offset + (i % itemSize)];
        values[i] = isHalf ? halfOf(number) : one > 1 ? Math.max(number / one, -1) : number;
    }
    return values;
}

/** The number of half precision with these bits. */
function halfOf(bits: number): number {
    const [exponent, fraction] = [(bits >> 10) & 31, bits & 1023];
    const size = exponent === 31 ? (fraction ? NaN : Infinity) : exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : fraction * 2 ** -24;
    return bits >> 15 ? -size : size;
}

const cross = (m: ArrayLike<number>, a: number, b: number): number[] => [0, 1, 2].map((i) => m[a + ((i + 1) % 3)] * m[b + ((i + 2) % 3)] - m[a + ((i + 2) % 3)] * m[b + ((i + 1) % 3)]);

/** The determinant of a matrix. */
function turn(m: ArrayLike<number>): number {
    return cross(m, 0, 4).reduce((sum, x, i) => sum + x * m[8 + i], 0);
}

/** Positions in double precision where a matrix moves them. */
function placed(values: ArrayLike<number> & Iterable<number>, matrix?: ArrayLike<number>): Values {
    const isIdentity = !matrix || Array.from(matrix).every((x, i) => x === (i % 5 === 0 ? 1 : 0));
    if (isIdentity) return /^Float/.test(kindOf(values)!) ? (values as Values) : Float64Array.from(values);
    return Float64Array.from(values, (_, i) => [0, 1, 2].reduce((sum, k) => sum + matrix[4 * k + (i % 3)] * values[i - (i % 3) + k], matrix[12 + (i % 3)]));
}

/** Normals and tangents as a matrix turns them, of length 1; others as they are. */
function directed(values: ArrayLike<number> & Iterable<number>, name: string, size: number, matrix?: ArrayLike<number>): ArrayLike<number> & Iterable<number> {
    if (!matrix || !/^(normal|tangent)$/.test(name) || size < 3) return values;
    const sign = Math.sign(turn(matrix));
    const columns = name === "normal" ? [cross(matrix, 4, 8), cross(matrix, 8, 0), cross(matrix, 0, 4)] : [0, 4, 8].map((k) => Array.from({ length: 3 }, (_, i) => matrix[k + i]));
    const turned = Float32Array.from(values);
    for (let at = 0; at < turned.length; at += size) {
        const vector = [0, 1, 2].map((i) => columns.reduce((sum, column, k) => sum + column[i] * values[at + k], 0) * (name === "normal" ? sign : 1));
        const length = Math.hypot(...vector) || 1;
        turned.set(vector.map((x) => x / length), at);
    }
    return turned;
}

/** Arrays one behind the other, in the kind of all or as floats. */
function joined<Kind extends ArrayLike<number>>(arrays: readonly Kind[]): Kind {
    if (arrays.length === 1) return arrays[0];
    const kinds = new Set(arrays.map(kindOf));
    const Type = kinds.size === 1 ? (arrays[0].constructor as Float32ArrayConstructor) : kinds.has("Float64Array") ? Float64Array : Float32Array;
    const all = new Type(arrays.reduce((sum, { length }) => sum + length, 0));
    arrays.reduce((at, array) => (all.set(array, at), at + array.length), 0);
    return all as unknown as Kind;
}
