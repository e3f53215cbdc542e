"""Evaluation: rates, exact solvers, Draco's order of vertices, results as JSON, and pictures from JSON."""

import importlib.util
import json
import math
import re

import numpy as np
import pytest

from bsm import CorruptError, EncodeOptions, MeshError, TriangleMesh, save
from bsm.cli import main
from bsm.codec.geometry.metrics import Reference
from bsm.evaluation.curve import (
    STYLES,
    Curve,
    Draco,
    Line,
    Spectral,
    bd_rate,
    compare_curves,
    distinct,
    draw_all,
    measure,
    our_curve,
    paper_curves,
    paper_options,
    points_of,
    rate_curve,
    rate_ratio,
    read_results,
    run_curve,
    table,
)
from bsm.ground.pictures import render, view_matrix
from tests.blocks import blocks_of
from tests.shapes import knot, patch, torus
from tools.laplacians import dense_laplacian
from tools.replicate.paper.compression import EXACT
from tools.vectors.meshes import shuffled

GEOMETRY_KEYS = (
    "bpv_geometry bpv_paper nmsve_db nmsve_paper_db theta_deg rms_relative max_error_relative"
)
POINT_KEYS = {*f"settings bytes bpv_total {GEOMETRY_KEYS} encode_seconds decode_seconds".split()}


def tiny_curve() -> Curve:
    codecs = (Spectral(paper_options(block_size=150, keep=keep)) for keep in (0.1, 0.3))
    return Curve("oi-r1", "OI, R", tuple(codecs))


class TestRates:
    def test_only_the_common_range_counts(self):
        # ln r = -d and ln r = -2 d: straight lines, which piecewise cubics reproduce. Over d in [-3, -1], the range of
        # both, the difference -2 d - (-d) = -d has the mean 2, so the rate is e^2 times as high.
        reference = rate_curve(np.exp([5.0, 4.0, 3.0, 1.0]), [-5.0, -4.0, -3.0, -1.0])
        tested = rate_curve(np.exp([6.0, 4.0, 2.0, 0.0]), [-3.0, -2.0, -1.0, 0.0])
        assert bd_rate(reference, tested) == pytest.approx(100 * (math.exp(2) - 1))

    def test_ranges_that_do_not_meet_have_no_rate(self):
        assert bd_rate(rate_curve([2, 1], [1, 2]), rate_curve([2, 1], [3, 4])) is None
        assert bd_rate(rate_curve([2, 1], [1, 2]), rate_curve([2], [1])) is None

    def test_ratio_at_one_distortion(self):
        reference, tested = rate_curve([8.0, 2.0], [1.0, 3.0]), rate_curve([2.0, 1.0], [2.0, 4.0])
        # Halfway in the logarithm of 8 and 2 lies 4.
        assert rate_ratio(reference, tested, 2.0) == pytest.approx(0.5)
        assert rate_ratio(reference, tested, 1.5) is None

    def test_points_that_others_beat_do_not_count(self):
        curve = rate_curve([4.0, 5.0, 2.0, 3.0], [1.0, 2.0, 3.0, 3.0])
        assert curve.distortions.tolist() == [1.0, 3.0]
        assert np.exp(curve.log_rates) == pytest.approx([4.0, 2.0])

    def test_theta_is_compared_on_a_logarithmic_scale(self):
        def result(name, rates, angles):
            points = [
                {"bpv_total": r, "theta_deg": a, "nmsve_db": None}
                for r, a in zip(rates, angles, strict=True)
            ]
            return {"codec": name, "mesh": {"name": "m"}, "points": points}

        # Each halving of theta costs two bits per octave: at 7 degrees both are straight lines in log rate, log theta.
        row = compare_curves(
            result("draco", [8, 4, 2], [3.5, 7, 14]), result("ours", [4, 2, 1], [3.5, 7, 14])
        )
        assert row["bytes_at_theta"] == {"7": pytest.approx(0.5), "10": pytest.approx(0.5)}
        assert row["bd_rate_percent"] == {"theta_deg": pytest.approx(-50), "nmsve_db": None}


