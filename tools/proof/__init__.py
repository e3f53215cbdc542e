"""Proof that decoders agree and that nothing escapes them: `python -m tools.proof`, see `tools.proof.__main__`."""
