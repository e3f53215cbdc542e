"""Errors of usage and their messages; completion."""

import json
import re
import shutil
import subprocess

import numpy as np
import pytest

from bsm import PRESETS, __version__
from bsm.cli import COMMANDS, main, program_parser
from bsm.commands.flags import PROMISES
from bsm.files.mesh import write_mesh
from tests.bsm.test_batch import bsm
from tests.shapes import torus


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["enc"], "bsm: unknown command enc; did you mean encode?"),
        (["encdoe"], "bsm: unknown command encdoe; did you mean encode?"),
        (["quux"], "bsm: unknown command quux"),
        (["encode", "a.ply", "--tehta", "5"], "bsm encode: unknown option --tehta; did you mean --theta?"),
        (["encode", "a.ply", "--qick"], "bsm encode: unknown option --qick; did you mean --quick?"),
        (["encode", "--theta", "x", "a.ply"], "bsm encode: argument --theta: invalid float value: 'x'"),
        (
            ["encode", "--preset", "fien", "a.ply"],
            "bsm encode: argument --preset: unknown value fien; did you mean fine? (small, balanced, fine, "
            "near-lossless, grid14, lossless, none)",
        ),
        (["encode"], "bsm encode: the following arguments are required: IN"),
        (["encode", "a.ply", "-j", "-3"], "bsm encode: argument -j/--jobs: -3 is less than 0"),
        (["tile", "a.ply", "-o", "b", "-j", "x"], "bsm tile: argument -j/--jobs: invalid whole_number value: 'x'"),
        (["view", "--port", "99999"], "bsm view: argument --port: 99999 is more than 65535"),
        (["view", "--port", "-1"], "bsm view: argument --port: -1 is less than 0"),
        (["demo", "--vertices", "-1"], "bsm demo: argument --vertices: -1 is less than 1"),
        (["bench", "a.ply", "--sample", "0"], "bsm bench: argument --sample: 0 is less than 1"),
        (["bench", "a.ply", "--repeat", "0"], "bsm bench: argument --repeat: 0 is less than 1"),
        (["curve", "-o", "a", "--blocks", "0"], "bsm curve: argument --blocks: 0 is less than 1"),
        (["curve", "-o", "a", "--repeat", "0"], "bsm curve: argument --repeat: 0 is less than 1"),
        (["compare", "a", "b", "c"], "bsm compare: c: one input too many"),
    ],
)
def test_wrong_words(words, message, capsys):
    with pytest.raises(SystemExit) as stop:
        main(words)
    assert stop.value.code == 2
    first, usage = capsys.readouterr().err.splitlines()
    assert first == message
    assert usage.startswith("usage: bsm") and "--help" in usage


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_a_command_is_that_of_its_flag(command, capsys):
    shown = []
    for words in (["help", command], [command, "--help"]):
        with pytest.raises(SystemExit) as stop:
            main(words)
        assert stop.value.code == 0
        shown.append(capsys.readouterr().out)
    assert shown[0] == shown[1] and shown[0].startswith(f"usage: bsm {command}")


def test_targets_go_by_the_name_of_their_flag(tmp_path, capsys):
    write_mesh(tmp_path / "a.ply", torus(5, 5))
    assert main(["encode", str(tmp_path / "a.ply"), "--theta", "0"]) == 2
    assert "mean angle 0 degrees cannot be a target" in capsys.readouterr().err


def test_a_pipe_needs_a_format(capsys):
    assert main(["denoise", "-", "-o", "-"]) == 2
    assert "--format" in capsys.readouterr().err


def test_no_words_are_wrong_usage(capsys):
    assert main([]) == 2
    assert "COMMAND" in capsys.readouterr().err


def test_the_version():
    done = bsm("--version")
    assert (done.returncode, done.stdout) == (0, f"bsm {__version__}\n")


def test_options_between_inputs(tmp_path, capsys):
    words = ["verify", str(tmp_path / "a"), "--quick", str(tmp_path / "b")]
    assert main(words) == 9
    assert capsys.readouterr().err.count("No such file") == 2
    assert main(["verify", "--", "-a"]) == 9
    assert capsys.readouterr().err == "bsm: -a: No such file or directory\n"


def test_points_may_begin_with_a_minus(tmp_path):
    write_mesh(tmp_path / "a.ply", torus())
    words = ["encode", str(tmp_path / "a.ply"), "--grid-cell", "0.01", "--grid-origin", "-1,-.5,-1e-3"]
    assert main(words) == 0


