"""The encoder of a mesh that moves."""
