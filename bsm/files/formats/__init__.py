"""One module a format, each with what reads and writes it."""
