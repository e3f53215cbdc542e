"""The specification cites existing rules, shows the vectors as they are, and keeps its permanent promises."""

import hashlib
import importlib
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm._core.bitstream import priors, start
from bsm.cli import main
from tools.bsmdec import build, decode, of_sequence, released
from tools.surgery import frames_of
from tools.vectors.example import NAME, example
from tools.vectors.good_attributes import charts, colors, creases, groups, with_attributes
from tools.vectors.meshes import shuffled, torus
from tools.vectors.store import FOLDER, alike, arrays_of
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
                found |= {
                    f"{other or letter} {number}",
                    f"{other or letter} {number.split('.')[0]}",
                }
    return found


RULES = rules()


def unknown(text: str) -> set[str]:
    return {
        f"{letter} {section}{rule}" for letter, section, rule in re.findall(CITED, text)
    } - RULES


@pytest.mark.parametrize("name", LAW)
def test_it_cites_rules_that_exist(name):
    assert not unknown(LAW[name])


def test_code_cites_rules_that_exist():
    root = SPEC.parent
    folders = "spec/*.py", "bitstream", "codec", "src/bsm", "tools/vectors", "web/src", "tools/*.py"
    names = subprocess.run(
        ["git", "ls-files", *folders], cwd=root, capture_output=True, text=True, check=True
    ).stdout
    texts = {
        name: root / name
        for name in names.split()
        if name.endswith((".py", ".c", ".h", ".ts", ".md"))
    }
    wrong = {
        name: cited
        for name, path in texts.items()
        if path.is_file() and (cited := unknown(path.read_text()))
    }
    assert not wrong


def test_the_example_is_the_vector():
    document = (FOLDER.parent / "README.md").read_text()
    section = document[
        document.index("## A worked example") : document.index("## Two worked blocks")
    ]
    assert example() in section, (
        "run python -m tools.vectors --example and put it into spec/vectors/README.md"
    )
    shown = re.findall(r"^    ((?:[0-9a-f]{2} )*[0-9a-f]{2})  ", section, re.MULTILINE)
    assert bytes.fromhex(" ".join(shown)) == (FOLDER / f"{NAME}.bsm").read_bytes()
    with np.load(FOLDER / f"{NAME}.npz") as expected:
        positions = [
            [float(word) for word in line.split()] for line in section.rstrip().splitlines()[-4:]
        ]
        assert np.abs(positions - expected["positions"]).max() < 1e-6


def test_the_worked_blocks_are_those_of_the_reference_decoder():
    assert worked_blocks() in (FOLDER.parent / "README.md").read_text(), (
        "run python -m tools.vectors --example"
    )


@pytest.mark.parametrize(
    ("name", "built", "documents"),
    [
        ("priors", priors, ["core-3-mathematics.md", "reference_decoder.py"]),
        ("start", start, ["extension-congruence.md"]),
    ],
)
def test_the_learnt_numbers_are_named(name, built, documents):
    data = (SPEC / f"{name}.bin").read_bytes()
    assert built() == data, "the kernels were built from other numbers: tools/build_kernels.sh"
    assert all(
        hashlib.sha256(data).hexdigest() in (SPEC / document).read_text() for document in documents
    )


@pytest.mark.skipif(shutil.which("file") is None, reason="file(1) is not here")
def test_other_programs_tell_a_stream_by_its_first_bytes():
    command = [
        "file",
        "-m",
        SPEC / "media/bsm.magic",
        "--brief",
        "--mime-type",
        FOLDER / f"{NAME}.bsm",
        __file__,
    ]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    assert printed[0] == "model/vnd.bsm" and printed[0] != printed[1]


HERE = Path(__file__).parent
OLD = dict(line.split() for line in (HERE / "version-0.txt").read_text().splitlines())
"""Streams of version 0, hexadecimal, by the commits that wrote them: of all days until 1.0."""


@pytest.mark.parametrize("commit", OLD)
def test_streams_of_version_0_are_named(commit, tmp_path, capsys, monkeypatch):
    data = bytes.fromhex(OLD[commit])
    message = r"written by version 0 of the format, and this reads 1: encode the source again, or decode it with the"
    for decoder in (bsm.decode, bsm.decode_sequence):
        with pytest.raises(bsm.UnsupportedError, match=message):
            decoder(data)
    found = decode(build(), data)
    assert found.status == 5 and re.search(message, found.message)
    monkeypatch.syspath_prepend(str(HERE.parents[1] / "spec"))
    reference = importlib.import_module("reference_decoder")
    with pytest.raises(reference.UnsupportedError, match="version 0, and this reads 1"):
        reference.decode(data)
    (tmp_path / "old.bsm").write_bytes(data)
    for command in ("info", "verify", "decode"):
        assert main([command, str(tmp_path / "old.bsm")]) == 5
        assert re.search(message, capsys.readouterr().err)


def test_a_later_minor_version_is_read_and_reported(capsys):
    assert main(["info", str(FOLDER / "good-minor.bsm")]) == 0
    assert "version 1.15, core only" in capsys.readouterr().out


