"""Meshes, their graphs, and how far two of them lie apart."""
