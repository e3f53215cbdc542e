"""Scans of a mesh as depth cameras make them, with the true surface: views of one pose, and many fused on a grid.

A structured-light camera (the first Kinect) measures whole eighths of a pixel of disparity, which its windows share, at
places that are off by half a pixel; a time-of-flight camera (the second) measures depth, smoothed over pixels that
touch. Both are noisier far away and on slanted surfaces.

References
----------
C. V. Nguyen, S. Izadi, D. Lovell, "Modeling Kinect sensor noise for improved 3D reconstruction and tracking", 2012.
J. T. Barron, J. Malik, "Intrinsic scene properties from a single RGB-D image", 2013.
A. Handa et al., "A benchmark for RGB-D visual odometry, 3D reconstruction and SLAM", 2014.
B. Curless, M. Levoy, "A volumetric method for building complex models from range images", 1996.
"""

import importlib
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import ndimage, spatial

from bsm.codec.arrays import Faces, Floats, Mask, Positions
from bsm.codec.geometry.metrics import distances_to_surface, face_geometry, face_normals
from bsm.ground.pictures import nearest_faces

# Metres between projector and camera, by the eighths of a pixel that it resolves.
BASELINE_EIGHTHS = 8.0 * 0.075
# Pixels: of the window that is matched, of places, of flight's filter.
WINDOW_SPREAD, LATERAL, SHAPED = 2.5, 0.5, 0.5
JUMP = 12.0  # pixels' widths between neighbors from which on they are on different surfaces


class Camera(NamedTuple):
    """Pixels a side, focal length in pixels, how far away the middle of the mesh is, in metres, and its noise."""

    pixels: int
    focal: float
    far: float
    noise: Callable[[Floats, Floats, float, np.random.Generator], Floats]


def axial(depth: Floats, slant: Floats) -> Floats:
    """Standard deviation of a structured-light camera's depth, metres (Nguyen et al., equation 2 of the paper)."""
    steep = np.square(slant / (0.5 * np.pi - slant))
    return np.asarray(0.0012 + 0.0019 * np.square(depth - 0.4) + 0.0001 / np.sqrt(depth) * steep)


def structured_light(
    depth: Floats, slant: Floats, focal: float, random: np.random.Generator
) -> Floats:
    rows, columns = np.indices(depth.shape) + random.normal(0.0, LATERAL, (2, *depth.shape))
    seen = ndimage.map_coordinates(depth, (rows, columns), order=1, mode="nearest")
    shared = ndimage.gaussian_filter(random.normal(size=depth.shape), WINDOW_SPREAD)
    eighths = focal * BASELINE_EIGHTHS / seen
    eighths += shared / shared.std() * 0.5 * axial(depth, slant) * eighths / seen + random.normal(
        0.0, 1 / 6, depth.shape
    )
    return np.asarray(focal * BASELINE_EIGHTHS / np.round(eighths))


def time_of_flight(
    depth: Floats, slant: Floats, focal: float, random: np.random.Generator
) -> Floats:
    noise = ndimage.gaussian_filter(random.normal(size=depth.shape), SHAPED)
    return np.asarray(
        depth + noise / noise.std() * 0.0015 * np.square(depth) / np.maximum(np.cos(slant), 0.2)
    )


CAMERAS = {
    "structured light": Camera(200, 570.0, 0.85, structured_light),
    "time of flight": Camera(150, 366.0, 0.75, time_of_flight),
}


@dataclass(frozen=True, eq=False)
class Scan:
    """A noisy mesh, and the surface that it is of."""

    positions: Positions
    faces: Faces
    normals: Floats  # true ones, shape (m, 3)
    offset: Callable[[Positions], Floats]  # how far vertices are from the truth

    def angle(self, positions: Positions) -> float:
        """Mean angle of the faces to the true surface, degrees, where there is one."""
        cosines = np.einsum("ij,ij->i", face_normals(positions, self.faces), self.normals)
        return float(
            np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))[self.normals.any(axis=1)].mean()
        )

    def rms(self, positions: Positions) -> float:
        return float(np.sqrt(np.square(self.offset(positions)).mean()))


