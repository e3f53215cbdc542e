"""`python -m tools.attack uses`: files that say something once and use it many times.

Nodes, skins, primitives, targets and animations of glTF, items and components of 3MF, references and instancers of
USD, nodes and controllers of COLLADA, materials and images of OBJ, files of lists, streams and members of archives:
`MODELS` is a table of what formats let be used again. Half of each file is what is used, and half are
its uses, so that reading could take the product of both. What reading takes is held against the law (M 14.8, M 14.9).
"""

import base64
import copy
import importlib.util
import io
import json
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import chain

import numpy as np

from bsm import TriangleMesh, encode
from bsm.files.formats.npz import write_npy
from tests.gltf import Tree, glb, unpack
from tests.shapes import ply_head
from tools.attack.readers import DATA_URI, Sample, Scene, problems, strip_of, three_mf, warm_up
from tools.attack.taken import Case, report
from tools.command import parser_of
from tools.vectors.meshes import patch

Use = Callable[[int, int], Sample]
"""Make a file by the bytes of what is used, and how often that is."""
MOST = 1.25
"""How much more than is documented a file may take."""
SPLITS = (0.5, 0.9, 0.1)
"""Shares of a file that what is used takes."""


# ---------------------------------------------------------------------------------------------------------------- glTF


def _gltf(change: Callable[[Scene, int], None], moves: bool, size: int, uses: int) -> Sample:
    scene = Scene(size)
    change(scene, uses)
    if moves:
        scene.move()
    return scene.sample()


def _nodes(scene: Scene, uses: int) -> None:
    scene.nodes(*({"mesh": 0} for _ in range(uses)))


def _tree_of_nodes(scene: Scene, uses: int) -> None:
    """Each node is a child of the one before it, and has the mesh as well."""
    chain: list[Tree] = [{"mesh": 0, "children": [number + 1]} for number in range(min(uses, 400))]
    scene.tree |= {"nodes": [*chain, {"mesh": 0}], "scenes": [{"nodes": [0]}]}


def _meshes(scene: Scene, uses: int) -> None:
    scene.tree["meshes"] *= uses
    scene.nodes(*({"mesh": number} for number in range(uses)))


def _primitives(scene: Scene, uses: int) -> None:
    scene.tree["meshes"][0]["primitives"] = [scene.primitive for _ in range(uses)]


