"""Finding noise in a mesh, and drawing noise of the same kind."""
