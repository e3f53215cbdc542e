"""Presets do not outdo each other: none writes more than another one whose stream keeps its promise as well."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import look
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import PRESETS
from bsm.files.mesh import read_mesh
from tests.shapes import patch, torus

PROMISING = {name: options.promise for name, options in PRESETS.items() if options.promise is not None}
MODELS = ("assets/1002_tray_bottom.STL", "assets/stirrer.obj", "assets/monkey.glb", "static/c3d_spot.ply")
LONG = ("assets/robot_forearm.obj", "assets/robot_hand.obj", "static/fandisk_6475.ply", "static/block.ply")


def outdone(mesh: TriangleMesh) -> list[tuple[str, str, int, int]]:
    """Presets, others that keep their promises in fewer bytes, and the bytes of both."""
    drafts, index = {}, {}
    for name in PROMISING:
        encoder = Encoder(mesh, replace(PRESETS[name], threads=1))
        drafts[name] = encoder.draft()
        index[name] = encoder.vertex_index
    found = []
    for name, contract in PROMISING.items():
        for other, draft in drafts.items():
            if draft.size >= drafts[name].size:
                continue
            used = (index[other] >= 0)[:, None]
            decoded = np.where(used, draft.decoded[index[other]], mesh.positions)
            moved = np.linalg.norm(decoded - mesh.positions, axis=1).max() / mesh.diagonal
            # Parts are bound more tightly than all, down to a tenth.
            near = moved <= contract.farthest * (0.1 if contract.by_part < math.inf else 1.0)
            if near and look(mesh, replace(mesh, positions=decoded)).distance <= contract.look:
                found.append((name, other, drafts[name].size, draft.size))
    return found


@pytest.mark.parametrize("mesh", [torus(40, 24), patch(20, 20)], ids=["torus", "patch"])
def test_no_preset_is_outdone(mesh: TriangleMesh) -> None:
    assert not outdone(mesh)


@pytest.mark.real
@pytest.mark.parametrize("name", [*MODELS, *(pytest.param(name, marks=pytest.mark.long) for name in LONG)])
def test_no_preset_is_outdone_on_real_meshes(name: str, meshes: Path) -> None:
    assert not outdone(read_mesh(str(meshes / name)).mesh.bare)
