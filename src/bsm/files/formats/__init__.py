"""One module a format (PLY: three), each with what reads and writes it."""
