"""Fields of integers on a mesh whose faces are known: positions on a grid, and levels that refine a mesh."""
