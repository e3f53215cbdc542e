/** What a header may not say of blocks and of runs (specification, F 4.6). */
import { mostCopies, refuse, sectionsOf, type Header } from "./header";

/** Of a run that has the mesh of another one; `more`: it has fields of its own. */
export function checkAgain(header: Header, more: boolean): void {
    refuse("more vertices than the corners of its faces", header.vertices > 3 * header.faces);
    refuse("the mesh of a run that has not been", header.again > header.run);
    refuse("no length for GOPs", header.gopFrames === 0);
    refuse("the mesh of another run, and fields of its own", more);
}

/** Of a mesh of blocks. */
export function checkBlocks(header: Header): void {
    const { vertices, faces, blocks, blockSize, coefficients, details, detailStep, frames, gopFrames, sections } = header;
    const steps = header.refinements.filter((_, i) => i % 2 === 0);
    const before = sectionsOf(header).at(-2) ?? { blocks: 0, faces: 0 };
    const ratios = header.refinements.filter((_, i) => i % 2 === 1);
    refuse("neither blocks nor a grid", blocks * blockSize * coefficients === 0);
    refuse("a lattice without a grid", header.lattice.length > 0);
    refuse("a corner without a grid", header.corner.length > 0);
    refuse("light values without a grid", header.light > 0);
    refuse("more vertices than the corners of its faces", vertices > 3 * faces);
    refuse("more blocks than vertices", blocks > vertices);
    refuse("blocks larger than the mesh", blockSize > vertices);
    refuse("blocks too small to cover the mesh", blocks * blockSize < vertices);
    refuse("blocks that overlap too much", blocks * blockSize > mostCopies(vertices));
    refuse("more coefficients than a block has vertices", coefficients > blockSize);
    refuse("more details than a block has vertices", details > blockSize);
    refuse("details without a step, or a step without details", details > 0 !== detailStep > 0);
    refuse("frames without a length for GOPs", frames > 0 && gopFrames === 0);
    refuse("a run of a static mesh", header.run > 0 && gopFrames === 0);
    refuse("refinements that are not pairs of step and ratio", steps.length !== ratios.length);
    refuse("a step of a refinement out of its range", !steps.every((step) => step >= 2 ** -40 && step <= 1));
    refuse("a ratio of a refinement out of its range", !ratios.every((ratio) => ratio === 0 || ratio >= 1 / 16));
    refuse("borders without refinements", header.borders > 0 && steps.length === 0);
    refuse("refinements of a sequence", steps.length > 0 && gopFrames > 0);
    refuse("sections that are not pairs of faces and blocks", sections.length % 2 > 0);
    refuse("no faces or no blocks for the last section", sections.length > 0 && (before.blocks >= blocks || before.faces >= faces));
    refuse("sections of a sequence", sections.length > 0 && gopFrames > 0);
}