class TestCodecs:
    @pytest.mark.parametrize("keep_order", [False, True])
    def test_ours_comes_back_in_the_original_order(self, keep_order):
        mesh = shuffled(torus())
        options = EncodeOptions(
            block_size=150, step=1e-4, keep=1.0, threads=1, keep_order=keep_order
        )
        point = measure(Spectral(options), mesh, Reference(mesh.positions, mesh.faces))
        assert point["max_error_relative"] < 0.01

    @pytest.mark.parametrize("position_bits", [5, 11])
    def test_draco_comes_back_in_the_original_order(self, position_bits):
        pytest.importorskip("DracoPy", reason="needs DracoPy (extra eval)")
        mesh = shuffled(torus())
        codec = Draco(position_bits, (7, 10))
        data, align = codec.encode(mesh)
        error = np.abs(align(codec.decode(data)) - mesh.positions)
        step = np.ptp(mesh.positions, axis=0).max() / (2**position_bits - 1)
        assert error.max() <= step / 2 + 1e-6

    def test_a_wrong_mesh_is_not_taken_for_what_draco_decoded(self):
        pytest.importorskip("DracoPy", reason="needs DracoPy (extra eval)")
        mesh = torus()
        data, align = Draco(11).encode(mesh)
        decoded = Draco(11).decode(data)
        flipped = TriangleMesh(decoded.positions, decoded.faces[:, ::-1])
        with pytest.raises(MeshError, match="different triangles"):
            align(flipped)

    def test_faces_without_area_stop_no_curve(self):
        """Copies of a vertex, as poles have them, with faces between them."""
        pytest.importorskip("DracoPy", reason="needs DracoPy (extra eval)")
        mesh = torus()
        copies = np.concatenate([mesh.positions, np.repeat(mesh.positions[:1], 2, axis=0)])
        flat = np.array([[0, len(copies) - 2, len(copies) - 1], [len(copies) - 1, 0, 1]])
        given = TriangleMesh(copies, np.concatenate([mesh.faces, flat]).astype(np.int32))
        result = run_curve(Curve("draco", "Draco", (Draco(11),)), given, "a")
        assert (
            result["mesh"]["faces"] == len(mesh.faces)
            and result["points"][0]["max_error_relative"] < 1e-3
        )


class TestResults:
    def test_schema(self):
        mesh = patch(20, 25)
        result = json.loads(json.dumps(run_curve(tiny_curve(), mesh, "patch"), allow_nan=False))
        assert set(result) == {"schema", "codec", "label", "mesh", "points"}
        assert result["mesh"] == {"name": "patch", "vertices": 500, "faces": len(mesh.faces)}
        for point in result["points"]:
            assert set(point) == POINT_KEYS
            sizes = point["bytes"]
            assert sum(size for name, size in sizes.items() if name != "total") == sizes["total"]
            assert point["bpv_total"] == 8 * sizes["total"] / 500
        coarse, fine = result["points"]
        assert coarse["bytes"]["total"] < fine["bytes"]["total"]
        assert coarse["nmsve_db"] > fine["nmsve_db"]

    def test_another_schema_is_refused(self, tmp_path):
        (tmp_path / "a.b.json").write_text('{"schema": 0}')
        with pytest.raises(CorruptError, match="schema 0"):
            list(read_results(tmp_path))


