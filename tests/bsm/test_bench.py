import json

import numpy as np
import pytest

from bsm.codec.basis.laplacian import dense_laplacian
from bsm.codec.basis.orthogonal_iteration import cosine_columns
from bsm.codec.blocks.overlap import derive_partition, grow_blocks
from bsm.codec.geometry.graph import graph_of_faces
from bsm.evaluation.bench import EXACT, POWERS, SHIFT, bench_tables, iterated, run_bench
from bsm.files.mesh import written_mesh
from tests.shapes import patch


@pytest.fixture(scope="module")
def block():
    graph = graph_of_faces(patch(14, 14).faces, 196)
    return grow_blocks(graph, derive_partition(graph, 1), 196).block(0)


@pytest.mark.parametrize("solver", EXACT, ids=lambda solver: solver.name)
def test_exact_solvers_span_the_lowest_eigenspace(solver, block):
    """By Ky Fan: among orthonormal columns, they have the least trace."""
    laplacian = dense_laplacian(block)
    basis = solver.solve(laplacian, 12)
    assert np.allclose(basis.T @ basis, np.eye(12), atol=1e-6)
    least = np.linalg.eigvalsh(laplacian)[:12].sum()
    assert np.einsum("ij,ij->", basis, laplacian @ basis) == pytest.approx(least, rel=1e-8)


@pytest.mark.parametrize("power", POWERS)
def test_iterations_are_those_of_dense_solvers(power, block):
    found = iterated(block, 12, power)
    columns = cosine_columns(block.size, 12)
    for _ in range(power):
        # Orthonormalized every time: the same subspaces in exact arithmetic, and no loss of precision.
        columns = np.linalg.qr(np.linalg.solve(dense_laplacian(block) + SHIFT * np.eye(block.size), columns))[0]
    aligned = columns * np.where(np.einsum("ij,ij->j", columns, found) < 0, -1.0, 1.0)
    assert np.abs(aligned - found).max() < 1e-6


def test_a_bench_of_a_small_mesh_is_complete_and_fit_for_json(tmp_path):
    pytest.importorskip("DracoPy")
    path = tmp_path / "patch.ply"
    path.write_bytes(written_mesh(patch(30, 30), "ply").data)
    result = run_bench([str(path)], sample=1, repeats=1, note=print)
    (row,) = result["meshes"]
    exact, ours = ([timing for timing in row["dictionaries"] if timing["exact"] is kind] for kind in (True, False))
    assert len(exact) == 4 * len(EXACT) and len(ours) == 4 * len(POWERS)
    for found in ours:
        rivals = [timing for timing in exact if timing["keep"] == found["keep"]]
        assert found["against_fastest"] == min(timing["seconds"] for timing in rivals) / found["seconds"]
        assert found["nmsve_db"] > rivals[0]["nmsve_db"] - 0.1
    assert set(row["files"]) == {f"{who} {what}" for who in ("ours", "draco") for what in ("encode", "decode")}
    json.dumps(result, allow_nan=False)
    assert "patch, 900 vertices" in bench_tables(result)
