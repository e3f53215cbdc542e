/**
 * The parts of three.js, and of what is built on it, with which the page of `bsm view` draws.
 *
 * Its build as one module holds everything that a renderer can do, so the sources are bundled instead. Modules that the
 * page never calls are replaced by what is asked of them all the same, and shaders lose the branches of features that no
 * material, light or geometry of the page has. What is left draws the same pixels: only what never runs is left out.
 */
import { readFileSync } from "node:fs";
import { join } from "node:path";

/** What materials, lights and geometries of the page never define. */
const ABSENT = new Set([
    ...["PHYSICAL", "LAMBERT", "PHONG", "DISTANCE", "DITHERING", "ALPHA_TO_COVERAGE", "IOR", "ENVMAP_TYPE_CUBE"],
    ...["DECODE_VIDEO_TEXTURE", "DECODE_VIDEO_TEXTURE_EMISSIVE", "PREMULTIPLIED_ALPHA", "USE_ALPHAHASH"],
    ...["USE_ANISOTROPY", "USE_ANISOTROPYMAP", "USE_BATCHING", "USE_BATCHING_COLOR", "USE_BUMPMAP"],
    ...["USE_CLEARCOAT", "USE_CLEARCOATMAP", "USE_CLEARCOAT_NORMALMAP", "USE_CLEARCOAT_ROUGHNESSMAP"],
    ...["USE_DIFFUSE_ROUGHNESS", "USE_DIFFUSE_ROUGHNESSMAP", "USE_DISPERSION", "USE_DISPLACEMENTMAP", "USE_FOG"],
    ...["USE_GRADIENTMAP", "USE_INSTANCING", "USE_INSTANCING_COLOR", "USE_INSTANCING_MORPH", "USE_IRIDESCENCE"],
    ...["USE_IRIDESCENCEMAP", "USE_IRIDESCENCE_THICKNESSMAP", "USE_LIGHTMAP", "USE_LOGARITHMIC_DEPTH_BUFFER"],
    ...["USE_MATCAP", "USE_MORPHCOLORS", "USE_MORPHNORMALS", "USE_MORPHTARGETS", "USE_NORMALMAP_OBJECTSPACE"],
    ...["USE_PACKED_NORMALMAP", "USE_POINTS_UV", "USE_RETROREFLECTION", "USE_REVERSED_DEPTH_BUFFER", "USE_SHADOWMAP"],
    ...["USE_SHEEN", "USE_SHEEN_COLORMAP", "USE_SHEEN_ROUGHNESSMAP", "USE_SKINNING", "USE_SPECULAR", "USE_SPECULARMAP"],
    ...["USE_SPECULAR_COLORMAP", "USE_SPECULAR_INTENSITYMAP", "USE_THICKNESSMAP", "USE_TRANSMISSION"],
    "USE_TRANSMISSIONMAP",
]);
/** Lights of which the page has none, and shadows. */
const NONE =
    /^NUM_(?:(?:SUN|SPOT|POINT|RECT_AREA)_LIGHTS|SPOT_LIGHT_(?:COORDS|MAPS)|LIGHT_PROBE_GRIDS|\w+_SHADOWS) > 0$/;
/** Shaders of materials that the page does not have, and of backgrounds; "cube" is what reflections are made with. */
const UNUSED =
    /(?:background|backgroundCube|depth|distance|equirect|linedashed|mesh(?:lambert|matcap|normal|phong|toon)|shadow|sprite|vsm)\.glsl\.js$/;
/** What the renderer still asks of modules that never run. */
const STAND_INS = [
    [
        /WebXRManager\.js$/,
        "export class WebXRManager extends EventTarget { enabled = false; dispose() {} setAnimationLoop() {} getEnvironmentBlendMode() {} }",
    ],
    [/WebGLShadowMap\.js$/, "export class WebGLShadowMap { enabled = false; render() {} }"],
    [/WebGLUniformsGroups\.js$/, "export class WebGLUniformsGroups { dispose() {} }"],
    [/WebGLOutput\.js$/, "export const WebGLOutput = undefined;"],
    [
        /three-mesh-bvh.*(?:bvhcast|(?:intersects|closestPointTo)Geometry(?:_indirect)?\.generated)\.js$/,
        ["bvhcast", "closestPointToGeometry", "closestPointToGeometry_indirect"]
            .concat(["intersectsGeometry", "intersectsGeometry_indirect"])
            .map((name) => `export const ${name} = undefined;`)
            .join(""),
    ],
];

