"""The vectors notice a decoder that looks at one neighbour or flap more than the law says."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

SPEC = Path(__file__).parents[2] / "spec"
FLAPS = "found.append((*flap, tip))\n        return found"
CHANGES = {"17 neighbours (V 3.1)": ("found[:16]", "found[:17]"), "9 flaps (V 3.2)": (f"{FLAPS}[:8]", f"{FLAPS}[:9]")}


def decoded(folder: Path) -> dict[str, np.ndarray] | None:
    """What the reference decoder in a folder makes of a vector; None: an error."""
    # -B: bytecode would outlive the change of one digit within a second.
    command = [sys.executable, "-B", folder / "reference_decoder.py"]
    command += [SPEC / "vectors" / "good-grid-tent.bsm", folder / "out.npz"]
    if subprocess.run(command, capture_output=True, check=False).returncode:
        return None
    with np.load(folder / "out.npz") as found:
        return {key: found[key] for key in found.files}


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
def test_it_is_noticed(change, tmp_path):
    before, after = CHANGES[change]
    for path in (*SPEC.glob("*.py"), SPEC / "priors.bin"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    right = decoded(tmp_path)
    assert right is not None
    integers = tmp_path / "reference_integers.py"
    assert integers.read_text().count(before) == 1
    integers.write_text(integers.read_text().replace(before, after))
    wrong = decoded(tmp_path)
    assert wrong is None or not all(np.array_equal(right[key], wrong[key]) for key in right)
