"""The decoder in TypeScript knows of the format what Python has, and scripts of pages find what they import of it."""

import importlib
import re

import pytest

from tools.web_constants import TARGET, source

SCRIPTS = sorted((TARGET.parents[1] / "scripts").glob("*.mjs"))
IMPORTED = [
    (path.name, module, name)
    for path in SCRIPTS
    for module, names in re.findall(
        r"^from (bsm[.\w]*) import (.+)$", path.read_text(), re.MULTILINE
    )
    for name in names.split(", ")
]


def test_constants_are_made_of_pythons() -> None:
    assert TARGET.read_text() == source(), "run: python -m tools.web_constants --write"


@pytest.mark.parametrize(("script", "module", "name"), IMPORTED)
def test_scripts_import_what_there_is(script: str, module: str, name: str) -> None:
    assert hasattr(importlib.import_module(module), name), script
