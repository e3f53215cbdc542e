"""Sparse factorisation of a block and solutions for many columns at once."""
