"""What people see first: help, completion, names, sizes and lengths in words, maps and curves."""

import argparse
import inspect
import json
import re
import subprocess
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import PRESETS, __version__
from bsm.cli import COMMANDS, command_parser, main
from bsm.commands.flags import PROMISES
from bsm.ground.lengths import (
    IN_METRES,
    UNITS,
    Length,
    UnitError,
    in_own_unit,
    known_unit,
    parse_bytes,
    parse_length,
    unit_named,
)
from tests.bsm.test_batch import bsm as program
from tests.shapes import torus
from tests.streams import events_of
from tools.preset_tables import DOCUMENTS, with_table

ROOT = Path(__file__).parents[2]
SHARE = ROOT / "share"


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_a_command_is_that_of_its_flag(command, capsys):
    shown = []
    for words in (["help", command], [command, "--help"]):
        with pytest.raises(SystemExit) as stop:
            main(words)
        assert stop.value.code == 0
        shown.append(capsys.readouterr().out)
    assert shown[0] == shown[1] and shown[0].startswith(f"usage: bsm {command}")


OPTIONS_OF_OTHER_TOOLS = """
--report --resume --recursive --quality --qp --bits --compression-level -cl --level --scale --unit --units --fps
--start --end --from --to --frame-range --max-error --error --tolerance --simplify --ratio --texture --textures
--texture-size --draco -cc -c --webp --normals --uv --colors --color --threads --cores --parallel --workers
--verbose -v --log --debug --progress --no-progress --force --overwrite --yes --input -i --out --output-format
--to-obj --ascii --binary --timeout --memory --limit --gpu --coefficients --blocks --block --keep --hausdorff
--psnr --metric --title --dpi --size --width --checksum --sha256 --hash --open --host --lossless --best --fast
--speed --version --json --csv --html --silent --dry-run --strip --merge --weld --origin --center --up --axis
--frames -R -t -d
"""


@pytest.mark.parametrize("command", COMMANDS)
def test_answers_to_options_of_other_tools_name_an_option_of_the_command(command, capsys):
    for flag in ("--help", *["--help-all"] * (command == "encode")):
        with pytest.raises(SystemExit):
            main([command, flag])
    offered = set(re.findall(r"(?<![\w-])(--?[a-zA-Z][\w-]*)", capsys.readouterr().out))
    answered = 0
    for option in set(OPTIONS_OF_OTHER_TOOLS.split()) - offered:
        with suppress(SystemExit):
            assert main([command, "none.ply", option, "3"]) != 0
        answer = capsys.readouterr().err
        suggested = re.search(r"(?:did you mean|instead:) (--?[a-z][\w-]*)", answer)
        if suggested:
            answered += 1
            assert suggested[1] in offered, answer
    assert answered, "some of these words have another name in each command"


def test_no_words_are_wrong_usage(capsys):
    assert main([]) == 2
    assert "COMMAND" in capsys.readouterr().err


def test_the_version():
    done = program("--version")
    assert (done.returncode, done.stdout) == (0, f"bsm {__version__}\n")


