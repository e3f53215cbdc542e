/** What three.js draws, as a mesh for the encoder: `web/README.md` has a table of what is kept, refused and noted. */
import {
    BufferAttribute,
    Color,
    Matrix3,
    type BufferGeometry,
    type InterleavedBufferAttribute,
    type Material,
    type Matrix4,
    type Mesh,
    type Object3D,
    type Texture,
} from "three";
import { kindOf, refuse, wholes, type AttributeInput, type MeshInput } from "./encoding";
import { linearOf } from "./parting";

type Values = Float32Array | Float64Array;
interface Part {
    geometry: BufferGeometry;
    name: string;
    material?: Material | Material[];
    matrix?: Matrix4;
}

const REFUSED = {
    isSkinnedMesh: "skins",
    isInstancedMesh: "instances",
    isBatchedMesh: "batches",
    isLOD: "levels of detail",
};
const GETTERS = ["getX", "getY", "getZ", "getW"] as const;
const LABELS = ["part", "material"];
const ROUNDED = 0.51 / 65535; // by which colors of glTF are off
type ThreeAttribute = BufferAttribute | InterleavedBufferAttribute;

function semanticOf(name: string): AttributeInput["semantic"] {
    if (name === "normal") return "normal";
    if (name.startsWith("color")) return "color";
    return /^(uv|texcoord)\d*$/.test(name) ? "texcoord" : "generic";
}

/** One mesh of all that a geometry, or an object with all that is in it, draws; `note` receives what is left out. */
export function meshOf(
    given: BufferGeometry | Object3D,
    note: (text: string) => void = console.warn,
): MeshInput & { positions: Values; faces: Uint32Array } {
    const left = new Set<string>();
    const parts = "attributes" in given ? [{ geometry: given, name: "" }] : partsOf(given, left);
    if (parts.length === 0)
        refuse(`there are no meshes with triangles${left.size > 0 ? `, only ${[...left].join(", ")}` : ""}`);
    const materials = [...new Set(parts.flatMap(({ material = [] }: Part) => material))];
    const faces = parts.map((part) => facesOf(part, materials));
    if (faces.every(({ labels }) => labels.length === 0))
        refuse("no face is drawn: see the index, the draw range, the groups and the materials");
    const places = parts.map((part) => valuesOf(part, "position") as Values);
    const starts = places.map((_, i) => places.slice(0, i).reduce((sum, { length }) => sum + length / 3, 0));
    const names = new Set(parts.flatMap(({ geometry }) => Object.keys(geometry.attributes)));
    names.delete("position");
    const attributes = [...names].flatMap((name): AttributeInput[] => {
        const own = parts.flatMap(({ geometry }) => geometry.attributes[name] ?? []);
        const components = own[0].itemSize;
        const isTaken = ({ array, itemSize }: ThreeAttribute): boolean =>
            kindOf(array ?? []) !== undefined && itemSize === components && itemSize <= GETTERS.length;
        if (own.length < parts.length || LABELS.includes(name) || !own.every(isTaken)) return (left.add(name), []);
        const values = joined(parts.map((part) => valuesOf(part, name)));
        if (semanticOf(name) !== "color" || components < 3)
            return [{ name, components, semantic: semanticOf(name), values }];
        const isBright = Array.prototype.some.call(values, (share: number) => share < 0 || share > 1); // more than a screen shows
        if (isBright) return [{ name, components, values }];
        const isOfBytes = own.every(({ array }) => array.BYTES_PER_ELEMENT === 1);
        return [{ name, components, semantic: "color", values: filed(values, components, isOfBytes) }];
    });
    const labels = LABELS.map((name, which) => ({
        name,
        components: 1,
        domain: "face" as const,
        values: Uint16Array.from(faces.flatMap(({ labels }, part) => (which ? labels : labels.map(() => part)))),
    }));
    const metadata: NonNullable<MeshInput["metadata"]> = {};
    if (materials.length > 1) materials.forEach(({ name }, i) => (metadata[`material.${i}.name`] = name));
    if (parts.length > 1) metadata["part.names"] = parts.map(({ name }) => name.replaceAll("\n", " ")).join("\n");
    if (materials.some((material) => Object.values(material).some((value: Texture | undefined) => value?.isTexture)))
        left.add("textures");
    if (left.size > 0) note(`Left out: ${[...left].join(", ")}.`);
    return {
        positions: joined(places),
        faces: joined(faces.map(({ corners }, i) => corners.map((vertex) => vertex + starts[i]))),
        attributes: [...attributes, ...labels.filter(({ values }) => values.some(Boolean))],
        metadata,
    };
}

/** The meshes of an object and of all in it that can be seen. */
function partsOf(object: Object3D, left: Set<string>): Part[] {
    let top = object;
    while (top.parent) top = top.parent;
    top.updateMatrixWorld(true);
    const found = (each: Object3D): Part[] => {
        if (!each.visible) return (left.add("what is invisible"), []);
        for (const [kind, what] of Object.entries(REFUSED))
            if (kind in each) refuse(`no stream has ${what}: encode the geometry, or a mesh of what is drawn`);
        const { geometry, isMesh, material, name, matrixWorld: matrix } = each as Mesh;
        if (geometry && !isMesh) left.add("points and lines");
        return [...(isMesh ? [{ geometry, name, material, matrix }] : []), ...each.children.flatMap(found)];
    };
    return found(object).filter(({ geometry }) => geometry.attributes.position?.count > 0);
}

