"""The command line: words that a user types, and their results."""

import subprocess
import sys
from dataclasses import MISSING, fields
from pathlib import Path

import numpy as np
import pytest

from bsm import read_mesh, save
from bsm.cli import COMMANDS, main
from bsm.commands.flags import FLAGS
from bsm.ground.exits import EXITS
from tests.bsm.program import ROOT, bsm, process, python, run_json
from tests.shapes import knot, torus

SMALL = ["--set", "block-size=150", "--threads", "1", "--set", "step=0.004"]


@pytest.fixture(scope="module")
def mesh():
    return knot(900)


@pytest.fixture(scope="module")
def folder(tmp_path_factory, mesh):
    """A folder with sample.ply and its stream."""
    folder = tmp_path_factory.mktemp("cli")
    save(mesh, folder / "sample.ply")
    assert (
        main(
            [
                "encode",
                str(folder / "sample.ply"),
                "-q",
                "--permutation",
                str(folder / "order.npy"),
                *SMALL,
            ]
        )
        == 0
    )
    return folder


# ------------------------------------------------------------------------------------------------------- round trips


def test_encode_and_decode_name_their_outputs(folder, tmp_path, capsys):
    source = tmp_path / "mesh.ply"
    source.write_bytes((folder / "sample.ply").read_bytes())
    assert main(["encode", str(source), *SMALL]) == 0
    output = capsys.readouterr()
    assert output.out == ""
    assert "mesh.bsm" in output.err and "bits per vertex" in output.err
    source.unlink()
    assert main(["decode", str(tmp_path / "mesh.bsm"), "-q"]) == 0
    assert capsys.readouterr() == ("", "")
    assert {path.name for path in tmp_path.iterdir()} == {"mesh.bsm", "mesh.ply"}
    assert main(["compare", str(folder / "sample.ply"), str(source), "-q"]) == 0
    assert "theta_deg" in capsys.readouterr().out


def test_info_adds_up(folder, capsys, mesh):
    info = run_json("info", folder / "sample.bsm")
    assert (info["vertices"], info["faces"]) == (len(mesh.positions), len(mesh.faces))
    assert len(info["coefficients"]) == info["blocks"] > 1
    sizes = info["bytes"]
    total = sizes.pop("total")
    assert sizes["coefficients"] == sum(info["positions"].values())
    assert total == (folder / "sample.bsm").stat().st_size == sum(sizes.values())
    assert all(size >= 0 for size in sizes.values())
    assert info["bpv_total"] == pytest.approx(8 * total / info["vertices"])
    assert main(["info", str(folder / "sample.bsm")]) == 0
    assert f"{info['vertices']} vertices" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "expected", "absent"),
    [
        (["--grid", "8"], "positions on a grid of ", "blocks"),
        (["--grid", "8"], "\n    grid  ", "levels of"),
        (["--quick"], "positions on a grid of ", "blocks"),
        (["--set", "step=0.004"], " blocks of ", "paper"),
        (["--set", "step=0.004"], "\n    blocks  ", "grid"),
        (["--set", "bits=12"], " by the paper's formula\n", "refinement"),
        (
            ["--preset", "paper"],
            "\npreset paper: R^2, iterations 1, 12 bits a coefficient, METIS",
            "refinement",
        ),
    ],
)
def test_info_tells_how_positions_are_coded(folder, tmp_path, capsys, options, expected, absent):
    assert (
        main(["encode", str(folder / "sample.ply"), "-q", "-o", str(tmp_path / "a.bsm"), *options])
        == 0
    )
    assert main(["info", str(tmp_path / "a.bsm")]) == 0
    text = capsys.readouterr().out
    assert expected in text and absent not in text


