"""Two hundred first commands: each does what was meant, or says in a sentence what to type."""

import re
import shlex

import numpy as np
import pytest

import bsm
from bsm.cli import main
from tests.bsm.program import run
from tests.shapes import torus

MEANT = """
encode ring.ply | ring.bsm
encode ring.ply -o a.bsm | a.bsm
encode ring.ply --output a.bsm | a.bsm
encode -o a.bsm ring.ply | a.bsm
encode ring.ply -f | ring.bsm
encode ring.ply --preset fine | ring.bsm
encode ring.ply --preset lossless | ring.bsm
encode ring.ply --preset grid14 -o a.bsm | a.bsm
encode ring.ply --max-error 0.1% | ring.bsm
encode ring.ply --max-error 0.001 | ring.bsm
encode ring.ply --max-error 0.05mm --meta unit=mm | ring.bsm
encode ring.ply --max-error '0.05 mm' --meta unit=mm | ring.bsm
encode ring.ply --max-error 0.05mm --meta unit=m | ring.bsm
encode ring.ply --look 2 | ring.bsm
encode ring.ply --size 2kB | ring.bsm
encode ring.ply --size 2KB | ring.bsm
encode ring.ply --theta 3 | ring.bsm
encode ring.ply --theta 1e-9 | ring.bsm
encode ring.ply --nmsve-db -45 | ring.bsm
encode ring.ply --quick | ring.bsm
encode ring.ply --effort best | ring.bsm
encode ring.ply --keep-order | ring.bsm
encode ring.ply --up z | ring.bsm
encode ring.ply --grid-cell 0.01 --grid-origin -1,-.5,-1e-3 | ring.bsm
encode ring.ply --json | ring.bsm
encode ring.glb | ring.bsm
encode ring.obj -o sub/ | sub/ring.bsm
encode ring.ply ring2.ply -o sub | sub/ring2.bsm
encode scans -r | scans/b.bsm
encode -r scans -o sub | sub/b.bsm
encode scans/a.ply scans/b.obj -o sub/ | sub/a.bsm
encode walk.npz | walk.bsm
encode walk -o a.bsm | a.bsm
encode 'walk/*.ply' -o a.bsm | a.bsm
encode walk/0.ply walk/1.ply walk/2.ply -o a.bsm | a.bsm
encode walk.npz --frame-rate 30 | walk.bsm
encode ring.ply --attribute '*=none' | ring.bsm
encode ring.ply --simplify | ring.bsm
encode ring.ply --out a.bsm | a.bsm
decode old.bsm | old.ply
decode old.bsm -o a.obj | a.obj
decode old.bsm -o a.glb | a.glb
decode old.bsm -o a.stl | a.stl
decode old.bsm --format obj | old.obj
decode old.bsm -o sub/ | sub/old.ply
decode moving.bsm | moving.npz
decode moving.bsm -o 'sub/%04d.obj' | sub/0002.obj
decode moving.bsm -o frames/ | frames/00000.ply
decode moving.bsm --frames 1:2 -o one.obj | one.obj
decode moving.bsm -o a.glb | a.glb
decode moving.glb | moving.npz
decode -r streams | streams/old.ply
decode -r streams -o sub | sub/old.ply
decode named.glb -o a.ply | a.ply
info old.bsm |
info moving.bsm |
info old.bsm --json |
info named.glb |
info moving.glb |
verify old.bsm |
verify -r streams |
verify moving.glb |
verify old.bsm moving.bsm |
compare ring.ply old.bsm |
compare old.bsm ring.ply |
compare ring.ply ring.obj |
compare walk.npz moving.bsm |
compare walk.npz moving.glb |
compare -r scans scans |
compare ring.ply old.bsm --look |
compare ring.ply old.bsm --json |
glb ring.glb -o a.glb | a.glb
glb ring.ply -o a.glb | a.glb
glb ring.obj -o a.glb | a.glb
glb old.bsm -o a.glb | a.glb
glb moving.bsm -o a.glb | a.glb
glb ring.glb -o a.glb --preset fine | a.glb
denoise ring.ply | ring.denoised.ply
denoise ring.ply -o a.ply | a.ply
view ring.ply --save page.html | page.html
view old.bsm --save page.html | page.html
help |
--help |
help encode |
encode --help |
--version |
encode --help-all |
"""
"""Commands, and the file that each makes, if any."""

