"""Bits for symbols: the range coder, mixed models, and zstd for what has no model."""