class TestPictures:
    @pytest.fixture
    def results(self):
        """Two lines on each of two meshes."""

        def point(bpv, db, theta, settings):
            numbers = {
                "bpv_total": bpv,
                "bpv_paper": bpv,
                "nmsve_db": db,
                "nmsve_paper_db": db,
                "theta_deg": theta,
            }
            return {"settings": settings, **numbers, "encode_seconds": bpv, "decode_seconds": bpv}

        asked = [{"target": {"kind": "theta_deg", "value": value}} for value in (9, 1)]
        lines = {
            "draco": [point(5, -50, 9, {}), point(8, None, 0.1, {})],
            "ours": [point(2, -50, 8.5, asked[0]), point(3, -60, 0.9, asked[1])],
            "svd": [point(4, -50, 9, {"bits": 12})],
        }
        return [
            {
                "codec": name,
                "label": name,
                "mesh": {"name": mesh, "vertices": 3, "faces": 1},
                "points": points,
            }
            for mesh in "mn"
            for name, points in lines.items()
        ]

    def test_drawn_from_json_alone_in_each_format(self, results, tmp_path):
        pytest.importorskip("matplotlib", reason="needs matplotlib (extra eval)")
        for picture in draw_all(results[:3]):
            for path in picture.save(tmp_path, ("png", "svg", "pdf")):
                start = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}[path.suffix]
                assert path.read_bytes().startswith(start)
        names = {
            f"{stem}.{suffix}"
            for stem in ("m.paper", "m.nmsve", "m.theta")
            for suffix in ("png", "svg", "pdf")
        }
        assert {path.name for path in tmp_path.iterdir()} == names
        exact = [
            {
                **found,
                "points": [
                    {**p, "nmsve_db": None, "nmsve_paper_db": None} for p in found["points"]
                ],
            }
            for found in results[:3]
        ]
        assert [picture.name for picture in draw_all(exact)] == ["m.theta"]

    def test_lines_of_the_paper_that_are_named_are_among_whole_files(self, results):
        figure = pytest.importorskip("matplotlib.figure", reason="needs matplotlib (extra eval)")
        other = {**results[2], "codec": "oi-r1", "label": "oi-r1"}
        for named, lines in (((), 2), (("oi-r1",), 3)):
            (picture,) = (p for p in draw_all([*results[:3], other], named) if p.name == "m.nmsve")
            picture.draw(drawn := figure.Figure())
            assert len(drawn.axes[0].lines) == lines

    def test_points_that_another_one_beats_are_counted(self, results):
        (point,) = results[2]["points"]
        worse = {**point, "bpv_total": 5, "nmsve_db": -49}
        assert (
            compare_curves(results[0], {**results[2], "points": [point, worse]})["beaten"][
                "nmsve_db"
            ]
            == 1
        )

    def test_lines_that_lie_on_each_other_are_drawn_once(self):
        points = [(1.0, -40.0), (2.0, -45.0)]
        moved = [(rate, error + 0.001) for rate, error in points]
        lines = {
            "oi-r1": Line("R", [(1.0, -39.0), (2.0, -44.0)]),
            "oi-r1-t2": Line("R twice", points),
        }
        kept = distinct({**lines, "oi-r2": Line("R²", moved), "svd": Line("SVD", points[:1])})
        assert list(kept) == ["oi-r1", "oi-r1-t2", "svd"] and kept["oi-r1-t2"] == Line(
            "R twice = R²", points
        )

    def test_the_exact_line_is_last(self):
        assert [curve.name for curve in paper_curves(150)][-2:] == ["doi-r1", "svd"]

    def test_several_meshes_share_a_figure_a_legend_and_colors(self, results):
        figure = pytest.importorskip("matplotlib.figure", reason="needs matplotlib (extra eval)")
        seen = {}
        for picture in draw_all(results):
            picture.draw(drawn := figure.Figure())
            assert all(
                (axes.get_xscale() == "log") != ("paper" in picture.name) for axes in drawn.axes
            )
            seen[picture.name] = [{line.get_color() for line in axes.lines} for axes in drawn.axes]
            for legend in drawn.legends:
                labels = [text.get_text() for text in legend.get_texts()]
                asked = ["ours, asked for 9 to 1°"] if "theta" in picture.name else []
                assert labels == (
                    ["svd (4 s)"] if "paper" in picture.name else [*asked, "draco", "svd"]
                )
        assert set(seen) == {"m.paper", "n.paper", "meshes.nmsve", "meshes.theta"}
        color = {name: STYLES[name][0] for name in ("ours", "draco", "svd")}
        assert seen["m.paper"] == seen["n.paper"] == [{color["svd"]}]
        assert seen["meshes.theta"] == [set(color.values())] * 2
        assert seen["meshes.nmsve"] == [{color["draco"], color["svd"]}] * 2, (
            "ours was asked for the other measure"
        )


