"""How far a decoded mesh, or moving mesh, is from its original, by others' measures beside our own; less is better."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.graph import mesh_edges
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference, face_normals
from bsm.codec.look.measure import LookMetric
from tools.replicate.pictures import Gallery

MEASURES = {
    "look": "our look",
    "facets": "difference in facets",
    "Hausdorff": "Hausdorff distance",
    "RMS": "RMS distance",
    "angle": "angle of normals",
    "NMSVE": "NMSVE",
    "DAME": "DAME",
}
"""Measures of a mesh, as a table calls them."""
FOLDED = math.log(100.0)  # at an angle of 180 degrees, a change of it counts a hundredth in DAME
Floats = npt.NDArray[np.float64]


class Judge:
    """An original, and what each measure says of decoded versions with the same faces."""

    def __init__(self, mesh: TriangleMesh) -> None:
        self._mesh, self._faces = mesh, mesh.faces
        self._look, self._gallery = LookMetric(mesh, threads=1), Gallery(mesh)
        self._reference = Reference(mesh.positions, mesh.faces)
        self._angles, self._pairs = dihedral_angles(mesh.positions, mesh.faces)
        self._samples = max(10_000, min(50_000, 2 * len(mesh.faces)))

    def measures(self, positions: Positions) -> dict[str, float]:
        """By the names of `MEASURES`, lengths over the diagonal of the box."""
        decoded = TriangleMesh(positions, self._faces)
        compared = self._reference.compare(positions)
        farthest, rms = surface_distance(self._mesh, decoded, self._samples)
        return {
            "look": self._look.compare(decoded).distance,
            "facets": self._gallery.facets(positions),
            "Hausdorff": farthest / self._reference.scale,
            "RMS": rms / self._reference.scale,
            "angle": compared.angle_deg,
            "NMSVE": compared.nmsve,
            "DAME": self.dame(positions),
        }

    def dame(self, positions: Positions) -> float:
        """Dihedral angle mesh error (Vasa and Rus, 2012) in radians, with masking, without its term of visibility.

        doi 10.1111/j.1467-8659.2012.03176.x. Its abstract could be read, its weight of masking is from memory.
        """
        angles = dihedral_angles(positions, self._faces, self._pairs)[0]
        weights = np.exp(-FOLDED * np.square(self._angles / np.pi))
        return float(np.mean(weights * np.abs(self._angles - angles))) if len(angles) else 0.0


def dihedral_angles(positions: Positions, faces: Faces, pairs: Any = None) -> tuple[Floats, Any]:
    """Signed angles between the normals of faces that share an edge, and which these are; edges of two faces count."""
    if pairs is None:
        ends = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        order = np.lexsort(ends.T)
        same = (ends[order][1:] == ends[order][:-1]).all(axis=1)
        # Of three faces at an edge no two are chosen.
        twice = same & ~np.append(same[1:], False) & ~np.insert(same[:-1], 0, False)
        first, second = order[:-1][twice], order[1:][twice]
        pairs = (
            first // 3,
            second // 3,
            faces[second // 3, (second % 3 + 2) % 3],
            faces[first // 3, first % 3],
        )
    left, right, apex, foot = pairs
    normals = face_normals(positions, faces)
    cosines = np.clip(np.einsum("ij,ij->i", normals[left], normals[right]), -1.0, 1.0)
    side = np.einsum("ij,ij->i", normals[left], positions[apex] - positions[foot])
    return np.arccos(cosines) * np.where(side < 0, -1.0, 1.0), pairs


def surface_distance(
    first: TriangleMesh, second: TriangleMesh, samples: int
) -> tuple[float, float]:
    """Metro's distances between surfaces, the larger of both directions: Hausdorff, and root mean square (MeshLab)."""
    import pymeshlab

    meshes = pymeshlab.MeshSet(verbose=False)
    for mesh in (first, second):
        meshes.add_mesh(pymeshlab.Mesh(mesh.positions.astype(np.float64), mesh.faces))
    sampled = {"samplevert": True, "sampleedge": False, "sampleface": True, "samplenum": samples}
    ways = [
        meshes.get_hausdorff_distance(sampledmesh=k, targetmesh=1 - k, **sampled) for k in (0, 1)
    ]
    return max(way["max"] for way in ways), max(way["RMS"] for way in ways)


STED_TIME, STED_SHARE = 0.05, 1.0
"""A frame's length in time over the diagonal of the box, and how much the temporal part of STED counts."""


def sted(original: Positions, decoded: Positions, faces: Faces) -> float:
    """Spatio-temporal edge difference of frames of shape (T, n, 3), after Vasa and Skala (2011), from memory.

    The spatial part is the deviation of relative changes of edges' lengths around each vertex (its own edges), the
    temporal part the relative change of what a vertex moves from a frame to the next, with time as a fourth axis.
    """
    edges = mesh_edges(faces, original.shape[1])
    diagonal = float(np.linalg.norm(np.ptp(original.reshape(-1, 3), axis=0)))
    spatial, temporal = [], []
    for own, right in zip(original, decoded, strict=True):
        lengths, changed = (
            np.linalg.norm(np.subtract(*frame[edges.T]), axis=1) for frame in (own, right)
        )
        spatial.append(
            _deviation((changed - lengths) / np.maximum(lengths, 1e-12), edges, len(own))
        )
    for frames in zip(original, original[1:], decoded, decoded[1:]):
        lengths, changed = (
            np.hypot(np.linalg.norm(after - before, axis=1) / diagonal, STED_TIME)
            for before, after in (frames[:2], frames[2:])
        )
        temporal.append(float(np.sqrt(np.mean(np.square((changed - lengths) / lengths)))))
    return math.hypot(float(np.mean(spatial)), STED_SHARE * float(np.mean(temporal or [0.0])))


def _deviation(changes: Floats, edges: npt.NDArray[Any], vertices: int) -> float:
    """The standard deviation of edges' values around each vertex, its mean over vertices."""
    ends, values = edges.T.reshape(-1), np.tile(changes, 2)
    count = np.maximum(np.bincount(ends, minlength=vertices), 1)
    mean = np.bincount(ends, values, vertices) / count
    squares = np.bincount(ends, np.square(values - mean[ends]), vertices) / count
    return float(np.sqrt(squares).mean())
