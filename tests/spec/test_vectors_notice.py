"""The vectors notice a decoder that looks at one neighbour, flap, end, base or corner more than the law says."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

SPEC = Path(__file__).parents[2] / "spec"
CHANGES = {
    "17 neighbours (V 3.1)": ("reference_fields.py", 0, "[:16]", "[:17]", "good-grid-tent"),
    "9 flaps (V 3.2)": ("reference_fields.py", 0, "[:8]", "[:9]", "good-grid-tent"),
    "17 ends (V 15.3)": ("reference_fields.py", 1, "[:16]", "[:17]", "good-light-tent"),
    "9 bases (A 2.3)": ("reference_values.py", 0, "bases[:8]", "bases[:9]", "good-attribute-tent"),
    "65 corners (A 6.4)": ("reference_values.py", 0, "[:64]", "[:65]", "good-attribute-tent"),
    "65 corners (A 6.5)": ("reference_values.py", 1, "[:64]", "[:65]", "good-attribute-tent"),
}


def decoded(folder: Path, name: str) -> dict[str, np.ndarray] | None:
    """What the decoder in a folder makes of a vector; None: an error."""
    # -B: bytecode would outlive the change of one digit within a second.
    command = [sys.executable, "-B", folder / "reference_decoder.py"]
    command += [SPEC / "vectors" / f"{name}.bsm", folder / "out.npz"]
    if subprocess.run(command, capture_output=True, check=False).returncode:
        return None
    with np.load(folder / "out.npz") as found:
        return {key: found[key] for key in found.files}


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
def test_it_is_noticed(change, tmp_path):
    file, which, before, after, name = CHANGES[change]
    for path in (*SPEC.glob("*.py"), SPEC / "priors.bin"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    right = decoded(tmp_path, name)
    assert right is not None
    pieces = (SPEC / file).read_text().split(before)
    text = before.join(pieces[: which + 1]) + after + before.join(pieces[which + 1 :])
    (tmp_path / file).write_text(text)
    wrong = decoded(tmp_path, name)
    assert wrong is None or not all(np.array_equal(right[key], wrong[key]) for key in right)
