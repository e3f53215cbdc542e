/** The camera: it shows the front of a mesh first, as large as the picture, and follows mouse, touch and keys. */
import { type BufferAttribute, MathUtils, Matrix4, PerspectiveCamera, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { REACH, turnBy } from "../turning";
import type { Area } from "./room";

const FIELD = (30 / 180) * Math.PI; // of view, along the shorter side
const NARROW = FIELD / 30; // so narrow that rays are nearly parallel
const AROUND = 1.06 / Math.sin(FIELD / 2); // distance that shows a whole ball of radius 1
const FILLED = 0.94; // of the picture
const VIEW = new Spherical(1, 72 * MathUtils.DEG2RAD, 35 * MathUtils.DEG2RAD); // the first view
const OPEN = 0.15; // length of the mean normal of a surface that has a front

/** The corners of all meshes, one after the other: what `act` is given is used again. */
export type Points = (act: (point: Vector3) => void) => void;

/** The mean normal of the vertices of a surface: that of a closed one is nearly 0. */
export function frontOf(normals?: BufferAttribute): Vector3 {
    const [front, normal] = [new Vector3(), new Vector3()];
    for (let i = 0; i < (normals?.count ?? 0); i++) front.add(normal.fromBufferAttribute(normals!, i));
    return front.divideScalar(normals?.count || 1);
}

export class Camera extends PerspectiveCamera {
    touched = false;
    size = [1, 1];
    /** Where the middle of the mesh is, in pixels from the left. */
    middle = 0.5;
    private field = FIELD;
    /** Pixels of one mesh, which are half of them where there are two side by side. */
    private part = [1, 1];
    readonly controls: OrbitControls;

    constructor(
        canvas: HTMLCanvasElement,
        private readonly redraw: () => void,
    ) {
        super(30, 1, 0.01, 1000);
        this.controls = new OrbitControls(this, canvas);
        this.controls.enableDamping = true;
        this.controls.autoRotateSpeed = 4;
        this.controls.addEventListener("change", redraw);
        this.controls.addEventListener("start", () => (this.touched = true));
        canvas.addEventListener("keydown", (event) => this.turn(event));
        this.reset();
    }

    reset(): void {
        this.touched = false;
        this.position.setFromSpherical(VIEW).setLength(AROUND / 2);
        this.controls.target.set(0, 0, 0);
    }

    fit(width: number, height: number, beside: number): void {
        this.size = [width, height];
        this.part = [width / beside, Math.max(height, 1)];
        if (!this.view) this.middle = this.part[0] / 2;
        this.aspect = this.part[0] / this.part[1];
        this.fov = 2 * MathUtils.RAD2DEG * Math.atan(Math.tan(this.field / 2) / Math.min(this.aspect, 1));
        this.updateProjectionMatrix();
    }

    /** Have rays be nearly parallel, or no longer, and what is in the middle as large as it is. */
    setParallel(isParallel: boolean): void {
        const before = this.field;
        this.field = isParallel ? NARROW : FIELD;
        const { target } = this.controls;
        const scale = Math.tan(before / 2) / Math.tan(this.field / 2);
        [this.controls.minDistance, this.controls.maxDistance] = [0, Infinity];
        this.position.sub(target).multiplyScalar(scale).add(target);
        this.near = isParallel ? 1 : 0.01;
    }

    /** Pixels of a unit at a distance of 1. */
    get pixels(): number {
        return (this.size[1] * devicePixelRatio) / (2 * Math.tan(this.fov / 2 / MathUtils.RAD2DEG));
    }

    /** Show points, which a matrix puts around the origin, from their front, in that area where they are largest. */
    aim(points: Points, matrix: Matrix4, front: Vector3, areas: Area[], side?: Spherical): void {
        const begin = (side ?? VIEW).clone();
        if (!side && Math.hypot(front.x, front.z) > OPEN) begin.theta += Math.atan2(front.x, front.z);
        this.controls.target.set(0, 0, 0);
        [this.controls.minDistance, this.controls.maxDistance] = [0, Infinity];
        this.position.setFromSpherical(begin);
        this.controls.update();
        const [width, height] = this.part;
        const turn = new Matrix4().makeRotationFromQuaternion(this.quaternion.clone().invert());
        const towards = turn.multiply(matrix);
        const pixel = (FILLED * Math.tan(this.fov / 2 / MathUtils.RAD2DEG)) / height;
        const distances = areas.map(() => 0.1);
        points((point) => {
            const { x, y, z } = point.applyMatrix4(towards);
            areas.forEach(({ left, right, top, bottom }, i) => {
                const far = z + Math.max(Math.abs(x) / (right - left), Math.abs(y) / (bottom - top)) / pixel;
                if (far > distances[i]) distances[i] = far;
            });
        });
        const best = distances.indexOf(Math.min(...distances));
        const { left, right, top, bottom } = areas[best];
        this.middle = (left + right) / 2;
        this.setViewOffset(width, height, (width - left - right) / 2, (height - top - bottom) / 2, width, height);
        this.position.setLength(distances[best]);
        [this.controls.minDistance, this.controls.maxDistance] = REACH.map((share) => share * distances[best]);
        this.far = 4 * REACH[1] * distances[best];
        this.updateProjectionMatrix();
        this.redraw();
    }

    private turn(event: KeyboardEvent): void {
        if (!turnBy(event.key, this.controls)) return;
        event.preventDefault();
        this.touched = true;
        this.controls.update();
        this.redraw();
    }
}
