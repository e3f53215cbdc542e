"""Evaluation: rates against hand-computed cases, Draco's order of vertices, results as JSON, pictures from JSON."""

import json
import math

import numpy as np
import pytest

from bsm.bitstream.errors import CorruptError, MeshError
from bsm.cli import main
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.codec.static.options import EncodeOptions, changed
from bsm.evaluation.curve import (
    Curve,
    Draco,
    Spectral,
    bd_rate,
    compare_curves,
    measure,
    our_curve,
    paper_options,
    points_of,
    rate_curve,
    rate_ratio,
    read_results,
    run_curve,
    table,
    write_result,
)
from bsm.files.mesh import write_mesh
from tests.shapes import patch, torus

POINT_KEYS = {
    "settings",
    "bytes",
    "bpv_total",
    "bpv_geometry",
    "bpv_paper",
    "nmsve_db",
    "theta_deg",
    "rms_relative",
    "max_error_relative",
    "encode_seconds",
    "decode_seconds",
}


def tiny_curve() -> Curve:
    codecs = (Spectral(paper_options(block_size=150, keep=keep)) for keep in (0.1, 0.3))
    return Curve("oi-r1", "OI, R", tuple(codecs))


class TestRates:
    def test_half_the_rate_everywhere_is_minus_fifty_percent(self):
        quality = [-40.0, -45.0, -52.0, -60.0]
        reference = rate_curve([2.0, 4.0, 7.0, 12.0], quality)
        tested = rate_curve([1.0, 2.0, 3.5, 6.0], quality)
        assert bd_rate(reference, tested) == pytest.approx(-50.0)
        assert bd_rate(tested, reference) == pytest.approx(100.0)

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
            points = [{"bpv_total": r, "theta_deg": a, "nmsve_db": None} for r, a in zip(rates, angles, strict=True)]
            return {"codec": name, "mesh": {"name": "m"}, "points": points}

        # Each halving of theta costs two bits per octave: at 7 degrees both are straight lines in log rate, log theta.
        row = compare_curves(result("draco", [8, 4, 2], [3.5, 7, 14]), result("ours", [4, 2, 1], [3.5, 7, 14]))
        assert row["bytes_at_theta"] == {"7": pytest.approx(0.5), "10": pytest.approx(0.5)}
        assert row["bd_rate_percent"] == {"theta_deg": pytest.approx(-50), "nmsve_db": None}


class TestCodecs:
    @pytest.mark.parametrize("keep_order", [False, True])
    def test_ours_comes_back_in_the_original_order(self, keep_order):
        mesh = shuffled(torus())
        options = EncodeOptions(block_size=150, step=1e-4, keep=1.0, threads=1, keep_order=keep_order)
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

    def test_settings_tell_what_differs_from_the_defaults(self):
        step = EncodeOptions().first_step
        assert Spectral(changed(EncodeOptions(), power=4, threads=1)).settings == {
            "step": step,
            "power": 4,
            "threads": 1,
        }
        assert Spectral(changed(EncodeOptions(), bits=9)).settings == {"bits": 9}


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

    def test_isolated_vertices_are_left_out(self):
        mesh = patch(20, 25)
        padded = TriangleMesh(np.concatenate([mesh.positions, [[9.0, 9, 9]]]), mesh.faces)
        assert run_curve(tiny_curve(), padded, "patch")["mesh"]["vertices"] == 500

    def test_written_results_are_read_again(self, tmp_path):
        result = run_curve(tiny_curve(), patch(20, 25), "patch")
        assert write_result(result, tmp_path).name == "patch.oi-r1.json"
        assert list(read_results(tmp_path)) == [result]

    def test_another_schema_is_refused(self, tmp_path):
        (tmp_path / "a.b.json").write_text('{"schema": 0}')
        with pytest.raises(CorruptError, match="schema 0"):
            list(read_results(tmp_path))


class TestPictures:
    def test_drawn_from_json_alone(self, tmp_path):
        pytest.importorskip("matplotlib", reason="needs matplotlib (extra eval)")
        from bsm.evaluation.curve import draw_all

        def point(bpv, db, theta, settings):
            numbers = {"bpv_total": bpv, "bpv_paper": bpv, "nmsve_db": db, "theta_deg": theta, "decode_seconds": bpv}
            return {"settings": settings, **numbers}

        mesh = {"name": "m", "vertices": 3, "faces": 1}
        curves = [
            {"codec": "svd", "label": "SVD", "mesh": mesh, "points": [point(4, -50, 9, {"bits": 12})]},
            {
                "codec": "draco",
                "label": "Draco",
                "mesh": mesh,
                "points": [point(5, -50, 9, {}), point(8, None, 0.1, {})],
            },
        ]
        written = draw_all(curves, tmp_path)
        names = {f"{stem}.{suffix}" for stem in ("m.paper", "m.nmsve", "m.theta") for suffix in ("png", "svg")}
        assert {path.name for path in written} == names
        for path in written:
            start = path.read_bytes()[:200]
            assert start.startswith(b"\x89PNG") if path.suffix == ".png" else b"<?xml" in start


class TestCommands:
    def test_our_curve_is_what_is_chosen_for_its_measure_and_goes_as_far_as_draco(self):
        mesh = patch(20, 25)
        curve = our_curve(fine=True)
        kinds = {codec.options.target.kind: codec for codec in curve.codecs}
        found = {
            kind: json.loads(json.dumps(measure(codec, mesh, Reference(mesh.positions, mesh.faces))))
            for kind, codec in kinds.items()
        }
        assert found["theta_deg"]["theta_deg"] <= 0.2 and found["nmsve_db"]["nmsve_db"] <= -68.0
        points = list(found.values())
        assert [points_of(points, kind) for kind in kinds] == [[point] for point in points]

    def test_curve(self, tmp_path, capsys):
        write_mesh(tmp_path / "torus.npz", torus(20, 20))
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
            "-q",
        ]
        assert main(words) == 0
        assert {path.name for path in folder.glob("*.json")} == {"torus.oi-r2.json", "torus.svd.json"}
        printed = capsys.readouterr().out.splitlines()
        assert len(printed) == 2 + sum(len(result["points"]) for result in read_results(folder))

    def test_curve_knows_its_codecs(self, tmp_path, capsys):
        write_mesh(tmp_path / "torus.npz", torus(20, 20))
        assert main(["curve", str(tmp_path / "torus.npz"), "-o", str(tmp_path), "--codecs", "mp3"]) == 2
        assert "no codec is called mp3" in capsys.readouterr().err


def test_table():
    assert table(("a", "b"), [("x", "3"), ("yyy", "2")]) == "| a   |  b |\n| --- | -: |\n| x   |  3 |\n| yyy |  2 |"


def shuffled(mesh: TriangleMesh) -> TriangleMesh:
    """The same surface with its vertices and faces in another order."""
    random = np.random.default_rng(3)
    order = random.permutation(len(mesh.positions))
    return TriangleMesh(mesh.positions[order], random.permutation(np.argsort(order)[mesh.faces]))
