"""The law must be no longer than it may, cite rules that there are, and show what the vectors hold."""

import hashlib
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from bsm.bitstream._kernels import priors
from tools.vectors.example import NAME, example
from tools.vectors.store import FOLDER
from tools.vectors.worked_blocks import worked_blocks

SPEC = Path(__file__).parents[2] / "spec"
LAW = {path.name: path.read_text() for path in SPEC.glob("*.md")}
CITED = r"\b([FMCVASD])\s+(\d+)(\.\d+)?\b"


def rules() -> set[str]:
    """The sections and rules that there are, as they are cited."""
    found: set[str] = set()
    for text in LAW.values():
        letter = ""
        for line in text.splitlines():
            if line.startswith("## ") and (sections := re.findall(r"\b([FMCVASD]) (\d+)", line)):
                letter = sections[0][0]
                found |= {f"{section} {number}" for section, number in sections}
            for other, number in re.findall(r"\*\*(?:([FMCVASD]) )?(\d+\.\d+)\*\*", line):
                found |= {f"{other or letter} {number}", f"{other or letter} {number.split('.')[0]}"}
    return found


RULES = rules()


def unknown(text: str) -> set[str]:
    return {f"{letter} {section}{rule}" for letter, section, rule in re.findall(CITED, text)} - RULES


@pytest.mark.parametrize("name", LAW)
def test_it_cites_rules_that_exist(name):
    assert not unknown(LAW[name])


def test_code_cites_rules_that_exist():
    root = SPEC.parent
    folders = "spec/*.py", "bitstream", "codec", "src/bsm", "tools/vectors", "web/src", "tools/*.py"
    names = subprocess.run(["git", "ls-files", *folders], cwd=root, capture_output=True, text=True, check=True).stdout
    texts = {name: root / name for name in names.split() if name.endswith((".py", ".c", ".h", ".ts", ".md"))}
    wrong = {name: cited for name, path in texts.items() if path.is_file() and (cited := unknown(path.read_text()))}
    assert not wrong


def test_the_example_is_the_vector():
    document = (FOLDER.parent / "README.md").read_text()
    section = document[document.index("## A worked example") : document.index("## Two worked blocks")]
    assert example() in section, "run python -m tools.vectors --example and put it into spec/vectors/README.md"
    shown = re.findall(r"^    ((?:[0-9a-f]{2} )*[0-9a-f]{2})  ", section, re.MULTILINE)
    assert bytes.fromhex(" ".join(shown)) == (FOLDER / f"{NAME}.bsm").read_bytes()
    with np.load(FOLDER / f"{NAME}.npz") as expected:
        positions = [[float(word) for word in line.split()] for line in section.rstrip().splitlines()[-4:]]
        assert np.abs(positions - expected["positions"]).max() < 1e-6


def test_the_worked_blocks_are_those_of_the_reference_decoder():
    assert worked_blocks() in (FOLDER.parent / "README.md").read_text(), "run python -m tools.vectors --example"


def test_the_learnt_numbers_are_named():
    data = (SPEC / "priors.bin").read_bytes()
    assert priors() == data, "the kernels were built from other numbers: tools/build_kernels.sh"
    assert hashlib.sha256(data).hexdigest() in LAW["core-3-mathematics.md"]
    assert hashlib.sha256(data).hexdigest() in (SPEC / "reference_decoder.py").read_text()


@pytest.mark.skipif(shutil.which("file") is None, reason="file(1) is not here")
def test_other_programs_tell_a_stream_by_its_first_bytes():
    command = ["file", "-m", SPEC / "media/bsm.magic", "--brief", "--mime-type", FOLDER / f"{NAME}.bsm", __file__]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    assert printed[0] == "model/vnd.bsm" and printed[0] != printed[1]
