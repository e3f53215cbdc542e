"""Losses of meshes: one account for all commands."""
