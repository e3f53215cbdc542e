"""Words of other programs, and the command or option of bsm for each."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Sequence
from pathlib import Path

from bsm.bitstream.errors import OptionError

COMMANDS = {
    **dict.fromkeys(("compress", "pack", "zip", "create", "make", "encoder"), "encode"),
    **dict.fromkeys(("decompress", "unpack", "extract", "restore", "unzip", "decoder", "export"), "decode"),
    **dict.fromkeys(("convert", "transcode", "import"), "encode, and back: bsm decode IN.bsm -o OUT.obj"),
    **dict.fromkeys(("list", "ls", "inspect", "stat", "stats", "dump", "header", "identify"), "info"),
    **dict.fromkeys(("diff", "error", "measure", "distance", "cmp", "metric", "psnr"), "compare"),
    **dict.fromkeys(("check", "test", "validate", "fsck"), "verify"),
    **dict.fromkeys(("serve", "open", "show", "display", "preview", "viewer", "gui"), "view"),
    **dict.fromkeys(("gltf", "scene", "gltfpack", "gltf2"), "glb"),
    **dict.fromkeys(("smooth", "clean", "filter", "noise"), "denoise"),
    **dict.fromkeys(("simplify", "decimate", "reduce", "lod"), "encode --simplify"),
    **dict.fromkeys(("split", "cut", "chunk", "tiles"), "tile"),
    **dict.fromkeys(("join", "merge"), "untile"),
    **dict.fromkeys(("plot", "rd", "curves", "evaluate"), "curve"),
    **dict.fromkeys(("benchmark", "speed", "time"), "bench"),
    **dict.fromkeys(("sample", "example", "tutorial", "try"), "demo"),
    **dict.fromkeys(("version", "-v", "-V"), "--version"),
}
"""What follows `bsm` instead."""

OPTIONS = {
    **dict.fromkeys(("-i", "--input", "--in", "--file"), "inputs need no option"),
    **dict.fromkeys(("--quality", "-qp", "--level", "-cl", "--cl", "--compression", "--profile"), "--preset fine"),
    **dict.fromkeys(("--lossless", "--exact"), "--preset lossless"),
    **dict.fromkeys(("--small", "--fine", "--balanced", "--near-lossless"), "--preset small (balanced, fine, ...)"),
    **dict.fromkeys(("--bits", "--qp", "--quantization", "--quantize", "--position-bits", "-vp"), "--grid 14"),
    **dict.fromkeys(("--tolerance", "--tol", "--error", "--precision", "--epsilon", "--accuracy"), "--max-error 0.1%"),
    **dict.fromkeys(("--ratio", "--target", "--target-size", "--bytes", "--rate", "--bitrate"), "--size 20kB"),
    **dict.fromkeys(("--decimate", "--triangles", "--faces", "--reduce", "-si"), "--simplify"),
    **dict.fromkeys(("-v", "--verbose", "--progress", "--debug"), "results are printed without it"),
    **dict.fromkeys(("--verify", "--check", "--validate"), "bsm always checks its streams"),
    **dict.fromkeys(("--fast", "--speed"), "--quick"),
    **dict.fromkeys(("--best", "--slow"), "--effort best"),
    **dict.fromkeys(("-y", "--yes", "--overwrite", "--replace", "--clobber"), "--force"),
    **dict.fromkeys(("-s", "--silent"), "--quiet"),
    **dict.fromkeys(("--texture", "--textures", "--webp", "--jpeg", "-tc"), "--images webp:85"),
    **dict.fromkeys(("--unit", "--units"), "--meta unit=mm"),
    **dict.fromkeys(("--fps", "--framerate"), "--frame-rate 30"),
    **dict.fromkeys(("--normals", "--no-normals"), "--attribute normal=none"),
    **dict.fromkeys(("--uv", "--texcoords"), "--attribute texcoord=12bits"),
    **dict.fromkeys(("--frame", "--frame-range", "--start"), "--frames 29:30"),
    **dict.fromkeys(("-d", "--dir", "--folder", "--output-dir", "--outdir"), "--output FOLDER/"),
    **dict.fromkeys(("-R", "--batch", "--all"), "--recursive"),
    **dict.fromkeys(("-t", "--nthreads", "--workers", "--parallel"), "--jobs 0 or --threads 4"),
    **dict.fromkeys(("--nmsve", "--db"), "--nmsve-db -50"),
    **dict.fromkeys(("--angle", "--normal-error"), "--theta 3"),
    **dict.fromkeys(("--draco",), "bsm compares itself with Draco in bsm curve and bsm view"),
}
"""What to write instead, in words or as an option."""

MESHES = (".ply", ".obj", ".stl", ".off", ".vtp", ".npz", ".gltf", ".glb", ".3mf", ".dae")
_NUMBER = re.compile(r"[-+]?[\d.]+(?:e[-+]?\d+)?%?")
_UNIT = re.compile(r"mm|cm|m|in|inch|%|[kMG]i?B|KB|bytes|dB|deg(?:rees)?|bpv", re.IGNORECASE)


def advice_on_command(words: Sequence[str]) -> str:
    """Return what to type instead of a command that does not exist; empty if that is not known."""
    word = words[0]
    if word.lower() in COMMANDS:
        return f"; it is: bsm {COMMANDS[word.lower()]}"
    named = next((name for name in words if Path(name).suffix.lower() in (*MESHES, ".bsm")), None)
    if named is None or not (word.startswith("-") or named == word):
        return ""
    stream = Path(named).suffix.lower() == ".bsm"
    return f"; a command comes first: bsm {'decode' if stream else 'encode'} {shlex.quote(named)}"


def refuse_misplaced(command: str, inputs: Sequence[str], *, recursive: bool) -> None:
    """Raise an error that says what to type, if a word is an output, a unit or a value instead of an input."""
    if command == "decode" and not recursive and (folder := next(filter(os.path.isdir, inputs), None)):
        raise OptionError(
            f"{folder} is a folder. To decode each stream in it, run: bsm decode -r {folder} -o OUT/; tiles: bsm untile"
        )
    missing = [name for name in inputs if "://" not in name and name != "-" and not os.path.exists(name)]
    for name in missing:
        if _UNIT.fullmatch(name) and not os.path.dirname(name):
            raise OptionError(f"{name}: no such file; if it is a unit, write it without a space, such as 0.1{name}")
        if _NUMBER.fullmatch(name):
            raise OptionError(
                f"{name}: no such file, and the option before it takes no value; see bsm {command} --help"
            )
    if len(inputs) != 2 or inputs[0] in missing:
        return
    last = Path(inputs[1]).suffix.lower()
    if inputs[1] in missing or (command == "encode" and last == ".bsm") or (command == "decode" and last in MESHES[:5]):
        given, output = map(shlex.quote, inputs)
        raise OptionError(f"{inputs[1]}: the output is named with -o. Run: bsm {command} {given} -o {output}")
