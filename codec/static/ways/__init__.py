"""The parts of a static stream: blocks, refinement, grids."""
