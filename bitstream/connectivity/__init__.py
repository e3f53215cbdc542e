"""Faces, order and partition of a mesh to bytes and back."""
