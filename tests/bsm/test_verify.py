"""Whether all of it is there: streams, the images that they link to, and the outputs that a report names."""

import csv
import json
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm.cli import main
from tests.shapes import torus

MISSING, DAMAGED = 9, 4


@pytest.fixture
def archive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two encoded meshes that share an image, and the report of their run."""
    pillow = pytest.importorskip("PIL.Image")
    monkeypatch.chdir(tmp_path)
    source = tmp_path / "source"
    source.mkdir()
    mesh = torus(8, 6)
    texcoords = bsm.Attribute("texcoord", np.float32(mesh.positions[:, :2]), "vertex", "texcoord")
    textured = bsm.TriangleMesh(mesh.positions, mesh.faces, (texcoords,))
    for name in ("a.obj", "b.obj"):
        bsm.save(textured, source / name)
        lines = (source / name).read_text().replace("\nf ", "\nusemtl m\nf ", 1)
        (source / name).write_text(f"mtllib k.mtl\n{lines}")
    (source / "k.mtl").write_text("newmtl m\nmap_Kd k.png\n")
    noise = np.random.default_rng(1).integers(0, 256, (64, 64, 3)).astype(np.uint8)
    pillow.fromarray(noise).save(source / "k.png")
    assert main(["encode", "-q", "-r", "source", "-o", "streams", "--report", "run.json"]) == 0
    return tmp_path


def image_of(archive: Path) -> Path:
    (image,) = (archive / "streams" / "images").iterdir()
    return image


def damage(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 255
    path.write_bytes(data)


CHECKS = (["-r", "streams"], ["streams/a.bsm"], ["run.json"], ["--quick", "streams/a.bsm"])


@pytest.mark.parametrize("words", CHECKS)
def test_all_is_there(archive: Path, words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", *words]) == 0
    assert "whole" in capsys.readouterr().err


@pytest.mark.parametrize("words", CHECKS)
def test_a_missing_image_is_told_from_a_damaged_one(
    archive: Path, words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    image = image_of(archive)
    damage(image)
    assert main(["verify", *words]) == DAMAGED
    assert f"{image.name} is damaged" in capsys.readouterr().err
    image.unlink()
    assert main(["verify", *words]) == MISSING
    assert image.name in (answer := capsys.readouterr().err) and "missing" in answer


def test_decode_info_and_load_use_the_same_words(
    archive: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    image = image_of(archive)
    damage(image)
    assert main(["decode", "streams/a.bsm", "-o", "a.glb"]) == 0
    assert f"the image images/{image.name}, which is damaged" in capsys.readouterr().err
    assert main(["info", "streams/a.bsm"]) == 0
    assert f"the image images/{image.name} is damaged" in capsys.readouterr().out
    with pytest.warns(bsm.BsmWarning, match="which is damaged"):
        bsm.load("streams/a.bsm")


def test_a_report_finds_missing_and_damaged_outputs(
    archive: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("streams/a.bsm").unlink()
    assert main(["verify", "run.json"]) == MISSING
    assert "streams/a.bsm: the output is missing" in capsys.readouterr().err
    damage(archive / "streams" / "b.bsm")
    assert main(["verify", "run.json"]) == MISSING, "the code of the first fault"
    answer = capsys.readouterr().err
    assert "1 missing, 1 damaged" in answer and "its SHA-256 is not that of the report" in answer


def test_a_report_that_moved_with_its_folder_finds_its_outputs(
    archive: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("run.json").rename("streams/run.json")
    Path("streams").rename("moved")
    monkeypatch.chdir("/")
    assert main(["verify", "--json", str(archive / "moved" / "run.json")]) == 0
    files = json.loads(capsys.readouterr().out)["files"]
    assert files == [{"output": f"streams/{name}.bsm", "state": "whole"} for name in "ab"]
    # Below a folder, the report of its run is found among the streams.
    (archive / "moved" / "b.bsm").unlink()
    assert main(["verify", "-r", str(archive / "moved")]) == MISSING


def test_inputs_that_failed_are_not_there(
    archive: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("source/c.obj").write_text("nonsense")
    assert (
        main(["encode", "-q", "-f", "-r", "source", "-o", "streams", "--report", "run.json"]) == 3
    )
    capsys.readouterr()
    assert main(["verify", "run.json"]) == MISSING
    assert "streams/c.bsm: it was not written" in capsys.readouterr().err


def test_other_json_files_are_no_reports(archive: Path) -> None:
    Path("other.json").write_text('{"a": 1}')
    assert main(["verify", "other.json"]) == 3
    Path("streams/other.json").write_text('{"a": 1}')
    assert main(["verify", "-r", "streams"]) == 0
    Path("broken.json").write_text('{"command": "encode", "files": [{"input": 3}]}')
    assert main(["verify", "broken.json"]) == 3


@pytest.mark.parametrize(
    "words",
    [
        ["encode", "-f", "-q", "-r", "source", "-o", "streams"],
        ["compare", "-r", "source", "streams"],
    ],
)
def test_reports_have_the_format_of_their_suffix(archive: Path, words: list[str]) -> None:
    for kind in ("json", "csv", "html"):
        assert main([*words, "--report", f"out.{kind}"]) == 0
    names = {"source/a.obj", "source/b.obj"}
    assert {
        result["input"] for result in json.loads(Path("out.json").read_text())["files"]
    } == names
    with Path("out.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["input"] for row in rows} == names
    assert all(float(row["max_error_relative"]) > 0 for row in rows)
    page = PageText()
    page.feed(Path("out.html").read_text(encoding="utf-8"))
    assert page.images == 2 and names <= set(page.words)
    assert main([*words, "--report", "out.xml"]) == 2


def test_a_page_of_results_lists_failures_first_and_writes_names_as_text(archive: Path) -> None:
    Path("source/<b>.obj").write_text("nonsense")
    assert (
        main(["encode", "-f", "-q", "-r", "source", "-o", "streams", "--report", "out.html"]) == 3
    )
    page = PageText()
    page.feed(Path("out.html").read_text(encoding="utf-8"))
    rows = [word for word in page.words if word.startswith("source/") and word.endswith(".obj")]
    assert rows == ["source/<b>.obj", "source/a.obj", "source/b.obj"]


def test_a_table_of_results_has_no_formulas(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    bsm.save(torus(8, 6), "=1+1.ply")
    assert main(["encode", "-q", "=1+1.ply", "--report", "out.csv"]) == 0
    assert Path("out.csv").read_text().splitlines()[1].startswith("'=1+1.ply,")


def test_a_report_that_is_no_json_cannot_be_resumed(archive: Path) -> None:
    assert (
        main(["encode", "-q", "-r", "source", "-o", "streams", "--report", "run.csv", "--resume"])
        == 2
    )


def test_a_folder_of_streams_is_a_page(archive: Path) -> None:
    assert main(["view", "streams", "--save", "out.html"]) == 0
    page = PageText()
    page.feed(Path("out.html").read_text(encoding="utf-8"))
    assert page.images == 2 and {"streams/a.bsm", "streams/b.bsm"} <= set(page.words)


class PageText(HTMLParser):
    """The texts and the number of pictures of a page, as a parser of HTML finds them."""

    def __init__(self) -> None:
        super().__init__()
        self.words: list[str] = []
        self.images = 0

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.images += tag == "img"

    def handle_data(self, data: str) -> None:
        self.words.append(data)
