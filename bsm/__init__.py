"""The codec as people meet it: one name to import, one command."""
