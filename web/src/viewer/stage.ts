/** Light and meshes on a canvas: one alone, two behind a wipe, or two side by side. */
import {
    type BufferAttribute,
    type BufferGeometry,
    type DataTexture,
    DirectionalLight,
    BackSide,
    DoubleSide,
    Group,
    type Material,
    MathUtils,
    Mesh,
    MeshBasicMaterial,
    MeshStandardMaterial,
    NeutralToneMapping,
    type Object3D,
    Plane,
    PlaneGeometry,
    PMREMGenerator,
    Raycaster,
    Scene,
    Spherical,
    Vector2,
    Vector3,
    WebGLRenderer,
} from "three";
import { MeshBVH } from "three-mesh-bvh";
import { disposeOf } from "../materials";
import { Camera, frontOf } from "./camera";
import { GROUND, shadowOf, studio } from "./light";
import { normalLines, wrongEdges } from "./overlays";
import { freeAreas } from "./room";

const CLAY = 0xcdc6ba;
const WHITE = 0xffffff;
const WIRES = { wireframe: true, color: 0x101418, transparent: true, opacity: 0.35 };
const THUMB = 44; // pixels of the handle of the wipe
const [QUIET, SMOOTH] = [400, 2]; // milliseconds, and by how much pixels are finer then
const [READY, NORMAL] = [400_000, 0.01]; // faces that are searched without being asked; length of a normal over the diagonal
const [AIMED, BOUNDED] = [50_000, 5_000_000]; // points that the camera makes room for, and that boxes hold

export type Mode = "one" | "wipe" | "split";
export type Shading = "smooth" | "flat" | "wire";
/** What is drawn over a mesh: boundaries and edges of three faces, back faces, or normals. */
export type Overlay = "" | "edges" | "backs" | "normals";

/** A place of a mesh below the pointer: which mesh, one of its faces, and where in its unit. */
export interface Hit {
    index: number;
    geometry: BufferGeometry;
    face: number;
    point: Vector3;
}

type AnyMesh = Mesh<BufferGeometry, Material | Material[]>;

/** A mesh, or the tiles of one, plain or in materials of its own. */
class Figure {
    readonly holder = new Group();
    readonly clay = new MeshStandardMaterial({ color: CLAY, roughness: 0.6, side: DoubleSide });
    own: MeshStandardMaterial[] = [];

    /** Draw these geometries, and no others. */
    put(geometries: BufferGeometry[]): void {
        const fresh = new Set(geometries);
        for (const mesh of [...this.meshes]) {
            if (fresh.delete(mesh.geometry)) continue;
            this.holder.remove(mesh);
            strip(mesh);
            mesh.geometry.dispose();
        }
        for (const geometry of fresh) {
            const mesh = new Mesh(geometry, geometry.userData.material ?? this.clay);
            mesh.frustumCulled = geometries.length > 1; // one alone may grow and move out of its bounds
            this.holder.add(mesh);
        }
        this.wear([]);
    }

    /** Have these materials, and give back those that it had. */
    wear(own: MeshStandardMaterial[]): void {
        disposeOf(this.own);
        this.own = own;
    }

    get meshes(): AnyMesh[] {
        return this.holder.children as AnyMesh[];
    }

    get materials(): MeshStandardMaterial[] {
        return [this.clay, ...this.own, ...this.meshes.flatMap(({ geometry }) => geometry.userData.material ?? [])];
    }
}

/** Take away what is drawn over a mesh. */
function strip(mesh: AnyMesh): void {
    for (const child of mesh.children as Mesh[]) if (child.geometry !== mesh.geometry) child.geometry.dispose();
    mesh.clear();
}

/** Whether something draws that was made for it, and no program. */
function isFast(): boolean {
    const context = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
    const named = context?.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? context?.RENDERER;
    const name = named ? String(context!.getParameter(named)) : "software";
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return !/software|swiftshader|llvmpipe|basic render/i.test(name);
}

