import numpy as np
import pytest

from bsm.bitstream.coefficients.trellis import points_of_levels
from bsm.codec.basis.orthogonal_iteration import hash_columns
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.detail import Normals, fold_details, make_surface
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from tests.shapes import grid_faces, torus


def whole(mesh):
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    return Block(np.arange(len(mesh.positions), dtype=np.int32), graph.offsets, graph.neighbours)


def test_normals_of_a_plane_point_out_of_it():
    faces = grid_faces(5, 6)
    x, y = np.meshgrid(np.arange(5.0), np.arange(6.0), indexing="ij")
    positions = np.stack([x, y, np.zeros_like(x)], -1).reshape(-1, 3)
    graph = graph_of_faces(faces, 30)
    block = Block(np.arange(30, dtype=np.int32), graph.offsets, graph.neighbours)
    normals = Normals(make_surface(faces, 30)).of(block, positions)
    assert np.allclose(normals, [0, 0, 1], atol=1e-5)
    assert (np.linalg.norm(normals, axis=1) < 1).all()


def test_normals_see_only_the_faces_inside_the_block():
    mesh = torus(12, 8)
    inside = np.arange(40, dtype=np.int32)
    surface = make_surface(mesh.faces, len(mesh.positions))
    block = Block(inside, np.zeros(41, np.int32), np.zeros(0, np.int32))
    first = Normals(surface).of(block, mesh.positions[inside])
    kept = mesh.faces[(mesh.faces < 40).all(axis=1)]
    second = Normals(make_surface(kept, 40)).of(block, mesh.positions[inside])
    assert np.array_equal(first, second)


def test_normals_of_nothing_are_zero():
    surface = make_surface(np.array([[0, 1, 2], [1, 1, 0]], np.int32), 3)
    block = Block(np.arange(3, dtype=np.int32), np.zeros(4, np.int32), np.zeros(0, np.int32))
    assert not Normals(surface).of(block, np.zeros((3, 3))).any()


def test_a_block_can_be_used_again():
    mesh = torus(12, 8)
    normals = Normals(make_surface(mesh.faces, len(mesh.positions)))
    block = whole(mesh)
    assert np.array_equal(normals.of(block, mesh.positions), normals.of(block, mesh.positions))


def test_heights_move_along_normals():
    mesh = torus(12, 8)
    normals, block = Normals(make_surface(mesh.faces, len(mesh.positions))), whole(mesh)
    subspace, levels = hash_columns(block.size, 5), np.array([[3, -2, 0], [1, 7, 0]], np.int32)
    raised = mesh.positions.copy()
    normals.raise_block(block, subspace, levels, 4, 0.25, raised)
    height = subspace[:, :4] @ (points_of_levels(levels).reshape(-1)[:4] * 0.125)
    assert np.allclose(raised, mesh.positions + normals.of(block, mesh.positions) * height[:, None], atol=1e-14)
    normals.raise_block(block, subspace, levels, 0, 0.25, same := mesh.positions.copy())
    assert np.array_equal(same, mesh.positions)


@pytest.mark.parametrize(("columns", "count"), [(5, 6), (9, 7), (5, -1)])
def test_more_heights_than_columns_or_levels_are_a_mistake(columns, count):
    mesh = torus(12, 8)
    normals, block = Normals(make_surface(mesh.faces, len(mesh.positions))), whole(mesh)
    with pytest.raises(ValueError, match="fit together"):
        normals.raise_block(
            block, np.zeros((block.size, columns)), np.zeros((2, 3), np.int32), count, 0.25, mesh.positions.copy()
        )


@pytest.mark.parametrize("count", [0, 1, 2, 3, 7])
def test_folding(count):
    levels = np.arange(1, count + 1, dtype=np.int32)
    folded = fold_details(levels)
    assert folded.shape == ((count + 2) // 3, 3)
    assert folded.reshape(-1)[:count].tolist() == levels.tolist()


def test_the_detail_layer_saves_bytes_at_equal_angles():
    mesh = torus(80, 60, bumps=0.2)
    plain = Encoder(mesh, EncodeOptions(block_size=400, detail=0.0)).attempt(0.0012)
    detailed = Encoder(mesh, EncodeOptions(block_size=400, detail=3.0)).attempt(0.0008)
    assert detailed.comparison.theta_deg < plain.comparison.theta_deg
    assert detailed.size < plain.size
