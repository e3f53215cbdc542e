"""What the exhibits are made from: models, real or generated, and how much work to put into each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
import numpy.typing as npt
from scipy.spatial import ConvexHull

from bsm.bitstream.errors import OptionError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.evaluation.sample import knot
from bsm.files.formats.npz import read_arrays
from bsm.files.mesh import format_of_name, read_mesh
from bsm.pictures import DEFAULT_VIEW, view_matrix
from tools.noise import gaussian_along_normals

Item = TypeVar("Item")

_UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns y, which points up in the files, to z, which points up in pictures."""

LARGEST = ""
"""In place of a file's name: the largest file there is."""

GENERATED = 12_000
"""Most vertices of a generated model."""


@dataclass(frozen=True)
class Role:
    """A model of the paper."""

    name: str
    vertices: int
    clean: str
    noisy: str
    shape: Callable[[int], TriangleMesh]
    sigma: float
    remark: str = ""
    azimuth: float = -70.0

    @property
    def view(self) -> npt.NDArray[np.float64]:
        """The camera for our file, see `bsm.evaluation.plots`."""
        view: npt.NDArray[np.float64] = view_matrix(self.azimuth, 15.0) @ _UPRIGHT
        return view


Doubles = npt.NDArray[np.float64]


def box(vertices: int, sides: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> TriangleMesh:
    """A box, for CAD models: six grids of triangles, joined along the edges."""
    size = max(2, round((vertices / 6) ** 0.5))
    v, u = np.mgrid[: size + 1, : size + 1].reshape(2, -1)
    corner = (np.arange(size)[:, None] * (size + 1) + np.arange(size)).ravel()
    flat = np.concatenate(
        [
            np.stack([corner, corner + 1, corner + size + 2], axis=1),
            np.stack([corner, corner + size + 2, corner + size + 1], axis=1),
        ]
    )
    low, high = np.zeros_like(u), np.full_like(u, size)
    grids = [(v, u, low), (u, v, high), (low, v, u), (high, u, v), (u, low, v), (v, high, u)]
    points = np.concatenate([np.stack(grid, axis=1) for grid in grids])
    faces = np.concatenate([flat + index * len(u) for index in range(6)])
    positions, number = np.unique(points, axis=0, return_inverse=True)
    return TriangleMesh(positions * np.array(sides) / size, number.ravel()[faces])


def ball(vertices: int, spikes: float = 0.0) -> TriangleMesh:
    """A sphere of Fibonacci's points; `spikes` above 0 makes it a star of as much depth."""
    index = np.arange(vertices) + 0.5
    height, angle = 1 - 2 * index / vertices, np.pi * (1 + 5**0.5) * index
    ring = np.sqrt(1 - height**2)
    points = np.stack([ring * np.cos(angle), ring * np.sin(angle), height], axis=1)
    faces = ConvexHull(points).simplices
    corners = points[faces]
    inwards = np.einsum(
        "ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 0]
    )
    faces[inwards < 0] = faces[inwards < 0][:, ::-1]
    radius = 1 + spikes * np.cos(5 * np.arctan2(points[:, 1], points[:, 0])) * ring**2
    return TriangleMesh(points * radius[:, None], faces)


def swaying(mesh: TriangleMesh, frames: int) -> Doubles:
    """Frames, shape (T, n, 3), in which a mesh twists to and fro about its z axis."""
    turns = 0.6 * np.sin(np.linspace(0, 2 * np.pi, frames, endpoint=False))
    height = mesh.positions[:, 2] / (np.ptp(mesh.positions[:, 2]) or 1.0)
    angle = turns[:, None] * height
    x, y, z = mesh.positions.T
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([cos * x - sin * y, sin * x + cos * y, np.broadcast_to(z, angle.shape)], axis=-1)


ROLES = {
    "bunny": Role("Bunny", 34_817, "bunny_34834", "bunny_34834_noisy", knot, 0.2, "17 vertices more than the paper's"),
    "julio": Role(
        "Julio", 36_201, "julius_36201", "julius_36201_noisy", lambda n: knot(n, 2), 0.2, "known as Julius", 110.0
    ),
    "twelve": Role("Twelve", 0, "twelve_dodecahedron", "twelve_dodecahedron_noisy", box, 0.3, "impulsive noise"),
    "fandisk": Role(
        "Fandisk", 0, "fandisk_6475", "fandisk_0.7_noisy", lambda n: box(n, (1.0, 0.6, 0.3)), 0.7, "", 110.0
    ),
    "armadillo": Role(
        "Armadillo",
        20_002,
        "armadillo_20002_derived",
        "",
        lambda n: knot(n, 3),
        0.2,
        "the authors' own file is not published; another reduction of the same scan to the same number of vertices",
        110.0,
    ),
    "hand": Role(
        "Hand",
        327_323,
        LARGEST,
        "",
        lambda n: knot(n, 4),
        0.2,
        "not available; the largest mesh of the folder takes its place, in blocks of the size that the Hand's had",
    ),
    "sphere": Role("Sphere", 0, "sharpsphere", "sharpsphere_noisy", ball, 0.3, "the sharp sphere of the same data set"),
    "star": Role("Trim star", 0, "trim_star", "trim_star_noisy", lambda n: ball(n, 0.35), 0.5),
    "gargoyle": Role("Gargoyle", 0, "gargoyle_10002", "", lambda n: knot(n, 5), 0.2),
}
MOVING = Role("a sequence", 0, "samba", "", knot, 0.2)
"""Of the dynamic case, for which the paper names no model."""


@dataclass(frozen=True, eq=False)
class Model:
    """A model as it is used."""

    name: str
    role: Role
    clean: Positions
    noisy: Positions
    faces: Faces
    view: npt.NDArray[np.float64] = field(default_factory=lambda: DEFAULT_VIEW)

    @property
    def size(self) -> int:
        """Number of vertices."""
        return len(self.clean)

    @property
    def mesh(self) -> TriangleMesh:
        """The clean mesh."""
        return TriangleMesh(self.clean, self.faces)

    @property
    def reference(self) -> Reference:
        """The clean mesh, prepared for comparison."""
        return Reference(self.clean, self.faces)

    def segments(self, paper: int) -> int:
        """As many segments as make segments of the paper's size, where the paper has `paper` of them."""
        return max(2, round(paper * self.size / (self.role.vertices or self.size)))

    def block(self, paper: int) -> int:
        """Vertices of a segment before overlap, where the paper has `paper` of them."""
        return round(self.size / self.segments(paper))


@dataclass(frozen=True, kw_only=True)
class Effort:
    """How many settings an exhibit tries."""

    thinning: int
    vertices: int
    pixels: int
    repeats: int
    frames: int

    def some(self, values: Iterable[Item]) -> list[Item]:
        """The values that are tried."""
        every = list(values)
        return [v for i, v in enumerate(every) if i % self.thinning == 0 or i == len(every) - 1]


FULL = Effort(thinning=1, vertices=GENERATED, pixels=300, repeats=3, frames=1000)
QUICK = Effort(thinning=4, vertices=1_200, pixels=120, repeats=1, frames=12)


@dataclass(frozen=True, eq=False)
class Study:
    """Where exhibits get their models."""

    folder: Path | None
    effort: Effort
    note: Callable[[str], None]
    _models: dict[str, Model] = field(default_factory=dict, init=False)

    def model(self, role: str) -> Model:
        """The model that plays a role of the paper."""
        if role not in self._models:
            self._models[role] = self._generated(ROLES[role]) if self.folder is None else self._read(ROLES[role])
        return self._models[role]

    def partner(self, role: str, noisy: str, sigma: float) -> Model:
        """A model with other noise: of the file `noisy`, or as strong as `sigma` where there is none."""
        model = self.model(role)
        if self.folder is None:
            moved = gaussian_along_normals(model.clean, model.faces, sigma, seed=2)
        else:
            moved = self._positions("noisy", noisy).positions
        return replace(model, noisy=moved)

    def sequence(self) -> tuple[Model, npt.NDArray[np.float64]]:
        """A sequence: its first frame as a model, and frames of shape (T, n, 3)."""
        if self.folder is None:
            mesh = knot(min(9_971, self.effort.vertices))
            frames = swaying(mesh, min(48, self.effort.frames))
            return Model("generated", MOVING, frames[0], frames[0], mesh.faces), frames
        path = self.folder / "dynamic" / f"{MOVING.clean}.npz"
        if not path.exists():
            raise OptionError(f"there is no {path}")
        positions, faces = read_arrays(path, "positions", "faces")
        frames = positions[: self.effort.frames].astype(np.float64)
        return Model(MOVING.clean, MOVING, frames[0], frames[0], faces.astype(np.int32), MOVING.view), frames

    def _read(self, role: Role) -> Model:
        name = role.clean or self._largest("static")
        mesh = self._positions("static", name)
        if role.noisy:
            moved = self._positions("noisy", role.noisy).positions
        else:
            moved = gaussian_along_normals(mesh.positions, mesh.faces, role.sigma, seed=1)
        return Model(name, role, mesh.positions, moved, mesh.faces, role.view)

    def _largest(self, part: str) -> str:
        assert self.folder is not None
        files = [path for path in sorted((self.folder / part).iterdir()) if format_of_name(path)]
        if not files:
            raise OptionError(f"{self.folder / part} holds no mesh")
        return max(files, key=lambda path: path.stat().st_size).stem

    def _positions(self, part: str, name: str) -> TriangleMesh:
        assert self.folder is not None
        found = sorted((self.folder / part).glob(f"{name}.*"))
        if not found:
            raise OptionError(f"{self.folder / part} holds no {name}.ply or the like")
        return read_mesh(found[0]).mesh

    def _generated(self, role: Role) -> Model:
        mesh = role.shape(min(role.vertices or 6_000, self.effort.vertices))
        moved = gaussian_along_normals(mesh.positions, mesh.faces, role.sigma, seed=1)
        return Model(f"generated {role.name}", role, mesh.positions, moved, mesh.faces)
