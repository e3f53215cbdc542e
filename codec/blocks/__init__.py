"""Cutting a mesh into overlapping blocks, and blending them again."""
