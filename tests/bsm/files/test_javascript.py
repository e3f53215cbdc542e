"""Mesh files in pages: JavaScript reads vertices, triangles, attributes and notes as Python does."""

import gzip
import hashlib
import json
import re
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest

from bsm import BsmError, read_mesh
from bsm.files.formats import stl
from tests.shapes import file_of, ply_head, tetrahedron, torus

ROOT = Path(__file__).parents[3]
WEB = ROOT / "web"
ABOUT_FILES = re.compile(
    r"no such file|not in the folder|Left out: colors and textures of materials"
)
READ = ("obj", "ply", "stl")

pytestmark = pytest.mark.skipif(
    shutil.which("node") is None or not (WEB / "node_modules/three").is_dir(),
    reason="needs node, and npm ci in web",
)


def hashed(values):
    return hashlib.sha256((np.asarray(values, np.float64) + 0.0).tobytes()).hexdigest()


def area(mesh):
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def by_python(path):
    try:
        read = read_mesh(path)
    except BsmError as error:
        return {"error": str(error)}
    mesh = read.mesh
    attributes = [
        {
            "name": a.name,
            "domain": a.domain,
            "semantic": a.semantic,
            "kind": a.values.dtype.name,
            "shape": list(a.values.shape),
            "values": hashed(a.values),
            "indices": None if a.indices is None else hashed(a.indices),
        }
        for a in mesh.attributes
    ]
    return {
        "counts": [len(mesh.positions), len(mesh.faces)],
        "positions": hashed(mesh.positions),
        "faces": hashed(mesh.faces),
        "attributes": attributes,
        "metadata": dict(mesh.metadata),
        "notes": sorted(note for note in read.notes if not ABOUT_FILES.search(note)),
    }


