"""Files of few bytes that claim, repeat or chain much: readers of our own refuse them, or walk over them once."""

import ast
import re
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

import bsm
from tests.motion import sequence_in

SOURCES = Path(bsm.__file__).parent / "files"
FACE = "GRID,1,{0},0.,0.,0.\nGRID,2,{0},1.,0.,0.\nGRID,3,{0},0.,1.,0.\nCTRIA3,1,1,1,2,3\n"


def test_no_pattern_begins_a_line_with_blanks_of_many_lines():
    """Such a pattern starts anew at each of n blank lines, and walks over those after it."""
    for path in SOURCES.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, (str, bytes)):
                text = node.value if isinstance(node.value, str) else node.value.decode("latin-1")
                assert not re.match(r"\^\(?(\?:)?\\s[*+]", text), (
                    f"{path.name}, line {node.lineno}: {text[:40]}"
                )


# ---------------------------------------------------------------------------------------------------- Nastran


def systems(depth: int, last: int = 0) -> str:
    """Systems of three nodes each, which are in the next system."""
    rows, node = ["BEGIN BULK\n"], 10
    for number in range(1, depth + 1):
        above = number + 1 if number < depth else last
        for at in ("0.,0.,0.", "0.,0.,1.", "1.,0.,0."):
            rows.append(f"GRID,{node},{above},{at}\n")
            node += 1
        rows.append(f"CORD1R,{number},{node - 3},{node - 2},{node - 1}\n")
    return "".join([*rows, FACE.format(1), "ENDDATA\n"])


def test_each_coordinate_system_is_placed_once(tmp_path):
    (tmp_path / "a.nas").write_text(systems(1500))
    found = bsm.read_mesh(tmp_path / "a.nas").mesh
    assert found.positions[found.faces].tolist() == [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
    for last, words in ((1, "refers to itself"), (9999, "9999 is not there")):
        (tmp_path / "a.nas").write_text(systems(20, last))
        with pytest.raises(bsm.FormatError, match=words):
            bsm.read_mesh(tmp_path / "a.nas")


@pytest.mark.parametrize(
    ("name", "text"), [("bdf", "INCLUDE '{}'\n"), ("inp", "*INCLUDE, INPUT={}\n")]
)
def test_files_may_include_each_other_deeper_than_python_calls(name, text, tmp_path):
    end = {
        "bdf": FACE.format(0),
        "inp": "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n*ELEMENT, TYPE=S3\n1,1,2,3\n",
    }[name]
    for number in range(1500):
        (tmp_path / f"{number}.{name}").write_text(
            text.format(f"{number + 1}.{name}") if number < 1499 else end
        )
    assert len(bsm.read_mesh(tmp_path / f"0.{name}").mesh.faces) == 1


# ----------------------------------------------------------------------------------------------------- Abaqus


def instances(count: int, own: str = "") -> str:
    nodes = "".join(f"{n},{n % 17},{n % 13},{n % 11}\n" for n in range(1, 1001))
    part = f"*PART, NAME=P\n*NODE\n{nodes}*ELEMENT, TYPE=S3\n1,1,2,3\n2,2,3,4\n*END PART\n*ASSEMBLY, NAME=A\n"
    one = f"*INSTANCE, NAME=I, PART=P\n0,0,1\n{own}*END INSTANCE\n"
    return f"*HEADING\nx\n{part}{one * count}*END ASSEMBLY\n"


@pytest.mark.parametrize("own", ["", "*NODE\n5000,0,0,0\n"])
def test_instances_are_counted_before_they_are_placed(own, tmp_path):
    (tmp_path / "a.inp").write_text(instances(3, own))
    found = bsm.read_mesh(tmp_path / "a.inp").mesh
    assert len(found.faces) == 6 and found.positions[:, 2].min() == 1
    (tmp_path / "a.inp").write_text(instances(2000, own))
    with pytest.raises(bsm.LimitError):
        bsm.read_mesh(tmp_path / "a.inp", limits=bsm.Limits(vertices=100_000))


# ------------------------------------------------------------------------------------------------------- Gmsh


def gmsh(nodes: int, more: str) -> str:
    rows = "".join(f"{n} {n % 7} {n % 5} {n / 100}\n" for n in range(1, nodes + 1))
    head = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}\n{rows}$EndNodes\n"
    return f"{head}$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n{more}"


def values(name: str, time: float, width: int, rows: str) -> str:
    count = len(rows.splitlines())
    return f'$NodeData\n1\n"{name}"\n1\n{time}\n3\n0\n{width}\n{count}\n{rows}$EndNodeData\n'


