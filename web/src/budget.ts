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
