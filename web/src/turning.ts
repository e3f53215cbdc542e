/** Keys that turn and zoom a camera around its target. */
import { type PerspectiveCamera, Spherical, type Vector3 } from "three";

const TURN = Math.PI / 24;
const ZOOM = 1.1;
const STEPS: Record<string, [theta: number, phi: number, radius: number]> = {
    ArrowLeft: [-TURN, 0, 1],
    ArrowRight: [TURN, 0, 1],
    ArrowUp: [0, -TURN, 1],
    ArrowDown: [0, TURN, 1],
    "+": [0, 0, 1 / ZOOM],
    "-": [0, 0, ZOOM],
};

/** Move the camera as a key says; returns whether it says so. */
export function turnBy(key: string, camera: PerspectiveCamera, target: Vector3): boolean {
    const step = STEPS[key];
    if (!step) return false;
    const place = new Spherical().setFromVector3(camera.position.sub(target));
    place.theta += step[0];
    place.phi += step[1];
    place.radius *= step[2];
    camera.position.setFromSpherical(place.makeSafe()).add(target);
    return true;
}
