"""The encoder and decoder of a mesh that moves."""