def test_files_may_begin_with_a_minus(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    bsm.save(torus(6, 5), "-a b.stl")
    with pytest.raises(SystemExit):
        main(["encode", "-a b.stl"])
    assert "name the file as './-a b.stl'" in capsys.readouterr().err
    assert main(["encode", "./-a b.stl", "-q"]) == main(["info", "--", "-a b.bsm"]) == 0
    (tmp_path / "--json").touch()  # an option is one, whatever files there are
    assert main(["info", "./-a b.bsm", "--json"]) == 0


def test_compare_says_which_file_is_wrong(tmp_path, capsys):
    (tmp_path / "a.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    (tmp_path / "b.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    for words in (["a.off", "b.off"], ["b.off", "a.off"]):
        assert main(["compare", *(str(tmp_path / word) for word in words)]) == 3
        assert capsys.readouterr().err.startswith(
            f"bsm: {tmp_path / 'b.off'}: a face refers to vertex 7"
        )


def test_bash_completes_options_and_files(tmp_path):
    (tmp_path / "mesh.ply").touch()
    script = (SHARE / "bash-completion/completions/bsm").read_text("utf-8")
    for words, found in (
        ("encode --the", "--theta"),
        ("encode me", "mesh.ply"),
        ("decode -o me", "mesh.ply"),
    ):
        word = words.split()[-1]
        script += f"\nCOMP_WORDS=(bsm {words}); COMP_CWORD={len(words.split())}"
        script += f"; _shtab_bsm bsm {word} x; echo ${{COMPREPLY[@]}} = {found}\n"
    done = subprocess.run(
        ["bash"], input=script, capture_output=True, text=True, timeout=60, check=True, cwd=tmp_path
    )
    assert all(
        got == wanted for got, wanted in (line.split(" = ") for line in done.stdout.splitlines())
    )
    assert len(done.stdout.splitlines()) == 3


def test_manual_pages_and_completion_are_current():
    """`python -m tools.manuals` makes them."""
    completion = [
        (SHARE / name).read_text("utf-8")
        for name in ("bash-completion/completions/bsm", "zsh/site-functions/_bsm")
    ]
    pages = {path.stem: path.read_text("utf-8") for path in (SHARE / "man/man1").iterdir()}
    assert pages.keys() == {"bsm", *(f"bsm-{name}" for name in COMMANDS)}
    for name, summary in COMMANDS.items():
        page = re.sub(r"\\f.|\\[,/]", "", pages[f"bsm-{name}"]).replace("\\-", "-")
        parser = command_parser(name)
        assert f".SH NAME\nbsm-{name} - {summary}\n" in page
        assert summary.replace("-", "\\-") in pages["bsm"]
        named = dict(re.findall(r"^\.TP\n(.+)\n(.+)", page, re.MULTILINE))
        actions = [
            action
            for action in parser._actions
            if action.help not in (None, argparse.SUPPRESS, "show this help message and exit")
        ]
        helps = {parser._get_formatter()._expand_help(action) for action in actions}
        assert set(named.values()) == helps
        options = {option for action in actions for option in action.option_strings}
        assert {
            word
            for key in named
            if key.startswith("-")
            for word in re.findall(r"(?<![\w-])--?[a-z][\w-]*", key)
        } == options
        assert all(option in text for option in options for text in completion)
        choices = [" ".join(map(str, action.choices)) for action in actions if action.choices]
        assert all(f"({some})" in text for some in choices for text in completion)
        shown = [
            ",".join(map(str, action.choices))
            for action in actions
            if action.choices and not action.metavar
        ]
        assert all(f"{{{some}}}" in page for some in shown)


def test_every_command_says_what_it_takes_for_files():
    files = [action.dest for name in COMMANDS for action in command_parser(name).file_arguments()]
    assert {"inputs", "output", "original", "decoded", "permutation"} <= set(files)


def test_help_says_what_presets_promise():
    rows = dict(re.findall(r"^([\w-]+) {2,}(.+)$", PROMISES, flags=re.MULTILINE))
    for name, options in PRESETS.items():
        row = rows[name]
        if options.grid is not None:
            assert f"{options.grid} bits" in row
        elif options.exact:
            assert "single precision" in row
        elif options.sets_coding:
            assert "the codec of the paper" in row
        elif options.contract is None:
            assert "only the bounds and targets" in row
        else:
            look = f"{options.contract.look:g}" if np.isfinite(options.contract.look) else "any"
            assert row.split()[:3] == [look, f"{100 * options.contract.farthest:g}", "%"]
            assert ("whole mesh" in row) == (options.contract.by_part > options.contract.farthest)


@pytest.mark.parametrize("name", DOCUMENTS)
def test_documents_have_the_table_of_presets(name):
    text = (ROOT / name).read_text("utf-8")
    assert with_table(text) == text, "run python -m tools.manuals"


@pytest.mark.parametrize("words", [["--max-error", "1%"], ["--nmsve-db", "-40"]])
def test_a_bound_alone_reports_what_is_visible(words, tmp_path, capsys):
    bsm.save(torus(40, 24), tmp_path / "a.npz")
    command = ["encode", str(tmp_path / "a.npz"), "-f", "-o", str(tmp_path / "b.bsm"), *words]
    assert main([*command, "--preset", "none"]) == 0
    assert "no look is promised; measured: look " in capsys.readouterr().err
    assert main(command) == 0
    assert "no look is promised" not in capsys.readouterr().err


def test_a_dry_run_reports_and_writes_nothing(tmp_path, capsys):
    bsm.save(torus(9, 6), tmp_path / "a.npz")
    assert main(["encode", str(tmp_path / "a.npz"), "-r", str(tmp_path), "--dry-run"]) == 2
    assert main(["encode", str(tmp_path / "a.npz"), "--dry-run", "-o", str(tmp_path / "new/")]) == 0
    assert main(["encode", "-r", str(tmp_path), "--dry-run", "--json"]) == 0
    shown = capsys.readouterr()
    assert "look 0." in shown.err and "0 of" not in shown.err and "of 1" in shown.err
    assert json.loads(shown.out)["bytes"] > 100
    assert (
        main(["encode", str(tmp_path / "a.npz"), "--dry-run", "--report", str(tmp_path / "r.json")])
        == 2
    )
    assert [path.name for path in tmp_path.iterdir()] == ["a.npz"]


def test_a_size_that_is_too_small_names_the_way_out(tmp_path, capsys):
    bsm.save(torus(30, 20), tmp_path / "a.npz")
    assert main(["encode", str(tmp_path / "a.npz"), "--dry-run", "--size", "180"]) == 10
    assert "preset none reaches it with look " in capsys.readouterr().err


MESH = torus()


def test_what_is_printed_fits_a_line():
    painted = bsm.TriangleMesh(
        MESH.positions, MESH.faces, (bsm.Attribute("heat", np.arange(len(MESH.positions))),)
    )
    assert (
        repr(painted)
        == f"TriangleMesh({len(MESH.positions)} vertices, {len(MESH.faces)} faces, heat)"
    )
    assert (
        repr(painted.attributes[0])
        == f"Attribute('heat', {len(MESH.positions)} x 1 int32 per vertex, generic)"
    )
    assert repr(bsm.Limits()) == "Limits()" and repr(bsm.Limits(work=3.0)) == "Limits(work=3.0)"
    for name in ("decode", "load", "decode_sequence", "read_mesh"):
        assert len(str(inspect.signature(getattr(bsm, name)))) < 400, name
    for event in events_of(bsm.encode(MESH, step=0.01)):
        if not isinstance(event, bsm.HeaderEvent):
            assert len(repr(event)) < 120 and "array" not in repr(event)


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("20kB", 20e3),
        ("20k", 20e3),
        ("1.5MiB", 1.5 * 2**20),
        ("900 B", 900),
        ("1e4", 1e4),
        (700, 700),
        ("2 MB", 2e6),
    ],
)
def test_sizes_are_read(text, count):
    assert parse_bytes("size", text) == count


