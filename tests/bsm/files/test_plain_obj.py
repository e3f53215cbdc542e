"""The fast reader of plain OBJ files finds what the reader of all OBJ files finds, and leaves others to it."""

from pathlib import Path

import numpy as np
import pytest

from bsm import Limits, MeshError
from bsm.files.formats import obj

PLAIN = b"""# made by hand
mtllib a.mtl b.mtl
o first
v 0.1 -2 3e-2
v +1.25e+3 .5 7.
\tv 123456789.123456789 -0 1e-40
v 0.30000000000000004 1e22 1e23
vt 0.5 1
vt 0 .25
vn 0 0 1
usemtl red
f 1/1 2/2/1 3//1
s 1
f -1 -2 -3/-1
f 1 2 3 4
g last one
v 5 6 7
f 5 -1 1
lines of no OBJ
"""


def same(text: bytes) -> None:
    """Require that both readers make the same of a text."""
    plain, slow = obj._plain_lines(text, (2, 3, 4)), obj._Lines(text, (2, 3, 4))
    assert plain is not None
    assert plain.keywords - {b""} == slow.keywords - {b"", b"v", b"vt", b"vn", b"f"}
    assert (plain.sizes == slow.sizes).all()
    for which, keyword in enumerate((b"v", b"vt", b"vn")):
        assert (plain.places(which) == slow.places(which)).all()
        one, other = plain.rows(keyword, "vertex"), slow.rows(keyword, "vertex")
        assert (one.counts == other.counts).all() and (one.starts == other.starts).all()
        assert one.values.tobytes() == other.values.tobytes(), (
            "to the bit, and with the sign of zero"
        )
    for keyword in (b"mtllib", b"usemtl", b"g", b"o", b"s", b"lines"):
        assert plain.values_of(keyword) == slow.values_of(keyword)
        assert (plain.before_faces(keyword) == slow.before_faces(keyword)).all()


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r", b"  \t\n"])
def test_plain_texts_are_read_alike(end: bytes) -> None:
    same(PLAIN.replace(b"\n", end))
    same(PLAIN.rstrip().replace(b"\n", end))


def test_every_number_is_the_nearest_double() -> None:
    random = np.random.default_rng(3)
    numbers = random.normal(size=3000) * 10.0 ** random.integers(-40, 40, 3000)
    digits = [
        f"{number:.{places}{kind}}"
        for number, places, kind in zip(numbers, [3, 8, 17] * 1000, "gfe" * 1000)
    ]
    same(
        "".join(f"v {x} {y} {z}\n" for x, y, z in zip(*[iter(digits)] * 3)).encode() + b"f 1 2 3\n"
    )


@pytest.mark.parametrize(
    "line",
    [
        b"v 1 2 3 4",  # other lines have three
        b"v 1 2 nan",
        b"v 1_0 2 3",
        b"v 1 2 3 # a comment",
        b"v 1e 2 3",
        b"vt",
        b"f 0 1 2",
        b"f 1/2/3/4 2 3",
        b"f /1 2 3",
        b"f 1.0 2 3",
        b"f 1 2 3x",
        b"f 12345678901234567890 1 2",
    ],
)
def test_other_lines_are_left_to_the_reader_of_all_files(line: bytes) -> None:
    assert obj._plain_lines(PLAIN + line, (0, 0, 0)) is None


def test_errors_say_what_they_said(tmp_path: Path) -> None:
    with pytest.raises(MeshError, match="count from 1"):
        obj.read_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", Limits())
    far = obj.read_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9 1 2\n", Limits())
    with pytest.raises(MeshError, match="refers to vertex -6"):
        far.checked(Limits())


def test_files_without_points_or_faces_are_plain() -> None:
    for text in (b"", b"\n", b"# nothing\n", b"v 1 2 3\n"):
        assert obj._plain_lines(text, (0, 0, 0)) is not None
