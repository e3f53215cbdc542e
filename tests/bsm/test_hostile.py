"""Files on which real tools choke: each loads or is refused with a typed error, quickly and in little memory."""

import json
import os
import resource
from pathlib import Path

import pytest

from bsm.bitstream import errors
from tests.bsm.program import python

SECONDS = 10
BYTES = 1 << 30
PROGRAM = f"""
import json, os, signal, sys
from bsm.bitstream.errors import BsmError
from bsm.codec.geometry.mesh import NoFacesError
from bsm.files.mesh import read_mesh
for path in sys.argv[1:]:
    child = os.fork()
    if child == 0:
        signal.alarm({SECONDS})
        try:
            mesh = read_mesh(path).mesh
            result = len(mesh.positions), len(mesh.faces)
        except BsmError as error:
            result = "MeshError" if isinstance(error, NoFacesError) else type(error).__name__
        print(json.dumps([path, result]), flush=True)
        os._exit(0)
    status = os.waitpid(child, 0)[1]
    if status:
        print(json.dumps([path, f"died with status {{status}}"]), flush=True)
"""
# Vertices and faces as each file's own text or header has them, polygons cut into triangles.
EXPECTED = {
    "c3d_beetle_nonmanifold.obj": [1148, 2053],
    "igl_truck.obj": [2956, 4770],
    "cgal_tet-shuffled.off": [4, 4],
    "trimesh_cycloidal.ply": [21384, 43368],
    "made_duplicate_faces.obj": [4, 4],
    "made_offset_1e7.obj": [4, 2],
    "trimesh_quadknot.obj": [1440, 2880],
    "trimesh_joined_tetrahedra.obj": [5, 8],
    "trimesh_two_objects.obj": [12, 16],
    "trimesh_comments.off": [8, 12],
    "draco_extra_vertex.obj": [10, 3],
    "draco_Box.ply": [24, 12],
    "pmp_icosahedron_binary.stl": [12, 20],
    "trimesh_multibody.stl": [20, 32],
    "made_negative_index.off": "MeshError",
    "made_index_out_of_range.ply": "MeshError",
    "made_truncated.ply": "TruncatedError",
    "made_huge_count.ply": "LimitError",
    "draco_inf_nan.obj": "MeshError",
    "draco_int_point_cloud.ply": "MeshError",
    "trimesh_empty.stl": "MeshError",
}


def bound_memory():
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))


def read_all(paths):
    """Read each file in a process of its own, of limited time and memory: what came of it, by name."""
    single = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    done = python("-c", PROGRAM, *paths, timeout=20 * SECONDS, preexec_fn=bound_memory, env=single)
    assert done.returncode == 0, done.stderr
    return {Path(path).name: result for path, result in map(json.loads, done.stdout.splitlines())}


def test_the_helper_notices_a_file_that_kills_the_process(tmp_path):
    pipe = tmp_path / "never_written.obj"
    os.mkfifo(pipe)
    program = PROGRAM.replace(f"alarm({SECONDS})", "alarm(1)")
    assert b"died" in python("-c", program, pipe).stdout


@pytest.mark.real
def test_every_hostile_file_loads_or_is_refused(meshes):
    paths = sorted((meshes / "hostile").iterdir())
    results = read_all(paths)
    assert set(results) == {path.name for path in paths}
    refused = {name: result for name, result in results.items() if isinstance(result, str)}
    unknown = {name: result for name, result in refused.items() if not hasattr(errors, result)}
    assert unknown == {}
    assert {name: results[name] for name in EXPECTED} == EXPECTED
    assert len(refused) < 20, f"most of these files hold meshes: {refused}"