@pytest.mark.parametrize("text", ["20 cows", "kB", "-3kB", None, "1.2.3", True])
def test_what_is_no_size_is_reported(text):
    with pytest.raises(bsm.ArgumentError, match="such as 20000 or 20kB"):
        parse_bytes("size", text)


def test_a_tree_is_mirrored(tmp_path, capsys):
    tree, out = tmp_path / "tree", tmp_path / "out"
    for name in ("scan_1/mesh.ply", "scan_2/mesh.ply", "scan_2/deep/mesh.obj", "top.stl"):
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        bsm.save(MESH, tree / name)
    (tree / "scan_1/notes.txt").write_text("no mesh")
    assert main(["encode", str(tree), "-o", str(out), "-r", "-q", "--grid", "8"]) == 0
    made = {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()}
    assert made == {"scan_1/mesh.bsm", "scan_2/mesh.bsm", "scan_2/deep/mesh.bsm", "top.bsm"}
    assert main(["encode", str(tree), "-r", "-q", "--grid", "8"]) == 0
    assert (tree / "scan_2/deep/mesh.bsm").exists(), "beside, without -o"
    assert main(["encode", str(tree / "top.stl"), "-r"]) == 2
    bsm.save(MESH, tree / "scan_1/mesh.off")
    assert main(["encode", str(tree), "-o", str(tmp_path / "new"), "-r", "-q", "--grid", "8"]) == 0
    assert {path.name for path in (tmp_path / "new/scan_1").iterdir()} == {
        "mesh.ply.bsm",
        "mesh.off.bsm",
    }
    (tmp_path / "empty").mkdir()
    assert main(["encode", str(tmp_path / "empty"), "-r"]) == 2
    errors = capsys.readouterr().err
    assert "not a local folder" in errors and "no mesh files" in errors


