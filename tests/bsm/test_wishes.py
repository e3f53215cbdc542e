"""A wish means the same at each door: its stream is that of Python, byte by byte, or the wish is refused."""

import json
import struct
import sys
from contextlib import nullcontext
from types import SimpleNamespace as Some

import numpy as np
import pytest

import bsm
from bsm import open_tiles, read_mesh
from bsm.cli import main
from bsm.viewer.contents import made
from tests.motion import sequence_in
from tests.shapes import torus

MESH = torus(16, 12)
TEXTURE = bsm.Attribute(
    "texcoord", np.random.default_rng(1).random((16 * 12, 2), np.float32), "vertex", "texcoord"
)
LOOSE = {"look": 50}  # so that the bound on vertices counts
WISHES = {
    "nothing": {},
    "unit": {**LOOSE, "max_error": "20um"},
    "another unit": {**LOOSE, "max_error": "1mil"},
    "percent": {**LOOSE, "max_error": "0.05%"},
    "bare number": {**LOOSE, "max_error": 0.0005},
    "meta": {"metadata": {"unit": "m", "name": "ring"}, **LOOSE, "max_error": "2cm"},
    "angle": {"theta": 4.0},
    "size": {"size": "2kB"},
    "preset": {"preset": "fine"},
    "quality": {"attributes": {"texcoord": "12bits"}},
    "order": {"keep_order": True},
    "provenance": {"provenance": True, "max_error": "0.02mm"},
    "doubtful": {"max_error": 0.05},
    "unknown unit": {"max_error": "2parsec"},
    "unknown unit of the mesh": {"metadata": {"unit": "milimeter"}},
    "no such option": {"qualty": 3},
}
REFUSED = ("doubtful", "unknown unit", "unknown unit of the mesh", "no such option")


