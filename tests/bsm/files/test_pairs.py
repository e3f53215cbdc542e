"""From each format to each other one, what a mesh means stays, or is named: place, colors, opacity, materials."""

import importlib.util
import itertools

import numpy as np
import pytest

from bsm import Attribute, TriangleMesh, read_mesh, save
from bsm.files.conventions import placement, shares_of, to_linear
from bsm.files.formats.appearance import appearance
from bsm.files.formats.metadata import materials_in
from bsm.files.table import WRITTEN_FORMATS

FACES = np.array([[0, 1, 2], [2, 1, 3], [2, 3, 4]])
COLORS = np.array(
    [[255, 0, 0, 255], [0, 128, 0, 200], [0, 0, 64, 255], [9, 9, 9, 10], [200, 100, 50, 128]],
    np.uint8,
)
MESH = TriangleMesh(
    np.array([[0, 0, 0], [10, 0, 0], [0, 20, 30], [10, 20, 40], [5, 40, 80.0]]),
    FACES,
    (
        Attribute("color", COLORS, semantic="color"),
        Attribute(
            "texcoord",
            np.array([[0, 0], [1, 0], [0, 1], [1, 1], [0.25, 0.75]]),
            semantic="texcoord",
        ),
        Attribute("material", np.array([[0], [1], [1]], np.int32), "face"),
    ),
    {
        **{"unit": "mm", "up": "z", "material.0.name": "Red", "material.0.Kd": "1 0 0"},
        **{"material.1.name": "Glass", "material.1.Kd": "0 0.501961 1", "material.1.d": "0.298039"},
    },
)
# Words by which writers name what they leave out, for each part of what a mesh means.
WORDS = {
    "place": {"unit", "up"},
    "colors": {"color"},
    "opacity": {"color", "alpha of color"},
    "texcoord": {"texcoord"},
    "material": {"material"},
}
NEEDED = {"3mf": "lib3mf"}
FORMATS = [kind for kind in WRITTEN_FORMATS if importlib.util.find_spec(NEEDED.get(kind, "bsm"))]


def meaning(mesh):
    """Return corners in meters with y up, and attributes, in an order that no format changes."""
    corners = (mesh.positions @ placement(mesh.metadata, "glb").matrix.T)[mesh.faces]
    turn = (np.argmin(corners @ [1, 100, 1e4], axis=1)[:, None] + np.arange(3)) % 3
    order = np.argsort(corners.mean(axis=1)[:, 1])

    def sorted_(values):
        return np.take_along_axis(values, turn[..., None], 1)[order]

    found, of = (
        {"place": sorted_(corners)},
        {attribute.semantic: attribute for attribute in mesh.attributes},
    )
    of_faces = next(
        (attribute for attribute in mesh.attributes if attribute.name == "material"), None
    )
    for name in of.keys() & {"color", "texcoord"}:
        rows = mesh.faces if of[name].domain == "vertex" else np.arange(mesh.faces.size)
        rows = rows if of[name].indices is None else of[name].indices
        found[name] = sorted_(
            of[name].values[np.reshape(rows, (-1, 3))].astype(of[name].values.dtype)
        )
    if "color" in found:
        linear = to_linear(shares_of(found.pop("color")))
        found["colors"], found["opacity"] = linear[..., :3], linear[..., 3:]
        if linear.shape[-1] == 3:
            del found["opacity"]
    if of_faces is not None and (materials := materials_in(mesh.metadata)):
        numbers = of_faces.values.ravel()[order].tolist()
        found["material"] = np.array(
            [[*(look := appearance(materials[n])).color, look.opacity] for n in numbers]
        )
    return found


@pytest.mark.parametrize(("first", "second"), [*itertools.product(FORMATS, repeat=2)])
def test_what_a_mesh_means_stays_or_is_named(first, second, tmp_path):
    lost, mesh = set(), MESH
    for kind in (first, second):
        lost |= set(save(mesh, tmp_path / f"a.{kind}"))
        mesh = read_mesh(tmp_path / f"a.{kind}").mesh
    found = meaning(mesh)
    for name, expected in meaning(MESH).items():
        if not lost & WORDS[name]:
            np.testing.assert_allclose(found[name], expected, rtol=0, atol=1e-6, err_msg=name)
