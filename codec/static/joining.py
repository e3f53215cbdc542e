"""A mesh as its geometry is: one vertex at each position, none that no face uses; and the way back, which is exact."""

from dataclasses import dataclass, replace

import numpy as np

from bsm.bitstream.container.splits import Splits
from bsm.bitstream.errors import MeshError
from bsm.codec.arrays import Indices, Mask, Order
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import weld


@dataclass(frozen=True, eq=False)
class JoinedMesh:
    """What becomes of a given mesh."""

    mesh: TriangleMesh
    index: Indices
    first: Order
    kept: Order
    splits: Splits | None
    notes: tuple[str, ...]


def join(mesh: TriangleMesh, *, keep: bool, exact: bool = False) -> JoinedMesh:
    """Make vertices at one position one, and see what `joined` says."""
    changed = 0
    if exact:
        mesh, changed = _single(mesh)
    found = joined(mesh, weld(mesh.positions, mesh.faces, bits=exact)[2], keep=keep)
    notes = (f"{changed} coordinates were rounded to single precision",) if changed else ()
    return replace(found, notes=(*notes, *found.notes))


def joined(mesh: TriangleMesh, index: Indices, *, keep: bool, keep_loose: bool = True) -> JoinedMesh:
    notes = []
    faces = index[mesh.faces]
    collapsed = _degenerate(faces) & ~_degenerate(mesh.faces)
    if keep or collapsed.all():
        collapsed[:] = False
    kept = np.flatnonzero(~collapsed)
    used = np.zeros(int(index.max(initial=-1)) + 1, np.bool_)
    used[faces[kept]] = True
    index = np.where(used[index], (np.cumsum(used) - 1)[index], -1).astype(np.int32)
    # A vertex that no face uses is no copy of one that is used, although it is there, too.
    given = np.zeros(len(mesh.positions), np.bool_)
    given[mesh.faces[kept]] = True
    index[~given] = -1
    first = np.full(int(used.sum()), len(index), np.int64)
    np.minimum.at(first, index[given], np.flatnonzero(given))
    order = np.argsort(first)  # where the first at a place was in no face, another one has become the first
    if (np.diff(first) < 0).any():
        rank = np.empty(len(order), np.int32)
        rank[order] = np.arange(len(order), dtype=np.int32)
        index[given] = rank[index[given]]
        first = first[order]
    mentioned = np.zeros(len(mesh.positions), np.bool_)
    mentioned[mesh.faces] = True
    merged, loose = int(mentioned.sum()) - len(first), len(index) - int(mentioned.sum())
    splits = None
    if keep and keep_loose and (merged or loose):
        splits = Splits(index, mesh.faces, mesh.positions[~given])
    elif keep and merged:
        splits = Splits(index[given], (np.cumsum(given) - 1)[mesh.faces].astype(np.int32), np.zeros((0, 3)))
    if merged and not keep:
        notes.append(f"{merged} vertices were merged with others at the same position")
    if collapsed.any():
        notes.append(f"{int(collapsed.sum())} faces without area were left out")
    if loose and not (keep and keep_loose):
        notes.append(f"{loose} vertices that no face uses were left out")
    mesh = TriangleMesh(mesh.positions[first], index[mesh.faces[kept]])
    return JoinedMesh(mesh, index, first, kept, splits, tuple(notes))


def _single(mesh: TriangleMesh) -> tuple[TriangleMesh, int]:
    """With coordinates in single precision, as doubles, and how many that changes."""
    with np.errstate(over="ignore"):
        single = mesh.positions.astype(np.float32).astype(np.float64)
    if not np.isfinite(single).all():
        raise MeshError("a coordinate is beyond the range of single precision, which lossless keeps; scale the mesh")
    return replace(mesh, positions=single), int((single != mesh.positions).sum())


def _degenerate(faces: Indices) -> Mask:
    a, b, c = faces.T
    return np.asarray((a == b) | (b == c) | (a == c))
