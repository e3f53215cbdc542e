"""bsm.show: what the widget of a notebook is given."""

import base64
import sys

import numpy as np
import pytest

import bsm
import bsm.ground.console
from bsm.viewer.page import embedded, script
from tests.shapes import torus

pytest.importorskip("anywidget")
MESH = torus()


def test_stream_is_shown_as_it_is():
    data = bsm.encode(MESH)
    widget = bsm.show(data, height=300)
    (layer,) = widget.content["layers"]
    assert (base64.b64decode(layer["data"]), widget.height, widget.content["name"]) == (
        data,
        300,
        "mesh",
    )
    assert "render" in widget._esm and str(widget._esm) == script(embedded)


def test_mesh_is_encoded_and_compared_with_itself():
    widget = bsm.show((MESH.positions, MESH.faces), theta=4)
    original, decoded = (
        bsm.decode(base64.b64decode(layer["data"])) for layer in widget.content["layers"][:2]
    )
    assert bsm.compare(MESH, decoded).theta_deg < 4
    assert widget.content["facts"]["angle"] == pytest.approx(bsm.compare(MESH, decoded).angle_deg)
    assert bsm.compare(MESH, original).max_error < 1e-6


def test_mesh_is_shown_without_scipy(monkeypatch):
    for name in [name for name in sys.modules if name.startswith("bsm.evaluation")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.delattr(bsm, "evaluation", raising=False)
    monkeypatch.setitem(sys.modules, "scipy", None)
    widget = bsm.show(MESH)
    assert [layer["title"] for layer in widget.content["layers"]] == ["Original", "BSM"]


def test_crease_angle_is_told_to_the_page():
    data = bsm.encode(MESH)
    assert '"creaseAngle": 30' in str(bsm.show(data, crease_angle=30)._esm)
    for angle in (-1, 181, float("nan")):
        with pytest.raises(bsm.OptionError, match="crease angle"):
            bsm.show(data, crease_angle=angle)


def test_sequence_is_encoded():
    positions = np.stack([MESH.positions, 1.1 * MESH.positions])
    widget = bsm.show((positions, MESH.faces), frame_rate=10)
    assert len(bsm.decode_sequence(base64.b64decode(widget.content["layers"][0]["data"]))[0]) == 2


def test_what_is_encoded_is_not_encoded_again():
    with pytest.raises(bsm.OptionError, match="theta"):
        bsm.show(bsm.encode(MESH), theta=3)


def test_missing_anywidget_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(bsm.DependencyError, match=r"pip install .*\[notebook\]"):
        bsm.show(bsm.encode(MESH))


HOSTILE = [
    "<img src=x onerror=alert(1)>",
    "</script><script>1</script>",
    "\x1b[2J",
    "a\nb",
    "`${1}`",
]


@pytest.mark.parametrize("name", HOSTILE)
def test_a_name_is_handed_over_as_text(name, tmp_path):
    """It is a value of the widget, never a part of its code; the page puts it into a node of text."""
    path = tmp_path / f"{name.replace(chr(47), chr(32))}.bsm"
    path.write_bytes(bsm.encode(MESH))
    widget = bsm.show(path)
    assert widget.content["name"] == path.name
    assert path.name not in str(widget._esm)


def test_a_damaged_stream_is_handed_to_the_page_but_not_compared():
    data = bsm.encode(MESH)
    with pytest.raises(bsm.BsmError):
        bsm.show(data[: len(data) // 2], original=MESH)


@pytest.mark.slow
def test_functions_show_progress_in_a_notebook(tmp_path):
    """A bar that is drawn while there is work and goes away; none outside of notebooks."""
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    cell = """
import bsm, bsm.ground.console
from bsm.evaluation.sample import knot

bsm.ground.console._PATIENCE = 0.0
bsm.encode(knot(20000), theta=3)
"""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell)])
    nbclient.NotebookClient(
        notebook, timeout=120, resources={"metadata": {"path": str(tmp_path)}}
    ).execute()
    text = "".join(
        output.get("text", "")
        for output in notebook.cells[0].outputs
        if output.get("name") == "stderr"
    )
    assert "encoding: " in text and text.endswith("\r")
    assert not bsm.ground.console.in_notebook()
