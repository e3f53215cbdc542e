"""Meshes larger than memory: tiles on one lattice, coarse to fine, in shards, and back to one mesh."""