ADVICE = """
encode 'walk/*.ply' -o scans/ | stands for many files, which make one
compress ring.ply | it is: bsm encode
pack ring.ply | it is: bsm encode
Compress ring.ply | it is: bsm encode
encde ring.ply | did you mean encode
enc ring.ply | unknown command enc; did you mean encode
decompress old.bsm | it is: bsm decode
unpack old.bsm | it is: bsm decode
extract old.bsm | it is: bsm decode
convert ring.ply a.glb | bsm encode
inspect old.bsm | it is: bsm info
list old.bsm | it is: bsm info
diff ring.ply old.bsm | it is: bsm compare
check old.bsm | it is: bsm verify
validate old.bsm | it is: bsm verify
show old.bsm | it is: bsm view
open old.bsm | it is: bsm view
preview old.bsm | it is: bsm view
smooth ring.ply | it is: bsm denoise
simplify ring.ply | bsm encode --simplify
decimate ring.ply | bsm encode --simplify
gltf ring.glb | it is: bsm glb
plot ring.ply | it is: bsm curve
merge scan | it is: bsm untile
version | bsm --version
-v | bsm --version
-V | bsm --version
ring.ply | bsm encode ring.ply
old.bsm | bsm decode old.bsm
ring.ply -o a.bsm | bsm encode ring.ply
-i ring.ply -o a.bsm | bsm encode ring.ply
-o a.bsm ring.ply | a command comes first
quux | unknown command quux
encode | IN
decode | IN
info | IN
compare ring.ply | B
glb ring.glb | named with -o
glb ring.glb a.glb | named with -o
tile ring.ply | named with -o
curve ring.ply | named with -o
untile scan | named with -o
encode ring.ply a.bsm | bsm encode ring.ply -o a.bsm
encode ring.ply old.bsm | bsm encode ring.ply -o old.bsm
encode ring.ply sub2/ | bsm encode ring.ply -o sub2/
decode old.bsm a.ply | bsm decode old.bsm -o a.ply
decode old.bsm a.obj | bsm decode old.bsm -o a.obj
decode old.bsm ring.ply | bsm decode old.bsm -o ring.ply
denoise ring.ply clean.ply | bsm denoise ring.ply -o clean.ply
encode -i ring.ply -o a.bsm | inputs need no option
encode --input ring.ply | inputs need no option
encode ring.ply -o a.glb | bsm glb ring.ply -o a.glb
encode ring.ply -o 'a b.ply' | bsm decode
encode ring.ply -o a.usdz | bsm encode
encode ring.glb -o a.glb | bsm glb ring.glb -o a.glb
encode ring.glb -o a.gltf | bsm glb ring.glb -o a.glb
encode ring.ply -o a.ply | bsm encode ring.ply -o a.bsm
encode ring.ply -o a.drc | bsm encode ring.ply -o a.bsm
encode ring.ply -o a.stl | then bsm decode a.bsm -o a.stl
encode walk.npz -o a.glb | bsm encode walk.npz -o a.bsm; bsm glb a.bsm -o a.glb
encode walk -o a.glb | bsm encode walk -o a.bsm; bsm glb a.bsm -o a.glb
encode walk -o a.usdc | bsm decode a.bsm -o a.usdc
encode ring.ply --format glb | bsm glb ring.ply
encode ring.ply --format drc | unknown value drc
encode ring.ply --quality 80 | --preset fine
encode ring.ply -qp 11 | --preset fine
encode ring.ply -cl 10 | --preset fine
encode ring.ply --level 10 | --preset fine
encode ring.ply -q 90 | -q takes no value, and 90 is not a file
encode ring.ply --lossless | --preset lossless
encode ring.ply --fine | --preset
encode ring.ply --preset high | small, balanced, fine
encode ring.ply --preset best | small, balanced, fine
encode ring.ply --preset fien | did you mean fine
encode ring.ply --bits 12 | --grid 14
encode ring.ply --qp 12 | --grid 14
encode ring.ply --tolerance 0.1mm | --max-error
encode ring.ply --error 1% | --max-error
encode ring.ply --precision 0.1 | --max-error
encode ring.ply --max-error 0.05 | 5 % of the diagonal
encode ring.ply --max-error 5 | share of the diagonal
encode ring.ply --max-error 0.1mm | --meta unit=m or --meta unit=mm
encode ring.ply --max-error 0.1 mm | without a space
encode ring.ply --max-error 0,1% | must be a number
encode ring.ply --max-error -1% | --max-error: expected one
encode ring.ply --max-error ten | must be a number
encode ring.ply --size 20 kB | without a space
encode ring.ply --size 5% | such as 20000 or 20kB
encode ring.ply --size small | such as 20000 or 20kB
encode ring.ply --ratio 10 | --size 20kB
encode ring.ply --target-size 20kB | --size 20kB
encode ring.ply --look 0 | look must be above 0
encode ring.ply --theta 5deg | a number is expected, not '5deg'
encode ring.ply --theta | expected one argument
encode ring.ply --theta 3 --size 2kB | not allowed with argument
encode ring.ply --simplify 0.5 | --simplify takes no value, and 0.5 is not a file
encode 0.5 --preset fine | 0.5: no such file
encode ring.ply --decimate 0.5 | --simplify
encode ring.ply --fast | --quick
encode ring.ply --best | --effort best
encode ring.ply -v | printed without it
encode ring.ply --verbose | printed without it
encode ring.ply --verify | always checks
encode ring.ply --overwrite | --force
encode ring.ply -y | --force
encode ring.ply --silent | --quiet
encode ring.ply --texture webp | webp:85
encode ring.ply --images gif | webp:85
encode ring.ply --unit mm | --meta unit=mm
encode ring.ply --meta mm | NAME=TEXT
encode ring.ply --meta =mm | NAME=TEXT
encode . | gives the output no name; name it with -o | 2
encode ring.ply --fps 30 | --frame-rate
encode ring.ply --no-normals | --attribute normal=none
encode ring.ply --tehta 3 | did you mean --theta
encode ring.ply --qick | unknown option --qick; did you mean --quick
encode ring.ply --effort bst | unknown value bst; did you mean best
encode ring.ply --set partition=mtis | unknown value 'mtis' of partition; did you mean metis
encode ring.ply --set keep=7 | keep | 2
encode ring.ply --theta 0 | mean angle 0 degrees cannot be a target | 2
encode ring.ply --size 20 | 20 bytes at most cannot be | 10
encode ring.ply -j -3 | argument -j/--jobs: -3 is less than 0
encode ring.ply -o - --json | json | 2
encode old.bsm | replace | 2
encode ring.ply -o old.bsm | exists | 9
encode none/ | the folder none does not exist | 9
encode -r none | none: not a local folder | 2
encode ring.ply --grid 30 | grid
encode ring.ply --workers 4 | --jobs
encode ring.ply --outdir sub | --output FOLDER/
encode old.bsm -o a.bsm | decode it first | 3
encode none.ply | No such file | 9
encode none/ring.ply | folder none does not exist
encode a.fbx | convert it to GLB
encode notes.txt | convert it to GLB
encode empty.ply | empty
encode scans | -r
encode ring.ply ring2.ply -o a | need an output folder: -o a/
encode ring.ply -o none/a.bsm | folder | 9
decode | IN
decode ring.ply | bsm encode ring.ply | 3
decode ring.glb -o ring.glb | -o
decode streams | bsm decode -r streams
decode none.bsm | No such file
decode old.bsm -o a.fbx | not written as fbx | 2
decode old.bsm -o a.ply --blocks 0 | at least one block | 2
decode old.bsm -o a.usdc | single meshes are not written as usdc; use one of .3mf, .dae, .glb
decode old.bsm -o a.ply --format usdc | not written as usdc
decode moving.bsm --layers 1 -o a.npz | single meshes
decode old.bsm -o old.bsm | -o
decode moving.bsm -o a.obj | --frames 0:1
decode moving.bsm --frame 1 -o a.obj | --frames
decode moving.bsm --frames 1 -o a.obj | give A:B
decode moving.bsm --frames 9:10 -o a.obj | count from 0
decode old.bsm --frames 0:1 -o a.obj | single mesh
decode cut.bsm | ends | 12
info ring.ply | bsm encode ring.ply
info ring.obj | bsm encode ring.obj
info '' | the name given for IN is empty; name a file | 2
info later.bsm | version | 5
info streams | folder
verify ring.ply | bsm encode ring.ply
verify streams | verify -r
verify ring.glb | no streams
verify damaged.bsm | checksum | 4
verify -- -a | -a: No such file | 9
verify cut.bsm | ends
compare ring.ply none.ply | No such file
compare ring.ply scans/b.obj | faces | 3
compare moving.bsm none.usda | No such file
compare ring.ply moving.bsm | sequence
compare ring.ply old.bsm walk.npz | one input too many
glb walk -o a.glb | bsm encode walk
glb ring.glb -o a.bsm | .glb
glb none.glb -o a.glb | No such file
glb a.fbx -o a.glb | convert it to GLB
denoise none.ply | No such file
denoise ring.ply --fine best | best
denoise ring.ply --keep 2 | keep
denoise ring.ply --iterations -1 | iterations
denoise ring.ply --for beauty | beauty
denoise ring.ply -o out.xyz | not written as xyz
denoise ring.ply -o - --json | standard output
denoise ring.ply -o ring2.ply | exists | 9
denoise - -o - | --format | 2
view none.ply | No such file
view --port 99999 | argument --port: 99999 is more than 65535
view --port -1 | argument --port: -1 is less than 0
demo --vertices -1 | argument --vertices: -1 is less than 1
tile ring.ply -o b -j x | argument -j/--jobs: a whole number is expected, not 'x'
curve -o a --blocks 0 | argument --blocks: 0 is less than 1
curve -o a --repeat 0 | argument --repeat: 0 is less than 1
curve ring.ply -o a.json | folder or a picture
curve ring.ply -o a --codecs mp3 | unknown codec mp3
"""
"""Commands that cannot be meant as they are, a part of the sentence that says what to type, and some exit codes."""


