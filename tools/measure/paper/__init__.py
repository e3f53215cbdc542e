"""The tables and figures of the paper, made again: data first, then one HTML report from the data.

Arvanitis, Lalos, Moustakas, "Block-Based Spectral Processing of Static and Dynamic 3D Meshes using Orthogonal
Iterations".
"""
