"""The search for a step: it ends near its bound, asks little, and is never wrong about what it keeps."""

import math

import pytest

from bsm.codec.static.choice.search import LOOK_SLACK, LOOK_TRIES, Trial, widest_step

SLOPES = (0.9, 1.8)


class Curve:
    """A distance that grows with a step, as glances see it and as it is."""

    def __init__(self, slope: float, glance: float = 1.0, bound: float = 1.0) -> None:
        self.slope, self.glance, self.bound = slope, glance, bound
        self.asked = list[bool]()

    def __call__(self, step: float, sure: bool) -> Trial[float]:
        true = self.slope * math.log(step / self.bound)
        seen = true + math.log(self.glance)
        known = sure or -0.2 <= seen <= 0.1
        self.asked.append(known)
        return Trial(step, true if known else seen, near=True, found=step, sure=known)


@pytest.mark.parametrize("slope", [0.9, 1.2, 1.8])
@pytest.mark.parametrize("first", [0.2, 0.7, 1.0, 1.3, 3.0])
@pytest.mark.parametrize("glance", [0.95, 1.0, 1.05])
def test_it_uses_up_what_is_allowed(slope, first, glance):
    curve = Curve(slope, glance)
    found = widest_step(curve, first, tries=LOOK_TRIES, most=100.0, slopes=SLOPES, slack=LOOK_SLACK)
    assert found is not None
    assert found.kept
    assert (1.0 - 2.0 * LOOK_SLACK) <= found.step**slope <= 1.0
    assert sum(curve.asked) <= 4


def test_nothing_is_kept_that_was_only_glanced_at():
    curve = Curve(1.2, glance=0.5)
    found = widest_step(curve, 1.0, tries=1, most=100.0, slopes=SLOPES)
    assert found is not None
    assert found.sure
    curve = Curve(1.2, glance=0.5, bound=0.9)
    assert widest_step(curve, 1.0, tries=1, most=100.0, slopes=SLOPES) is None
    assert curve.asked == [False, True]


def test_the_largest_step_may_do():
    curve = Curve(1.2)
    found = widest_step(curve, 10.0, tries=LOOK_TRIES, most=0.01, slopes=SLOPES)
    assert found is not None
    assert found.kept
    assert found.step == 0.01


def test_vertices_too_far_off_want_a_finer_step():
    found = widest_step(
        lambda step, sure: Trial(step, -math.inf, near=step < 0.5, found=step), 1.0, tries=6, most=1.0, slopes=SLOPES
    )
    assert found is not None
    assert 0.4 < found.step < 0.5