def placed(positions: Positions, camera: Camera, turn: Floats) -> Positions:
    """The mesh turned, at the size that fills most of the picture, before a camera that looks along z."""
    middle = 0.5 * (positions.min(axis=0) + positions.max(axis=0))
    turned = (positions - middle) @ turn.T
    size = (
        0.85
        * 0.5
        * camera.pixels
        / camera.focal
        * camera.far
        / np.linalg.norm(turned[:, :2], axis=1).max()
    )
    return np.asarray(size * turned + [0.0, 0.0, camera.far])


def render(positions: Positions, faces: Faces, camera: Camera) -> tuple[Floats, Floats]:
    """True depth at each pixel, inf where nothing is and -inf at backs, and the angle at which the surface is met."""
    screen = positions[:, :2] / positions[:, 2:] * camera.focal + 0.5 * camera.pixels
    corners = np.column_stack([screen, 1.0 / positions[:, 2]])
    owner = nearest_faces(corners, faces, camera.pixels)
    first, second, third = (corners[faces[owner, corner]] for corner in range(3))
    # Of nearness, which is linear in columns and rows.
    slope = np.cross(second - first, third - first)
    rows, columns = np.indices(owner.shape) + 0.5
    away = slope[..., 0] * (columns - first[..., 0]) + slope[..., 1] * (rows - first[..., 1])
    nearness = first[..., 2] - away / slope[..., 2]
    rays = _rays(camera)
    facing = -np.einsum("ijk,ijk->ij", face_normals(positions, faces)[owner], rays)
    depth = np.where(owner < 0, np.inf, np.where(facing > 0.0, 1.0 / nearness, -np.inf))
    return depth, np.arccos(np.clip(facing / np.linalg.norm(rays, axis=2), 0.1, 1.0))


def _rays(camera: Camera) -> Floats:
    rows, columns = (np.indices((camera.pixels,) * 2) + 0.5 - 0.5 * camera.pixels) / camera.focal
    return np.stack([columns, rows, np.ones_like(rows)], axis=2)


def photograph(
    positions: Positions, faces: Faces, camera: Camera, seed: int
) -> tuple[Floats, Floats]:
    """True and measured depth at each pixel."""
    depth, slant = render(positions, faces, camera)
    seen = np.isfinite(depth)
    nearest = ndimage.distance_transform_edt(~seen, return_distances=False, return_indices=True)
    filled, slant = depth[tuple(nearest)], slant[tuple(nearest)]
    measured = camera.noise(filled, slant, camera.focal, np.random.default_rng(seed))
    return depth, np.where(seen, measured, depth)


def view(
    positions: Positions, faces: Faces, camera: Camera, seed: int, turn: Floats | None = None
) -> Scan:
    """What the camera makes of one pose: a grid of pixels, without the triangles that reach across gaps."""
    placed_ = placed(positions, camera, turning(seed) if turn is None else turn)
    depth, measured = photograph(placed_, faces, camera, seed)
    number = np.arange(depth.size).reshape(depth.shape)
    a, b, c, d = (
        number[:-1, :-1].ravel(),
        number[:-1, 1:].ravel(),
        number[1:, :-1].ravel(),
        number[1:, 1:].ravel(),
    )
    grid = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    grid = grid[_together(measured.ravel()[grid], camera)]
    kept = np.unique(grid)
    grid = np.searchsorted(kept, grid).astype(np.int32)
    rays = _rays(camera).reshape(-1, 3)[kept]
    noisy, true = (rays * values.ravel()[kept, None] for values in (measured, depth))
    known = _together(depth.ravel()[kept][grid], camera)
    normals = np.where(known[:, None], face_normals(true, grid), 0.0)
    return Scan(noisy, grid, normals, lambda moved: np.linalg.norm(moved - true, axis=1))


def _together(depths: Floats, camera: Camera) -> Mask:
    least, most = depths.min(axis=1), depths.max(axis=1)
    return np.asarray(np.isfinite(most) & (most < (1.0 + JUMP / camera.focal) * least))


