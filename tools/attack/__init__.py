"""Everything that attacks decoders and readers: `python -m tools.attack`."""
