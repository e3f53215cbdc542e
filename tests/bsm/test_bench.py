import json

import numpy as np
import pytest

from bsm.bitstream.errors import NumericError
from bsm.codec.basis.laplacian import dense_laplacian
from bsm.codec.basis.orthogonal_iteration import hash_columns, onorm
from bsm.codec.blocks.overlap import grow_blocks
from bsm.codec.blocks.partition import derive_partition
from bsm.codec.geometry.graph import graph_of_faces
from bsm.evaluation.bench import bench_tables, run_bench, subdivide
from bsm.evaluation.link import Delivery, break_even
from bsm.evaluation.solvers import EXACT, POWERS, Solver, check_iteration, check_lowest
from bsm.files.mesh import format_mesh
from tests.shapes import patch, tetrahedron, torus


@pytest.fixture(scope="module")
def block():
    graph = graph_of_faces(patch(14, 14).faces, 196)
    return grow_blocks(graph, derive_partition(graph, 1), 196).block(0)


@pytest.mark.parametrize("solver", EXACT, ids=lambda solver: solver.name)
def test_every_exact_solver_passes_the_check(solver, block):
    check_lowest(solver, dense_laplacian(block), 12)


def test_wrong_answers_are_found(block):
    laplacian = dense_laplacian(block)
    random = Solver("random", lambda a, c: onorm(hash_columns(len(a), c)))
    skewed = Solver("skewed", lambda a, c: np.linalg.eigh(a)[1][:, :c] * 1.01)
    later = Solver("later", lambda a, c: np.linalg.eigh(a)[1][:, 1 : c + 1])
    for solver in (random, skewed, later):
        with pytest.raises(NumericError, match=solver.name):
            check_lowest(solver, laplacian, 12)


@pytest.mark.parametrize("power", POWERS)
def test_iterations_pass_the_check(power, block):
    check_iteration(block, hash_columns(block.size, 12), power)


def test_subdividing_keeps_the_surface_and_its_topology():
    for mesh in (tetrahedron(), torus()):
        fine = subdivide(mesh)
        edges = len(mesh.faces) * 3 // 2
        assert len(fine.positions) == len(mesh.positions) + edges and len(fine.faces) == 4 * len(mesh.faces)
        assert len(graph_of_faces(fine.faces, len(fine.positions)).neighbours) == 2 * (2 * edges + 3 * len(mesh.faces))

        def areas(m):
            a, b, c = (m.positions[m.faces[:, i]] for i in range(3))
            return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2

        assert np.isclose(areas(fine), areas(mesh))


def test_the_link_on_which_both_are_as_quick():
    ours, theirs = Delivery(1_000, 7.0, 0.05), Delivery(11_000, 6.9, 0.01)
    assert break_even(ours, theirs) == pytest.approx(2.0)  # 80,000 bits in 40 ms
    assert break_even(Delivery(1_000, 7.0, 0.01), theirs) == float("inf")
    assert break_even(Delivery(11_000, 7.0, 0.05), theirs) == 0.0


def test_a_bench_of_a_small_mesh_is_complete_and_fit_for_json(tmp_path):
    pytest.importorskip("DracoPy")
    path = tmp_path / "patch.ply"
    path.write_bytes(format_mesh(patch(30, 30), "ply"))
    result = run_bench([str(path)], sample=1, repeats=1, largest=0)
    (row,) = result["meshes"]
    assert len(row["dictionaries"]) == 4 * (len(EXACT) + len(POWERS)) and len(row["speedups"]) == 4 * len(POWERS)
    assert all(timing["seconds"] > 0 for timing in row["dictionaries"])
    for speedup in row["speedups"]:
        seconds = {t["solver"]: t["seconds"] for t in row["dictionaries"] if t["keep"] == speedup["keep"]}
        assert speedup["against_fastest"] == min(seconds[s.name] for s in EXACT) / seconds[speedup["solver"]]
        assert speedup["nmsve_above_exact_db"] > -0.1
    assert set(row["files"]) == {f"{who} {what}" for who in ("ours", "draco") for what in ("encode", "decode")}
    json.dumps(result, allow_nan=False)
    assert "patch, 900 vertices" in bench_tables(result)
