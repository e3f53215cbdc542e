"""Bits for symbols: the range coder, mixed models, and zstd for data without a model."""
