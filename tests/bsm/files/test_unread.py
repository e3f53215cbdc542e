"""Each name of a schema is taken or named: the files in `every` have all of them, and without one another mesh comes
out of them, or other notes. What neither has is in silent.json: it is for programs, says the same again, or is named by
what refers to it."""

import copy
import fnmatch
import io
import json
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

from bsm import BsmError, read_mesh
from bsm.files import unread

EVERY = Path(__file__).parent / "every"
pytestmark = pytest.mark.slow


def read(source, kind):
    """Everything that a file is read as, or the error, and the names that nothing takes."""
    try:
        found = read_mesh(source, kind)
    except BsmError as error:
        return str(error), set()
    tables = [(a.name, a.domain, a.values.tolist(), repr(a.indices)) for a in found.mesh.attributes]
    mesh = (
        found.mesh.positions.tolist(),
        found.mesh.faces.tolist(),
        tables,
        dict(found.mesh.metadata),
    )
    return (mesh, found.notes), {*found.dropped}


def require_each(kind, whole, variants, monkeypatch):
    """A file without one of its names gives another mesh or other notes, except for the names in `silent.json`."""
    monkeypatch.setattr(unread, "_MOST_NAMED", 1 << 16)
    (held, left), told, every = read(whole, kind), set(), set()
    for name, source in variants(left):
        every.add(name)
        told |= {name} if name not in told and read(source, kind)[0] != held else set()
    patterns = json.loads((EVERY / "silent.json").read_text())[kind]
    known = {pattern: {*fnmatch.filter(every - told, pattern)} for pattern in patterns}
    assert (
        not isinstance(held, str)
        and every - told == set().union(*known.values())
        and all(known.values())
    )


def objects(tree, left, owner=""):
    """The objects of a tree that are not below one that is left out, each with the name under which it stands."""
    if isinstance(tree, dict):
        yield owner, tree
    for name, value in (
        tree.items() if isinstance(tree, dict) else [(owner, value) for value in tree]
    ):
        if isinstance(value, dict | list) and not {name, f"{name} of {owner}"} & left:
            yield from objects(value, left, name)


def test_each_name_of_a_gltf_is_taken_or_named(monkeypatch):
    whole = (EVERY / "every.gltf").read_bytes()

    def variants(left):
        left, tree = {*left, "animations"}, json.loads(whole)
        for place, (owner, node) in enumerate(objects(tree, left)):
            for name in node:
                less = copy.deepcopy(tree)
                del [*objects(less, left)][place][1][name]
                yield f"{owner}.{name}".removeprefix("."), json.dumps(less).encode()

    require_each("gltf", whole, variants, monkeypatch)


def documents(text, left):
    """A document of XML without each attribute and each element that is not below one that is left out."""
    waiting = [root := ElementTree.fromstring(text)]
    while waiting:
        above = waiting.pop()
        owner = above.tag.rpartition("}")[2]
        for name, value in [*above.items()]:
            del above.attrib[name]
            yield f"{owner}.{name.rpartition('}')[2]}", ElementTree.tostring(root)
            above.set(name, value)
        for place, one in enumerate([*above]):
            del above[place]
            yield f"{owner}.{(name := one.tag.rpartition('}')[2])}", ElementTree.tostring(root)
            above.insert(place, one)
            waiting += [] if f"{name} of {owner}" in left else [one]


@pytest.mark.parametrize(("kind", "library"), [("dae", "collada"), ("3mf", "lib3mf")])
def test_each_name_of_a_document_is_taken_or_named(kind, library, tmp_path, monkeypatch):
    pytest.importorskip(library)
    path, archive = EVERY / f"every.{kind}", zipfile.ZipFile(EVERY / "every.3mf")
    (tmp_path / "a.image").write_bytes((EVERY / "a.image").read_bytes())

    def packed(text):
        with zipfile.ZipFile(written := io.BytesIO(), "w") as other:
            for name in archive.namelist():
                other.writestr(name, text if name.endswith(".model") else archive.read(name))
        return written.getvalue()

    def variants(left):
        for name, text in documents(
            path.read_bytes() if kind == "dae" else archive.read("3D/3dmodel.model"), left
        ):
            (tmp_path / "a").write_bytes(text if kind == "dae" else packed(text))
            yield name, tmp_path / "a"

    require_each(kind, path, variants, monkeypatch)


def test_each_name_of_a_stage_is_taken_or_named(tmp_path, monkeypatch):
    sdf = pytest.importorskip("pxr.Sdf")
    (tmp_path / "a.image").write_bytes((EVERY / "a.image").read_bytes())
    layer, path = sdf.Layer.FindOrOpen(str(EVERY / "every.usda")), tmp_path / "a.usda"

    def variants(_):
        layer.Traverse("/", (found := []).append)
        for at in filter(lambda at: at.IsPropertyPath(), found):
            less = sdf.Layer.CreateAnonymous()
            less.TransferContent(layer)
            prim = less.GetPrimAtPath(at.GetPrimPath())
            prim.RemoveProperty(prim.properties[at.name])
            less.Export(str(path))
            yield f"{prim.typeName}.{at.name}", path

    require_each("usda", EVERY / "every.usda", variants, monkeypatch)
