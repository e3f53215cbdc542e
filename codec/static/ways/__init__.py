"""The parts of a static stream: blocks, refinement, grids; encode and decode of each side by side."""