export class Stage {
    mode: Mode = "one";
    /** The meshes on the left and on the right, by their numbers; one alone is the right one. */
    sides: [number, number] = [0, 0];
    wipe = 0.5;
    readonly camera: Camera;
    readonly renderer: WebGLRenderer;
    private readonly scene = new Scene();
    private readonly fast = isFast();
    private readonly key = new DirectionalLight(WHITE, 1.5);
    private readonly ground = new Mesh(
        new PlaneGeometry(GROUND, GROUND),
        new MeshBasicMaterial({ color: 0, transparent: true, depthWrite: false, toneMapped: false }),
    );
    private readonly wires = new MeshBasicMaterial(WIRES);
    /** What turns the axis that a mesh calls up to the top. */
    private readonly turned = new Group();
    private readonly drawn = [new Figure(), new Figure(), new Figure()];
    /** How far down the ground is. */
    private depth = Infinity;
    /** Has the camera show everything again. */
    private aim: () => void = () => {};
    /** The standard view that was chosen. */
    private side?: Spherical;
    private readonly marks = new Group();
    private readonly backs = new MeshBasicMaterial({ color: 0xd6006f, side: BackSide });
    private over: Overlay = "";
    private ratio = 0;
    /** Trees of faces, with the places that they were made of. */
    private readonly trees = new WeakMap<BufferGeometry, [places: unknown, faces: unknown, tree: MeshBVH]>();
    private shading: Shading = "smooth";
    private stale = true;
    private moved = 0;

    constructor(readonly canvas: HTMLCanvasElement) {
        this.renderer = new WebGLRenderer({ canvas, antialias: this.fast, alpha: true });
        this.renderer.setPixelRatio(devicePixelRatio);
        this.renderer.autoClear = false;
        this.renderer.toneMapping = NeutralToneMapping;
        this.camera = new Camera(canvas, () => this.redraw());
        const { texture, probe } = studio();
        // A program that draws would need seconds for reflections. What was drawn for them is lost with the context.
        const reflect = (): void =>
            void (this.scene.environment = new PMREMGenerator(this.renderer).fromEquirectangular(texture).texture);
        if (this.fast) reflect();
        else this.scene.add(probe);
        canvas.addEventListener("webglcontextrestored", () => {
            if (this.fast) reflect();
            this.redraw();
        });
        canvas.addEventListener("dblclick", () => this.look());
        this.light = 0;
        this.ground.rotation.x = -Math.PI / 2;
        this.ground.visible = false;
        this.scene.add(this.key, this.ground, this.turned);
        this.turned.add(...this.drawn.map(({ holder }) => holder), this.marks);
    }

    show(index: number, ...geometries: BufferGeometry[]): void {
        const shown = this.drawn[index];
        shown.put(geometries);
        const isColored = geometries.some((geometry) => geometry.hasAttribute("color"));
        this.whiten(shown.clay, isColored);
        this.shade(this.shading);
    }

    /** Lay the box of all meshes around the middle, and turn it by these angles. */
    place(center: number[], diagonal: number, turn: [number, number, number] = [0, 0, 0]): void {
        const { turned } = this;
        turned.rotation.set(...turn);
        turned.scale.setScalar(1 / diagonal);
        turned.position.fromArray(center).negate().multiplyScalar(turned.scale.x).applyEuler(turned.rotation);
        turned.updateWorldMatrix(true, false);
        this.ground.position.y = this.depth;
        this.redraw();
    }

    /** Have points of meshes in the middle, and fill the picture with them, unless the reader chose another place. */
    fill(samples: ArrayLike<number>[], turn?: [number, number, number], normals?: BufferAttribute): void {
        const { camera, turned } = this;
        const [low, high, point] = [Infinity, -Infinity, 0].map((far) => new Vector3(far, far, far));
        const total = samples.reduce((sum, { length }) => sum + length / 3, 0);
        const over = (act: (point: Vector3) => void, most: number): void => {
            const step = 3 * Math.ceil(total / most);
            for (const array of samples)
                for (let i = 0; i < array.length; i += step) if (array[i] === array[i]) act(point.fromArray(array, i));
        };
        over(() => (low.min(point), high.max(point)), BOUNDED);
        if (!(low.x <= high.x)) return;
        if (!camera.touched)
            this.place(low.clone().add(high).divideScalar(2).toArray(), low.distanceTo(high) || 1, turn);
        let depth = Infinity;
        over(() => (depth = Math.min(depth, point.applyMatrix4(turned.matrixWorld).y)), BOUNDED);
        [this.depth, this.ground.position.y] = [depth, depth];
        const [matrix, front] = [turned.matrixWorld.clone(), frontOf(normals).applyEuler(turned.rotation)];
        const root = this.canvas.closest<HTMLElement>(".bsm")!;
        this.aim = () => {
            const areas = freeAreas(root, this.mode === "split" ? 2 : 1);
            camera.aim((act) => over(act, AIMED), matrix, front, areas, this.side);
        };
        if (!camera.touched) this.aim();
    }

    /** Show all of it from a side, by degrees around the upward axis and down from it; without them, as it was first seen. */
    look(angles?: [theta: number, phi: number]): void {
        const [theta, phi] = (angles ?? []).map((angle) => angle * MathUtils.DEG2RAD);
        this.side = angles && new Spherical(1, phi, theta);
        this.camera.touched = false;
        this.aim();
    }