def by_javascript(paths):
    done = subprocess.run(
        ["node", Path(__file__).with_name("reading.mjs"), WEB, *paths],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    # Names may have other breaks.
    found = [json.loads(line) for line in done.stdout.rstrip("\n").split("\n")]
    for each in found:
        if "error" not in each:
            each["notes"] = sorted(note for note in each["notes"] if not ABOUT_FILES.search(note))
    return found


def require_same(paths):
    """Require that both read each file alike, or that both refuse it."""
    read = 0
    for path, theirs in zip(paths, by_javascript(paths), strict=True):
        ours = by_python(path)
        assert ("error" in ours) == ("error" in theirs), (
            f"{path}: {ours.get('error')} {theirs.get('error')}"
        )
        if "error" not in ours:
            read += 1
            assert theirs | ours == theirs, path
    return read


def written(folder, files):
    paths = []
    for name, content in files.items():
        paths.append(folder / name)
        paths[-1].write_bytes(content if isinstance(content, bytes) else content.encode())
    return paths


CORNERS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .25 0\n"
TEXTS = {
    "concave": "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4 5 6\n",
    "bowtie": CORNERS + "f 1 3 2 4\n",
    "line": "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 1.5 .5 0\nv 0 2 0\nf 1 2 3 4 5 6\n",
    "negative": CORNERS + "vt 0 0\nvt 1 0\nf -5/-2 -4/-1 -3/-1\nv 9 9 9\nf -1 1 2\n",
    "texcoords": CORNERS
    + "vt 0 0 .5\nvt .25\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1 4//1\nf 1/1 2/2 5\nf 1//1 2 5\n",
    "colors": "v 0 0 0 1 0 0\nv 1 0 0 0 .2 0\nv 0 1 0 0 0 1\nf 1 2 3\n",
    "bytes": "v 0 0 0 255 0 0\nv 1 0 0 0 51 0\nv 0 1 0 0 0 7\nf 1 2 3\n",
    "alpha": "v 0 0 0 1 0 0 .5\nv 1 0 0 0 .213 0 1\nv 0 1 0 0 0 1 1\nf 1 2 3\n",
    "weights": "v 0 0 0 1\nv 1 0 0 .5\nv 0 1 0 1\nf 1 2 3\n",
    "states": "mtllib a b.mtl\no one\ng x y\n"
    + CORNERS
    + "usemtl r\nf 1 2 3\ns 1\nf 1 3 4\no two\nusemtl g\nf 1 2 5\n",
    "many": CORNERS + "".join(f"o part {i}\nf 1 2 {3 + i % 3}\n" for i in range(20)),
    "remarks": '# meta unit: "mm"\n#meta x\n'
    + CORNERS
    + "f 1 2 3 # the first\nl 1 2\ncurv 1\n#MRGB 00\n",
    "continued": "v 0 0 \\\n0\r\nv 1 0 0\rv 0 1 0\n\n# no \\\nf 1 2 \\\n 3\n",
    "thin": CORNERS + "f 1 2\nf 1\nf 1 2 3\n",
    "numbers": "v 0 0 0\nv 1e-3 +.5 1.\nv 0 1 1E2\nf 1 2 3\n",
    "special": "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn nan 0 1\nvn 0 0 1\nf 1//1 2//2 3//2\n",
    "all special": "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn nan 0 1\nf 1//1 2//1 3//1\n",
    "no colors": "v 0 0 0 255 0 0\nv 1 0 0 nan nan nan\nv 0 1 0 0 0 51\nf 1 2 3\n",
    "no shares": "v 0 0 0 1 0 .2\nv 1 0 0 0 inf 0\nv 0 1 0 0 0 1\nf 1 2 3\n",
    "no texcoords": CORNERS
    + "vt nan .1\nvt .3 .4\nvt .7 .2\nvt .25 -inf\nf 1/1 2/2 3/3\nf 1/4 3/3 4/2\n",
    "objects again": CORNERS + "o a\nf 1 2 3\no b\nf 1 2 4\no a\nf 1 2 5\no c\no b\nf 2 3 4\n",
    "fine": "v 0.1 0.2 0.3\nv 1000000.123456 0 0\nv 0 1 0\nf 1 2 3\n",
    "infinite": "v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "hexadecimal": "v 0 0 0x10\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "underscore": "v 0 0 1_0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "short": "v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "outside": CORNERS + "f 1 2 6\n",
    "zero": CORNERS + "f 0 1 2\n",
    "half": CORNERS + "f 1.5 1 2\n",
    "slash": CORNERS + "f /1 1 2\n",
    "empty corner": CORNERS + "vt 0 0\nf 1/ 2/1 3/1\n",
    "no faces": CORNERS,
    "values outside": CORNERS + "vt 0 0\nf 1/1 2/2 3/1\n",
    "wide blank": "v 0 0 0\nv 1\u00a00 0\nv 0 1 0\nf 1 2 3\n",
    "wide blanks in names": CORNERS
    + "usemtl a\u00a0b\nf 1 2 3\nusemtl c\u3000\u2028\x85\nf 1 3 4\n",
    "words of objects": CORNERS + "constructor a\n__proto__ b\nf 1 2 3\n",
    "hole": "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\nf 1 2 3 4 1 5 6 7 8 5\n",
    "latin": "g \u00e9t\u00e9\n" + CORNERS + "f 1 2 3\n",
}


def test_texts(tmp_path):
    files = {f"{name.replace(' ', '_')}.obj": text for name, text in TEXTS.items()}
    files["latin1.obj"] = TEXTS["latin"].encode("latin-1")
    files["two codes.obj"] = b"# caf\xe9 \x80\n" + f"{CORNERS}g \u00e9\nf 1 2 3\n".encode()
    files["mark.obj"] = TEXTS["latin"].encode("utf-8-sig")
    files["wide.obj"] = TEXTS["latin"].encode("utf-16")
    assert require_same(written(tmp_path, files)) > 20


def test_random_polygons(tmp_path):
    """Stars around the origin, most of them not convex, in planes of all directions."""
    random, files = np.random.default_rng(5), {}
    for number in range(12):
        lines, count = [], 0
        for _ in range(20):
            size = int(random.integers(4, 100))
            angles = np.sort(random.random(size)) * 2 * np.pi
            flat = np.column_stack([np.cos(angles), np.sin(angles)]) * (
                0.2 + random.random((size, 1))
            )
            if number % 2:
                flat = np.rint(8 * flat)
            points = flat @ random.normal(size=(2, 3))
            lines += ["v {!r} {!r} {!r}\n".format(*row) for row in points.tolist()]
            lines.append(f"f {' '.join(str(count + i + 1) for i in range(size))}\n")
            count += size
        files[f"{number}.obj"] = "".join(lines)
    assert require_same(written(tmp_path, files)) == 12


def plys():
    more = "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float w_0\nproperty float w_1\n"
    rows = "0 0 0 255 0 0 .5 1\n1 0 0 0 9 0 .25 0\n1 1 0 0 0 300 0 0\n0 1 0 1 1 1 1 1\n"
    yield "colors", ply_head(4, 1, more=more) + rows + "4 0 1 2 3\n"
    yield "fits", ply_head(4, 1, more=more) + rows.replace("300", "30") + "4 0 1 2 3\n"
    faces = "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty list uchar float texcoord\n"
    head = ply_head(4, 2).replace("end_header", faces + "property int flag\nend_header")
    square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
    yield "faces", head + square + "3 0 1 2 9 8 7 6 0 0 1 0 1 1 5\n3 0 2 3 0 0 0 0 -1\n"
    yield "extra", head + square + "3 0 1 2 9 8 7 0 5\n3 0 2 3 0 0 0 0 -1 7\n"
    yield "wrong", head + square + "3 0 1 2 9 8 7 1 0 5\n3 0 2 3 0 0 0 0 -1\n"
    yield "fans", ply_head(5, 1) + square + ".5 .25 0\n" + "5 0 1 2 4 3\n"
    comments = 'comment by me\ncomment meta unit: "mm"\nobj_info x\ncomment TextureFile a.png\nelement vertex'
    yield (
        "comments",
        ply_head(3, 1).replace("element vertex", comments) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    )
    yield "points", ply_head(3, 0) + "0 0 0\n1 0 0\n0 1 0\n"
    yield "short", ply_head(3, 2) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    yield (
        "edges",
        ply_head(3, 1).replace("end_header", "element edge 1\nproperty int a\nend_header")
        + ("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n4\n"),
    )
    for order, kind in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
        head = ply_head(4, 2, order).replace("list uchar int", "list ushort uint")
        body = struct.pack(f"{kind}12f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.1)
        body += struct.pack(f"{kind}H3I", 3, 0, 1, 2) + struct.pack(f"{kind}H4I", 4, 0, 1, 2, 3)
        yield f"{kind == '<'}", head.encode() + body
        yield f"cut_{kind == '<'}", head.encode() + body[:-5]
    yield "marked", "\ufeff" + ply_head(3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    yield (
        "unknown",
        ply_head(3, 1).replace("float x", "toString x") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    )
    more = "property float constructor\nproperty float __proto__\n"
    yield "objects", ply_head(3, 1, more=more) + "0 0 0 1 2\n1 0 0 3 4\n0 1 0 5 6\n3 0 1 2\n"
    for number in ("7", "-7", "4000000000", "9007199254740993"):
        yield (
            f"long{number}",
            ply_head(3, 1, more="property int64 id\n")
            + f"0 0 0 {number}\n1 0 0 1\n0 1 0 2\n3 0 1 2\n",
        )
    yield from plys_of_colors()
    yield from plys_of_textures()
    yield "mac", (ply_head(3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").replace("\n", "\r")
    yield "windows", (ply_head(3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").replace("\n", "\r\n")


def plys_of_colors():
    """Numbers of every type that are colors, or are none."""
    rows = {
        "bytes": "0 9 255", "words": "0 256 65535", "more": "0 1 65536", "less": "-1 0 3",
        "shares": "0 .2 1", "floats": "0 51 255", "wide": "0 .5 300", "none": "nan 9 255", "nowhere": "nan inf nan",
    }  # fmt: skip
    for kind in (
        "uchar",
        "char",
        "ushort",
        "short",
        "uint",
        "int",
        "int64",
        "uint64",
        "float",
        "double",
    ):
        more = "".join(f"property {kind} {name}\n" for name in ("red", "green", "blue"))
        for name, row in rows.items():
            body = f"0 0 0 {row}\n1 0 0 255 255 255\n0 1 0 0 0 0\n3 0 1 2\n"
            yield f"{kind} {name}", ply_head(3, 1, more=more) + body
    more = "".join(
        f"property float {name}\n" for name in ("red", "green", "blue", "alpha", "quality")
    )
    body = "0 0 0 1 0 0 9000 .5\n1 0 0 0 .2 0 1 nan\n0 1 0 0 0 1 1 .25\n3 0 1 2\n"
    yield "wild alpha", ply_head(3, 1, more=more) + body
    yield "no alpha", ply_head(3, 1, more=more) + body.replace("9000", "nan")
    for names in (("diffuse_red", "diffuse_green", "diffuse_blue"), ("r", "g", "b")):
        more = "".join(f"property uchar {name}\n" for name in names)
        head = ply_head(3, 1, more=more).replace("end_header", f"{more}end_header")
        yield names[0], head + "0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n3 0 1 2 7 7 7\n"


def plys_of_textures():
    """Texture coordinates of vertices and corners, and numbers of materials and images, with and without images."""
    images = "comment TextureFile a.png\ncomment TextureFile b.png\n"
    said = 'comment meta material.0.map_Kd: 1\ncomment meta image.1.name: "a.png"\n'
    of_corners = "property list uchar float texcoord\n"
    numbers = "".join(f"property int {name}\n" for name in ("material_index", "texnumber"))
    square = "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 nan\n"
    for comments in ("", images, f"{images}{said}"):
        for u, v in (
            ("u", "v"),
            ("s", "t"),
            ("texture_u", "texture_v"),
            ("texture_s", "texture_t"),
        ):
            more = f"property float {u}\nproperty float {v}\n"
            head = ply_head(4, 2, more=more).replace("element vertex", f"{comments}element vertex")
            head = head.replace("end_header", f"{of_corners}{numbers}end_header")
            for textures in ("01", "10", "00", "21"):
                faces = f"3 0 1 2 6 0 0 1 0 1 1 0 {textures[0]}\n3 0 2 3 0 1 {textures[1]}\n"
                yield f"{u} {len(comments)} {textures}", head + square + faces
                alone = (head + square + faces).replace("material_index", "flag")
                yield f"{u} {len(comments)} {textures} alone", alone


def test_plys(tmp_path):
    assert require_same(written(tmp_path, {f"{name}.ply": data for name, data in plys()})) > 150


def records(triangles, head=b""):
    facets = np.zeros(len(triangles), stl.RECORD)
    facets["corners"] = triangles
    return head.ljust(80, b"\0") + len(facets).to_bytes(4, "little") + facets.tobytes()


def test_stls(tmp_path):
    random = np.random.default_rng(3)
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 {}\nendloop\nendfacet\n"
    two = f"solid a\n{facet.format(0)}endsolid a\nsolid b c\n{facet.format(-0.0)}{facet.format(2)}endsolid\n"
    binary = file_of(torus(), "stl")
    cube = np.array([[int(bit) for bit in f"{i:03b}"] for i in range(8)])
    sides = np.array(
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    )
    body = cube[sides[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)]
    bodies = [body + place for place in ((0, 0, 0), (1, 0, 0), (1, 1, 1), (2, 1, 0), (0, 0, 0))]
    parts = [np.add(body[:7], (0, 3, 0)), np.add(body[3:], (1, 3, 0))]  # that are open
    touching = np.concatenate([*bodies, *parts])
    random.shuffle(touching)
    colored = bytearray(binary)
    colored[84 + 48] = 7
    files = {
        "two": two,
        "one": f"solid\n{facet.format(0.1)}endsolid",
        "upper": two.upper(),
        "cut": two[:-80],
        "lines": two.replace("\n", " ").replace("solid a", "solid a\n"),
        "touching": records(touching),
        "remarks": "; by me\n" + two.replace("facet n", "color 1 0 0\nfacet n"),
        "late": "# " + 2000 * "x" + "\n" + two,
        "wide": two.encode("utf-16"),
        "marked": two.encode("utf-8-sig"),
        "code": records(body, b"caf\xe9 \x80"),
        "binary": binary,
        "colored": bytes(colored),
        "more": binary + b"1234567",
        "unknown": binary[:80] + bytes(4) + binary[84:],
        "less": binary[:-30],
        "header": b"solid by me".ljust(80, b"\0") + binary[80:],
        "nothing": b"",
    }
    assert (
        require_same(written(tmp_path, {f"{name}.stl": data for name, data in files.items()})) >= 8
    )


@pytest.mark.parametrize("kind", READ)
def test_what_is_written(kind, tmp_path):
    files = {f"{i}.{kind}": file_of(mesh, kind) for i, mesh in enumerate((tetrahedron(), torus()))}
    assert require_same(written(tmp_path, files)) == 2


@pytest.mark.parametrize("kind", READ)
def test_garbage(kind, tmp_path):
    """Bytes changed at random: both read the same, or both refuse."""
    random, data = np.random.default_rng(7), file_of(tetrahedron(), kind)
    files = {}
    for number in range(60):
        changed = bytearray(data)
        for place in random.integers(0, len(data), 1 + number % 3):
            changed[place] = random.integers(32, 127) if kind != "stl" else random.integers(0, 256)
        files[f"{number}.{kind}"] = bytes(changed)
    require_same(written(tmp_path, files))


def scene(*primitives, nodes=None, **more):
    """A GLB of meshes, each with one primitive: arrays by the names of its attributes, and its `indices`."""
    views, accessors, body = [], [], b""
    kinds = {"float32": 5126, "uint8": 5121, "uint16": 5123, "uint32": 5125}

    def placed(values):
        nonlocal body
        values = np.asarray(values)
        views.append({"buffer": 0, "byteOffset": len(body), "byteLength": values.nbytes})
        body += values.tobytes() + bytes(-values.nbytes % 4)
        kind = {
            "componentType": kinds[values.dtype.name],
            "type": "SCALAR" if values.ndim == 1 else f"VEC{values.shape[1]}",
        }
        limits = (
            {"min": values.min(0).tolist(), "max": values.max(0).tolist()}
            if values.ndim == 2
            else {}
        )
        whole = {"normalized": True} if values.ndim == 2 and values.dtype.kind == "u" else {}
        accessors.append(
            {"bufferView": len(views) - 1, "count": len(values), **kind, **limits, **whole}
        )
        return len(accessors) - 1

    shared = {}
    meshes = []
    for given in primitives:
        numbers = {
            name: shared.setdefault(id(a), placed(a)) if id(a) not in shared else shared[id(a)]
            for name, a in given.items()
        }
        indices = {"indices": numbers.pop("indices")} if "indices" in numbers else {}
        meshes.append(
            {"name": f"mesh{len(meshes)}", "primitives": [{"attributes": numbers, **indices}]}
        )
    nodes = nodes or [{"mesh": i} for i in range(len(meshes))]
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [*range(len(nodes))]}],
        "nodes": nodes,
    }
    tree |= {
        "meshes": meshes,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(body)}],
        **more,
    }
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    chunks = (
        struct.pack("<I4s", len(text), b"JSON")
        + text
        + struct.pack("<I4s", len(body), b"BIN\0")
        + body
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def test_scenes(tmp_path):
    """Parts that lack what others have, tables that parts share, copies, and what no mesh can have."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    faces = np.array([0, 1, 2, 0, 3, 1], np.uint16)
    plain = {"POSITION": corners, "indices": faces}
    flat, bytes_ = (
        np.linspace(0, 1, 8, dtype=np.float32).reshape(4, 2),
        np.arange(16, dtype=np.uint8).reshape(4, 4),
    )
    full = {
        **plain,
        "TEXCOORD_0": flat,
        "TEXCOORD_1": flat[::-1].copy(),
        "COLOR_0": bytes_,
        "TANGENT": np.eye(4, dtype=np.float32),
    }
    narrow = {**plain, "COLOR_0": bytes_[:, :3].astype(np.float32) / 255}
    shared = {"POSITION": np.tile(corners, (30, 1)), "NORMAL": np.tile(corners, (30, 1))}
    parts = [
        {**shared, "indices": np.array([4 * k, 4 * k + 1, 4 * k + 2], np.uint16)} for k in (7, 3)
    ]
    places = np.array([[5, 0, 0], [0, 5, 0], [0, 0, 5]], np.float32)
    copies = [
        {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 2}}}}
    ]
    instanced = scene(
        {**plain, "_PLACES": places}, nodes=copies, extensionsUsed=["EXT_mesh_gpu_instancing"]
    )
    files = {
        "lacking": scene(full, plain, narrow),
        "shared": scene(*parts),
        "copies": instanced.replace(b', "_PLACES": 2', b"              "),
        "turned": scene(
            plain, nodes=[{"mesh": 0, "scale": [1, -2, 1], "rotation": [0.5, 0.5, 0.5, 0.5]}]
        ),
        "outside": scene({**plain, "indices": faces + np.uint16(2)}, plain),
        "infinite": scene(
            {**plain, "POSITION": np.where(corners > 0, np.float32(np.inf), corners)}
        ),
        "old": scene(plain).replace(b'"2.0"', b'"1.0"'),
        "older": scene(plain)[:4] + b"\1" + scene(plain)[5:],
        "circle": scene(plain, nodes=[{"mesh": 0, "children": [1]}, {"children": [0]}]),
        "nothing": b"",
        "cut": scene(plain)[:100],
    }
    paths = written(tmp_path, {f"{name}.glb": data for name, data in files.items()})
    read = 0
    for path, theirs in zip(paths, by_javascript(paths), strict=True):
        ours = by_python(path)
        assert ("error" in ours) == ("error" in theirs), (
            f"{path}: {ours.get('error')} {theirs.get('error')}"
        )
        if "error" in ours:
            assert not re.search("THREE|undefined", theirs["error"])
            continue
        read += 1
        for key in ("counts", "positions", "faces"):
            assert ours[key] == theirs[key], path
        shown = [
            [(a["name"], a["semantic"], a["shape"]) for a in each["attributes"]]
            for each in (ours, theirs)
        ]
        assert sorted(shown[0]) == sorted(shown[1]), path
        assert {note for note in ours["notes"] if "parts" in note} <= {*theirs["notes"]}, path
        assert all(
            "TANGENT of attributes" in "".join(each["notes"]) for each in (ours, theirs)
        ) == (path.stem == "lacking")
    assert read == 4


@pytest.mark.real
def test_assets(meshes):
    most = 10_000_000  # bytes: of larger ones there are some alike
    found = [
        path
        for kind in READ
        for path in sorted(meshes.rglob(f"*.{kind}"))
        if path.stat().st_size < most
    ]
    assert require_same(found) > 10
    scenes = sorted(meshes.rglob("*.glb"))
    for path, theirs in zip(scenes, by_javascript(scenes), strict=True):
        mesh = read_mesh(path).mesh
        assert theirs["counts"] == [len(mesh.positions), len(mesh.faces)], path
        assert theirs["area"] == pytest.approx(area(mesh), rel=1e-6), path


def test_compressed_meshes_are_read_by_python_alone(tmp_path):
    """A page is told that .gz is not read there, in place of nonsense."""
    (path,) = written(tmp_path, {"a.obj.gz": gzip.compress(TEXTS["concave"].encode())})
    (theirs,) = by_javascript([path])
    assert "Only PLY, OBJ, STL" in theirs["error"]
