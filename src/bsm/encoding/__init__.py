"""Mesh files and sequences to streams, one job at a time."""
