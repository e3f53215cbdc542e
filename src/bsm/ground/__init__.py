"""Foundations: the console, exit codes, lengths with units, and pictures."""
