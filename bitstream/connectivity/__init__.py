"""Faces, order and partition of a mesh as bytes."""
