"""What README, CONTRIBUTING and the specification tell people to type: every block and every command is run.

Commands stand in blocks (lines indented by four, or fenced as sh or python) or between backticks. What needs a folder
of meshes is asked for its help always, and run as it stands where there are real meshes and time (`-m long`).
"""

import ast
import inspect
import os
import platform
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import Attribute, TriangleMesh
from tests.bsm.program import declare_entry_points
from tests.bsm.test_libraries import painted
from tests.shapes import knot
from tools import docs_pages
from tools.docs_pages import exit_codes
from tools.noise import gaussian_along_normals
from tools.pictures import PICTURES

ROOT = Path(__file__).parents[1]
PAGES = tuple(
    str(path.relative_to(Path(__file__).parents[1]))
    for path in sorted((Path(__file__).parents[1] / "docs").rglob("*.md"))
    if not path.is_symlink()
)
DOCUMENTS = ("README.md", "CONTRIBUTING.md", "spec/README.md", "src/bsm/SERVICE.md", *PAGES)
PROGRAMS = r"(?:bsm|python3?|pytest|mkdocs|ruff|\.ci/run|\.venv|eval|cat)"
BY_CI = r"\.ci/|^mkdocs|\.venv/bin/|^pytest|^ruff|^bsm --help$|tools\.attack|tools\.measure house"
"""What .ci/run itself does, or is."""
NEEDS_FOLDER = r"MESHES|SEQUENCES|FOLDER|MESH\.\.\.|bunny_34834"
HELP_ONLY = (
    r"tools\.(?:release|pictures|blender|charges|vectors|processors|replicate)|measure (?:assets|speed|targets)"
    r"|s3://|bsm view"
)
"""What would change the repository, and does so in tests of its own, needs machines of others, or takes time."""
PLACES = {
    "COMMAND": "encode",
    "MESH": "bunny.ply",
    "spec/": f"{ROOT}/spec/",
    "IN.bsm": "bunny.bsm",
    "OUT.npz": "reference.npz",
    " N": " 1",
    'CMD {in} {out}"': 'bsm decode -q {in} -o {out}" --only good-one',
}


MANY = "bsm encode -q -f a.ply b.obj c.stl -o streams/ --report report.json"
"""Makes the folder and the report that some commands read."""


SETTING = """
from bsm.files.mesh import read_mesh
mesh = read_mesh("bunny.ply").mesh
positions, faces = mesh.positions, mesh.faces
data = open("bunny.bsm", "rb").read()
chunks = [data[i : i + 100] for i in range(0, len(data), 100)]
"""
"""What a snippet speaks of without making it."""