/** The drawn faces, and the material of each: with several, what is in no group is not drawn. */
function facesOf(
    { geometry, material, matrix }: Part,
    materials: Material[],
): { corners: Uint32Array; labels: number[] } {
    const { index, attributes, groups, drawRange, morphAttributes } = geometry;
    const { start, count } = drawRange;
    if (!(attributes.position as ThreeAttribute)?.array) refuse("the geometry has no positions");
    if (Object.values(morphAttributes).some(({ length }) => length > 0))
        refuse("no stream has morph targets: delete geometry.morphAttributes, or encode each shape");
    if ("instanceCount" in geometry || Object.values(attributes).some((each) => "isInstancedBufferAttribute" in each))
        refuse("no stream has instances: encode the geometry without them");
    const all = index
        ? wholes(index.array, "an index")
        : Uint32Array.from({ length: attributes.position.count }, (_, i) => i);
    const own = material && [material].flat();
    const numberOf = (number = 0): number =>
        !own ? number : own[number]?.visible ? materials.indexOf(own[number]) : -1;
    const isGrouped = Array.isArray(material) && groups.length > 0;
    const labels = new Int32Array(all.length).fill(isGrouped ? -1 : numberOf());
    if (isGrouped || !own)
        for (const group of groups) labels.fill(numberOf(group.materialIndex), group.start, group.start + group.count);
    const length = Math.floor(Math.min(count, all.length - start) / 3);
    const firsts = Array.from({ length }, (_, i) => start + 3 * i).filter((first) => labels[first] >= 0);
    const order = matrix !== undefined && matrix.determinant() < 0 ? [2, 1, 0] : [0, 1, 2]; // of a mirrored one
    const cornerAt = (_: unknown, i: number): number => all[firsts[Math.floor(i / 3)] + order[i % 3]];
    const corners = Uint32Array.from({ length: 3 * firsts.length }, cornerAt);
    return { corners, labels: firsts.map((first) => labels[first]) };
}

/** Linear colors in sRGB: bytes where these say the same to 16 bits, else words if linear bytes were given, or floats. */
function filed(linear: ArrayLike<number>, components: number, ofBytes: boolean): ArrayLike<number> {
    const [color, shares] = [new Color(), Float32Array.from(linear)];
    for (let i = 0; i < shares.length; i += components) {
        color.fromArray(linear as number[], i).convertLinearToSRGB();
        color.toArray(shares, i);
    }
    const bytes = Uint8Array.from(shares, (share) => Math.round(255 * share));
    const back = (byte: number, i: number): number => (i % components < 3 ? linearOf(byte / 255) : byte / 255);
    if (bytes.every((byte, i) => Math.abs(back(byte, i) - linear[i]) <= ROUNDED)) return bytes;
    return ofBytes ? Uint16Array.from(shares, (share) => Math.round(65535 * share)) : shares;
}

/** The numbers that an attribute stands for, where its object is. */
function valuesOf({ geometry, matrix }: Part, name: string): ArrayLike<number> {
    const attribute = geometry.attributes[name] as ThreeAttribute;
    const { array, itemSize, normalized } = attribute;
    const isPlace = name === "position";
    const [count, width] = [geometry.attributes.position.count, isPlace ? 3 : itemSize];
    const moves = isPlace || /^(normal|tangent)$/.test(name);
    const isMoved = matrix !== undefined && moves && !matrix.equals(matrix.clone().identity());
    const isPacked = "data" in attribute || "isFloat16BufferAttribute" in attribute || normalized;
    const isPlain = !isPacked && kindOf(array) !== undefined;
    if (isPlain && !isMoved && width === itemSize && (!isPlace || /^float/.test(kindOf(array)!)))
        return array.subarray(0, width * count);
    const read = (_: unknown, i: number): number =>
        i % width < itemSize ? attribute[GETTERS[i % width]](Math.floor(i / width)) : 0;
    const length = width * Math.min(count, attribute.count);
    const moved = new BufferAttribute(Float64Array.from({ length }, read), width);
    if (!isMoved)
        return isPlace && (kindOf(array) === "float64" || !normalized) ? moved.array : Float32Array.from(moved.array);
    if (isPlace) return moved.applyMatrix4(matrix).array; // a matrix may place it where single precision is coarse
    if (name === "normal") moved.applyNormalMatrix(new Matrix3().getNormalMatrix(matrix));
    else moved.transformDirection(matrix);
    return Float32Array.from(moved.array);
}

/** Arrays one behind the other, in the kind of all or as floats. */
function joined<Kind extends ArrayLike<number>>(arrays: readonly Kind[]): Kind {
    if (arrays.length === 1) return arrays[0];
    const kinds = new Set(arrays.map(kindOf));
    const Mixed = kinds.has("float64") ? Float64Array : Float32Array;
    const Type = kinds.size === 1 ? (arrays[0].constructor as Float32ArrayConstructor) : Mixed;
    const all = new Type(arrays.reduce((sum, { length }) => sum + length, 0));
    arrays.reduce((at, array) => (all.set(array, at), at + array.length), 0);
    return all as unknown as Kind;
}
