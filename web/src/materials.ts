/** Materials and images that metadata speak of, in the words of glTF, for three.js. */
import {
    DoubleSide,
    FrontSide,
    LinearSRGBColorSpace,
    type Material,
    type Mesh,
    MeshStandardMaterial,
    NoColorSpace,
    type Object3D,
    RepeatWrapping,
    SRGBColorSpace,
    Texture,
} from "three";
import type { BSMGeometry } from "./geometry";
import type { Metadata } from "./index";

/** Angles that turn the axis which a mesh calls up to y. */
export function turnOf(metadata: Metadata): [number, number, number] {
    const up = metadata.get("up");
    return up === "z" ? [-Math.PI / 2, 0, 0] : up === "x" ? [0, 0, Math.PI / 2] : [0, 0, 0];
}

/** What metadata call a part or a material. */
export function nameOf(metadata: Metadata, kind: "part" | "material", number: number): string {
    const called = (what: string): unknown =>
        metadata.get(`${what}.${number}.name`) ?? String(metadata.get(`${what}.names`) ?? "").split("\n")[number];
    return String(called(kind) || (kind === "part" && called("object")) || `${kind} ${number}`);
}

type Words = Map<string, string | number>;
type Slot = "map" | "emissiveMap" | "normalMap" | "metalnessMap" | "roughnessMap" | "aoMap";

/** Textures of glTF, and of MTL, and where three.js has them. */
const TEXTURES: Record<string, Slot[]> = {
    baseColorTexture: ["map"],
    map_Kd: ["map"],
    emissiveTexture: ["emissiveMap"],
    map_Ke: ["emissiveMap"],
    normalTexture: ["normalMap"],
    norm: ["normalMap"],
    metallicRoughnessTexture: ["metalnessMap", "roughnessMap"],
    occlusionTexture: ["aoMap"],
};
const COLORED = ["map", "emissiveMap"];
/** Numbers of both, the last that there is. */
const NUMBERS = [
    ["metallicFactor", "metalness"],
    ["Pm", "metalness"],
    ["roughnessFactor", "roughness"],
    ["Pr", "roughness"],
] as const;
/** Words that only materials of glTF have. */
const OF_GLTF = ["baseColorFactor", "baseColorTexture", "metallicFactor", "roughnessFactor"];

/** The images of metadata, by their numbers. */
async function imagesOf(metadata: Metadata, tell: (unshown: string) => void): Promise<Map<number, Texture>> {
    const found = [...metadata].flatMap(([key, value]) => {
        const match = /^image\.(\d+)\.data$/.exec(key);
        return match && value instanceof Uint8Array ? [[Number(match[1]), value] as const] : [];
    });
    const images = new Map<number, Texture>();
    const textures = await Promise.all(found.map(([, data]) => textureOf(data)));
    for (const [i, [number]] of found.entries()) {
        const texture = textures[i];
        if (texture) images.set(number, texture);
        else tell(`the image ${metadata.get(`image.${number}.name`) ?? number}, which browsers do not read`);
    }
    return images;
}

/** An image as a texture whose first row is at the bottom; undefined if the browser does not know its format. */
async function textureOf(data: Uint8Array): Promise<Texture | undefined> {
    try {
        const options = { imageOrientation: "flipY", colorSpaceConversion: "none" } as const;
        const image = await createImageBitmap(new Blob([data as Uint8Array<ArrayBuffer>]), options);
        const wrap = { wrapS: RepeatWrapping, wrapT: RepeatWrapping };
        return Object.assign(new Texture(image), { ...wrap, flipY: false, needsUpdate: true });
    } catch {
        return undefined;
    }
}

/** Give back what materials hold, and their images, which nobody else closes. */
export function disposeOf(materials: Material[]): void {
    for (const material of materials) {
        for (const texture of Object.values(material)) {
            if (!(texture instanceof Texture)) continue;
            texture.dispose();
            if (texture.image instanceof ImageBitmap) texture.image.close();
        }
        material.dispose();
    }
}

/** The materials of all meshes in an object. */
export function materialsIn(object: Object3D): Material[] {
    const materials = new Set<Material>();
    object.traverse((each) => {
        for (const material of [(each as Partial<Mesh>).material ?? []].flat()) materials.add(material);
    });
    return [...materials];
}

/** The materials of a geometry by their numbers; plain ones where it has none. `tell` hears of what is not shown. */
export async function materialsOf(
    { metadata, pieces, color }: BSMGeometry,
    tell: (unshown: string) => void = (what) => console.warn(`BSM: not shown: ${what}`),
): Promise<MeshStandardMaterial[]> {
    const images = await imagesOf(metadata, tell);
    const length = 1 + Math.max(0, ...pieces.map(({ material }) => material));
    const words = Array.from({ length }, (): Words => new Map());
    for (const [key, value] of metadata) {
        const match = /^material\.(\d+)\.(.+)$/s.exec(key);
        if (match && Number(match[1]) < words.length && (typeof value === "string" || typeof value === "number"))
            words[Number(match[1])].set(match[2], value);
    }
    return words.map((material) => Object.assign(materialOf(material, images), { vertexColors: color !== undefined }));
}

function numbersIn(value: string | number | undefined): number[] {
    const words = String(value ?? "").split(/\s+/);
    return words.filter(Boolean).map(Number);
}

function materialOf(words: Words, images: Map<number, Texture>): MeshStandardMaterial {
    const isMtl = !OF_GLTF.some((name) => words.has(name));
    const name = String(words.get("name") ?? "");
    const material = new MeshStandardMaterial({ name, metalness: isMtl ? 0 : 1, roughness: 1 });
    const color = numbersIn(words.get("baseColorFactor") ?? words.get("Kd"));
    const isBlack = words.has("map_Kd") && !color.some(Boolean); // some programs write that beside an image
    const [r = 1, g = 1, b = 1, a = 1] = isBlack ? [] : color;
    const spaceOf = (factor: string): string => (words.has(factor) ? LinearSRGBColorSpace : SRGBColorSpace); // MTL has colors of screens
    material.color.setRGB(r, g, b, spaceOf("baseColorFactor"));
    const [red = 0, green = 0, blue = 0] = numbersIn(words.get("emissiveFactor") ?? words.get("Ke"));
    material.emissive.setRGB(red, green, blue, spaceOf("emissiveFactor"));
    for (const [name, set] of NUMBERS) if (words.has(name)) material[set] = Number(words.get(name));
    for (const [name, slots] of Object.entries(TEXTURES)) {
        const texture = images.get(Number(words.get(name) ?? NaN));
        if (texture) for (const slot of slots) material[slot] = inSpace(texture, COLORED.includes(slot));
    }
    if (words.has("map_Ke") && red + green + blue === 0) material.emissive.set(0xffffff);
    const opacity = a * Number(words.get("d") ?? 1);
    const mode = words.get("alphaMode");
    material.opacity = opacity;
    material.transparent = mode === "BLEND" || (mode === undefined && opacity < 1);
    if (mode === "MASK") material.alphaTest = Number(words.get("alphaCutoff") ?? 0.5);
    material.side = isMtl || Number(words.get("doubleSided") ?? 0) ? DoubleSide : FrontSide;
    return material;
}

/** A texture in the space of its colors; an image that is used as both is so two textures. */
function inSpace(texture: Texture, colored: boolean): Texture {
    const space = colored ? SRGBColorSpace : NoColorSpace;
    if (texture.colorSpace === space) return texture;
    if (texture.userData.taken) texture = Object.assign(texture.clone(), { needsUpdate: true });
    texture.userData.taken = true;
    texture.colorSpace = space;
    return texture;
}
