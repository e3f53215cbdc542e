"""The frames of a stream: their types and order."""
