"""Sequences in files: one module for each form, with what reads and what writes it."""
