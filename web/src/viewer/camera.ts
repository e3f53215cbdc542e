/** The camera: it shows the front of a mesh first, as large as the picture, and follows mouse, touch and keys. */
import { type BufferAttribute, MathUtils, Matrix4, PerspectiveCamera, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const TURN = Math.PI / 24;
const ZOOM = 1.1;
const FIELD = (30 / 180) * Math.PI; // of view, along the shorter side
const AROUND = 1.06 / Math.sin(FIELD / 2); // distance that shows a whole ball of radius 1
const FILLED = 0.94; // of the picture
const DOCK = 70; // pixels of the controls at the bottom
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
    /** Whether the reader has moved it. */
    touched = false;
    /** Pixels of the picture. */
    size = [1, 1];
    readonly controls: OrbitControls;

    constructor(canvas: HTMLCanvasElement, private readonly redraw: () => void) {
        super(30, 1, 0.01, 100);
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
        this.aspect = width / beside / Math.max(height, 1);
        this.fov = 2 * MathUtils.RAD2DEG * Math.atan(Math.tan(FIELD / 2) / Math.min(this.aspect, 1));
        this.updateProjectionMatrix();
    }

    /** Pixels of a unit at a distance of 1. */
    get pixels(): number {
        return (this.size[1] * devicePixelRatio) / (2 * Math.tan(this.fov / 2 / MathUtils.RAD2DEG));
    }

    /** Show points, which a matrix puts around the origin, from the side of their front, if they have one. */
    aim(points: Points, matrix: Matrix4, front: Vector3): void {
        const begin = VIEW.clone();
        if (Math.hypot(front.x, front.z) > OPEN) begin.theta += Math.atan2(front.x, front.z);
        this.position.setFromSpherical(begin);
        this.controls.update();
        const [width, height] = this.size;
        const towards = matrix.clone().premultiply(new Matrix4().makeRotationFromQuaternion(this.quaternion.clone().invert()));
        const seen = FILLED * Math.tan(this.fov / 2 / MathUtils.RAD2DEG);
        const [wide, tall] = [seen * (width / height), Math.max(seen * (1 - (2 * DOCK) / height), seen / 2)];
        let far = 0.1;
        points((point) => {
            const { x, y, z } = point.applyMatrix4(towards);
            far = Math.max(far, z + Math.abs(x) / wide, z + Math.abs(y) / tall);
        });
        this.position.setLength(far);
        this.redraw();
    }

    /** Its position around the target. */
    get place(): Spherical {
        return new Spherical().setFromVector3(this.position.clone().sub(this.controls.target));
    }

    set place(place: Spherical) {
        this.position.setFromSpherical(place.makeSafe()).add(this.controls.target);
        this.controls.update();
        this.redraw();
    }

    private turn(event: KeyboardEvent): void {
        const { place } = this;
        if (event.key === "ArrowLeft") place.theta -= TURN;
        else if (event.key === "ArrowRight") place.theta += TURN;
        else if (event.key === "ArrowUp") place.phi -= TURN;
        else if (event.key === "ArrowDown") place.phi += TURN;
        else if (event.key === "+") place.radius /= ZOOM;
        else if (event.key === "-") place.radius *= ZOOM;
        else return;
        event.preventDefault();
        this.touched = true;
        this.place = place;
    }
}