def blocks(name):
    """The blocks of a document."""
    text = (ROOT / name).read_text()
    fenced = re.findall(r"^```(?:sh|python)\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)
    found = re.findall(r"(?:^|\n\n)((?: {4}[^\n]*(?:\n|$)|\n(?= {4}))+)", text)
    indented = [
        re.sub(r"^ {4}", "", block, flags=re.MULTILINE).strip("\n") + "\n" for block in found
    ]
    return indented + fenced


def commands(name):
    """The commands between backticks."""
    spans = re.findall(r"`([^`\n]+)`", (ROOT / name).read_text())
    return [
        span
        for span in dict.fromkeys(spans)
        if re.match(rf"{PROGRAMS}(?: |$)", span) and " " in span
    ]


def is_python(block):
    return re.match(r"(?:from|import) \w", block) is not None


BLOCKS = [(name, block) for name in DOCUMENTS for block in blocks(name)]
COMMANDS = list(dict.fromkeys(command for name in DOCUMENTS for command in commands(name)))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the meshes that the documents speak of, and programs that they call."""
    mesh = knot(600)
    folder = tmp_path_factory.mktemp("made")
    declare_entry_points(folder / "site")
    bsm.save(painted(mesh), folder / "spot.obj")
    for name in ("bunny.ply", "a.ply", "b.obj", "c.stl"):
        bsm.save(mesh, folder / name)
    noisy = gaussian_along_normals(mesh.positions, mesh.faces, 0.2, 0)
    bsm.save(TriangleMesh(noisy, mesh.faces), folder / "scan.ply")
    frames = np.array([mesh.positions * (1 + 0.1 * np.sin(t)) for t in range(4)])
    np.savez(folder / "dance.npz", positions=frames, faces=mesh.faces)
    for name in ("capture", "scans"):
        (folder / name).mkdir()
        for number, shape in enumerate((mesh, mesh, knot(300))):
            bsm.save(shape, folder / f"{name}/{number}.ply")
    (folder / "painted").mkdir()
    for number, frame in enumerate(frames):
        shades = np.full((len(frame), 3), 40 * number, np.uint8)
        shape = TriangleMesh(frame, mesh.faces, [Attribute("color", shades, semantic="color")])
        bsm.save(shape, folder / f"painted/{number}.ply")
    programs = {
        "bsm": f'exec "{sys.executable}" -m bsm "$@"',
        "python": f'exec "{sys.executable}" "$@"',
        "viewer": "cat",
    }
    (folder / "bin").mkdir()
    for name, line in programs.items():
        (folder / "bin" / name).write_text(f"#!/bin/sh\n{line}\n")
        (folder / "bin" / name).chmod(0o755)
    encodes = "bsm encode -q bunny.ply spot.obj --set congruence=no && bsm decode -q spot.bsm -o scene.glb"
    passed(run(folder, f"{encodes} && bsm tile -q scan.ply -o scan/"))
    return folder


def run(folder, script, timeout=300):
    """Run a script in the folder, as somebody would who works there with this checkout."""
    environment = {
        **os.environ,
        # A wheel for one level of processors compiles in half the time.
        **({"CMAKE_ARGS": "-DBSM_LEVEL=1"} if platform.machine() == "x86_64" else {}),
        "PATH": f"{folder}/bin:{os.environ['PATH']}",
        "PYTHONPATH": f"{folder}/site:{ROOT}:{ROOT / 'src'}",
    }
    return subprocess.run(
        ["bash", "-c", f"set -eo pipefail\n{script}"],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=timeout,
        check=False,
    )


def passed(done):
    assert done.returncode == 0, done.stderr[-2000:]
    assert "Traceback" not in done.stderr


def filled(command):
    for placeholder, value in PLACES.items():
        command = command.replace(placeholder, value)
    return command


@pytest.mark.slow
@pytest.mark.parametrize(("name", "block"), BLOCKS, ids=[f"{n}-{b[:30]}" for n, b in BLOCKS])
def test_blocks(name, block, folder):
    if re.search(BY_CI, block):
        assert block.strip() in _run_by_ci()
    elif is_python(block):
        for library in re.findall(
            r"import (?:bsm, )?(?:bsm\.)?(trimesh|pyvista|meshio|open3d|openmesh)\b", block
        ):
            pytest.importorskip(library)
        (folder / "snippet.py").write_text(SETTING + block)
        passed(run(folder, "python snippet.py"))
    elif not re.match(PROGRAMS, block):
        pytest.skip("not a command")
    else:
        for name in ("out.ply", "clean.ply"):
            (folder / name).unlink(missing_ok=True)
        stream = (folder / "bunny.bsm").read_bytes()
        if re.search(r"^bsm encode bunny\.ply(?! +-f)", block, flags=re.MULTILINE):
            (folder / "bunny.bsm").unlink()
        try:
            # A server runs until it is stopped; tests/bsm/test_view.py talks to it. That C compiles needs no optimizer.
            block = re.sub(r"^cc -O3 ", "cc -O0 ", block, flags=re.MULTILINE)
            block = re.sub(r"^python spec/", f"python {ROOT}/spec/", block, flags=re.MULTILINE)
            passed(run(folder, re.sub(r"^bsm view .*\n", "", block, flags=re.MULTILINE)))
        finally:
            (folder / "bunny.bsm").write_bytes(stream)


def _run_by_ci():
    """The commands that CI takes out of the README: .ci/run prints them when it is asked to."""
    done = subprocess.run(
        [ROOT / ".ci" / "run", "--list"], capture_output=True, text=True, timeout=60, check=True
    )
    return done.stdout.splitlines()


@cache
def helped(folder, program):
    """What a program says of itself."""
    done = run(folder, f"{program} --help")
    passed(done)
    return done


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_commands(command, folder):
    if re.search(BY_CI, command):
        pytest.skip("run by CI itself")
    if "tools.manuals" in command:
        pytest.importorskip("argparse_manpage", reason="no argparse-manpage here (extra manuals)")
    if re.search(f"{NEEDS_FOLDER}|{HELP_ONLY}", command) or re.fullmatch(r"bsm [a-z]+", command):
        program = re.match(
            r"bsm \w+|python -m tools\.(?:measure|attack) \w+|python -m [\w.]+", command
        ).group()
        done = helped(folder, program)
        for option in re.findall(r" (--[a-z-]+|-[a-z])\b", command[len(program) :]):
            assert option in done.stdout, f"{program} has no {option}"
        if only := re.search(r"--only (\w+)", command):
            assert only.group(1) in done.stdout
    else:
        shutil.rmtree(folder / "streams", ignore_errors=True)
        if re.match(r"bsm (?:decode -r|verify|view streams)", command):
            passed(run(folder, MANY))
        stream = (folder / "bunny.bsm").read_bytes()
        try:
            passed(run(folder, filled(command)))
        finally:
            (folder / "bunny.bsm").write_bytes(stream)


@pytest.mark.long
@pytest.mark.real
@pytest.mark.parametrize(
    "command", [c for c in COMMANDS if re.search(NEEDS_FOLDER, c) and not re.search(HELP_ONLY, c)]
)
def test_commands_on_real_meshes(command, folder, meshes):
    places = {
        "MESHES": meshes / "static",
        "SEQUENCES": meshes / "dynamic",
        "FOLDER": meshes,
        "MESH...": "bunny.ply",
    }
    if "denois" in command:
        places["MESHES"] = meshes
    for placeholder, value in places.items():
        command = command.replace(placeholder, str(value))
    passed(
        run(
            folder,
            command.replace("bunny_34834.ply", f"{meshes}/static/bunny_34834.ply"),
            timeout=7200,
        )
    )


def test_something_is_found():
    assert len(BLOCKS) >= 5 and len(COMMANDS) >= 15
    assert sum(is_python(block) for _, block in BLOCKS) >= 1
    assert any("tools.attack costly" in command for command in COMMANDS)


# ----------------------------------------------------------------------------------------------- names in documents

PATH = re.compile(
    r"[\w.-]+(?:/[\w.-]+)+\.(?:py|csv|c|h|hpp|md|sh|json|bin|toml|png|ts|mjs)|[\w-]+/(?:[\w-]+/)*(?=`)"
)
PAPERS = (*DOCUMENTS, "codec/PAPER.md", "web/README.md")
HERE = ("", "codec", "src/bsm", "web", "spec", "bitstream")
"""Folders that paths in documents begin from."""


@pytest.mark.parametrize("name", PAPERS)
def test_paths_that_documents_name_exist(name):
    spans = re.findall(r"`([^`\n]+)`", (ROOT / name).read_text())
    named = {path for span in spans if " " not in span for path in PATH.findall(f"{span}`")}
    missing = {
        path for path in named if not any((ROOT / folder / path).exists() for folder in HERE)
    }
    assert missing <= EXAMPLES, f"{name} names paths that do not exist: {sorted(missing)}"


EXAMPLES = {"dist/", "out/", "streams/", "new/", "dance.glb/", "frames/"}
"""Names of files that a reader may have, not of ours."""
LEANING = re.compile(r"(?:Of|The same|And|That of|Those|Them)\b")


@pytest.mark.parametrize("room", ["bitstream", "codec", "src/bsm", "tools"])
def test_docstrings_can_be_read_alone(room):
    """A tooltip is shown without the one before it."""
    sources = [path for path in (ROOT / room).rglob("*.py") if "node_modules" not in path.parts]
    nodes = [(path, node) for path in sources for node in ast.walk(ast.parse(path.read_text()))]
    named = [
        (path, node) for path, node in nodes if isinstance(node, (ast.FunctionDef, ast.ClassDef))
    ]
    leaning = [
        f"{path}:{node.lineno}"
        for path, node in named
        if LEANING.match(ast.get_docstring(node) or "")
    ]
    assert not leaning


# ------------------------------------------------------------------------------------------------ shapes of arrays

SHAPE = re.compile(r"\bshapes? (?:of )?[(`]|\b(?:any|same) shape\b", flags=re.IGNORECASE)
ARRAYS = re.compile(r"NDArray|ArrayLike|Positions|Faces|Matrix|Points")


def public_functions():
    """Functions that are promised to stay, and the methods of classes that are."""
    for name in bsm.__all__:
        value = getattr(bsm, name)
        for owner, member in vars(value).items() if inspect.isclass(value) else [(name, value)]:
            function = (
                member.fget if isinstance(member, property) else getattr(member, "__func__", member)
            )
            if inspect.isfunction(function) and not owner.startswith("_"):
                yield f"{name}.{owner}", function


def test_each_page_of_the_site_is_linked_from_another():
    texts = [
        path for folder in ("docs", "docs/guides") for path in sorted((ROOT / folder).glob("*.md"))
    ]
    texts += [ROOT / source for source in docs_pages.ELSEWHERE.values()]
    links = {
        (text.parent / link).resolve()
        for text in texts
        for link in re.findall(r"\]\(([\w./-]+\.md)(?:#[\w-]+)?\)", text.read_text("utf-8"))
        if (text.parent / link).resolve() != text.resolve()
    }
    assert not [
        str(text) for text in texts if text.resolve() not in links and text.name != "index.md"
    ]


def test_docstrings_of_public_arrays_name_shapes():
    """One cannot call what takes an array without knowing how many rows and columns it has."""
    found = {name: it for name, it in public_functions() if ARRAYS.search(str(it.__annotations__))}
    assert found
    assert not [
        name for name, function in found.items() if not SHAPE.search(function.__doc__ or "")
    ]


def test_the_table_of_exit_codes_is_that_of_the_program():
    assert exit_codes() in (ROOT / "docs" / "troubleshooting.md").read_text()


def test_one_script_makes_all_pictures():
    kept = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout.split("\n")
    links = {
        str((ROOT / page).parent.joinpath(link).resolve().relative_to(ROOT.resolve()))
        for page in kept
        if page.endswith(".md")
        for link in re.findall(
            r"!\[[^\]]*\]\((?!https?:)([^)]+)\)", (ROOT / page).read_text("utf-8")
        )
    }
    assert (
        links
        == {*PICTURES}
        == {name for name in kept if re.search(r"\.(png|jpe?g|gif|webp|svg|avif)$", name)}
    )


def test_the_first_picture_says_what_the_table_says():
    """`python -m tools.pictures` writes both figures of the bunny into the picture's text."""
    data = (ROOT / "tools" / "front.png").read_bytes()
    figures, at = {}, 8
    while at < len(data):
        size = int.from_bytes(data[at : at + 4], "big")
        if data[at + 4 : at + 8] == b"tEXt":
            name, _, value = data[at + 8 : at + 8 + size].decode("latin-1").partition("\0")
            figures[name] = value
        at += size + 12
    row = next(
        line
        for line in (ROOT / "README.md").read_text("utf-8").splitlines()
        if line.startswith("| bunny")
    )
    cells = [cell.strip() for cell in row.split("|")]
    assert (figures["file"], figures["balanced"]) == (cells[2], cells[4]), (
        "run python -m tools.pictures MESHES"
    )


def test_every_page_and_every_document_of_the_law_is_on_the_site():
    navigation = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    pages = [page.removeprefix("docs/") for page in PAGES] + [*docs_pages.ELSEWHERE]
    missing = [
        page
        for page in pages
        if f": {page}\n" not in navigation and not page.startswith("api/python")
    ]
    assert missing == []
    assert set(docs_pages.law().values()) == {
        f"spec/{path.name}" for path in (ROOT / "spec").glob("*.md")
    }
    overview = (ROOT / "spec/README.md").read_text(encoding="utf-8")
    assert [path.name for path in (ROOT / "spec").glob("*.md") if path.name not in overview] == [
        "README.md"
    ]