def lines(text):
    return [tuple(part.strip() for part in line.split("|")) for line in text.strip().split("\n")]


@pytest.fixture(scope="module")
def pristine(tmp_path_factory):
    """A folder with a mesh in several formats, a sequence, streams of both, and files that are none."""
    folder = tmp_path_factory.mktemp("first")
    mesh, write = torus(12, 8), folder.joinpath
    for name in (
        "ring.ply",
        "ring2.ply",
        "ring.obj",
        "ring.glb",
        "old.bsm",
        "streams/old.bsm",
        "scans/a.ply",
    ):
        write(name).parent.mkdir(exist_ok=True)
        bsm.save(mesh, write(name))
    bsm.save(torus(9, 7), write("scans/b.obj"))
    frames = np.array([mesh.positions + 0.1 * number for number in range(3)])
    np.savez(write("walk.npz"), positions=frames, faces=mesh.faces)
    write("moving.bsm").write_bytes(bsm.encode_sequence(frames, mesh.faces))
    assert main(["glb", str(write("moving.bsm")), "-o", str(write("moving.glb")), "-q"]) == 0
    write("walk").mkdir()
    for number in range(3):
        bsm.save(bsm.TriangleMesh(frames[number], mesh.faces), write(f"walk/{number}.ply"))
    write("named.glb").write_bytes(write("old.bsm").read_bytes())
    stream = write("old.bsm").read_bytes()
    write("cut.bsm").write_bytes(stream[:-40])
    write("damaged.bsm").write_bytes(stream[:60] + bytes([stream[60] ^ 1]) + stream[61:])
    write("later.bsm").write_bytes(stream[:4] + b"\x7f" + stream[5:])
    write("a.fbx").write_bytes(b"Kaydara FBX Binary  \0\x1a\0")
    write("notes.txt").write_text("buy milk\n")
    write("empty.ply").write_bytes(b"")
    write("sub").mkdir()
    return folder