def turning(seed: int) -> Floats:
    """A rotation, all alike likely."""
    return np.asarray(spatial.transform.Rotation.random(random_state=seed).as_matrix())


def isosurface(
    values: Floats, steps: Floats | float, origin: Floats | float
) -> tuple[Positions, Faces]:
    """Marching cubes at 0 of values that are positive inside, whose normals point outwards."""
    filters, data, numpy_support = (
        importlib.import_module(f"vtkmodules.{name}")
        for name in ("vtkFiltersCore", "vtkCommonDataModel", "util.numpy_support")
    )
    volume, marching = data.vtkImageData(), filters.vtkFlyingEdges3D()
    volume.SetDimensions(values.shape)
    # Larger inside: the triangles of VTK face lower values.
    flat = np.ascontiguousarray(values.ravel(order="F"), np.float32)
    volume.GetPointData().SetScalars(numpy_support.numpy_to_vtk(flat))
    marching.SetInputData(volume)
    marching.SetValue(0, 0.0)
    marching.ComputeNormalsOff()
    marching.Update()
    surface = marching.GetOutput()
    corners = numpy_support.vtk_to_numpy(surface.GetPoints().GetData())
    faces = numpy_support.vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return corners.astype(np.float64) * steps + origin, np.ascontiguousarray(faces, np.int32)


# Voxels: how far views reach; and from the truth, where surface is made up and cut away.
TRUNCATION, FALSE = 4.0, 2.0
SAMPLES = 400_000


def fused(
    positions: Positions, faces: Faces, camera: Camera, seed: int, poses: int = 12, cells: int = 90
) -> Scan:
    """Fuse views: average the distances along their rays on a grid, and mesh the surface where they are 0."""
    lone = placed(positions, camera, turning(seed)) - [0.0, 0.0, camera.far]
    half = 1.06 * np.abs(lone).max()
    step = 2.0 * half / (cells - 1)
    voxels = np.stack(
        np.meshgrid(*3 * [np.linspace(-half, half, cells)], indexing="ij"), axis=-1
    ).reshape(-1, 3)
    sums, weights = np.zeros(len(voxels)), np.zeros(len(voxels))
    for pose in range(poses):
        height = 1.0 - (2.0 * pose + 1.0) / poses
        level = math.acos(height)
        turn = spatial.transform.Rotation.from_euler(
            "zx", (pose * math.pi * (1.0 + math.sqrt(5.0)), level)
        ).as_matrix()
        _, measured = photograph(lone @ turn.T + [0.0, 0.0, camera.far], faces, camera, seed + pose)
        there = voxels @ turn.T + [0.0, 0.0, camera.far]
        at = np.floor(there[:, :2] / there[:, 2:] * camera.focal + 0.5 * camera.pixels).astype(int)
        inside = ((at >= 0) & (at < camera.pixels)).all(axis=1)
        apart = (
            np.where(inside, measured[tuple(np.clip(at, 0, camera.pixels - 1).T[::-1])], np.inf)
            - there[:, 2]
        )
        counted = apart > -TRUNCATION * step
        sums += np.where(counted, np.minimum(apart / (TRUNCATION * step), 1.0), 0.0)
        weights += counted
    field = np.where(weights > 0.0, sums / np.maximum(weights, 1.0), 1.0).reshape(3 * (cells,))
    noisy, made = isosurface(-field, step, -half)
    geometry = face_geometry(lone, faces)
    random = np.random.default_rng(seed)
    chosen = random.choice(len(faces), SAMPLES, p=geometry.areas / geometry.areas.sum())
    points = np.einsum("ij,ijk->ik", random.dirichlet(np.ones(3), SAMPLES), lone[faces[chosen]])
    apart, near = spatial.cKDTree(points).query(face_geometry(noisy, made).centroids)
    kept = apart < FALSE * step
    used, number = np.unique(made[kept], return_inverse=True)
    return Scan(
        noisy[used],
        np.ascontiguousarray(number.reshape(-1, 3), np.int32),
        geometry.normals[chosen[near[kept]]],
        lambda moved: distances_to_surface(moved, lone, faces),
    )
