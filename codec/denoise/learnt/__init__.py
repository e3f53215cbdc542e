"""Normals by small networks that were trained on made shapes."""