def test_compare_takes_streams_files_and_permutations(folder, tmp_path, mesh):
    stream = run_json("compare", folder / "sample.ply", folder / "sample.bsm")
    main(["decode", str(folder / "sample.bsm"), "-q", "-o", str(tmp_path / "a.npz")])
    file = run_json("compare", folder / "sample.ply", tmp_path / "a.npz")
    assert file == stream
    order = ["--permutation", str(folder / "order.npy")]
    assert run_json("compare", folder / "sample.ply", folder / "sample.bsm", *order) == stream
    main(["decode", str(folder / "sample.bsm"), "-q", "-o", str(tmp_path / "b.npz"), *order])
    ordered = read_mesh(tmp_path / "b.npz").mesh
    distance = np.linalg.norm(ordered.positions - mesh.positions, axis=1)
    assert distance.max() == pytest.approx(stream["max_error"], rel=1e-5)
    assert stream["max_error_relative"] < 0.05
    same = run_json("compare", folder / "sample.ply", folder / "sample.ply")
    assert same["rms"] == same["theta_deg"] == 0
    assert same["nmsve_db"] is None


def test_some_blocks_are_a_part_of_the_mesh(folder, tmp_path):
    blocks = run_json("info", folder / "sample.bsm")["blocks"]
    whole = run_json("decode", folder / "sample.bsm", "-o", tmp_path / "all.ply")
    faces = [
        run_json(
            "decode", folder / "sample.bsm", "-o", tmp_path / f"{count}.ply", "--blocks", count
        )["faces"]
        for count in range(1, blocks + 2)
    ]
    assert faces == sorted(faces)
    assert 0 < faces[0] < faces[blocks - 1] == faces[blocks] == whole["faces"]


def test_some_blocks_of_a_stream_that_is_cut_short(folder, tmp_path):
    data = (folder / "sample.bsm").read_bytes()
    cut = tmp_path / "cut.bsm"
    cut.write_bytes(data[: len(data) - 40])
    assert main(["decode", str(cut), "-q"]) == 12
    assert main(["decode", str(cut), "-q", "--blocks", "2"]) == 0
    assert main(["decode", str(cut), "-q", "-f", "--blocks", "1000"]) == 12


def test_pipes(folder, mesh):
    encoded = process("encode", "-", "-q", *SMALL, input=(folder / "sample.ply").read_bytes())
    assert (encoded.returncode, encoded.stderr) == (0, b"")
    assert encoded.stdout == (folder / "sample.bsm").read_bytes()
    decoded = process("decode", "-", "--format", "obj", input=encoded.stdout)
    assert decoded.returncode == 0
    assert decoded.stdout.count(b"\nf ") == len(mesh.faces)
    assert b"[" not in decoded.stderr, "no progress bar without a terminal"


def test_the_demo_draws_a_picture_without_a_library(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    folder = tmp_path / "new" / "folder"
    result = run_json("demo", "-o", folder, "--vertices", "900")
    assert {Path(path).name for path in result["written"]} == {"bsm_demo.bsm", "bsm_demo.png"}
    assert (folder / "bsm_demo.png").read_bytes().startswith(b"\x89PNG")
    assert main(["verify", str(folder / "bsm_demo.bsm"), "-q"]) == 0
    assert result["bytes"] == (folder / "bsm_demo.bsm").stat().st_size


def test_what_is_left_of_a_damaged_stream_is_written(tmp_path, capsys):
    save(torus(30, 30), tmp_path / "whole.ply")
    whole = tmp_path / "whole.bsm"
    main(["encode", str(tmp_path / "whole.ply"), "-q", *SMALL, "--set", "key_interval=1"])
    data = bytearray(whole.read_bytes())
    data[-60] ^= 0xFF
    broken, output = tmp_path / "broken.bsm", tmp_path / "left.ply"
    broken.write_bytes(data)
    assert main(["decode", str(broken), "-o", str(output)]) == 4
    assert not output.exists()
    capsys.readouterr()
    assert main(["decode", str(broken), "-o", str(output), "--tolerant"]) == 0
    assert "lost: " in capsys.readouterr().err
    assert 100 < len(read_mesh(str(output)).mesh.faces) < 1800


# ------------------------------------------------------------------------------------------------------ what goes wrong


def test_an_interrupt_that_something_wrapped_is_an_interrupt(monkeypatch, capsys):
    def wrapped(*_):
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt:
            raise RuntimeError("while compiling")  # noqa: B904

    monkeypatch.setattr("bsm.commands.info.run", wrapped)
    assert main(["info", "some.bsm"]) == 130
    assert capsys.readouterr().err == "bsm: interrupted\n"


def test_a_missing_package_has_its_code(folder, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "collada", None)
    (tmp_path / "a.dae").write_bytes(b"<COLLADA/>")
    assert main(["compare", str(tmp_path / "a.dae"), str(folder / "sample.bsm")]) == 8
    assert "pip install" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["denoise", "sample.ply"], ["demo"]])
