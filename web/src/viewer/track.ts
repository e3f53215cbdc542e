/** The way of a moving mesh, for a camera that follows it. */
import { Box3, Vector3 } from "three";

const STRAYS = 0.4; // how far a mesh moves from its middle, in its own diagonals, before the camera follows
const SMOOTH = 0.5; // seconds to each side of which a middle is the mean
const SAMPLED = 2000; // vertices of a frame that are looked at

/** The middle of each frame, smoothed; all are the same where the mesh stays about where it is. */
export class Track {
    private readonly middles: Vector3[] = [];

    constructor(frames: ArrayLike<number>[], rate: number) {
        const boxes = frames.map(boxOf);
        const all = boxes.reduce((union, box) => union.union(box), new Box3());
        const middle = all.getCenter(new Vector3());
        const sizes = boxes.map((box) => box.getSize(new Vector3()).length()).sort((a, b) => a - b);
        const centers = boxes.map((box) => box.getCenter(new Vector3()));
        const strays = Math.max(0, ...centers.map((center) => center.distanceTo(middle)));
        if (strays <= STRAYS * (sizes[sizes.length >> 1] ?? 1)) {
            this.middles = centers.map(() => middle);
            return;
        }
        const half = Math.max(1, Math.round(SMOOTH * rate));
        this.middles = centers.map((_, i) => {
            const near = centers.slice(Math.max(0, i - half), i + half + 1);
            return near.reduce((sum, center) => sum.add(center), new Vector3()).divideScalar(near.length);
        });
    }

    /** Where the camera looks at a frame, in the unit of the mesh. */
    at(frame: number): Vector3 {
        return this.middles[Math.min(frame, this.middles.length - 1)] ?? new Vector3();
    }
}

function boxOf(positions: ArrayLike<number>): Box3 {
    const [box, point] = [new Box3(), new Vector3()];
    const step = 3 * Math.ceil(positions.length / 3 / SAMPLED);
    for (let i = 0; i + 2 < positions.length; i += step) if (positions[i] === positions[i]) box.expandByPoint(point.fromArray(positions, i));
    return box;
}