def test_compare_says_which_file_is_wrong(tmp_path, capsys):
    (tmp_path / "a.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    (tmp_path / "b.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    for words in (["a.off", "b.off"], ["b.off", "a.off"]):
        assert main(["compare", *(str(tmp_path / word) for word in words)]) == 3
        assert capsys.readouterr().err.startswith(f"bsm: {tmp_path / 'b.off'}: a face refers to vertex 7")


def test_a_target_out_of_reach_has_its_code(tmp_path, capsys):
    write_mesh(tmp_path / "a.npz", torus(9, 6))
    theta, size = ("cannot be kept", "the best possible is normal error"), ("20 bytes at most cannot be", "takes")
    for words, parts in ((["--theta", "1e-9"], theta), (["--size", "20"], size)):
        assert main(["encode", str(tmp_path / "a.npz"), "-o", str(tmp_path / "b.bsm"), *words]) == 10
        error = capsys.readouterr().err
        assert all(part in error for part in parts) and "inf" not in error, error
        assert not (tmp_path / "b.bsm").exists()


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_knows_commands_and_options(shell, capsys):
    pytest.importorskip("shtab")
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert all(name in script for name in COMMANDS) and "keep-order" in script
    if shutil.which(shell):
        subprocess.run([shell, "-n"], input=script.encode(), timeout=60, check=True)


def test_bash_completes(tmp_path):
    pytest.importorskip("shtab")
    script = bsm("completion", "bash").stdout + (
        "\nCOMP_WORDS=(bsm encode --the); COMP_CWORD=2; _shtab_bsm bsm --the encode; echo ${COMPREPLY[@]}\n"
    )
    done = subprocess.run(["bash"], input=script, capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout.split() == ["--theta"]


def test_every_command_says_what_it_takes_for_files():
    files = [action.dest for action in program_parser(complete=True).file_arguments()]
    assert {"inputs", "output", "original", "decoded", "permutation"} <= set(files)


def test_help_says_what_presets_promise():
    rows = dict(re.findall(r"^([\w-]+) {2,}(.+)$", PROMISES, flags=re.MULTILINE))
    for name, options in PRESETS.items():
        row = rows[name]
        if options.grid is not None:
            assert f"{options.grid} bits" in row
        elif options.exact:
            assert "single precision" in row
        elif options.contract is None:
            assert "only the bounds and targets" in row
        else:
            look = f"{options.contract.look:g}" if np.isfinite(options.contract.look) else "any"
            assert row.split()[:3] == [look, f"{100 * options.contract.farthest:g}", "%"]
            assert ("whole mesh" in row) == (options.contract.by_part > options.contract.farthest)


@pytest.mark.parametrize("words", [["--max-error", "1%"], ["--nmsve-db", "-40"]])
def test_a_bound_alone_reports_what_is_visible(words, tmp_path, capsys):
    write_mesh(tmp_path / "a.npz", torus(40, 24))
    command = ["encode", str(tmp_path / "a.npz"), "-f", "-o", str(tmp_path / "b.bsm"), *words]
    assert main([*command, "--preset", "none"]) == 0
    assert "no look is promised; measured: look " in capsys.readouterr().err
    assert main(command) == 0
    assert "no look is promised" not in capsys.readouterr().err


def test_a_dry_run_reports_and_writes_nothing(tmp_path, capsys):
    write_mesh(tmp_path / "a.npz", torus(9, 6))
    assert main(["encode", str(tmp_path / "a.npz"), "-r", str(tmp_path), "--dry-run"]) == 2
    assert main(["encode", str(tmp_path / "a.npz"), "--dry-run", "-o", str(tmp_path / "new/")]) == 0
    assert main(["encode", "-r", str(tmp_path), "--dry-run", "--json"]) == 0
    shown = capsys.readouterr()
    assert "look 0." in shown.err and "0 of" not in shown.err and "of 1" in shown.err
    assert json.loads(shown.out)["bytes"] > 100
    assert main(["encode", str(tmp_path / "a.npz"), "--dry-run", "--report", str(tmp_path / "r.json")]) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["a.npz"]


@pytest.mark.parametrize(
    ("words", "code", "advice"),
    [
        (("--effort", "bst"), 2, "unknown value bst; did you mean best?"),
        (("--set", "partition=mtis"), 2, "unknown value 'mtis' of partition; did you mean metis?"),
        (("--preset", "fin"), 2, "did you mean fine?"),
        (("--size", "300"), 10, "preset none reaches it with look "),
    ],
)
def test_errors_name_the_way_out(tmp_path, capsys, words, code, advice):
    write_mesh(tmp_path / "a.npz", torus(30, 20))
    try:
        found = main(["encode", str(tmp_path / "a.npz"), "--dry-run", *words])
    except SystemExit as error:
        found = error.code
    assert found == code and advice in capsys.readouterr().err


def test_missing_folders_are_named(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("none/", "none/a.ply"):
        assert main(["encode", name]) == 9
        assert capsys.readouterr().err == f"bsm: {name}: the folder none does not exist\n"
    assert main(["encode", "-r", "none"]) == 2
    assert "none: not a local folder" in capsys.readouterr().err
