"""Streams of a few bytes that ask for much, and a command that measures what they get."""
