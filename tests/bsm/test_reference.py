"""The pages of `import bsm`: each public name has one that can be read alone, and its example runs."""

import dataclasses
import doctest
import importlib
import inspect
import pickle
import re

import numpy as np
import pytest

import bsm
from bsm.cli import main
from tests.bsm.test_libraries import painted
from tests.shapes import knot
from tools.docs_pages import MODULES, reference
from tools.noise import gaussian_along_normals

NAMES = [
    name
    for name in bsm.__all__
    if inspect.isfunction(getattr(bsm, name)) or inspect.isclass(getattr(bsm, name))
]
VALUES = {"__version__", "END_OF_STREAM", "NEED_DATA", "PRESETS"}
"""What is neither: the pages of `Signal` and of `EncodeOptions` tell of them."""
NEEDS = {
    "bsm.trimesh": "trimesh",
    "bsm.pyvista": "pyvista",
    "bsm.vtk": "vtkmodules",
    "bsm.openmesh": "openmesh",
}
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def test_every_name_has_a_page():
    pages = reference()
    assert {f"bsm.{name}" for name in NAMES} | set(MODULES) == set(pages)
    assert {*NAMES, *VALUES} == set(bsm.__all__)
    for name, page in pages.items():
        assert f"::: {name}" in page


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The files that examples speak of."""
    folder = tmp_path_factory.mktemp("examples")
    mesh = knot(1200)
    bsm.save(painted(mesh), folder / "spot.obj")
    for name in ("bunny.ply", "a.ply", "b.obj"):
        bsm.save(mesh, folder / name)
    assert main(["tile", str(folder / "bunny.ply"), "-o", str(folder / "scan"), "--finest"]) == 0
    noisy = gaussian_along_normals(mesh.positions, mesh.faces, 0.2, 0)
    bsm.save(bsm.TriangleMesh(noisy, mesh.faces), folder / "scan.ply")
    (folder / "bunny.bsm").write_bytes(bsm.encode(mesh))
    (folder / "spot.bsm").write_bytes(bsm.encode(painted(mesh)))
    frames = np.array([mesh.positions * (1 + 0.1 * np.sin(t)) for t in range(6)])
    (folder / "dance.bsm").write_bytes(bsm.encode_sequence(frames, mesh.faces, step=0.01))
    return folder


def examined(found):
    """The docstring of a name, and the sections that it has."""
    text = inspect.getdoc(found) or ""
    return text, set(re.findall(r"^([A-Z]\w+)\n-{3,}$", text, re.MULTILINE))


def described(text):
    """Names of parameters and attributes that a docstring describes, or only lists."""
    heads = re.findall(r"^(\*{0,2}\w+(?:, \*{0,2}\w+)*)(?: :.*)?$", text, re.MULTILINE)
    return {name.strip("* ") for head in heads for name in head.split(",")}


def check_alone(found):
    """What a page needs: parameters, what comes back, what is raised, and an example."""
    text, sections = examined(found)
    assert text and "Examples" in sections and ">>>" in text
    taken = [name for name in _signature(found) if not name.startswith("_")]
    assert {*taken} <= described(text)
    if inspect.isfunction(found):
        assert "Raises" in sections
        assert ("Returns" in sections) == (
            inspect.signature(found).return_annotation not in ("None", None)
        )


def _signature(found):
    if dataclasses.is_dataclass(found):
        inherited = {
            name.name
            for base in found.__bases__
            if dataclasses.is_dataclass(base)
            for name in _own(base)
        }
        return [name.name for name in _own(found) if name.name not in inherited]
    if inspect.isclass(found) and "__init__" not in vars(found):
        return []
    return [name for name in inspect.signature(found).parameters if name != "self"]


def _own(kind):
    return [field for field in dataclasses.fields(kind) if field.init]


def run(found, folder, monkeypatch):
    """Run the examples of a docstring there."""
    monkeypatch.chdir(folder)
    tests = doctest.DocTestFinder(recurse=False).find(
        found, getattr(found, "__name__", "bsm"), globs={}
    )
    assert sum(len(test.examples) for test in tests) > 0
    assert [doctest.DocTestRunner(optionflags=FLAGS).run(test).failed for test in tests] == [0]


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_a_page_can_be_read_alone(name, folder, monkeypatch):
    if name == "show":
        pytest.importorskip("anywidget")
    check_alone(getattr(bsm, name))
    run(getattr(bsm, name), folder, monkeypatch)


@pytest.mark.parametrize("module", ["bsm", *MODULES])
def test_modules_can_be_read_alone(module, folder, monkeypatch):
    pytest.importorskip(NEEDS.get(module, "numpy"))
    room = importlib.import_module(module)
    assert all(inspect.getdoc(getattr(room, name)) for name in room.__all__)
    run(room, folder, monkeypatch)


@pytest.mark.parametrize("name", [name for name in NAMES if inspect.isclass(getattr(bsm, name))])
def test_types_are_called_as_they_are_imported(name):
    kind = getattr(bsm, name)
    assert kind.__module__ == "bsm" and pickle.loads(pickle.dumps(kind)) is kind
