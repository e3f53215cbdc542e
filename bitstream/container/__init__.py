"""The frames of a stream: what they are, in which order they come, how they are read and written."""
