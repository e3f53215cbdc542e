"""The dictionaries of blocks: Laplacian, orthogonal iterations, subspace sizes."""
