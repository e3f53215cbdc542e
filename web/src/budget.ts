import { checkLimit, type Limits } from "./limits";

/** How much work a decoder may still do (specification, M 14.3). */
export class Budget {
    private owed = 0;
    private vertices = 0;

    constructor(private readonly limits: Limits) {}

    /** Take note of vertices that the stream really has. */
    grant(vertices: number): void {
        this.vertices += vertices;
    }

    /** Take note of work to come, and of the bytes that ask for it. */
    charge(work: number, received = 0): void {
        const { limits, vertices } = this;
        this.owed += Math.max(0, work - limits.workPerByte * received);
        checkLimit({ ...limits, work: limits.work + limits.workPerVertex * vertices }, "work", this.owed);
    }
}

/** Work on faces and graph, in nanoseconds of a processor core (M 14.3); fans beyond a closed surface are sewn together. */
export function meshCost(vertices: number, faces: number, received: number): number {
    return 140 * vertices + 85 * faces + 700 * Math.max(0, faces / 2 - vertices) + 400 * received;
}

/** Work on a grid before its bytes are counted, and on each of its sections. */
export const LIGHT_COST = {
    whole: (vertices: number, faces: number): number => 200 * vertices + 40 * faces,
    frame: (received: number): number => 5e4 + 120 * received,
};
