"""The models of the paper: files of BSM_MESHES where they are there, else fetched meshes that only stand in."""

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from bsm.codec.arrays import Faces, Positions
from bsm.codec.blocks.overlap import Blocks, block_size, grow_blocks, metis_partition
from bsm.codec.denoise.coarse import OVERLAP, CoarseFilter
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.evaluation.curve import timed
from bsm.files.mesh import read_mesh
from tools.noise import gaussian_along_normals
from tools.replicate.fetch import Source

Item = TypeVar("Item")


class Role(NamedTuple):
    """A model of the paper: its name there, our file, a noisy one or how strong noise is, the paper's vertices."""

    title: str
    file: str
    noisy: str
    sigma: float
    vertices: int = 0


ROLES = {
    "bunny": Role("the Bunny", "bunny_34834", "bunny_34834_noisy", 0.2, 34_817),
    "julio": Role("Julio", "julius_36201", "julius_36201_noisy", 0.2, 36_201),
    "twelve": Role("Twelve", "twelve_dodecahedron", "twelve_dodecahedron_noisy", 0.3, 4610),
    "fandisk": Role("Fandisk", "fandisk_6475", "fandisk_0.7_noisy", 0.7, 6475),
    "fandisk 0.3": Role("Fandisk", "fandisk_6475", "fandisk_0.3_noisy", 0.3, 6475),
    "armadillo": Role("the Armadillo", "armadillo_20002_derived", "", 0.2, 20_002),
    "hand": Role("the Hand", "dragon_437645", "", 0.2, 327_323),
    "sphere": Role("Sphere", "sharpsphere", "sharpsphere_noisy", 0.3),
    "star": Role("Trim star", "trim_star", "trim_star_noisy", 0.5),
}
"""The authors' Armadillo is not published: another reduction of the same scan to as many vertices. Nor is the Hand: a
dragon of 437,645 vertices plays it, in blocks of the size that the Hand's had."""
NAMED, QUICK_SIZE = "named", 1200
"""The group of meshes that a user names, and vertices of stand-ins if few settings are tried."""
SEGMENTS = {"armadillo": 20.0, "hand": 930 * 327_323 / 437_645}
"""The Armadillo's are the paper's; those of the Hand make 930 of the dragon, and n_d about 540."""


def complete(folder: Path | None) -> bool:
    """Whether a folder has a file for every role."""
    return folder is not None and all(
        (folder / "static" / f"{role.file}.ply").exists() for role in ROLES.values()
    )


@dataclass(frozen=True, eq=False)
class Model:
    """A model as it is used; `vertices` are the paper's, and `own` says whether claims are judged on it.

    They are on the paper's models, on those that play one well, and on meshes that a user names.
    """

    name: str
    title: str
    own: bool
    clean: Positions
    noisy: Positions
    faces: Faces
    vertices: int

    @cached_property
    def reference(self) -> Reference:
        """The clean mesh, prepared for comparison."""
        return Reference(self.clean, self.faces)

    @property
    def mesh(self) -> TriangleMesh:
        """The clean mesh, without vertices that no face has."""
        return TriangleMesh(self.clean, self.faces).without_isolated_vertices()[0]

    def segments(self, paper: float) -> int:
        """As many segments as make segments of the paper's size, where the paper has `paper` of them."""
        return max(2, round(paper * len(self.clean) / (self.vertices or len(self.clean))))

    def counted(self, paper: float) -> str:
        """The segments in words: a mesh of another size keeps the size of the paper's, and not their number."""
        count = self.segments(paper)
        if count == paper:
            return f"{paper:g} segments"
        return f"{count} segments, about as large as {paper:.4g} of {self.title}"

    def block(self, paper: float) -> int:
        """Vertices of a segment before overlap, where the paper has `paper` of them."""
        return round(len(self.clean) / self.segments(paper))

    def coarse(self, segments: float, **how: Any) -> CoarseFilter:
        """The coarse step in as many segments as the paper has."""
        return CoarseFilter(self.faces, len(self.clean), block=self.block(segments), **how)

    def blocks(self, segments: float, overlap: float = OVERLAP) -> Blocks:
        """The overlapping blocks that grow from the parts that METIS finds."""
        graph = graph_of_faces(self.faces, len(self.clean))
        partition = metis_partition(graph, self.segments(segments))
        return grow_blocks(graph, partition, block_size(partition, overlap))


@dataclass(frozen=True, eq=False)
class Study:
    """Where tables get their models and put their pictures; `quick`: few settings."""

    folder: Path | None
    sources: Sequence[Source]
    quick: bool
    output: Path | None = None
    _models: dict[str, Model] = field(default_factory=dict, init=False)

    @property
    def repeats(self) -> int:
        """How many times what is timed runs."""
        return 1 if self.quick else 3

    def some(self, values: Iterable[Item]) -> list[Item]:
        """The values that are tried."""
        every = list(values)
        return [
            v for i, v in enumerate(every) if not self.quick or i % 4 == 0 or i == len(every) - 1
        ]

    def model(self, role: str) -> Model:
        """The model that plays a role of the paper."""
        if role not in self._models:
            self._models[role] = self._made(ROLES[role])
        return self._models[role]

    def _made(self, role: Role) -> Model:
        path = self.folder and self.folder / "static" / f"{role.file}.ply"
        taken = {model.name for model in self._models.values()}
        free = [source for source in self.sources if source.name not in taken]
        if path is not None and path.exists() and not any(source.group == NAMED for source in free):
            return self._from_folder(role, read_mesh(str(path)).mesh)
        wanted = min(role.vertices or 6000, QUICK_SIZE if self.quick else 12_000)
        source = min(free or self.sources, key=lambda source: abs(source.vertices - wanted))
        mesh = source.mesh()
        noisy = gaussian_along_normals(mesh.positions, mesh.faces, role.sigma, seed=1)
        own = source.group == NAMED
        return Model(source.name, role.title, own, mesh.positions, noisy, mesh.faces, role.vertices)

    def _from_folder(self, role: Role, mesh: TriangleMesh) -> Model:
        assert self.folder is not None
        path = self.folder / "noisy" / f"{role.noisy}.ply"
        if role.noisy and path.exists():
            noisy = read_mesh(str(path)).mesh.positions
        else:
            noisy = gaussian_along_normals(mesh.positions, mesh.faces, role.sigma, seed=1)
        return Model(role.file, role.title, True, mesh.positions, noisy, mesh.faces, role.vertices)


def fastest(work: Callable[[], object], repeats: int) -> float:
    """Seconds of a thread of the fastest run, so that what else the machine does counts for little."""
    return timed(work, repeats, time.thread_time)[0]
