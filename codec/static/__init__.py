"""The encoder of a static mesh."""