class TestCommands:
    def test_our_curve_is_what_is_chosen_for_its_measure_and_goes_as_far_as_draco(self):
        mesh = patch(20, 25)
        curve = our_curve()
        kinds = {codec.options.target.kind: codec for codec in curve.codecs}
        found = {
            kind: json.loads(
                json.dumps(measure(codec, mesh, Reference(mesh.positions, mesh.faces)))
            )
            for kind, codec in kinds.items()
        }
        assert found["theta_deg"]["theta_deg"] <= 0.2 and found["nmsve_db"]["nmsve_db"] <= -68.0
        points = list(found.values())
        assert [points_of(points, kind) for kind in kinds] == [[point] for point in points]

    def test_our_curve_is_asked_for_the_errors_of_rivals(self):
        errors = [-30.0, -30.1, -33.0, -47.0]
        rival = {
            "points": [{"nmsve_db": level, "theta_deg": 10.0} for level in errors]
            + [{"nmsve_db": None}]
        }
        asked = {}
        for codec in our_curve([rival]).codecs:
            asked.setdefault(codec.options.target.kind, []).append(codec.options.target.value)
        assert asked["nmsve_db"] == [
            -30.0,
            -33.0,
            -40.0,
            -44.0,
            -47.0,
            -52.0,
            -56.0,
            -60.0,
            -64.0,
            -68.0,
        ]
        assert (
            10.0 in asked["theta_deg"]
            and 11.0 not in asked["theta_deg"]
            and 15.0 not in asked["theta_deg"]
        )
        assert asked["theta_deg"] == sorted(asked["theta_deg"], reverse=True)

    def test_each_point_of_a_rival_has_ours_beside_it(self, tmp_path, capsys):
        pytest.importorskip("matplotlib", reason="needs matplotlib (extra eval)")
        mesh, folder = tmp_path / "torus.npz", tmp_path / "out"
        save(torus(20, 20, bumps=0.02), mesh)
        (tmp_path / "mine.csv").write_text("label,bpv,nmsve_db\nmine,9,-41.3\nmine,12,-49.9\n")
        assert (
            main(
                [
                    "curve",
                    str(mesh),
                    "-o",
                    str(folder),
                    "--codecs",
                    "ours",
                    "-q",
                    "--points",
                    f"{tmp_path}/mine.csv",
                ]
            )
            == 0
        )
        found = {result["codec"]: result["points"] for result in read_results(folder)}
        reached = {
            point["settings"]["target"]["value"]: point["nmsve_db"]
            for point in points_of(found["ours"], "nmsve_db")
        }
        assert {-41.3, -49.9} <= reached.keys()
        assert all(level <= asked for asked, level in reached.items())
        assert "mine" in capsys.readouterr().out

    def test_curve(self, tmp_path, capsys):
        for name in ("matplotlib", "pymetis", "zstandard"):
            pytest.importorskip(name, reason=f"needs {name} (extra eval)")
        save(torus(20, 20), tmp_path / "torus.npz")
        folder = tmp_path / "out"
        words = [
            "curve",
            str(tmp_path / "torus.npz"),
            "-o",
            str(folder),
            "--codecs",
            "oi-r2,svd",
            "--blocks",
            "3",
        ]
        assert main([*words, "-q", "--csv", "--latex", "--pdf"]) == 0
        made = {
            f"torus.{end}"
            for end in ("oi-r2.json", "svd.json", "paper.png", "paper.svg", "paper.pdf")
        }
        assert {path.name for path in folder.iterdir()} == made | {"points.csv", "points.tex"}
        points = sum(len(result["points"]) for result in read_results(folder))
        assert len(capsys.readouterr().out.splitlines()) == 2 + points
        assert len((folder / "points.csv").read_text().splitlines()) == 1 + points

    def test_everything_that_is_missing_is_named_before_anything_is_measured(
        self, tmp_path, capsys, monkeypatch
    ):
        save(torus(20, 20), tmp_path / "torus.npz")
        find = importlib.util.find_spec
        gone = ("pymetis", "zstandard", "DracoPy")
        monkeypatch.setattr(
            importlib.util, "find_spec", lambda name: None if name in gone else find(name)
        )
        words = ["curve", str(tmp_path / "torus.npz"), "-o", str(tmp_path / "out")]
        assert main(words) != 0
        errors = capsys.readouterr().err
        assert all(name in errors for name in gone) and "eval" in errors
        assert not (tmp_path / "out").exists()

    def test_one_picture(self, tmp_path, capsys):
        pytest.importorskip("matplotlib", reason="needs matplotlib (extra eval)")
        pytest.importorskip("DracoPy", reason="needs DracoPy (extra eval)")
        mesh, picture = tmp_path / "torus.npz", tmp_path / "spot.PNG"
        save(torus(20, 20), mesh)
        words = ["curve", str(mesh), "-o", str(picture), "--codecs", "draco"]
        assert main(words) == 0
        assert picture.read_bytes().startswith(b"\x89PNG") and set(tmp_path.iterdir()) == {
            mesh,
            picture,
        }
        shown = capsys.readouterr()
        assert (
            re.search(r"^torus, Draco: about [0-9.]+ s$", shown.err, re.MULTILINE)
            and "|   draco" in shown.out
        )
        assert main(words) == 9 and "-f overwrites it" in capsys.readouterr().err
        assert main([*words, "-f", "-q"]) == 0 and not capsys.readouterr().err
        for wrong in (["-o", "a.json"], ["-o", "a.svg", "--csv"]):
            assert main([*words[:2], *wrong]) == 2
        assert main(["curve", "-o", "a.svg"]) == 2