@pytest.mark.parametrize(
    "later",
    sorted((FOLDER.parent / "1.1").glob("good-congruence-*-later.bsm")),
    ids=lambda path: path.stem,
)
def test_a_minor_version_that_is_too_small_changes_nothing(later):
    """Streams with congruent parts are of 1.1; those that say 1.0 are decoded to the same (F 2.2)."""
    earlier = later.with_name(later.name.replace("-later", ""))
    new, old = later.read_bytes(), earlier.read_bytes()
    assert (new[4], old[4]) == (0x11, 0x10) and frames_of(new) == frames_of(old)
    with np.load(later.with_suffix(".npz")) as one, np.load(earlier.with_suffix(".npz")) as other:
        assert all(np.array_equal(one[name], other[name]) for name in one)


def test_the_vectors_of_1_0_are_what_they_were():
    digest = hashlib.sha256()
    for path in sorted(FOLDER.iterdir()):
        digest.update(path.name.encode() + b"\0" + hashlib.sha256(path.read_bytes()).digest())
    assert (
        digest.hexdigest() == "38bc56c979efa2149192b3bdee80a09b17d64e7059141d3d8c902c05bb96d22b"
    ), "the vectors of 1.0 stay; new ones belong into the folder of a later version"


@pytest.fixture(scope="module")
def earlier():
    """The decoder that 1.0 released, in C, without comments."""
    return released()


WRITTEN = {
    "default": {},
    "fine": vars(bsm.PRESETS["fine"]),
    "small": vars(bsm.PRESETS["small"]),
    "grid14": {"grid": 14},
    "ordered": {"keep_order": True},
    "exact": {"exact": True},
}
"""What the encoder is asked for; without congruent parts, and with effort best, which has no swift attributes, no
answer may need an extension that 1.0 does not have."""


@pytest.mark.parametrize("options", WRITTEN.values(), ids=WRITTEN)
def test_1_0_decodes_what_is_written_today(options, earlier):
    mesh = with_attributes(shuffled(torus(20, 16)), charts, creases, colors, groups)
    stream = bsm.encode(
        mesh, bsm.EncodeOptions(**options | {"congruence": False, "effort": "best"})
    )
    found, mesh = decode(earlier, stream), bsm.decode(stream)
    right = {"positions": mesh.positions, "faces": mesh.faces} | arrays_of(mesh.attributes)
    assert found.status == 0, found.message
    assert found.arrays.keys() == right.keys() and len(right) > 5
    assert all(alike(found.arrays[name], right[name]) for name in right)
    assert np.array_equal(found.arrays["positions"], mesh.positions)


def test_1_0_refuses_congruent_parts_by_the_number_of_their_field(earlier):
    found = decode(earlier, (FOLDER.parent / "1.1" / "good-congruence-mirrors.bsm").read_bytes())
    assert found.status == 5 and found.message == "field 22 is unknown to this decoder"


def test_1_0_refuses_swift_attributes_by_the_number_of_their_field(earlier):
    found = decode(earlier, (FOLDER.parent / "1.3" / "good-swift-mixed-grid.bsm").read_bytes())
    assert found.status == 5 and found.message == "field 28 is unknown to this decoder"


def test_1_0_refuses_faces_on_edges_by_the_number_of_their_field(earlier):
    found = decode(earlier, (FOLDER.parent / "1.3" / "good-repeats-grid.bsm").read_bytes())
    assert found.status == 5 and found.message == "field 29 is unknown to this decoder"


def test_1_0_refuses_brief_streams_by_the_number_of_their_field(earlier):
    found = decode(earlier, (FOLDER.parent / "1.1" / "good-brief-plain.bsm").read_bytes())
    assert found.status == 5 and found.message == "field 23 is unknown to this decoder"


def test_1_0_refuses_turned_grids_by_the_numbers_of_their_fields(earlier):
    for name, key in (("turn-plain", 24), ("brief-turned", 25)):
        found = decode(earlier, (FOLDER.parent / "1.1" / f"good-{name}.bsm").read_bytes())
        assert found.status == 5 and found.message == f"field {key} is unknown to this decoder"


def test_1_0_decodes_sequences_that_are_written_today(earlier):
    moving = [torus(24, 18, phase=0.2 * t) for t in range(12)]
    stream = bsm.encode_sequence([mesh.positions for mesh in moving], moving[0].faces)
    found, (positions, faces) = decode(earlier, stream), bsm.decode_sequence(stream)
    assert found.status == 0, found.message
    assert np.array_equal(of_sequence(found)["positions"], positions)
    assert np.array_equal(of_sequence(found)["faces"], faces)


def test_clauses_keep_their_numbers():
    """All that 1.0 has: they may say it better, but stay where they are cited."""
    kept = (HERE / "clauses-1.0.txt").read_text().split("\n")
    assert not {clause for clause in kept if clause} - RULES
