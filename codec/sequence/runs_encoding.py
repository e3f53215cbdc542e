"""The meshes that runs have had, for later ones; the twin of `codec.sequence.runs_decoding`."""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256

from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.geometry.attributes import has
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.gop_encoding import Coded
from bsm.codec.sequence.joining import JoinedRun
from bsm.codec.sequence.moving_encoding import Mover
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.runs import Shelf
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.work import Allowance


@dataclass(frozen=True, eq=False)
class OpenedMesh:
    """A mesh that a run has had: the run that brought it, what was coded of it last, and what encodes what moves."""

    run: int
    prepared: Prepared
    coded: Coded
    movers: tuple[Mover, ...]


class Meshes:
    """The meshes that runs have had, as far as decoders keep them, see `Shelf`, and what decoders may still do."""

    def __init__(self, options: SequenceOptions) -> None:
        self.allowance = Allowance(NAMED_LIMITS[options.limits]())
        self._shelf: Shelf[OpenedMesh] = Shelf(self.allowance)
        self._known: dict[bytes, tuple[int, TriangleMesh]] = {}  # the run that brought a mesh, and that, by its faces

    def again(self, begun: JoinedRun) -> OpenedMesh | None:
        """What is kept of the mesh of a run that begins; None: it is to be sent."""
        run, before = self._known.get(_digest(begun), (-1, begun.given))
        opened = self._shelf.take(run) if run in self._shelf else None
        if opened is not None:
            moving = {mover.name for mover in opened.movers}
            others = (one for one in before.attributes if one.name not in moving)
            opened = opened if all(has(begun.given.attributes, one) for one in others) else None
        if opened is None:
            self._shelf.make_room()
            return None
        allowance = opened.coded.opening.allowance
        allowance.follow(self.allowance)
        allowance.show(opened.coded.opening.header.vertices)  # the first GOP does, at least
        return opened

    def keep(self, opened: OpenedMesh, ended: JoinedRun) -> None:
        """Take note that a run of this mesh has ended."""
        opening = opened.coded.opening
        opening.setting.dictionaries.release()
        self.allowance.follow(opening.allowance)
        if opened.run not in self._shelf:
            self._shelf.put(opened.run, opened)
        self._shelf.leave(opened.run)
        given = TriangleMesh(ended.given.positions, ended.given.faces, ended.given.attributes)
        self._known[_digest(ended)] = opened.run, given


def _digest(run: JoinedRun) -> bytes:
    """What runs of the same faces, joins and attributes have in common, whatever the values of those that can move."""
    mesh, moving = run.given, {one.name for one in run.moving}
    found = sha256(len(mesh.positions).to_bytes(8, "little") + mesh.faces.tobytes() + run.joined.index.tobytes())
    for one in mesh.attributes:
        found.update(repr((one.name, one.domain, one.semantic, one.values.dtype, one.values.shape)).encode())
        found.update(b"" if one.name in moving else one.values.tobytes())
        if one.indices is not None:
            found.update(one.indices.tobytes())
    return found.digest()
