"""Noise: made, found, and known for what it is."""
