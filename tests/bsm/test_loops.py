import json

import numpy as np
import pytest

from bsm.cli import main
from bsm.files.motion.frames import Loops
from tests.motion import bending


def descriptions_of(frames):
    loops = Loops()
    for frame in frames:
        loops.take(frame)
    return loops.descriptions()


def test_loops_are_reported():
    walk = bending(7)[0]
    assert descriptions_of(np.concatenate([walk, walk])) == ("frames 7 to 13 repeat 0 to 6",)
    assert descriptions_of(np.concatenate([walk, walk, walk[:3]])) == ("frames 7 to 16 repeat 0 to 6",)
    assert descriptions_of(np.concatenate([walk[:2] + 1, walk, walk])) == ("frames 9 to 15 repeat 2 to 8",)
    moved = np.concatenate([walk, walk + np.array([1e-3, 0, 0])])
    assert descriptions_of(moved) == (), "walking on is no loop"


PAUSE = np.concatenate([bending(6)[0], np.repeat(bending(6)[0][-1:], 8, axis=0)])


@pytest.mark.parametrize("frames", [bending(9)[0], np.repeat(bending(1)[0], 9, axis=0), bending(2)[0], PAUSE])
def test_what_is_no_loop(frames):
    assert descriptions_of(frames) == ()


def test_the_program_says_loops_and_errors_of_frames(tmp_path, capsys):
    walk, faces = bending(5)
    np.savez(tmp_path / "a.npz", positions=np.concatenate([walk, walk]), faces=faces)
    assert main(["encode", str(tmp_path / "a.npz"), "--set", "step=0.002"]) == 0
    assert "frames 5 to 9 repeat 0 to 4" in capsys.readouterr().err
    assert main(["compare", str(tmp_path / "a.npz"), str(tmp_path / "a.bsm"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    each = [frame["max_error_relative"] for frame in found["frames"]]
    assert len(each) == 10 and max(each) == pytest.approx(found["max_error_relative"])
    assert found["loops"] == ["frames 5 to 9 repeat 0 to 4"]
    assert main(["compare", str(tmp_path / "a.npz"), str(tmp_path / "a.bsm")]) == 0
    printed = capsys.readouterr().out
    assert f"worst_frame        {each.index(max(each))} " in printed and "repeat" in printed
