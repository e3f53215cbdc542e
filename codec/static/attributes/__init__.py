"""Attributes of a mesh: what is promised of them, whole numbers that keep it, and the frames that carry these."""
