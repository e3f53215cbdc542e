"""The comparison of attributes with Draco's: figures that stay what they are."""

from pathlib import Path

import pytest

from tests.bsm.program import python


@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "what", "most"), [("spot_uv.obj", "texcoord", 0.73), ("cortex_sulc.ply", "sulc", 0.51)]
)
def test_real_attributes_are_small(meshes: Path, name: str, what: str, most: float):
    pytest.importorskip("DracoPy")
    done = python(
        "-m", "tools.measure", "attributes", meshes / "assets" / name, "--grid", 12, text=True
    )
    rows = [[cell.strip() for cell in line.split("|")] for line in done.stdout.splitlines()]
    found = {row[2].split(",")[0]: row for row in rows if row[1] == name}
    assert float(found[what][5]) < most and float(found["whole file"][5]) < 0.85