@pytest.mark.parametrize(
    "more",
    [values("a", 0, 10**8, ""), "".join(values(f"n{n}", 0, 1, "1 2.5\n") for n in range(4000))],
)
def test_tables_of_few_values_are_refused_before_they_are_made(more, tmp_path):
    (tmp_path / "a.msh").write_text(gmsh(20_000, more))
    tracemalloc.start()
    with pytest.raises(bsm.LimitError, match="memory"):
        bsm.read_mesh(tmp_path / "a.msh")
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 1 << 26


def test_times_of_few_values_take_as_much_memory_as_one(tmp_path):
    (tmp_path / "a.msh").write_text(
        gmsh(5000, "".join(values("a", n, 1, "1 2.5\n") for n in range(1000)))
    )
    tracemalloc.start()
    frames = sequence_in(str(tmp_path / "a.msh"))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert frames.count == 1000 and most < 1 << 25


# ------------------------------------------------------------------------------------------------------- XDMF

TABLE = '<DataItem Name="d0" Dimensions="4" Format="XML">1 2 3 4</DataItem>'
GRID = (
    '<Grid Name="g"><Topology TopologyType="Triangle"><DataItem Dimensions="2 3" Format="XML">0 1 2 0 1 3</DataItem>'
    '</Topology><Geometry GeometryType="XYZ"><DataItem Dimensions="4 3" Format="XML">0 0 0 1 0 0 0 1 0 0 0 1'
    "</DataItem></Geometry>{}</Grid>"
)


def xdmf(path: Path, inside: str) -> Path:
    pytest.importorskip("lxml", reason="needs the extra simulation")
    path.write_text(f"<Xdmf><Domain>{inside}</Domain></Xdmf>")
    return path


def test_references_that_double_are_refused(tmp_path):
    two = '<DataItem Reference="XML">/Xdmf/Domain/DataItem[@Name="d{}"]</DataItem>' * 2
    chain = "".join(
        f'<DataItem Name="d{n}">{two.format(n - 1, n - 1)}</DataItem>' for n in range(1, 40)
    )
    with pytest.raises(bsm.LimitError):
        bsm.read_mesh(xdmf(tmp_path / "a.xdmf", TABLE + chain + GRID.format("")))


@pytest.mark.parametrize(
    "path", ["//*[//*[//*[@q]]]", "//*[count(//*)=9]", "//Grid//*", "/Xdmf" * 200]
)
def test_paths_in_paths_are_refused(path, tmp_path):
    attribute = f'<Attribute Name="a"><DataItem Reference="XML">{path}</DataItem></Attribute>'
    with pytest.raises(bsm.FormatError, match="more than a path"):
        bsm.read_mesh(xdmf(tmp_path / "a.xdmf", GRID.format(attribute)))


@pytest.mark.parametrize(
    "path", ["/Xdmf/Domain/DataItem[@Name='d0']", '//Domain/*[@Name="d0"]', "//Domain/DataItem[1]"]
)
def test_a_path_to_one_element_is_followed(path, tmp_path):
    attribute = f'<Attribute Name="a"><DataItem Reference="XML">{path}</DataItem></Attribute>'
    found = bsm.read_mesh(xdmf(tmp_path / "a.xdmf", TABLE + GRID.format(attribute))).mesh
    assert found.attributes[0].values.ravel().tolist() == [1, 2, 3, 4]


def test_a_large_table_that_many_grids_name_is_charged_for_each(tmp_path):
    h5py = pytest.importorskip("h5py", reason="needs the extra simulation")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["d"] = np.zeros((100_000, 3))
    place = '<DataItem Dimensions="100000 3" Format="HDF">a.h5:/d</DataItem>'
    one = re.sub(r"(<Geometry[^>]*>).*(</Geometry>)", rf"\1{place}\2", GRID.format(""))
    many = f'<Grid GridType="Collection">{one * 400}</Grid>'
    with pytest.raises(bsm.LimitError):
        bsm.read_mesh(xdmf(tmp_path / "a.xdmf", many))
    assert len(bsm.read_mesh(xdmf(tmp_path / "a.xdmf", one)).mesh.faces) == 2


def test_times_are_counted_before_they_are_made(tmp_path):
    time = '<Time TimeType="HyperSlab"><DataItem Dimensions="3" Format="XML">0 1 1e14</DataItem></Time>'
    series = (
        f'<Grid GridType="Collection" CollectionType="Temporal">{time}{GRID.format("") * 2}</Grid>'
    )
    with pytest.raises(bsm.FormatError, match="100000000000000 times for 2 steps"):
        bsm.read_mesh(xdmf(tmp_path / "a.xdmf", series))