def test_table():
    rows = [("x", "3"), ("yyy", "2 %")]
    assert table(("a", "b"), rows) == "| a   |   b |\n|:----|----:|\n| x   |   3 |\n| yyy | 2 % |"
    assert r"yyy & 2 \% \\" in table(("a", "b"), rows, "latex_booktabs")


def test_the_sample_is_a_closed_oriented_torus():
    mesh = knot(2000)
    directed = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    assert len(np.unique(directed, axis=0)) == len(directed)
    assert set(map(tuple, directed)) == set(map(tuple, directed[:, ::-1]))
    assert len(mesh.positions) - len(directed) // 2 + len(mesh.faces) == 0
    corners = mesh.positions[mesh.faces]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volume > 0, "the faces look outwards"


def test_the_nearest_face_is_drawn():
    far, near = [0, 0, 0], [0, 0, 1]
    positions = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]] * 2) + np.repeat(
        [far, near], 3, axis=0
    )
    faces = np.array([[0, 1, 2], [3, 4, 5]], np.int32)
    colors = np.array([[1.0, 0, 0], [0, 0, 1.0]])
    view = view_matrix(-90, 90)
    for order in ([0, 1], [1, 0]):
        image = render(positions, faces[order], 64, view=view, colors=colors[order])
        red, green, blue = image[40, 32]
        assert blue > 0.3
        assert red == green == 0
    assert image[0, 0] == pytest.approx([1, 1, 1])


@pytest.fixture(scope="module")
def block():
    return blocks_of(patch(14, 14)).block(0)


@pytest.mark.parametrize("name", EXACT)
def test_exact_solvers_span_the_lowest_eigenspace(name, block):
    """By Ky Fan: among orthonormal columns, they have the least trace."""
    laplacian = dense_laplacian(block)
    basis = EXACT[name](laplacian, 12)
    assert np.allclose(basis.T @ basis, np.eye(12), atol=1e-6)
    least = np.linalg.eigvalsh(laplacian)[:12].sum()
    assert np.einsum("ij,ij->", basis, laplacian @ basis) == pytest.approx(least, rel=1e-8)
