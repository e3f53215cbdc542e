"""Files that use something many times say it once, and are sound where it is used a few times."""

from pathlib import Path

import pytest

from bsm.bitstream.limits import Limits
from tools.attack.readers import read_all, written
from tools.attack.uses import cases, uses

USES = dict(uses())


@pytest.mark.parametrize("name", USES)
def test_a_few_uses_are_read(name, tmp_path):
    taken = read_all(written(USES[name](2000, 3), Path(tmp_path))[0], Limits())
    assert taken.outcome == "read" or "instancing" in name or "PointInstancer" in taken.outcome, taken.outcome


def test_files_have_the_size_that_is_asked_for():
    sizes = {case.name: len(case.make().data) for case in cases(20_000, (0.5,))}
    assert all(2000 < size < 40_000 for size in sizes.values()), sizes
