"""spec/mathematics.md must show what the vectors hold, and name the learnt numbers that the package has."""

import hashlib
import re
from pathlib import Path

import numpy as np

from bsm.bitstream._kernels import priors
from tools.vectors.example import NAME, example
from tools.vectors.store import FOLDER

SPEC = Path(__file__).parents[2] / "spec"
DOCUMENT = (SPEC / "mathematics.md").read_text()


def test_the_example_is_the_vector():
    section = DOCUMENT[DOCUMENT.index("## 16. Example") : DOCUMENT.index("## 17. ")]
    assert example() in section, "run python -m tools.vectors --example and put it into section 16"
    shown = re.findall(r"^    ((?:[0-9a-f]{2} )*[0-9a-f]{2})  ", section, re.MULTILINE)
    assert bytes.fromhex(" ".join(shown)) == (FOLDER / f"{NAME}.bsm").read_bytes()
    with np.load(FOLDER / f"{NAME}.npz") as expected:
        positions = [[float(word) for word in line.split()] for line in section.rstrip().splitlines()[-4:]]
        assert np.abs(positions - expected["positions"]).max() < 1e-6


def test_the_learnt_numbers_are_named():
    data = (SPEC / "priors.bin").read_bytes()
    assert priors() == data, "the kernels were built from other numbers: tools/build_kernels.sh"
    assert hashlib.sha256(data).hexdigest() in DOCUMENT
    assert hashlib.sha256(data).hexdigest() in (SPEC / "reference_decoder.py").read_text()


def test_rules_are_numbered_and_cited_rules_exist():
    texts = {path.name: path.read_text() for path in SPEC.glob("*.md")}
    rules = {
        "M": set(re.findall(r"\*\*M (\d+\.\d+)\*\*", texts["mathematics.md"])),
        "S": set(re.findall(r"\*\*S (\d+\.\d+)\*\*", texts["sequence.md"])),
        "C": set(re.findall(r"\*\*(\d+\.\d+)\*\*", texts["connectivity.md"])),
        "F": set(re.findall(r"\*\*(\d+\.\d+)\*\*", texts["format.md"])),
    }
    assert all(len(found) > 20 for found in rules.values())
    for name in ("mathematics.md", "sequence.md"):
        for letter, number in re.findall(r"\b([MSCF]) (\d+\.\d+)", texts[name]):
            assert number in rules[letter], f"{name} cites {letter} {number}, which is no rule"
    for letter, number in re.findall(r"\b([MSF]) (\d+\.\d+)", (SPEC / "reference_decoder.py").read_text()):
        assert number in rules[letter], f"reference_decoder.py cites {letter} {number}, which is no rule"
