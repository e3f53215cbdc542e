/** Where the vertices of a scene are while it moves: bones, morph targets and nodes, as three.js animates them. */
import { type AnimationClip, AnimationMixer, LoopOnce, type Mesh, type Object3D, Vector3 } from "three";

const RATES = [12, 15, 24, 25, 30, 48, 50, 60, 72, 90, 100, 120]; // frames per second that are likely
const USUAL = 24;

/** The likely rate that has a frame at each of these times in seconds. */
export function rateOf(times: number[]): number {
    const isAtFrames = (rate: number): boolean =>
        times.every((time) => Math.abs((time - times[0]) * rate - Math.round((time - times[0]) * rate)) < 0.02);
    return RATES.find(isAtFrames) ?? USUAL;
}

/** The drawn meshes of a scene, in the order in which they become one. */
function meshesIn(root: Object3D): Mesh[] {
    const found: Mesh[] = [];
    root.traverse((each) => {
        const { isMesh, geometry } = each as Mesh;
        if (isMesh && geometry.attributes.position?.count > 0) found.push(each as Mesh);
    });
    return found;
}

/** Positions of all vertices in each frame, the frames, and how many there are in a second. */
export type Poses = { positions: Float32Array | Float64Array; frames: number; rate: number };

/** Positions of all vertices in each frame of a clip, from its first key to its last; one frame if nothing moves. */
export function posesOf(root: Object3D, clip?: AnimationClip): Poses {
    const times = [...new Set(clip?.tracks.flatMap((track) => [...track.times]))].sort((a, b) => a - b);
    const [rate, meshes, mixer, point] = [rateOf(times), meshesIn(root), new AnimationMixer(root), new Vector3()];
    const frames = clip ? Math.floor((times.at(-1)! - times[0]) * rate + 1e-3) + 1 : 1;
    const action = clip && mixer.clipAction(clip).setLoop(LoopOnce, 1).play();
    if (action) action.clampWhenFinished = true;
    const size = 3 * meshes.reduce((sum, { geometry }) => sum + geometry.attributes.position.count, 0);
    const positions = new Float64Array(size * frames);
    for (let frame = 0, at = 0; frame < frames; frame++) {
        if (clip) mixer.setTime(times[0] + frame / rate);
        root.updateMatrixWorld(true);
        for (const mesh of meshes)
            for (let i = 0; i < mesh.geometry.attributes.position.count; i++, at += 3)
                mesh.getVertexPosition(i, point).applyMatrix4(mesh.matrixWorld).toArray(positions, at);
    }
    const moves = positions.some((number, i) => number !== positions[i % size]);
    return moves ? { positions, frames, rate } : { positions: positions.subarray(0, size), frames: 1, rate };
}