def _nodes_of_primitives(scene: Scene, uses: int) -> None:
    """As many nodes as primitives: work for each pair is the square."""
    _primitives(scene, max(1, uses // 2))
    scene.nodes(*({"mesh": 0} for _ in range(uses // 2 + 1)))


def _materials(scene: Scene, uses: int) -> None:
    scene.tree["materials"] = [{"name": str(number)} for number in range(uses)]
    scene.tree["meshes"][0]["primitives"] = [
        scene.primitive | {"material": number} for number in range(uses)
    ]


def _skin(scene: Scene) -> None:
    joints, weights = (
        np.zeros((scene.count, 4), "u1"),
        np.tile(np.array([1, 0, 0, 0], "<f4"), (scene.count, 1)),
    )
    scene.attributes |= {"JOINTS_0": scene.array(joints), "WEIGHTS_0": scene.array(weights)}


def _skins(scene: Scene, uses: int) -> None:
    """Each node plays the mesh by a skin of its own, with targets: one part for each."""
    _skin(scene)
    scene.primitive["targets"] = [{"POSITION": 0}] * uses
    scene.tree["skins"] = [{"joints": [0]} for _ in range(uses)]
    scene.nodes({}, *({"mesh": 0, "skin": number} for number in range(uses)))


def _targets(scene: Scene, uses: int) -> None:
    scene.primitive["targets"] = [{"POSITION": 0}] * uses
    scene.tree["meshes"][0]["weights"] = [0.5] * uses


def _attributes(scene: Scene, uses: int) -> None:
    scene.attributes |= {f"_A{number}": 0 for number in range(uses)}


def _joints(scene: Scene, uses: int) -> None:
    _skin(scene)
    scene.tree["skins"] = [{"joints": [0] * uses}]
    scene.nodes({}, *({"mesh": 0, "skin": 0} for _ in range(uses)))


def _animations(scene: Scene, uses: int) -> None:
    _nodes(scene, uses)
    scene.move()
    (animation,) = scene.tree["animations"]
    channels = [
        {"sampler": 0, "target": {"node": node, "path": "translation"}} for node in range(uses)
    ]
    scene.tree["animations"] = [{**animation, "channels": channels}] * 4


def _instancing(scene: Scene, uses: int) -> None:
    places = scene.array(np.zeros((uses, 3), "<f4"))
    instances = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places}}}
    scene.tree |= {"extensionsUsed": list(instances), "extensionsRequired": list(instances)}
    scene.nodes({"mesh": 0, "extensions": instances})


_GLTF = (
    *(
        _nodes,
        _tree_of_nodes,
        _meshes,
        _primitives,
        _nodes_of_primitives,
        _materials,
        _skins,
        _targets,
        _attributes,
    ),
    *(_joints, _instancing),
)
PIXEL = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)


def _images(size: int, uses: int) -> Sample:
    """One image, in as many images, textures and materials."""
    scene = Scene(1000)
    view = scene.view(PIXEL + bytes(size))
    scene.tree["images"] = [{"bufferView": view, "mimeType": "image/png"}] * uses
    scene.tree["textures"] = [{"source": number} for number in range(uses)]
    _materials(scene, uses)
    for number, material in enumerate(scene.tree["materials"]):
        material["pbrMetallicRoughness"] = {"baseColorTexture": {"index": number}}
    return scene.sample()


def _image_by_uri(size: int, uses: int) -> Sample:
    """One image in a buffer of text that all images, textures and materials use."""
    sample = _images(size, uses)
    tree, binary = unpack(sample.data)
    tree["buffers"][0]["uri"] = DATA_URI + base64.b64encode(binary).decode()
    return Sample("gltf", json.dumps(tree).encode())


# ------------------------------------------------------------------------------------------------------------- others


def _mesh_3mf(size: int) -> str:
    positions, faces = strip_of(size, 60)
    vertices = "".join(f'<vertex x="{x:.3g}" y="{y:.3g}" z="{z:.3g}"/>' for x, y, z in positions)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    return f'<object id="1"><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object>'


def _components(size: int, uses: int) -> Sample:
    """As many components of one object, and items of that."""
    root = max(1, int(uses**0.5))
    components = '<component objectid="1"/>' * root
    assembly = f'<object id="2"><components>{components}</components></object>'
    return Sample("3mf", three_mf(_mesh_3mf(size) + assembly, '<item objectid="2"/>' * root))


def _mesh_usd(size: int, name: str = "m", more: str = "") -> str:
    positions, faces = strip_of(size, 40)
    points = ", ".join(f"({x:.3g}, {y:.3g}, {z:.3g})" for x, y, z in positions)
    counts, indices = ", ".join(["3"] * len(faces)), ", ".join(map(str, faces.reshape(-1)))
    return (
        f'def Mesh "{name}" {{\nint[] faceVertexCounts = [{counts}]\nint[] faceVertexIndices = [{indices}]\n'
        f"point3f[] points = [{points}]\n{more}}}\n"
    )


def _usd(inside: str) -> Sample:
    return Sample("usda", ("#usda 1.0\n" + inside).encode())


def _references(instanceable: bool, size: int, uses: int) -> Sample:
    also = ", instanceable = true" if instanceable else ""
    text = f'def Xform "p" {{\n{_mesh_usd(size)}}}\n'
    return _usd(
        text
        + "".join(
            f'def "b{n}" (references = </p>{also.replace(", ", chr(10))}) {{}}\n'
            for n in range(uses)
        )
    )


def _instancer(size: int, uses: int) -> Sample:
    zeros, places = ", ".join(["0"] * uses), ", ".join(["(0, 0, 0)"] * uses)
    return _usd(
        f'def PointInstancer "i" {{\nint[] protoIndices = [{zeros}]\npoint3f[] positions = [{places}]\n'
        f"rel prototypes = </i/m>\n{_mesh_usd(size)}}}\n"
    )


def _moving_usd(size: int, uses: int) -> Sample:
    """A mesh below a transform that has many times: each is a frame."""
    times = "".join(f"{number}: ({number}, 0, 0),\n" for number in range(uses))
    samples = f"double3 xformOp:translate.timeSamples = {{\n{times}}}\n"
    moves = f'{samples}uniform token[] xformOpOrder = ["xformOp:translate"]\n'
    return _usd(f'def Xform "p" {{\n{moves}{_mesh_usd(size)}}}\n')


def _subsets(size: int, uses: int) -> Sample:
    subset = (
        'def GeomSubset "s{0}" {{\nuniform token elementType = "face"\nuniform token familyName = "materialBind"\n'
        'int[] indices = [0]\nrel material:binding = </m/a{0}>\n}}\ndef Material "a{0}" {{\n}}\n'
    )
    return _usd(_mesh_usd(size, more="".join(subset.format(n) for n in range(uses))))


def _dae(controllers: bool, size: int, uses: int) -> Sample:
    positions, faces = strip_of(size, 40)
    count = 3 * len(positions)
    numbers = " ".join(f"{x:.3g}" for x in positions.reshape(-1))
    source = (
        f'<source id="s"><float_array id="a" count="{count}">{numbers}</float_array><technique_common><accessor '
        f'source="#a" count="{len(positions)}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>'
        '<param name="Z" type="float"/></accessor></technique_common></source>'
    )
    geometry = (
        f'<library_geometries><geometry id="g"><mesh>{source}<vertices id="v"><input semantic="POSITION" source="#s"/>'
        f'</vertices><triangles count="{len(faces)}"><input semantic="VERTEX" source="#v" offset="0"/>'
        f"<p>{' '.join(map(str, faces.reshape(-1)))}</p></triangles></mesh></geometry></library_geometries>"
    )
    # A chain of libraries: each node has the one before it twice.
    if controllers:
        doubled = "".join(
            f'<node id="n{n}"><instance_node url="#n{n - 1}"/><instance_node url="#n{n - 1}"/></node>'
            for n in range(1, min(uses, 24))
        )
        nodes = '<node id="n0"><instance_geometry url="#g"/></node>' + doubled
        library, last = f"<library_nodes>{nodes}</library_nodes>", min(uses, 24) - 1
        scene = f'<node><instance_node url="#n{last}"/></node>'
    else:
        library, scene = "", '<node><instance_geometry url="#g"/></node>' * uses
    text = (
        '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>'
        f'<up_axis>Y_UP</up_axis></asset>{geometry}{library}<library_visual_scenes><visual_scene id="w">{scene}'
        '</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>'
    )
    return Sample("dae", text.encode())


def _obj_materials(size: int, uses: int) -> Sample:
    """As many materials that have one image, and groups that use them."""
    library = "".join(f"newmtl m{n}\nmap_Kd i.png\nmap_Ks i.png\n" for n in range(uses)).encode()
    lines = "".join(f"g a{n}\no b{n}\nusemtl m{n}\nf 1 2 3\n" for n in range(uses)).encode()
    beside = (("l.mtl", library), ("i.png", PIXEL + bytes(size)))
    return Sample("obj", b"mtllib l.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n" + lines, beside)


def _obj_libraries(size: int, uses: int) -> Sample:
    library = b"newmtl m\n" + b"Kd 1 1 1\n" * (size // 9)
    return Sample(
        "obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + b"mtllib l.mtl\n" * uses + b"f 1 2 3\n",
        (("l.mtl", library),),
    )


def _obj_polygons(size: int, uses: int) -> Sample:
    """Faces of many corners, all of the same few vertices."""
    face = b"f" + b" 1 2 3" * max(1, size // max(6 * uses, 6)) + b"\n"
    return Sample("obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + face * uses)


def _ply_images(size: int, uses: int) -> Sample:
    """One image that many lines name."""
    head = ply_head(more="comment TextureFile i.png\n" * min(uses, 2500))
    body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    return Sample("ply", (head + body).encode(), (("i.png", PIXEL + bytes(size)),))


@dataclass(frozen=True)
class Model:
    """What a format lets be used many times: the text around it, what is used, and one use, in which {0} counts.

    `unit` is repeated to fill the bytes of what is used; between uses stands `between`."""

    suffix: str
    head: str
    unit: str
    middle: str
    use: str
    tail: str
    between: str = ""
    beside: str = ""

    def made(self, size: int, uses: int) -> Sample:
        filled = self.unit * max(1, size // max(len(self.unit), 1))
        uses_text = self.between.join(
            self.use.replace("{0}", str(number)) for number in range(uses)
        )
        beside = (("b.obj", (TRIANGLE + filled).encode()),) if self.beside else ()
        used = "" if self.beside else filled
        return Sample(
            self.suffix, (self.head + used + self.middle + uses_text + self.tail).encode(), beside
        )


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
_COLLADA = '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>'
_USES = '<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"/></node></visual_scene>'
_USES += '</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>'
_SOURCE = '<source id="s"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor '
_SOURCE += (
    'source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>'
)
_SOURCE += '<param name="Z" type="float"/></accessor></technique_common></source>'
_SOURCE += '<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>'
_GEOMETRY = f'<library_geometries><geometry id="g"><mesh>{_SOURCE}'
_INPUT = '<input semantic="VERTEX" source="#v" offset="0"/>'
_CORNERS = f'count="1">{_INPUT}<p>0 1 2</p>'
_PRIM = "int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n"
_PRIM += "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n"
MODELS = {
    "pvd, one file": Model("pvd", '<VTKFile type="Collection"><Collection>', "v 0 0 0\n", "",
        '<DataSet timestep="{0}" part="0" file="b.obj"/>', "</Collection></VTKFile>", beside="b.obj"),
    "series, one file": Model("series", '{"file-series-version": "1.0", "files": [', "v 0 0 0\n", "",
        '{"name": "b.obj", "time": {0}}', "]}", ",", beside="b.obj"),
    "obj, corners of one vertex": Model("obj", TRIANGLE, "vt 0 0\n", "", "f 1/1 2/1 3/1\n", ""),
    "obj, materials of one name": Model("obj", TRIANGLE, "vn 0 0 1\n", "", "usemtl a\nf 1//1 2//1 3//1\n", ""),
    "off, one vertex": Model("off", "OFF\n3 1\n0 0 0\n1 0 0\n0 1 0\n", "# a\n", "3 0 1 2", " 0", "\n"),
    "dae, elements of one source": Model("dae", _COLLADA, "<!-- a -->", _GEOMETRY, f"<triangles {_CORNERS}</triangles>",
        f"</mesh></geometry></library_geometries>{_USES}"),
    "dae, inputs of one source": Model("dae", _COLLADA, "<!-- a -->", f'{_GEOMETRY}<triangles count="1">{_INPUT}',
        '<input semantic="NORMAL" source="#s" offset="0" set="{0}"/>',
        f"<p>0 1 2</p></triangles></mesh></geometry></library_geometries>{_USES}"),
    "usd, inherits": Model("usda", f'#usda 1.0\nclass "c" {{\ndef Mesh "m" {{\n{_PRIM}', "# a\n", "}\n}\n",
        'def "p{0}" (inherits = </c>) {}\n', ""),
    "usd, primvars of one array": Model("usda", f'#usda 1.0\ndef Mesh "m" {{\n{_PRIM}', "# a\n", "",
        'float[] primvars:q{0} = [0, 0, 0] (interpolation = "vertex")\n', "}\n"),
    "usd, meshes of a root": Model("usda", '#usda 1.0\ndef SkelRoot "r" {\n', "# a\n", "",
        f'def Mesh "m{{0}}" {{\n{_PRIM}}}\n', "}\n"),
}  # fmt: skip
"""By format and its word for the uses."""


def _views(has_own_views: bool, size: int, uses: int) -> Sample:
    """Accessors of one view, or each with a view of its own over the same bytes."""
    scene = Scene(size)
    first, view = scene.tree["accessors"][0], scene.tree["bufferViews"][0]
    for number in range(uses):
        if has_own_views:
            scene.tree["bufferViews"].append(view)
        scene.tree["accessors"].append(
            first | {"bufferView": len(scene.tree["bufferViews"]) - 1 if has_own_views else 0}
        )
        scene.attributes[f"_A{number}"] = len(scene.tree["accessors"]) - 1
    return scene.sample()


def _streams(has_own_streams: bool, size: int, uses: int) -> Sample:
    """One BSM stream, in as many views, or as many streams over the same bytes."""
    side = max(3, int(size**0.5))  # a plane takes few bytes
    mesh = patch(side, side)
    stream = encode(
        TriangleMesh(mesh.positions * (1.0, 1.0, 0.0), mesh.faces), preset="small", effort="quick"
    )
    count = len(mesh.positions)
    views: list[Tree] = [{"buffer": 0, "byteLength": len(stream)}] * (
        uses if has_own_streams else 1
    )
    for number in range(uses):
        coded = {"stream": number if has_own_streams else 0, "attribute": "POSITION"}
        views.append(
            {"buffer": 1, "byteLength": 12 * count, "extensions": {"EXT_bsm_compression": coded}}
        )
    accessor = {"componentType": 5126, "type": "VEC3", "count": 3}
    accessors = [{**accessor, "bufferView": len(views) - uses + number} for number in range(uses)]
    names = {("POSITION" if not number else f"_A{number}"): number for number in range(uses)}
    missing = {"byteLength": 12 * count, "extensions": {"EXT_bsm_compression": {"fallback": True}}}
    tree: Tree = {
        "asset": {"version": "2.0"}, "extensionsUsed": ["EXT_bsm_compression"], "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": names}]}], "accessors": accessors,
        "bufferViews": views, "buffers": [{"byteLength": len(stream)}, missing],
    }  # fmt: skip
    return Sample("glb", glb(tree, stream))


def _members(size: int, uses: int) -> Sample:
    """An npz whose directory names the same bytes again and again."""
    array, archive_file = io.BytesIO(), io.BytesIO()
    write_npy(array, np.zeros((size, 1), np.int8))
    with zipfile.ZipFile(archive_file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array_of_member in (("positions", np.eye(3)), ("faces", np.array([[0, 1, 2]]))):
            plain = io.BytesIO()
            write_npy(plain, array_of_member)
            archive.writestr(f"{name}.npy", plain.getvalue())
        archive.writestr("x.npy", array.getvalue())
        entry = archive.getinfo("x.npy")
        for number in range(uses):
            again = copy.copy(entry)
            again.filename = f"{number}.npy"
            archive.filelist.append(again)
    return Sample("npz", archive_file.getvalue())


def uses() -> Iterator[tuple[str, Use]]:
    """Yield all that can be used many times, by the format and its word for that."""
    for change in _GLTF:
        yield f"glb, {change.__name__.strip('_')}", partial(_gltf, change, False)
        yield f"moving glb, {change.__name__.strip('_')}", partial(_gltf, change, True)
    yield "moving glb, animations", partial(_gltf, _animations, False)
    yield from (("glb, images", _images), ("gltf, images", _image_by_uri))
    yield (
        "3mf, items",
        lambda size, uses: Sample("3mf", three_mf(_mesh_3mf(size), '<item objectid="1"/>' * uses)),
    )
    yield from (
        ("3mf, components", _components),
        ("obj, materials", _obj_materials),
        ("obj, libraries", _obj_libraries),
        ("obj, polygons", _obj_polygons),
    )
    yield "ply, images", _ply_images
    yield "npz, members", _members
    for what, make in {"views": _views, "streams": _streams}.items():
        yield f"glb, {what} of the same bytes", partial(make, True)
        yield f"glb, one of {what}", partial(make, False)
    foreign = {"usd": "pxr", "dae": "collada"}
    for name, model in MODELS.items():
        if (library := foreign.get(name[:3])) is None or importlib.util.find_spec(library):
            yield name, model.made
    if importlib.util.find_spec("pxr"):
        yield from (
            ("usd, references", partial(_references, False)),
            ("usd, instances", partial(_references, True)),
        )
        yield from (
            ("usd, instancer", _instancer),
            ("usd, times", _moving_usd),
            ("usd, subsets", _subsets),
        )
    if importlib.util.find_spec("collada"):
        yield from (
            ("dae, nodes", partial(_dae, False)),
            ("dae, nodes of nodes", partial(_dae, True)),
        )


def cases(size: int, splits: tuple[float, ...]) -> Iterator[Case]:
    """Yield files of about `size` bytes."""
    for name, make in uses():
        for split in splits:
            yield Case(
                f"{name}, {split} of {size} bytes are used", partial(of_size, make, size, split)
            )


def of_size(make: Use, size: int, split: float = SPLITS[0]) -> Sample:
    """Make a file of about `size` bytes, of which a share is used by the others."""
    each = max(4, (len(make(1000, 1100).data) - len(make(1000, 100).data)) // 1000)
    return make(int(split * size), max(1, int((1 - split) * size) // each))


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument(
        "--bytes",
        type=int,
        nargs="+",
        default=(40_000, 400_000),
        help="of files (default: %(default)s)",
    )
    parser.add_argument("--short", action="store_true", help="one size, one split: what CI does")
    parser.add_argument("--only", default="", metavar="TEXT", help="cases whose name begins so")
    args = parser.parse_args()
    warm_up()
    sizes, splits = (args.bytes[:1], SPLITS[:1]) if args.short else (args.bytes, SPLITS)
    cases_of_uses = [
        case for size in sizes for case in cases(size, splits) if case.name.startswith(args.only)
    ]
    both = chain.from_iterable(
        problems(cases_of_uses, limits, MOST) for limits in ("default", "service")
    )
    return report(both, f"{len(cases_of_uses)} files of {len(list(uses()))} kinds of uses")
