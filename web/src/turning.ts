/** Keys that turn and zoom a camera around its target. */
import { Spherical } from "three";
import type { OrbitControls } from "three/addons/controls/OrbitControls.js";

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

/** Nearest and farthest distance from the middle, over that which shows all. */
export const REACH = [0.04, 5];

/** Move the camera as a key says; returns whether it says so. */
export function turnBy(key: string, { object, target, minDistance, maxDistance }: OrbitControls): boolean {
    const step = STEPS[key];
    if (!step) return false;
    const place = new Spherical().setFromVector3(object.position.sub(target));
    place.theta += step[0];
    place.phi += step[1];
    place.radius = Math.min(Math.max(place.radius * step[2], minDistance), maxDistance);
    object.position.setFromSpherical(place.makeSafe()).add(target);
    return true;
}
