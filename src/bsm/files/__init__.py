"""Mesh files: one module per format, each with the twins that read and write it."""
