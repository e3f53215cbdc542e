"""The mode of the paper: overlap, and what orthogonal iterations lose."""

import pytest

from bsm.codec.geometry.metrics import Reference
from bsm.codec.static.options import EncodeOptions, changed
from bsm.evaluation.curve import EXACT_BASES, Spectral, measure, paper_options
from tests.shapes import patch


def test_only_the_mode_of_the_paper_has_overlap_unless_it_is_asked_for():
    assert EncodeOptions().growth == 1.0
    assert changed(EncodeOptions(), bits=12).growth == 1.15
    assert changed(EncodeOptions(overlap=1.0), bits=12).growth == EncodeOptions(overlap=1.0).growth == 1.0


@pytest.mark.parametrize(("power", "most"), [(1, 1.4), (2, 0.8)])
def test_orthogonal_iterations_are_near_the_exact_basis(power, most):
    mesh = patch(45, 45)
    reference = Reference(mesh.positions, mesh.faces)

    def nmsve_db(**how):
        return measure(Spectral(paper_options(block_size=300, keep=0.1, **how)), mesh, reference)["nmsve_db"]

    exact, ours = nmsve_db(**EXACT_BASES), nmsve_db(power=power)
    assert exact <= ours <= exact + most
    assert ours <= nmsve_db(power=power, overlap=1.0)
