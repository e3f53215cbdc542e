"""Sequence files: one module for each format, with its reader and writer."""
