/** Camera, light and the mesh on a canvas. */
import { AmbientLight, type BufferAttribute, BufferGeometry, DirectionalLight, DoubleSide, Group, type Material, MathUtils, Mesh, MeshLambertMaterial, PerspectiveCamera, Scene, Spherical, type Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const TURN = Math.PI / 24;
const ZOOM = 1.1;
const FIELD = (35 / 180) * Math.PI; // that is seen of the shorter side
const FAR_ENOUGH = 0.5 / Math.sin(FIELD / 2); // for a ball around a box whose diagonal is 1
const PLAIN = 0x7d8fa9;
const WHITE = 0xffffff;

export class Stage {
    private readonly renderer: WebGLRenderer;
    private readonly camera = new PerspectiveCamera(35, 1, 0.01, 100);
    private readonly scene = new Scene();
    private readonly controls: OrbitControls;
    private readonly material = new MeshLambertMaterial({ color: PLAIN, side: DoubleSide });
    private readonly watch = new ResizeObserver(() => this.fit());
    /** What turns the axis that a mesh calls up to the top. */
    private readonly turned = new Group();
    private mesh = new Mesh<BufferGeometry, Material | Material[]>(new BufferGeometry(), this.material);
    private readonly tiles = new Group();
    private clothes?: Material[];

    constructor(private readonly canvas: HTMLCanvasElement) {
        this.renderer = new WebGLRenderer({ canvas, antialias: isFast(), alpha: true });
        this.renderer.setPixelRatio(devicePixelRatio);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.addEventListener("change", () => this.draw());
        this.camera.position.set(0.5, 0.4, 2.1).setLength(FAR_ENOUGH);
        const light = new DirectionalLight(0xffffff, 2.8);
        light.position.set(1, 2, 3);
        this.camera.add(light);
        this.scene.add(this.camera, new AmbientLight(0xffffff, 0.5), this.turned);
        this.turned.add(this.mesh, this.tiles);
        this.controls.update();
        canvas.addEventListener("keydown", (event) => this.turn(event));
        this.watch.observe(canvas.parentElement!);
    }

    /** Show a geometry whose bounding box has this centre and diagonal, turned by these angles. */
    show(geometry: BufferGeometry, center: number[], diagonal: number, turn: [number, number, number]): void {
        this.turned.remove(this.mesh);
        this.tiles.clear();
        this.mesh.geometry.dispose();
        this.dress();
        this.turned.rotation.set(...turn);
        this.mesh = new Mesh(geometry, this.material);
        this.mesh.frustumCulled = false;
        this.mesh.scale.setScalar(1 / diagonal);
        this.mesh.position.set(-center[0] / diagonal, -center[1] / diagonal, -center[2] / diagonal);
        this.turned.add(this.mesh);
        this.draw();
    }

    /** Show these geometries together, which lie around a centre; those that are not among them go. */
    together(geometries: BufferGeometry[], center: number[], diagonal: number): void {
        this.mesh.visible = false;
        const fresh = new Set(geometries);
        for (const mesh of [...this.tiles.children] as Mesh[]) if (!fresh.delete(mesh.geometry)) this.tiles.remove(mesh);
        for (const geometry of fresh) this.tiles.add(new Mesh(geometry, this.material));
        this.tiles.scale.setScalar(1 / diagonal);
        this.tiles.position.set(-center[0] / diagonal, -center[1] / diagonal, -center[2] / diagonal);
        this.whiten(geometries.some((geometry) => geometry.hasAttribute("color")));
        this.draw();
    }

    /** From where one looks, in the unit of what is shown together, and how many pixels a unit has at a distance of 1. */
    get eye(): { place: Vector3; pixels: number } {
        this.tiles.updateWorldMatrix(true, false);
        const place = this.tiles.worldToLocal(this.camera.position.clone());
        return { place, pixels: this.canvas.height / (2 * Math.tan(this.camera.fov / 2 / MathUtils.RAD2DEG)) };
    }

    /** Draw with materials of its own, or with none again. */
    dress(materials?: Material[]): void {
        if (materials !== this.clothes) this.clothes?.forEach((material) => material.dispose());
        this.clothes = materials;
    }

    set wireframe(on: boolean) {
        for (const material of [this.material, ...(this.clothes ?? [])]) (material as MeshLambertMaterial).wireframe = on;
        this.draw();
    }

    /** Shade each face by itself. */
    set flat(on: boolean) {
        for (const material of [this.material, ...(this.clothes ?? [])] as MeshLambertMaterial[]) {
            material.flatShading = on;
            material.needsUpdate = true;
        }
        this.draw();
    }

    /** Colour the drawn vertices; or none of them; or draw the materials that there are. */
    colour(colours?: BufferAttribute, dressed = false): void {
        const on = colours !== undefined;
        const { clothes } = this;
        this.mesh.material = dressed && clothes ? (clothes.length > 1 ? clothes : clothes[0]) : this.material;
        if (colours) this.mesh.geometry.setAttribute("color", colours);
        this.whiten(on);
        this.draw();
    }

    /** Let vertices have colours, or not. */
    private whiten(on: boolean): void {
        if (this.material.vertexColors === on) return;
        this.material.vertexColors = on;
        this.material.color.set(on ? WHITE : PLAIN);
        this.material.needsUpdate = true;
    }

    draw(): void {
        this.renderer.render(this.scene, this.camera);
    }

    /** Give back what the machine's graphics hold. */
    dispose(): void {
        this.watch.disconnect();
        this.controls.dispose();
        this.mesh.geometry.dispose();
        this.dress();
        this.material.dispose();
        this.renderer.dispose();
    }

    private fit(): void {
        const { clientWidth, clientHeight } = this.canvas.parentElement!;
        this.renderer.setSize(clientWidth, clientHeight, false);
        this.camera.aspect = clientWidth / Math.max(clientHeight, 1);
        this.camera.fov = 2 * MathUtils.RAD2DEG * Math.atan(Math.tan(FIELD / 2) / Math.min(this.camera.aspect, 1));
        this.camera.updateProjectionMatrix();
        this.draw();
    }

    private turn(event: KeyboardEvent): void {
        const place = new Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
        if (event.key === "ArrowLeft") place.theta -= TURN;
        else if (event.key === "ArrowRight") place.theta += TURN;
        else if (event.key === "ArrowUp") place.phi -= TURN;
        else if (event.key === "ArrowDown") place.phi += TURN;
        else if (event.key === "+") place.radius /= ZOOM;
        else if (event.key === "-") place.radius *= ZOOM;
        else return;
        event.preventDefault();
        this.camera.position.setFromSpherical(place.makeSafe()).add(this.controls.target);
        this.controls.update();
        this.draw();
    }
}

/** Whether something draws that was made for it; where programs do, smooth edges would take most of the time. */
function isFast(): boolean {
    const context = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
}
