"""The kernels of whole stages look at what they are given, and refuse arrays that do not fit together."""

from types import SimpleNamespace

import numpy as np
import pytest

from bsm.codec import _kernels
from bsm.codec.basis import laplacian
from bsm.codec.basis.laplacian import laplacian_of
from bsm.codec.basis.orthogonal_iteration import hash_columns
from bsm.codec.blocks import overlap
from bsm.codec.blocks.partition import derive_partition
from bsm.codec.geometry import graph
from bsm.codec.signal import predict, smooth, transform
from tests.bitstream.test_kernels_defend import copied, shortened
from tests.shapes import torus

STAGES = {
    "find_fronts": laplacian,
    "chain_blocks": overlap,
    "reaches_all": graph,
    "suspend": predict,
    "smooth_all": smooth,
    "place_block": transform,
}

ROOMY = {
    "find_fronts": {10},
    "chain_blocks": {6, 7, 13},
    "reaches_all": {0},
    "suspend": set(),
    "smooth_all": {3},
    "place_block": {2, 4},
}
"""Arguments that may be shorter: what has room to spare, what means fewer of something, and faces that others name."""


@pytest.fixture
def calls(monkeypatch):
    """What the kernels of stages were given last, before they changed it."""
    seen = {}

    def spied(name):
        def call(*arguments):
            seen[name] = [copied(value) for value in arguments]
            return getattr(_kernels, name)(*arguments)

        return call

    names = {name: getattr(_kernels, name) for name in vars(_kernels) if not name.startswith("_")}
    watching = SimpleNamespace(**names | {name: spied(name) for name in STAGES})
    for module in STAGES.values():
        monkeypatch.setattr(module, "_kernels", watching)
    return seen


def test_every_stage_defends_itself(calls):
    mesh = torus(20, 15)
    whole = graph.graph_of_faces(mesh.faces, 300)
    block = overlap.grow_blocks(whole, derive_partition(whole, 3), 120).block(1)
    assert graph.is_connected(whole)
    around = predict.Known(whole, 8.0).around(laplacian_of(block), 0.125)
    levels = np.ones((4, 3), np.int32)
    transform.placed(around.continuation, hash_columns(120, 9).astype(np.float32), levels, 0.25)
    smooth.smooth(whole, mesh.positions, 4.0)
    assert set(calls) == set(STAGES)
    for name, arguments in calls.items():
        kernel = getattr(_kernels, name)
        for place, value in enumerate(arguments):
            for short in () if place in ROOMY[name] else shortened(value):
                with pytest.raises(ValueError, match="fit together"):
                    kernel(*map(copied, arguments[:place]), short, *map(copied, arguments[place + 1 :]))
        kernel(*map(copied, arguments))
