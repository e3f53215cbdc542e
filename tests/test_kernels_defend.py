"""Kernels that are given an array too short, or indices beyond others, refuse them, or do not need them."""

import sys
from collections.abc import Callable, Iterator
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bsm import TriangleMesh, decode, decode_sequence, denoise, encode, encode_sequence
from bsm._core import bitstream as of_bytes
from bsm._core import codec as of_arrays
from bsm.codec.denoise.learnt import descriptions
from bsm.codec.denoise.surface import Topology, surroundings
from bsm.codec.geometry.metrics import Original, Reference, surface_distance
from bsm.codec.look.measure import AttributeLook
from bsm.codec.signal.smooth import local_frames, raised, slide
from bsm.codec.static.choice.settling import Settler
from bsm.codec.static.choice.shaping import Shaper
from bsm.encoding.options import encode_options
from tests.blocks import graph_of
from tests.codec.static.attributes.test_attributes import dressed
from tests.motion import bending
from tests.refined import LAYER, refined
from tests.shapes import torus
from tools.noise import gaussian_along_normals
from tools.vectors.meshes import tangled

BEYOND = 10**6
KERNELS = {
    name: kernel
    for room in (of_bytes, of_arrays)
    for name, kernel in vars(room).items()
    if callable(kernel)
}
REFUSALS = 40
"""Of a kernel, after which it is left alone."""
NOTHING_SHORT = {"priors", "start", "constant", "fields", "frames_kept", "return_free_memory"}
"""Kernels that are given no array, or one that may be of any length."""


def copied(value: Any) -> Any:
    """Arguments with arrays of their own."""
    if isinstance(value, tuple):
        items = [copied(item) for item in value]
        return type(value)(*items) if hasattr(value, "_fields") else tuple(items)
    return value.copy() if isinstance(value, np.ndarray) else value


def spoiled(value: Any, beyond: int) -> Iterator[Any]:
    """Copies of arguments, in each of which one array lacks its last row, or has numbers so far beyond its own."""
    if isinstance(value, np.ndarray) and value.ndim and len(value):
        yield value[:-1].copy()
        if beyond and value.dtype == np.int32:
            yield value + np.int32(beyond)
    if isinstance(value, tuple):
        for place, item in enumerate(value):
            for wrong in spoiled(item, beyond):
                items = [*map(copied, value[:place]), wrong, *map(copied, value[place + 1 :])]
                yield type(value)(*items) if hasattr(value, "_fields") else tuple(items)


def defended(kernel: Callable[..., Any], name: str, refusals: dict[str, int]) -> Callable[..., Any]:
    """A kernel that is called with every array too short before it is called as it should be."""

    def call(*arguments: Any) -> Any:
        if refusals.setdefault(name, 0) < REFUSALS:
            for wrong in spoiled(arguments, BEYOND):
                try:
                    kernel(*wrong)
                except ValueError:
                    refusals[name] += 1
        return kernel(*arguments)

    return call


@pytest.fixture
def refusals(monkeypatch: pytest.MonkeyPatch) -> dict[str, int]:
    """How often each kernel that was called refused."""
    for late in (
        "bsm.codec.sequence.encoder",
        "bsm.codec.denoise.automatic",
        "bsm.codec.static.choice.search",
    ):
        import_module(late)  # modules that come later are not watched
    counts: dict[str, int] = {}
    wrapped = {name: defended(kernel, name, counts) for name, kernel in KERNELS.items()}
    for library, room in ((of_bytes, "bsm.bitstream."), (of_arrays, "bsm.codec.")):
        watched = SimpleNamespace(
            **{name: wrapped.get(name, kernel) for name, kernel in vars(library).items()}
        )
        for name, module in list(sys.modules.items()):
            if name.startswith(room) and getattr(module, "_kernels", None) is library:
                monkeypatch.setattr(module, "_kernels", watched)
    return counts


def test_every_kernel_defends_itself(refusals: dict[str, int]) -> None:
    bare = torus(16, 12)
    mesh, size = dressed(bare), len(bare.positions)
    moved = gaussian_along_normals(bare.positions, bare.faces, 0.3, seed=1)
    smooth = torus(24, 16)
    scan = TriangleMesh(
        gaussian_along_normals(smooth.positions, smooth.faces, 0.1, seed=1), smooth.faces
    )
    cases: tuple[tuple[TriangleMesh, dict[str, Any]], ...] = (
        (mesh, {"bits": 12, "key_seed": "svd", "partition": "metis"}),
        (mesh, {"step": 0.01, "smoothing": 1.0}),
        (mesh, {"preset": "fine"}),
        (TriangleMesh(moved, bare.faces), {}),
        (smooth, {}),
        (scan, {}),
        (mesh, {"effort": "quick", "contract": None, "grid": 9, "keep_order": True}),
        (mesh, {"exact": True, "contract": None}),
        (tangled(), {"grid": 9}),
    )
    denoise(TriangleMesh(moved, bare.faces), fine="guided", force=True)
    topology = Topology(bare.faces, size)
    assert list(descriptions(moved, topology, surroundings(moved, topology, 4.0)))
    surface_distance(moved, bare.faces, bare.positions, bare.faces)
    reference = Reference(bare.positions, bare.faces)
    assert reference.nmsve(moved) > 0.0 and reference.theta(moved) > 0.0
    for shape, options in cases:
        decode(encode(shape, encode_options(threads=1, **options)), threads=1)
    decode(refined(bare, LAYER, (size,)), threads=1)
    positions, faces = bending(3, 12, 8)
    decode_sequence(encode_sequence(positions, faces, threads=1, step=0.01), threads=1)
    frames, steps = local_frames(bare.positions, bare.faces), np.ones((size, 3))
    still = np.zeros((size, 3), np.int32)
    slide(raised(bare.positions, frames, still, 0.1), frames, still, np.ones(size))
    shaper = Shaper(Original(bare.positions, bare.faces), graph_of(bare))
    shaper.levels(bare.positions, still[:, :1], frames[:, None, :3], 1.0, 1.0)
    defended(of_arrays.turn_columns, "turn_columns", refusals)(
        np.eye(4, 2), np.empty(4), np.empty(2)
    )
    seen = Settler(bare.positions, bare.faces, graph_of(bare))
    seen.levels(2.0 * bare.positions, frames, steps, lambda _: steps, 0.01, np.full(size, np.inf))
    corners = bare.positions[bare.faces].reshape(-1, 9)
    assert AttributeLook(bare, "color", corners).distance(bare.positions, corners) == 0.0
    AttributeLook(bare, "texcoord", np.ascontiguousarray(corners[:, :6]))
    names = {*KERNELS} - NOTHING_SHORT
    assert sorted(names - set(refusals)) == [], "kernels that this test does not reach"
    assert [name for name in sorted(names) if not refusals[name]] == [], (
        "kernels that refuse nothing"
    )
