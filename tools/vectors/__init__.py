"""Streams that every decoder must treat alike: how they are made, and how a decoder is held against them."""
