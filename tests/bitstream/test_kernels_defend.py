"""Kernels that are given an array too short refuse it, or need no more than they are given."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bsm.bitstream import _kernels
from bsm.bitstream.attributes import seams as attribute_seams
from bsm.bitstream.attributes import values
from bsm.bitstream.attributes.values import octahedral_levels
from bsm.bitstream.coefficients import adaptive, matrices, rate_distortion
from bsm.bitstream.coefficients.adaptive import CoefficientModel
from bsm.bitstream.connectivity import faces, order, partition
from bsm.bitstream.connectivity.faces import decode_connectivity, encode_connectivity
from bsm.bitstream.connectivity.partition import decode_labels, encode_labels
from bsm.bitstream.container.splits import decode_order, encode_order
from bsm.bitstream.entropy import range_coder
from bsm.bitstream.fields import corners, grid, levels
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.geometry.graph import graph_of_faces
from tests.bitstream.fields.fields import decode, encode, field_of

MODULES = (
    *(adaptive, matrices, rate_distortion),
    *(faces, order, partition, range_coder),
    *(corners, grid, levels),
    *(attribute_seams, values),
)


def copied(value: Any) -> Any:
    """Arguments with arrays of their own."""
    if isinstance(value, tuple):
        items = [copied(item) for item in value]
        return type(value)(*items) if hasattr(value, "_fields") else tuple(items)
    return value.copy() if isinstance(value, np.ndarray) else value


def shortened(value: Any) -> Iterator[Any]:
    """Copies of arguments, in each of which one array lacks its last row."""
    if isinstance(value, np.ndarray) and len(value):
        yield value[:-1].copy()
    if isinstance(value, tuple):
        for place, item in enumerate(value):
            for short in shortened(item):
                items = [*map(copied, value[:place]), short, *map(copied, value[place + 1 :])]
                yield type(value)(*items) if hasattr(value, "_fields") else tuple(items)


def defended(name: str, refusals: dict[str, int]) -> Callable[..., Any]:
    """A kernel that is called with every array too short before it is called as it should be."""
    kernel = getattr(_kernels, name)

    def call(*arguments: Any) -> Any:
        if refusals.setdefault(name, 0) < 40:
            for short in shortened(arguments):
                try:
                    kernel(*short)
                except ValueError:
                    refusals[name] += 1
        return kernel(*arguments)

    return call


@pytest.fixture
def refusals(monkeypatch: pytest.MonkeyPatch) -> dict[str, int]:
    counts: dict[str, int] = {}
    names = [name for name in vars(_kernels) if not name.startswith("_")]
    wrapped = SimpleNamespace(**{name: defended(name, counts) for name in names})
    for module in MODULES:
        monkeypatch.setattr(module, "_kernels", wrapped)
    return counts


def test_every_kernel_defends_itself(refusals: dict[str, int]) -> None:
    given = np.random.default_rng(1).integers(0, 30, (60, 3), dtype=np.int32)
    given = np.unique(given, return_inverse=True)[1].reshape(-1, 3).astype(np.int32)
    vertices = int(given.max()) + 1
    encoded = encode_connectivity(given, vertices)
    decoded = decode_connectivity(encoded.payload, vertices, len(given))
    order, _ = decode_order(encode_order(given, encoded), decoded, vertices, DEFAULT_LIMITS)
    np.testing.assert_array_equal(order.faces, given)
    graph = graph_of_faces(decoded, vertices)
    labels = (np.arange(vertices) // 8).astype(np.int32)
    payload = encode_labels(graph.offsets, graph.neighbours, labels, int(labels[-1]) + 1)
    np.testing.assert_array_equal(decode_labels(payload, graph.offsets, graph.neighbours, int(labels[-1]) + 1), labels)

    positions = np.arange(3 * vertices).reshape(vertices, 3) % 7
    cells = grid.Cells(*(10 * positions.astype(np.int64) + more for more in (0, 5, 10)))
    payload = grid.Floats((6, 6, 6)).encode(positions.astype(np.int32), cells, cells.low + 3)
    found = grid.Floats((6, 6, 6)).decode(payload, positions.astype(np.int32), cells)
    np.testing.assert_array_equal(found, cells.low + 3)
    linked = corners.corners_of(decoded, vertices)
    torn = attribute_seams.find_seams(linked, given % 5)
    payload = attribute_seams.encode_seams(linked, torn)
    np.testing.assert_array_equal(attribute_seams.decode_seams(payload, linked), torn)
    assert attribute_seams.Joins(linked, torn).faces.shape == decoded.shape
    normals = octahedral_levels(positions - 3.5, 63)
    for name, offered in {
        "grid": positions,
        "light": positions,
        "levels": positions,
        "plain": positions,
        "texcoord": positions[:, :2],
        "normal": normals,
        "faces": (np.arange(len(decoded)) // 9)[:, None],
    }.items():
        largest = [126, 126] if name == "normal" else offered.max(axis=0)
        field = field_of(name, decoded, vertices, largest, positions)
        np.testing.assert_array_equal(decode(field, encode(field, offered)), offered)

    chosen = rate_distortion.choose_levels(CoefficientModel(60), 300 * given.astype(np.int64), 0.1).levels
    payload = adaptive.encode_coefficients(CoefficientModel(60), chosen)
    np.testing.assert_array_equal(adaptive.decode_coefficients(CoefficientModel(60), payload, len(chosen)), chosen)
    payload = matrices.encode_levels(matrices.make_level_bank(), [chosen], [chosen])
    assert matrices.price_levels(matrices.make_level_bank(), chosen, chosen).min() >= 0
    matrix = np.zeros_like(chosen)
    matrices.decode_levels(matrices.make_level_bank(), payload, [matrix], [chosen])
    np.testing.assert_array_equal(matrix, chosen)
    adaptive.look_at_block(adaptive.make_past(60), chosen)
    adaptive.expectation_bin(np.ones(20, np.int32), np.ones(20, np.int32))
    adaptive.points_of_levels(chosen)

    single = {"code_bit", "code_uniform", "code_mixed_bit", "code_signed", "points_of_levels"}
    given_nothing = {"priors"}
    names = {name for name in vars(_kernels) if not name.startswith("_")} - given_nothing
    assert not names - set(refusals) - single, "kernels that this test does not reach"
    assert not {name for name, count in refusals.items() if count == 0} - single, "kernels that refuse nothing"
