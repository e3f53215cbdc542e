"""What the decoder in TypeScript knows of the format is what Python has."""

from tools.web_constants import TARGET, source


def test_constants_are_made_of_pythons():
    assert TARGET.read_text() == source(), "run: python -m tools.web_constants --write"
