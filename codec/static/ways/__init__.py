"""What a static stream is made of: blocks, refinement, grids; encode and decode of each side by side."""
