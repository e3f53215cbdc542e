"""The encoder and decoder of a static mesh."""
