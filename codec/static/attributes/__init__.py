"""Attributes of a mesh: their promises, the integers that keep them, and their frames."""
