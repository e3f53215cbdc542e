"""Noise: synthesis, detection, and its kinds."""