/** The operands of an operator that stands outside of all parentheses. */
function operandsOf(condition, operator) {
    const operands = [""];
    let depth = 0;
    for (const word of condition.split(/([()]|\|\||&&)/)) {
        if (word === "(") depth++;
        if (word === ")") depth--;
        if (depth === 0 && word === operator) operands.push("");
        else operands[operands.length - 1] += word;
    }
    return operands.map((operand) => operand.trim());
}

/** Whether a condition of a shader holds; what is left of it where the page does not tell. */
function resolved(condition) {
    for (const [operator, decisive] of [
        ["||", true],
        ["&&", false],
    ]) {
        const operands = operandsOf(condition, operator);
        if (operands.length < 2) continue;
        const rest = operands.map(resolved).filter((operand) => operand !== !decisive);
        if (rest.includes(decisive)) return decisive;
        return rest.length > 0 ? rest.join(` ${operator} `) : !decisive;
    }
    const [, not, name] = /^(! ?)?defined ?\( ?(\w+) ?\)$/.exec(condition) ?? [];
    if (ABSENT.has(name)) return not !== undefined;
    if (name === undefined && condition.startsWith("(")) {
        const rest = resolved(condition.slice(1, -1).trim());
        return typeof rest === "string" ? `( ${rest} )` : rest;
    }
    return NONE.test(condition) ? false : condition;
}

/** A shader without comments, indents, and branches that the page never takes. */
function brief(shader) {
    const written = [];
    /** The conditions around a line: whether its branch is kept, a branch before it is, and no other can be taken. */
    const around = [];
    for (const raw of shader.replace(/\/\*[^]*?\*\/|\/\/.*$/gm, "").split("\n")) {
        const line = raw.trim();
        const [, word, rest] = /^#(if|ifdef|ifndef|elif|else|endif)\b *(.*)$/.exec(line) ?? [];
        const last = word?.startsWith("if") ? { isKept: false, isOpen: false, isOver: false } : around.at(-1);
        if (word?.startsWith("if")) around.push(last);
        const isOutside = around.every(({ isKept }) => isKept);
        if (!word) {
            if (line && isOutside) written.push(line);
            continue;
        }
        const isReached = around.slice(0, -1).every(({ isKept }) => isKept);
        if (word === "endif") {
            around.pop();
            if (isReached && last.isOpen) written.push("#endif");
            continue;
        }
        const named = { ifdef: `defined( ${rest} )`, ifndef: `! defined( ${rest} )`, else: "" }[word] ?? rest;
        const condition = word === "else" || resolved(named);
        last.isKept = !last.isOver && condition !== false;
        if (!last.isKept) continue;
        last.isOver = condition === true;
        if (isReached && last.isOver && last.isOpen) written.push("#else");
        if (last.isOver) continue;
        if (isReached) written.push(`#${last.isOpen ? "elif" : "if"} ${condition}`);
        last.isOpen = true;
    }
    return written.map((line) => `${line}\n`).join("");
}

/** Bundles these parts in place of three.js as a whole. */
export const drawingOnly = (folder) => ({
    name: "drawing only",
    setup({ onResolve, onLoad }) {
        const path = join(folder, "node_modules/three/src/Three.js");
        onResolve({ filter: /^three$/ }, () => ({ path, sideEffects: false }));
        onLoad({ filter: /three.src.renderers.shaders.*\.glsl\.js$/ }, ({ path }) => {
            const shaderOf = (_, shader) => `\`${UNUSED.test(path) ? "" : brief(shader)}\``;
            return { contents: readFileSync(path, "utf8").replace(/`([^]*?)`/g, shaderOf), loader: "js" };
        });
        onLoad({ filter: /GLTFExporter\.js$/ }, ({ path }) => {
            const extension = /this\.register\( function \( writer \) \{[^]*?\} \);/g; // of lights and other materials
            return { contents: readFileSync(path, "utf8").replace(extension, ""), loader: "js" };
        });
        for (const [filter, contents] of STAND_INS) onLoad({ filter }, () => ({ contents, loader: "js" }));
    },
});