    /** Draw objects over the meshes, in their unit. */
    mark(...objects: Object3D[]): void {
        this.marks.clear().add(...objects);
        this.redraw();
    }

    overlay(over: Overlay): void {
        this.over = over;
        this.shade(this.shading);
    }

    /** Have lines over the meshes follow them to another frame. */
    follow(): void {
        if (this.over === "edges" || this.over === "normals")
            for (const { meshes } of this.drawn) for (const mesh of meshes) this.edge(mesh);
    }

    /** Cut all meshes at a share of their box along an axis, 0 to 2; -1: nowhere. */
    cut(axis: number, share: number, flip: boolean): void {
        const { renderer, turned } = this;
        const plane = new Plane();
        const box = this.drawn[this.sides[1]].meshes[0]?.geometry.boundingBox;
        if (axis >= 0 && box) {
            plane.normal.set(0, 0, 0).setComponent(axis, flip ? 1 : -1);
            plane.constant = -plane.normal.dot(box.min.clone().lerp(box.max, share));
            turned.updateWorldMatrix(true, false);
            plane.applyMatrix4(turned.matrixWorld);
        }
        renderer.clippingPlanes = axis >= 0 && box ? [plane] : [];
        this.redraw();
    }

    /** What is at a place of the canvas; of a large mesh only if that is worth a moment. */
    pick(x: number, y: number, isAsked: boolean): Hit | undefined {
        const { camera, sides, mode, seam, turned, renderer } = this;
        const [width, height] = camera.size;
        const isLeft = mode !== "one" && x < seam;
        const [from, to] = mode !== "split" ? [0, width] : isLeft ? [0, seam] : [seam, width];
        const index = sides[isLeft ? 0 : 1];
        const caster = new Raycaster();
        caster.setFromCamera(new Vector2((2 * (x - from)) / (to - from) - 1, 1 - (2 * y) / height), camera);
        const [plane] = renderer.clippingPlanes as Plane[];
        if (plane?.distanceToPoint(caster.ray.origin) < 0 && !caster.ray.intersectPlane(plane, caster.ray.origin))
            return undefined;
        const ray = caster.ray.clone().applyMatrix4(turned.matrixWorld.clone().invert());
        let best: (Hit & { far: number }) | undefined;
        for (const { geometry } of this.drawn[index].meshes) {
            const faces = geometry.getIndex();
            if (!faces || geometry.drawRange.count < faces.count || (!isAsked && faces.count > 3 * READY)) continue;
            const hit = this.treeOf(geometry).raycastFirst(ray, DoubleSide);
            const isCut = hit && plane?.distanceToPoint(turned.localToWorld(hit.point.clone())) < -1e-6;
            if (hit && !isCut && hit.distance < (best?.far ?? Infinity))
                best = { index, geometry, face: hit.faceIndex!, point: hit.point, far: hit.distance };
        }
        return best;
    }

    private treeOf(geometry: BufferGeometry): MeshBVH {
        const [places, faces] = [geometry.getAttribute("position").array, geometry.getIndex()!.array];
        const [oldPlaces, oldFaces, old] = this.trees.get(geometry) ?? [];
        const tree = old && oldFaces === faces ? old : new MeshBVH(geometry, { indirect: true });
        if (tree === old && oldPlaces !== places) tree.refit(); // another frame
        this.trees.set(geometry, [places, faces, tree]);
        return tree;
    }

    shadow(...geometries: BufferGeometry[]): void {
        const { ground, turned } = this;
        if (this.depth === Infinity) return;
        const before = (ground.material.alphaMap as DataTexture | null) ?? undefined;
        ground.material.alphaMap = shadowOf(geometries, turned.matrixWorld, ground.position.y, before);
        ground.material.needsUpdate ||= !ground.visible;
        ground.visible = true;
        this.redraw();
    }

    clear(): void {
        for (const shown of this.drawn) shown.put([]);
        this.ground.visible = false;
        this.depth = Infinity;
        this.aim = () => {};
        this.side = undefined;
        this.camera.reset();
        this.redraw();
    }

    /** From where one looks, in the unit of the meshes. */
    get eye(): Vector3 {
        this.turned.updateWorldMatrix(true, false);
        return this.turned.worldToLocal(this.camera.position.clone());
    }

    /** The length of a pixel in the middle, in the unit of the meshes. */
    get pixel(): number {
        const { camera, turned } = this;
        return (camera.position.distanceTo(camera.controls.target) * devicePixelRatio) / camera.pixels / turned.scale.x;
    }

    setMaterials(index: number, own: MeshStandardMaterial[]): void {
        this.drawn[index].wear(own);
        this.shade(this.shading);
    }

