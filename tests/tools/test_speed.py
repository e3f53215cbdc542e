"""The guard of speed: the meshes that it chooses, and when it fails."""

import json
from argparse import Namespace
from pathlib import Path

import pytest

from tools.measure import speed


def test_half_of_the_meshes_are_chosen_by_a_hash() -> None:
    names = [*speed.NAMED, *(f"mesh {k}" for k in range(20))]
    found = speed.chosen(names)
    assert len(found) == 2 * len(speed.NAMED) and {*speed.NAMED} < {*found}
    assert speed.chosen(names[::-1]) == found


def test_what_needs_no_fetching_is_in_the_file() -> None:
    assert {name for name, _ in speed.made()} <= {*json.loads(speed.FIGURES.read_text())}


@pytest.mark.parametrize(
    ("known", "most", "code"),
    [([1e6, 1e6], 1.3, None), ([1e-6, 1e6], 1.3, 1), ([1e-6, 1e6], 1e12, None)],
)
@pytest.mark.parametrize("made", [False, True])
def test_a_ratio_above_the_file_fails(
    known: list[float], most: float, code: int | None, made: bool, tmp_path: Path
) -> None:
    file = tmp_path / "speed.json"
    file.write_text(json.dumps({"work": known}))
    works = (lambda: sum(range(9000)), lambda: sum(range(900))) * 2
    given = Namespace(folder=tmp_path, write=False, made=made, most=most)
    if code is None:
        speed.compare(iter([("work", works)]), given, file)
    else:
        with pytest.raises(SystemExit) as stopped:
            speed.compare(iter([("work", works)]), given, file)
        assert stopped.value.code == code
