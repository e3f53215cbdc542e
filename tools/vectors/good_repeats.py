"""Streams with faces that repeat a corner, which are counted on the edges of others."""

import re
from collections.abc import Callable
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np

from bsm.bitstream.connectivity.faces import ON_EDGES, encode_connectivity
from bsm.bitstream.container.wire import FrameType
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.gridded import gridded
from tools.surgery import frames_of, stream_of, with_header
from tools.vectors.good import Bad, Good
from tools.vectors.good_attributes import charts, creases, groups, with_attributes
from tools.vectors.meshes import hub, patch, shuffled, tangled, torus

law = import_module("spec.reference_integers")


def plaited(mesh: TriangleMesh, every: int = 2) -> TriangleMesh:
    """A mesh with faces that repeat a corner on edges of many of its faces, of each kind, up to five on one."""
    a, b, c = mesh.faces[::every].T
    kinds = [(a, a, b), (c, c, b), (a, c, a), (b, a, b)]
    needles = np.concatenate([np.stack(kind, 1)[k::4] for k, kind in enumerate(kinds)])
    return TriangleMesh(
        mesh.positions,
        np.concatenate([mesh.faces, needles, *[needles[:3]] * 2, *[needles[:1]] * 2]),
    )


def of(mesh: TriangleMesh, **options: Any) -> bytes:
    """What the encoder makes of a mesh; on a grid of 9 bits unless options say otherwise."""
    chosen: dict[str, Any] = {"grid": 9, "effort": "quick"} | options
    return encode(mesh, EncodeOptions(threads=1, **chosen))


def declared(mesh: TriangleMesh) -> bytes:
    """A mesh whose stream declares edges, whether that is smaller or not, on a grid of 8 bits."""
    size = len(mesh.positions)
    coded = encode_connectivity(mesh.faces, size, ON_EDGES)
    extent = np.ptp(mesh.positions, axis=0).max()
    values = np.rint((mesh.positions - mesh.positions.min(axis=0)) * 255 / extent).astype(np.int32)
    return stream_of(gridded(coded, values[coded.vertex_order], [size]))


def _alone() -> TriangleMesh:
    """Faces that all repeat a corner: there are no edges."""
    return TriangleMesh(patch(2, 3).positions, np.array([[0, 0, 1], [2, 3, 2], [4, 5, 5]]))


def _attributed() -> TriangleMesh:
    return with_attributes(plaited(torus(24, 16)), creases, charts, groups)


def _damaged(problem: str) -> bytes:
    """The first other byte in the faces of a stream of which the decoder of the law says so."""
    header, (kind, payload), *rest = frames_of(declared(plaited(patch(5, 5))))
    counts = len(patch(5, 5).positions), len(plaited(patch(5, 5)).faces)
    for index in range(len(payload)):
        for value in range(256):
            changed = payload[:index] + bytes([value]) + payload[index + 1 :]
            try:
                law.decode_connectivity(changed, *counts, repeats=ON_EDGES)
            except law.CorruptError as error:
                if re.search(problem, str(error)):
                    return stream_of([header, (kind, changed), *rest])
            except (law.TruncatedError, law.LimitError):
                pass
    raise AssertionError(problem)


def _torn() -> bytes:
    """Faces without their last 40 bytes."""
    frames = frames_of(declared(plaited(torus(24, 16))))
    return stream_of([(k, p[:-40] if k == FrameType.CONNECTIVITY else p) for k, p in frames])


_MADE: dict[str, tuple[str, Callable[[], bytes]]] = {
    "grid": ("on a grid", partial(of, plaited(torus(24, 16)))),
    "blocks": (
        "before blocks",
        lambda: of(
            plaited(torus(24, 16)), grid=None, contract=None, coefficients=30, effort="normal"
        ),
    ),
    "exact": (
        "exact floats",
        lambda: of(plaited(torus(24, 16)), grid=None, contract=None, exact=True, effort="normal"),
    ),
    "attributes": ("attributes of corners and faces", lambda: of(_attributed())),
    "order": (
        "vertices and faces in the given order",
        lambda: of(shuffled(plaited(torus(24, 16))), keep_order=True),
    ),
    "border": ("a border, where edges have one face", partial(of, plaited(patch(14, 15)))),
    "tangled": (
        "edges of three faces, and faces that are on no edge",
        partial(declared, tangled()),
    ),
    "hub": ("a vertex in many faces", partial(declared, plaited(hub(), 1))),
    "none": ("no faces that repeat a corner", partial(declared, torus(12, 9))),
    "alone": ("no other faces", partial(declared, _alone())),
}
REPEATS: dict[str, Good] = {
    f"good-repeats-{name}": Good(f"faces that repeat a corner, on edges: {probes}", make)
    for name, (probes, make) in _MADE.items()
}
REPEATS_BAD: dict[str, Bad] = {
    "bad-repeats-zero": Bad(
        "a stored default", "corrupt", lambda: with_header(declared(torus(12, 9)), repeats=0)
    ),
    "unsupported-repeats-method": Bad(
        "a method that is not known",
        "unsupported",
        lambda: with_header(declared(torus(12, 9)), repeats=2),
    ),
    "bad-repeats-more": Bad(
        "more faces on edges than repeat a corner",
        "corrupt",
        partial(_damaged, "more faces are on edges"),
    ),
    "bad-repeats-fewer": Bad(
        "edges that end before their faces",
        "corrupt",
        partial(_damaged, "fewer faces are on edges"),
    ),
    "bad-repeats-short": Bad("edges of a payload that ends early", "truncated", _torn),
}