def words(wish):
    """A wish as on the command line."""
    for name, value in wish.items():
        option = f"--{name.replace('_', '-')}"
        if name == "metadata":
            yield from (word for entry in value.items() for word in ("--meta", "=".join(entry)))
        elif name == "attributes":
            yield from (
                word for entry in value.items() for word in ("--attribute", "=".join(entry))
            )
        else:
            yield from (option,) if value is True else (option, str(value))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A mesh with a texture, the same without, and four frames; all in millimeters."""
    path = tmp_path_factory.mktemp("wishes")
    from PIL import Image

    Image.new("RGB", (512, 256)).save(path / "skin.png")
    entries = {
        "unit": "mm",
        "image.0.name": "skin.png",
        "image.0.data": (path / "skin.png").read_bytes(),
    }
    bsm.save(bsm.TriangleMesh(MESH.positions, MESH.faces, (TEXTURE,), entries), path / "ring.ply")
    bsm.save(bsm.TriangleMesh(MESH.positions, MESH.faces, (), {"unit": "mm"}), path / "bare.ply")
    bsm.save(bsm.TriangleMesh(MESH.positions, MESH.faces), path / "plain.glb")
    (path / "again.ply").write_bytes((path / "ring.ply").read_bytes())
    (path / "frames").mkdir()
    for number in range(4):
        moved = MESH.positions * (1.0, 1.0, 1.0 + 0.1 * number)
        bsm.save(
            bsm.TriangleMesh(moved, MESH.faces, (TEXTURE,), {"unit": "mm"}),
            path / "frames" / f"{number}.ply",
        )
    return path


def run(*given):
    """Do a command; an error is one that users see."""
    try:
        code = main([*map(str, given)])
    except SystemExit as error:
        code = error.code
    if code:
        raise bsm.OptionError(f"exit code {code}")


def frames_of(folder):
    return sorted((folder / "frames").iterdir())


def by_mesh(folder, wish):
    return bsm.encode(folder / "ring.ply", **wish)


def by_frames(folder, wish):
    return bsm.encode_frames(frames_of(folder), runs=False, **wish)


def by_sequence(folder, wish):
    positions = np.array([bsm.load(path).positions for path in frames_of(folder)])
    first, entries = bsm.load(frames_of(folder)[0]), {"unit": "mm", **wish.get("metadata", {})}
    more = {"metadata": entries, "mesh_attributes": first.attributes}
    return bsm.encode_sequence(positions, first.faces, **{**wish, **more})


def by_command(folder, wish):
    run("encode", folder / "ring.ply", "-o", folder / "command.bsm", "-f", *words(wish))
    return (folder / "command.bsm").read_bytes()


def by_command_of_frames(folder, wish):
    run("encode", folder / "frames", "-o", folder / "moving.bsm", "-f", *words(wish))
    return (folder / "moving.bsm").read_bytes()


def by_batch(folder, wish):
    run(
        "encode",
        folder / "again.ply",
        folder / "ring.ply",
        "-o",
        f"{folder}/many/",
        "-f",
        *words(wish),
    )
    return (folder / "many" / "ring.bsm").read_bytes()


def by_many(folder, wish):
    done = bsm.encode_many([folder / "ring.ply"], folder / "again", overwrite=True, **wish)
    if "error" in done[0]:
        raise bsm.OptionError(done[0]["error"])
    return (folder / "again" / "ring.bsm").read_bytes()


def by_view(folder, wish):
    if set(wish) - {"preset"}:
        run("view", folder / "ring.ply", "--save", folder / "page.html", *words(wish))
    source = read_mesh(folder / "ring.ply")
    content = made("ring.ply", 0, source, wish.get("preset", "balanced"), lambda stage, share: None)
    return content.layers[content.main].stream


def by_view_of_frames(folder, wish):
    if set(wish) - {"preset"}:
        run("view", folder / "frames", "--save", folder / "page.html", *words(wish))
    source = sequence_in(folder / "frames")
    content = made("frames", 0, source, wish.get("preset", "balanced"), lambda stage, share: None)
    return content.layers[content.main].stream


MESHES = {
    "mesh": by_mesh,
    "command": by_command,
    "batch": by_batch,
    "many": by_many,
    "view": by_view,
}
MOVING = {
    "frames": by_frames,
    "sequence": by_sequence,
    "command": by_command_of_frames,
    "view": by_view_of_frames,
}


def outcome(door, folder, wish):
    try:
        return door(folder, wish)
    except (bsm.BsmError, TypeError) as error:
        return type(error)


@pytest.mark.parametrize("wish", WISHES)
def test_doors_of_meshes_and_of_frames_do_the_same(wish, folder, capsys):
    differ = []
    for doors, whole in ((MESHES, by_mesh), (MOVING, by_frames)):
        usual = outcome(whole, folder, WISHES[wish])
        assert isinstance(usual, bytes) != (wish in REFUSED or (doors is MOVING and wish == "size"))
        for name, door in doors.items():
            found = outcome(door, folder, WISHES[wish])
            same = found == usual if isinstance(usual, bytes) else not isinstance(found, bytes)
            refused = (
                name == "view" and set(WISHES[wish]) - {"preset"} and not isinstance(found, bytes)
            )
            differ += [] if same or refused else [name]
    assert not differ


def stream_in(glb):
    """The stream of the only primitive of a scene."""
    size = struct.unpack_from("<I", glb, 12)[0]
    tree = json.loads(glb[20 : 20 + size])
    (number,) = {
        view["extensions"]["EXT_bsm_compression"]["stream"]
        for view in tree["bufferViews"]
        if "extensions" in view
    }
    view = tree["bufferViews"][number]
    begin = 28 + size + view.get("byteOffset", 0)
    return glb[begin : begin + view["byteLength"]]


@pytest.mark.parametrize("wish", WISHES)
def test_scenes_and_tiles_do_the_same_or_refuse(wish, folder, capsys):
    """What a scene or tiles cannot be asked for is an error, never silence."""
    given = WISHES[wish]
    mesh, cell = bsm.load(folder / "plain.glb").positions, {"grid_cell": 0.01}
    faces = bsm.load(folder / "plain.glb").faces
    out = folder / "out.glb"
    if wish in ("nothing", "preset"):
        run("glb", folder / "plain.glb", "-o", out, "-f", *words(given))
        assert stream_in(out.read_bytes()) == bsm.encode(
            (mesh, faces), **{"preset": "grid14", **given}
        )
    elif wish != "quality":
        with pytest.raises(bsm.BsmError):
            run("glb", folder / "plain.glb", "-o", out, "-f", *words(given))
    tiles = folder / "tiles"
    with pytest.raises(bsm.BsmError) if given else nullcontext():
        run("tile", folder / "bare.ply", "-o", tiles, "-f", *words(cell | given))
    if not given:
        found = open_tiles(str(tiles))
        (data,) = [found.data(shard, tile) for shard, tile in found.all()]
        cells = {"grid_cell": found.lattice.cell, "grid_origin": tuple(found.lattice.origin)}
        assert bsm.encode(bsm.decode(data), **cells) == data


class _Column(list):
    """Numbers that Blender hands over."""

    def foreach_get(self, name, table):
        table[:] = np.asarray([getattr(row, name) for row in self]).ravel()


def blender(monkeypatch):
    """As much of Blender as handing over an object needs; the whole is tried where it is installed."""
    points = MESH.positions.astype(np.float32)
    triangles = [
        Some(vertices=face, loops=range(3), polygon_index=number)
        for number, face in enumerate(MESH.faces)
    ]
    data = Some(
        calc_loop_triangles=lambda: None,
        loop_triangles=_Column(triangles),
        attributes=[],
        polygons=_Column([Some(material_index=0)] * len(MESH.faces)),
        loops=range(3 * len(MESH.faces)),
        vertices=_Column([Some(co=point) for point in points]),
    )
    moving = Some(name="ring", material_slots=[], matrix_world=np.eye(4), to_mesh=lambda: data)
    moving.evaluated_get, moving.to_mesh_clear = lambda graph: moving, lambda: None
    units = Some(system="METRIC", scale_length=1.0)
    scene = Some(
        frame_start=1,
        frame_end=3,
        frame_current=1,
        unit_settings=units,
        render=Some(fps=24, fps_base=1.0),
    )
    scene.frame_set = lambda number: None
    context = Some(scene=scene, evaluated_depsgraph_get=lambda: None)
    monkeypatch.setitem(
        sys.modules, "bpy", Some(context=context, types=Some(Object=Some), data=Some(), path=Some())
    )
    monkeypatch.delitem(sys.modules, "plugins.blender.extension.objects", raising=False)
    return moving, points


@pytest.mark.parametrize(
    "wish", [name for name, wish in WISHES.items() if not {"metadata", "provenance"} & set(wish)]
)
def test_blender_does_the_same(wish, tmp_path, monkeypatch):
    moving, points = blender(monkeypatch)
    package = type(sys)("plugins.blender.extension")
    package.__path__ = ["plugins/blender/extension"]
    monkeypatch.setitem(sys.modules, "plugins.blender.extension", package)
    monkeypatch.chdir(bsm.__path__[0] + "../..")
    from plugins.blender.extension.objects import export_object

    entries, faces = {"name": "ring", "up": "z", "unit": "meters"}, MESH.faces
    frames = np.array([points] * 3, np.float64)

    def exported(folder, wish):
        export_object(str(tmp_path / "a.bsm"), moving, animation=folder, **wish)
        return (tmp_path / "a.bsm").read_bytes()

    def usual(folder, wish):
        if folder:
            return bsm.encode_sequence(
                frames, faces, metadata={**entries, "frame_rate": 24.0}, **wish
            )
        return bsm.encode((frames[0], faces), metadata=entries, **wish)

    for moves in (False, True):
        given = {name: value for name, value in WISHES[wish].items() if name != "attributes"}
        assert outcome(exported, moves, given) == outcome(usual, moves, given)