def test_compare_says_it_in_a_sentence_with_units(tmp_path, capsys):
    mesh = bsm.TriangleMesh(MESH.positions, MESH.faces, metadata={"unit": "mm"})
    bsm.save(mesh, tmp_path / "a.ply")
    moved = MESH.positions.copy()
    moved[3, 2] += 0.25
    bsm.save(bsm.TriangleMesh(moved, MESH.faces), tmp_path / "b.ply")
    assert main(["compare", str(tmp_path / "a.ply"), str(tmp_path / "b.ply")]) == 0
    first = capsys.readouterr().out.splitlines()[0]
    assert first.startswith("largest vertex error 0.25 mm, ") and "% of the diagonal" in first
    assert main(["compare", str(tmp_path / "a.ply"), str(tmp_path / "a.ply")]) == 0
    assert capsys.readouterr().out.startswith("all vertices are equal\n")


def test_a_map_shows_where_vertices_are_off(tmp_path, capsys):
    bsm.save(MESH, tmp_path / "a.ply")
    moved = MESH.positions.copy()
    moved[: len(moved) // 2, 2] += 0.25
    bsm.save(bsm.TriangleMesh(moved, MESH.faces), tmp_path / "b.ply")
    words = ["compare", str(tmp_path / "a.ply"), str(tmp_path / "b.ply"), "--map"]
    for name in ("map.ply", "map.obj"):
        assert main([*words, str(tmp_path / name)]) == 0
        color = next(
            a for a in bsm.load(tmp_path / name).attributes if a.semantic == "color"
        ).values
        assert color[0, 0] > color[0, 2] and color[-1, 2] > color[-1, 0], (
            "red where it moved, blue where not"
        )
    distance = next(a for a in bsm.load(tmp_path / "map.ply").attributes if a.name == "distance")
    np.testing.assert_allclose(distance.values[[0, -1], 0], [0.25, 0], atol=1e-6)
    assert main([*words, str(tmp_path / "map.png")]) == 0
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    assert main([*words, str(tmp_path / "map.png")]) != 0, "it is there"
    assert main([*words, str(tmp_path / "map.txt")]) == 2
    assert "a picture (.png)" in capsys.readouterr().err


def test_obj_has_colors_that_every_reader_takes(tmp_path, capsys):
    rgba = np.tile(np.array([[255, 0, 51, 128]], np.uint8), (len(MESH.positions), 1))
    mesh = bsm.TriangleMesh(
        MESH.positions, MESH.faces, (bsm.Attribute("color", rgba, semantic="color"),)
    )
    assert bsm.save(mesh, tmp_path / "a.obj") == ("alpha of color",)
    rows = [
        line.split()
        for line in (tmp_path / "a.obj").read_text().splitlines()
        if line.startswith("v ")
    ]
    assert {len(row) for row in rows} == {7} and rows[0][4:] == ["1", "0", "0.2"]


@pytest.fixture(scope="module")
def loop(tmp_path_factory):
    """A stream that goes round twice, and the frames."""
    tmp_path = tmp_path_factory.mktemp("loop")
    angles = 2 * np.pi * np.arange(24) / 12
    waves = np.sin(3.0 * MESH.positions[None, :, 2:] + angles[:, None, None])
    frames = MESH.positions + 0.1 * waves * [1.0, 0.0, 0.0]
    np.savez(tmp_path / "loop.npz", positions=frames, faces=MESH.faces)
    (tmp_path / "loop.bsm").write_bytes(
        bsm.encode_sequence(frames, MESH.faces, preset="near-lossless")
    )
    return tmp_path


def test_the_errors_of_frames_are_drawn_as_a_curve(loop, capsys):
    words = ["compare", str(loop / "loop.npz"), str(loop / "loop.bsm")]
    assert main([*words, "--picture", str(loop / "curve.png")]) == 0
    assert (loop / "curve.png").read_bytes().startswith(b"\x89PNG")
    assert main([*words, "--map", str(loop / "map.png")]) == 2
    assert "for sequences, --picture" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (Length(0.05, True), (0.05, True)),
        ("0.1%", (0.001, False)),
        (" 2e-3 ", (0.002, False)),
        (0.5, (0.5, False)),
    ],
)
def test_lengths(given, expected):
    assert parse_length("gap", given) == expected


