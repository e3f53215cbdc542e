/** What a mesh on a light grid costs, in nanoseconds of a processor core (specification, M 14.3). */

/** Of faces and graph; what meets at more vertices than a closed surface has is sewn together. */
export function meshCost(vertices: number, faces: number, received: number): number {
    return 140 * vertices + 85 * faces + 700 * Math.max(0, faces / 2 - vertices) + 400 * received;
}

/** Of a grid before its bytes are counted, and of each of its frames. */
export const LIGHT_COST = {
    whole: (vertices: number, faces: number): number => 200 * vertices + 40 * faces,
    frame: (received: number): number => 5e4 + 120 * received,
};
