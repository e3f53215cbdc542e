/** What a header may not say of blocks, runs and the paper's codec (specification, F 4.6). */
import { PAPER_FIELDS } from "./constants";
import { mostCopies, refuse, type Header, type Paper } from "./header";

/** The field `paper`: numbers in the place of the law's constants. */
export function readPaper(numbers: number[], law: Paper): Paper {
    const fields = Object.entries(PAPER_FIELDS);
    refuse(`a paper of ${numbers.length} numbers`, numbers.length !== fields.length);
    for (const [name, { key, type, low, high }] of fields) {
        const value = numbers[key];
        refuse(`a paper with ${name} = ${value}`, value < low || value > high || (type === "int" && value % 1 !== 0));
    }
    refuse("a paper that says what the law says", fields.every(([name, { key }]) => numbers[key] === law[name as keyof Paper]));
    return Object.fromEntries(fields.map(([name, { key }]) => [name, numbers[key]])) as unknown as Paper;
}

/** Of a run that has the mesh of another one; `more`: it has fields of its own. */
export function checkAgain({ again = 0, run }: Header, more: boolean): void {
    refuse("the mesh of a run that has not been", again >= run);
    refuse("the mesh of another run, and fields of its own", more);
}

/** Of a mesh of blocks. */
export function checkBlocks(header: Header): void {
    const { vertices, blocks, blockSize, coefficients, gopFrames, refinement } = header;
    const [step = 1, ratio = 1] = refinement;
    refuse("neither blocks nor a grid", blocks * blockSize * coefficients === 0);
    refuse("a lattice without a grid", header.lattice.length > 0);
    refuse("a corner without a grid", header.corner.length > 0);
    refuse("light values without a grid", header.light > 0);
    refuse("more blocks than vertices", blocks > vertices);
    refuse("blocks larger than the mesh", blockSize > vertices);
    refuse("blocks too small to cover the mesh", blocks * blockSize < vertices);
    refuse("blocks that overlap too much", blocks * blockSize > mostCopies(vertices));
    refuse("more coefficients than a block has vertices", coefficients > blockSize);
    refuse("a refinement that is not a step and a ratio", refinement.length === 1);
    refuse("a step of a refinement out of its range", step < 2 ** -40 || step > 1);
    refuse("a ratio of a refinement out of its range", ratio < 1 / 16);
    refuse("refinement of a sequence", refinement.length > 0 && gopFrames > 0);
}