@pytest.mark.parametrize("given", ["", "mm", ".mm", "1..2mm", "-1mm", "nan", True, None])
def test_what_is_no_length(given):
    with pytest.raises(bsm.ArgumentError, match="gap"):
        parse_length("gap", given)


@pytest.mark.parametrize("unit", ["mm", "millimeters", "Millimetre", "0.001 m"])
def test_the_same_unit_by_any_name(unit):
    options = {"max_error": "0.5mm", "size": "3kB"}
    assert in_own_unit(options, {"unit": unit}) == {**options, "max_error": Length(0.5, True)}
    assert in_own_unit({"max_error": "0.5%"}, {"unit": unit}) == {"max_error": Length(0.005, False)}


def test_units_are_one_table():
    for names, meters in UNITS.items():
        named = unit_named(meters)
        assert named in names.split() and known_unit(named, "here") == meters
        for name in names.split():
            assert known_unit(name.upper(), "here") == known_unit(f"2 {name}", "here") / 2 == meters
    assert len(IN_METRES) == sum(len(names.split()) for names in UNITS), "no name has two meanings"


@pytest.mark.parametrize(
    ("unit", "words"),
    [("milimeter", "mean millimeter"), ("parsec", "known are nm"), ("imch", "mean inch"), (7, "7")],
)
def test_an_unknown_unit_is_an_error(unit, words, tmp_path):
    with pytest.raises(UnitError, match=words):
        known_unit(unit, "here")
    mesh, frames = torus(8, 7), np.array([torus(8, 7).positions] * 2)
    for wish in (
        {"metadata": {"unit": unit}},
        {"max_error": f"2{unit}", "metadata": {"unit": "mm"}},
    ):
        if unit != 7 or "max_error" not in wish:
            for door in (
                lambda wish: bsm.encode(mesh, **wish),
                lambda wish: bsm.encode_sequence(frames, mesh.faces, **wish),
                lambda wish: bsm.encode_frames([mesh, mesh], **wish),
            ):
                with pytest.raises(UnitError, match=words):
                    door(wish)
    bsm.save(
        bsm.TriangleMesh(mesh.positions, mesh.faces, (), {"unit": "furlong"}), tmp_path / "a.ply"
    )
    result = program("encode", tmp_path / "a.ply", "--max-error", "2mm")
    assert result.returncode == 2 and "unknown unit 'furlong'" in result.stderr
    result = program("encode", tmp_path / "a.ply")
    assert result.returncode == 0 and "its unit furlong is not known" in result.stderr


@pytest.mark.parametrize("metadata", [{}, {"unit": ""}, {"unit": 7}, {"name": "mm"}])
def test_a_length_with_a_unit_needs_a_mesh_that_has_one(metadata):
    for plain in ("0.5%", 0.01, "0.01"):
        assert not in_own_unit({"max_error": plain}, metadata)["max_error"].absolute
    with pytest.raises(bsm.OptionError, match=r"has no unit: .* --meta unit=mm .* such as 0\.1%"):
        in_own_unit({"max_error": "0.5mm"}, metadata)


def test_another_unit_is_converted(tmp_path):
    mesh, metadata = torus(8, 7), {"unit": "meters"}
    assert in_own_unit({"max_error": "0.05mm"}, metadata) == {"max_error": Length(5e-05, True)}
    own, other = (
        bsm.encode(mesh, metadata=metadata, max_error=text) for text in ("0.05meters", "50mm")
    )
    assert own == other
    bsm.save(mesh, tmp_path / "a.ply")
    words = (
        "encode",
        tmp_path / "a.ply",
        "-q",
        "-f",
        "-o",
        tmp_path / "a.bsm",
        "--meta",
        "unit=cm",
        "--max-error",
    )
    assert program(*words, "0.01in").returncode == 0
    inches = (tmp_path / "a.bsm").read_bytes()
    assert program(*words, "0.0254cm").returncode == 0
    assert inches == (tmp_path / "a.bsm").read_bytes()