    shade(shading: Shading): void {
        this.shading = shading;
        for (const shown of this.drawn) {
            for (const material of shown.materials) {
                material.flatShading = shading !== "smooth";
                material.polygonOffset = shading === "wire";
                material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
                material.needsUpdate = true;
            }
            shown.meshes.forEach((mesh) => this.edge(mesh));
        }
        this.redraw();
    }

    /** Color the drawn vertices of a mesh; or none of them; or draw the materials that it has. */
    color(index: number, colors?: BufferAttribute, withOwn = false): void {
        const { meshes, clay, own } = this.drawn[index];
        const material = withOwn && own.length > 0 ? (own.length > 1 ? own : own[0]) : clay;
        for (const mesh of meshes) {
            mesh.material = mesh.geometry.userData.material ?? material;
            if (colors) mesh.geometry.setAttribute("color", colors);
        }
        this.whiten(clay, colors !== undefined);
        this.redraw();
    }

    set light(angle: number) {
        const turn = angle * MathUtils.DEG2RAD;
        this.scene.environmentRotation.y = turn;
        this.key.position.set(-1.2, 1.9, 1.5).applyAxisAngle(this.scene.up, turn);
        this.redraw();
    }

    /** Wipe in the middle of the mesh. */
    halve(): void {
        this.wipe = Math.min(1, Math.max(0, (this.camera.middle - THUMB / 2) / (this.camera.size[0] - THUMB)));
    }

    get seam(): number {
        return this.mode === "split" ? this.camera.size[0] / 2 : THUMB / 2 + this.wipe * (this.camera.size[0] - THUMB);
    }

    redraw(): void {
        this.stale = true;
    }

    /** Draw, if there is anything new; where a program draws, edges are smooth once nothing moves. */
    step(): void {
        this.camera.controls.update();
        const now = performance.now();
        if (this.ratio !== devicePixelRatio) this.fit(); // on another screen
        if (this.stale) this.renew(1, now);
        else if (!this.fast && now - this.moved > QUIET && this.renderer.getPixelRatio() === devicePixelRatio)
            this.renew(SMOOTH, this.moved);
    }

    dispose(): void {
        this.camera.controls.dispose();
        this.clear();
        this.renderer.dispose();
        this.renderer.forceContextLoss(); // a page may have few contexts, and forgets none by itself
    }

    private renew(finer: number, moved: number): void {
        this.moved = moved;
        const ratio = finer * devicePixelRatio;
        if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
        this.draw();
    }

    draw(): void {
        this.stale = false;
        const [width, height] = this.camera.size;
        const { renderer, sides } = this;
        renderer.setScissorTest(false);
        renderer.setViewport(0, 0, width, height);
        renderer.clear();
        if (this.mode === "one") return this.render(sides[1]);
        const places = [0, this.seam, width];
        renderer.setScissorTest(true);
        for (const side of [0, 1]) {
            const [from, to] = [places[side], places[side + 1]];
            renderer.setScissor(from, 0, to - from, height);
            if (this.mode === "split") renderer.setViewport(from, 0, to - from, height);
            this.render(sides[side]);
        }
    }

    private render(index: number): void {
        this.drawn.forEach((shown, number) => (shown.holder.visible = number === index));
        this.renderer.render(this.scene, this.camera);
    }

    private edge(mesh: AnyMesh): void {
        strip(mesh);
        if (this.over === "backs") mesh.add(new Mesh(mesh.geometry, this.backs));
        if (this.over === "edges") mesh.add(wrongEdges(mesh.geometry));
        if (this.over === "normals") mesh.add(normalLines(mesh.geometry, NORMAL / this.turned.scale.x));
        for (const child of mesh.children) [child.frustumCulled, child.renderOrder] = [mesh.frustumCulled, 1];
        if (this.shading !== "wire") return;
        const edges = new Mesh(mesh.geometry, this.wires);
        edges.frustumCulled = mesh.frustumCulled;
        mesh.add(edges);
    }

    private whiten(clay: MeshStandardMaterial, on: boolean): void {
        if (clay.vertexColors === on) return;
        clay.vertexColors = on;
        clay.color.set(on ? WHITE : CLAY);
        clay.needsUpdate = true;
    }

    fit(): void {
        this.ratio = devicePixelRatio;
        const { clientWidth, clientHeight } = this.canvas.parentElement!;
        const { camera, renderer } = this;
        if (clientWidth !== camera.size[0] || clientHeight !== camera.size[1])
            renderer.setSize(clientWidth, clientHeight, false);
        camera.fit(clientWidth, clientHeight, this.mode === "split" ? 2 : 1);
        if (!camera.touched) this.aim();
        this.draw();
    }
}