@pytest.fixture
def folder(pristine, monkeypatch):
    """The folder; after a test it is as it was before."""
    monkeypatch.chdir(pristine)
    before = {path: path.read_bytes() if path.is_file() else None for path in pristine.rglob("*")}
    yield pristine
    for path in sorted(pristine.rglob("*"), reverse=True):
        if path not in before:
            path.rmdir() if path.is_dir() else path.unlink()
        elif before[path] is not None and path.read_bytes() != before[path]:
            path.write_bytes(before[path])


def test_there_are_two_hundred():
    assert len(lines(MEANT)) + len(lines(ADVICE)) >= 200


@pytest.mark.parametrize(("words", "made"), lines(MEANT))
def test_it_does_what_was_meant(folder, words, made):
    assert run(*shlex.split(words)) == 0
    assert not made or (folder / made).stat().st_size > 0


def test_what_only_exact_positions_keep_is_kept_with_a_note(folder, capsys):
    assert run("encode", "ring.ply", "--theta", "1e-9") == 0
    assert (
        "ring.ply: positions are exact: no coarser ones keep the promise" in capsys.readouterr().err
    )
    assert (
        (bsm.load("ring.bsm").positions[:, None] == bsm.load("ring.ply").positions)
        .all(axis=2)
        .any(axis=1)
        .all()
    )


@pytest.mark.parametrize("row", lines(ADVICE), ids=" | ".join)
def test_it_says_what_to_type(folder, capsys, row):
    before, (words, advice, *code) = set(folder.rglob("*")), row
    ended = run(*shlex.split(words))
    assert ended == int(code[0]) if code else ended not in (0, 1)
    shown = capsys.readouterr()
    said, *more = shown.err.splitlines()
    assert said.startswith(("bsm", "{")) and re.search(re.escape(advice), said, re.IGNORECASE), (
        shown.err
    )
    assert all(line.startswith("usage: bsm") and "--help" in line for line in more), shown.err
    assert not shown.out and "Traceback" not in shown.err and "utf-8" not in said
    made = [path for path in folder.rglob("*") if path not in before and path.is_file()]
    assert not made
    for command in filter(None, said.partition(" Run: ")[2].split("; ")):
        assert run(*shlex.split(command.removeprefix("then "))[1:]) in (0, 8, 9), (
            "no advice, file or library"
        )