def test_scipy_is_asked_for_where_it_is_needed(words, folder, tmp_path):
    hidden = "import sys; sys.modules['scipy'] = None; from bsm.__main__ import run; run()"
    words = [str(folder / word) if word == "sample.ply" else word for word in words]
    done = python("-c", hidden, *words, "-o", tmp_path / "out.ply", text=True)
    assert done.returncode == 8 and "pip install " in done.stderr and done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        ("info {stream} >&-", 0, b""),
        ("encode - -o {new} <&-", 9, b"bsm: standard input is closed\n"),
        ("decode {stream} --format ply -o - >&-", 9, b"standard output is closed\n"),
        ("encode {mesh} -q -o {new} <&- >&-", 0, b""),
    ],
)
def test_what_the_shell_has_closed(folder, tmp_path, words, code, message):
    places = {
        "stream": folder / "sample.bsm",
        "mesh": folder / "sample.ply",
        "new": tmp_path / "a.bsm",
    }
    command = f"'{sys.executable}' -m bsm {words.format(**places)}"
    done = subprocess.run(
        ["bash", "-c", command], capture_output=True, timeout=120, check=False, cwd=ROOT
    )
    assert (done.returncode, done.stderr.count(b"\n")) == (code, message.count(b"\n"))
    assert done.stderr.endswith(message)


# ---------------------------------------------------------------------------------------------------------------- help


def test_the_help_prints_the_table_of_codes_and_starts_fast(folder):
    done = bsm("--help")
    assert done.returncode == 0
    text = done.stdout.decode()
    assert all(f"{row.code:>3}  {row.meaning}" in text for row in EXITS)
    assert all(f"    {name}" in text for name in COMMANDS)
    program = "import sys; from bsm.cli import main; main(['info', sys.argv[1]]); sys.exit('codec' in sys.modules)"
    assert python("-c", program, folder / "sample.bsm").returncode == 0, (
        "bsm info needs no mathematics"
    )


def test_the_flags_are_fields_and_show_their_defaults():
    from bsm import EncodeOptions, Paper, SequenceOptions

    # A field of both has the static default: it is the one that is shown.
    owners = (SequenceOptions, EncodeOptions, Paper)
    defaults = {field.name: field.default for owner in owners for field in fields(owner)}
    assert all(
        defaults[flag.field] is not MISSING for flag in (*FLAGS["coding"], *FLAGS["settings"])
    )
    for flag in (*FLAGS["coding"], *FLAGS["settings"]):
        default = defaults[flag.field]
        shown = flag.help.partition("(default")[2]
        if isinstance(default, bool):
            assert not default or "yes" in shown
        elif default is not None:
            assert f"{default}" in shown, flag.field


@pytest.mark.parametrize(
    "words",
    [
        *(
            ("encode", "a.ply", "-o", ""),
            ("encode", ""),
            ("encode", "a.ply", ""),
            ("decode", "", "-o", "b.ply"),
        ),
        *(
            ("info", ""),
            ("glb", "a.glb", "-o", ""),
            ("tile", "a.ply", "-o", ""),
            ("compare", "", "a.ply"),
        ),
        *(
            ("encode", "a.ply", "--report", ""),
            ("view", "a.ply", "--save", ""),
            ("denoise", "a.ply", "-o", ""),
        ),
    ],
)
def test_an_empty_name_is_an_error(words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    save(torus(8, 6), tmp_path / "a.ply")
    before = sorted(tmp_path.iterdir())
    done = bsm(*words, text=True)
    assert done.returncode == 2 and "is empty; name a file" in done.stderr, done.stderr
    assert sorted(tmp_path.iterdir()) == before
