"""`python -m tools.attack figures`: is each figure that `bsm encode` states what `bsm compare` of the file finds?

Odd meshes and sequences are encoded with all options in turn: soups, cones, tubes and pinched tubes, faces without
area, doubled faces, vertices at one place and in no face, stray vertices, colors and normals. The line and the JSON of
each are held against those of `bsm compare` of the given file and the stream, and looks against the promise.
`--turned` encodes cones, globes, tubes and pinched tubes with each preset.
"""

import json
import math
import re
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bsm import Attribute, TriangleMesh, save
from bsm.codec.static.options import PRESETS
from tests.bsm import program
from tests.shapes import curved, patch, soup, tetrahedron, together, torus, turned
from tools.command import parser_of

Words = tuple[str, ...]
Random = np.random.Generator
BSM: Callable[..., Any] = program.bsm
_OF_PRESETS: tuple[Words, ...] = tuple(
    ("--preset", name)
    for name, options in PRESETS.items()
    if options.promise and options.promise.look < math.inf
)
STATIC: tuple[Words, ...] = (
    *_OF_PRESETS,
    *(
        ("--preset", "lossless"),
        ("--preset", "grid14"),
        ("--grid", "12"),
        ("--grid", "5"),
        ("--grid-cell", "0.1"),
    ),
    *(
        ("--max-error", "0.1%"),
        ("--look", "1.3"),
        ("--nmsve-db=-60",),
        ("--theta", "3"),
        ("--bpv", "200"),
    ),
    *(
        ("--simplify",),
        ("--preset", "small", "--simplify"),
        ("--effort", "best"),
        ("--meta", "unit=mm"),
    ),
    *(("--attribute", "normal=5bits"), ("--attribute", "color=10%"), ("--attribute", "*=exact")),
    *(("--attribute", "normal=none"), ("--attribute", "*=none")),
    *(
        ("--keep-order", *words)
        for words in ((), ("--preset", "lossless"), ("--nmsve-db=-50",), ("--grid", "9"))
    ),
)
MOVING: tuple[Words, ...] = (
    *_OF_PRESETS,
    *(
        ("--max-error", "0.1%"),
        ("--look", "1.3"),
        ("--kg", "0.1"),
        ("--bpvf", "100"),
        ("--gop", "2"),
    ),
    *(
        ("--theta", "3"),
        ("--nmsve-db=-50",),
        ("--keep-order",),
        ("--keep-order", "--preset", "small"),
    ),
    *(("--keep-order", "--kg", "0.2"), ("--runs",), ("--runs", "--preset", "small")),
)
CHANGES = ("loose", "mixed", "copies", "flat", "doubled", "stray", "far", "color", "normal")
_FIGURES = ("max_error_relative", "theta_deg", "angle_deg", "nmsve_db", "nmsve_paper_db")
NOTHING_DB = -165.0  # where rounding of double precision is all that a visual error has


def odd(random: Random, changes: Sequence[str] | None = None) -> TriangleMesh:
    """Return an unusual mesh; `changes` names its oddities, which are drawn by default."""
    size = int(random.integers(3, 12))
    pinched = torus(8, 6)
    twin = np.where(pinched.faces == 0, 0, pinched.faces + len(pinched.positions))
    count = int(random.integers(3, 40))
    meshes: list[Callable[[], TriangleMesh]] = [
        lambda: turned(random),
        lambda: soup(patch(size, size)),
        lambda: TriangleMesh(
            random.normal(size=(count, 3)), random.integers(0, count, (count, 3)).astype(np.int32)
        ),
        lambda: curved(torus(size + 3, size)),
        lambda: TriangleMesh(
            np.vstack([pinched.positions, 2 * pinched.positions[0] - pinched.positions]),
            np.vstack([pinched.faces, twin]),
        ),
        lambda: together(patch(size, size), tetrahedron(), torus(6, 5)),
        lambda: TriangleMesh(
            patch(size, size).positions * (1.0, 1.0, 0.0), patch(size, size).faces
        ),
    ]
    mesh = meshes[random.integers(7)]()
    drawn = [change for change in CHANGES if random.random() < 0.25] if changes is None else changes
    positions, faces = mesh.positions.copy(), mesh.faces.astype(np.int64)
    size_of = float(np.ptp(positions)) or 1.0
    if "stray" in drawn:
        positions[faces[0, 0]] += size_of * random.choice([3.0, 100.0, 1e5])
    if "copies" in drawn:
        for vertex in random.integers(0, len(positions), 5):
            faces[tuple(np.argwhere(faces == vertex)[:1].T)] = len(positions)
            positions = np.vstack([positions, positions[vertex]])
    if "flat" in drawn:
        faces = np.vstack([faces, faces[random.integers(0, len(faces), 4)][:, [0, 0, 2]]])
    if "doubled" in drawn:
        faces = np.vstack([faces, faces[:3], faces[:2, ::-1]])
    if "loose" in drawn:
        positions = np.vstack(
            [positions, random.normal(size=(3, 3)) * size_of * random.choice([1.0, 50.0])]
        )
    if "mixed" in drawn:
        order = random.permutation(len(positions))
        positions, faces = positions[order], np.argsort(order)[faces]
    positions = positions * 10.0 ** random.integers(-6, 7)
    if "far" in drawn:
        positions = positions + 1e3 * float(np.ptp(positions))
    attributes = []
    if "color" in drawn:
        values = random.integers(0, 256, (len(positions), 3)).astype(np.uint8)
        attributes.append(Attribute("color", values, "vertex", "color"))
    if "normal" in drawn:
        values = random.normal(size=(len(positions), 3)).astype(np.float32)
        values[0] = 0.0
        attributes.append(Attribute("normal", values, "vertex", "normal"))
    return TriangleMesh(positions, faces.astype(np.int32), tuple(attributes))


def moving(random: Random, mesh: TriangleMesh, frames: int) -> Any:
    """Frames of a mesh that bends, moves, rests, grows or trembles, and sometimes is one point; shape (T, n, 3)."""
    positions, size = mesh.positions, float(np.ptp(mesh.positions)) or 1.0
    times = np.arange(frames)[:, None, None] / 6.0
    motions: list[Callable[[], Any]] = [
        lambda: positions + 0.1 * size * np.sin(3.0 * positions / size + times),
        lambda: positions + times * size * np.array([1.0, 0.0, 0.0]),
        lambda: positions + 0.0 * times,
        lambda: positions * (1.0 + times),
        lambda: positions + 0.01 * size * random.normal(size=(frames, *positions.shape)),
    ]
    frames_of_motion = motions[random.integers(5)]()
    if random.integers(5) == 0:
        frames_of_motion[frames // 2] = frames_of_motion[frames // 2].mean(axis=0)
    return frames_of_motion


def of_mesh(
    mesh: TriangleMesh | Path, options: Words, folder: Path, suffix: str = "npz"
) -> list[str] | None:
    """The figures of a mesh that differ from what `bsm compare` finds; None: it is refused."""
    path, stream = (
        mesh if isinstance(mesh, Path) else folder / f"given.{suffix}",
        folder / "given.bsm",
    )
    if isinstance(mesh, TriangleMesh):
        save(mesh, path, overwrite=True)
    encoded = _encoded(path, stream, options)
    if encoded is None:
        return None
    facts, line = encoded
    surfaces = facts["error_of"] == "surfaces"
    comparison, code = _compared(path, stream, *(["--surface"] if surfaces else []))
    if comparison is None:
        return [f"compare ends with {code}"]
    looks = comparison.get("look", {})
    requested = [
        name
        for name, word in (("colors", "color"), ("checker", "texcoord"))
        if f"{word}=" in " ".join(options)
    ]
    distances = [
        looks.get(name)
        for name in ("distance", "colors", "checker")
        if name not in requested and "*=exact" not in options
    ]
    look = max(
        [float(value) for value in distances if value is not None] or [looks.get("distance", 0.0)]
    )
    unit = facts.get("unit")
    nothing = (facts["nmsve_db"] or -math.inf) < NOTHING_DB
    figures = (
        []
        if surfaces
        else [name for name in _FIGURES if not (nothing and name.startswith("nmsve"))]
    )
    problems = [_unlike(name, facts[name], comparison.get(name)) for name in figures]
    problems += (
        [_unlike("max_error", facts["max_error"], comparison["max_error"])]
        if unit and not surfaces
        else []
    )
    if surfaces:
        off, most = float(comparison["hausdorff_relative"]), float(facts["max_error_relative"])
        problems += (
            [f"surfaces are {off:.4g} apart, not {most:.4g}"]
            if abs(off - most) > 1e-3 * most + 1e-9
            else []
        )
    if facts["look"] is not None:
        problems += [
            _unlike("look", facts["look"], look, 1e-3, 1e-3)
        ]  # where faces cover each other, their order counts
    size = stream.stat().st_size
    counts = {"output_bytes": size, "bytes": size, "bpv_total": 8 * size / facts["vertices"]}
    problems += [_unlike(name, facts[name], value) for name, value in counts.items()]
    for pattern, value in {
        r"(\S+) bits per vertex": facts["bpv_total"],
        r"-> (\d+) bytes": size,
        r"look (\S+) of": look if facts["look"] is not None else None,
        r"largest vertex error (?:\S+ mm \()?(\S+) %": None
        if surfaces
        else 100 * comparison["max_error_relative"],
        r"mean normal error (\S+) degrees": None if surfaces else comparison["angle_deg"],
    }.items():
        match = re.search(pattern, line)
        if match and value is not None:
            problems.append(_unlike(f"line, {pattern}", float(match[1]), float(value), 6e-3, 6e-3))
        elif bool(match) != (value is not None) and "look" not in pattern:
            problems.append(f"line, {pattern}: {line}")
    promised = (
        None
        if {"normal=5bits", "normal=none", "*=none"} & {*options}
        else re.search(r"look \S+ of ([^\s,]+)", line)
    )
    if promised and look > float(promised[1]) * (1.0 + 1e-6):
        problems.append(f"look {look:.4g} of {promised[1]}")
    return [problem for problem in problems if problem]


def of_frames(frames: Any, faces: Any, options: Words, folder: Path) -> list[str] | None:
    """The figures of a sequence that differ from what `bsm compare` finds; None: it is refused."""
    path, stream = folder / "moving.npz", folder / "moving.bsm"
    np.savez(path, positions=frames, faces=faces)
    if "--runs" in options:  # from some frame on, a face is missing
        path = Path(tempfile.mkdtemp(dir=folder))
        for number, positions in enumerate(frames):
            mesh = TriangleMesh(positions, faces[number > len(frames) // 2 :])
            save(mesh, path / f"{number:04}.npz", overwrite=True)
    encoded = _encoded(path, stream, options)
    if encoded is None:
        return None
    facts, line = encoded
    comparison, code = _compared(path, stream)
    if comparison is None:
        return [f"compare ends with {code}"]
    problems = [_unlike(name, facts[name], comparison.get(name)) for name in ("kg", "bpvf_total")]
    problems += [_unlike("frames", facts["frames"], len(comparison["frames"]))]
    problems += [
        _unlike("bytes", facts[name], stream.stat().st_size) for name in ("bytes", "output_bytes")
    ]
    problems += [
        _unlike("line, kg", float(m[1]), comparison["kg"], 6e-3)
        for m in [re.search(r"KG error (\S+) %", line)]
        if m
    ]
    for name, word in (("kg", "--kg"), ("theta_deg", "--theta"), ("nmsve_db", "--nmsve-db=-50")):
        if word in options:
            target = -50.0 if "=" in word else float(options[options.index(word) + 1])
            value = -math.inf if comparison[name] is None else float(comparison[name])
            problems += (
                [f"{name} is {value:.6g}, and the target {target:g}"]
                if value > target + 1e-6
                else []
            )
    if match := re.search(r"look (\S+) of (\S+) in the worst frame drawn", line):
        worst = comparison.get("look_worst", 0.0)
        problems += (
            [f"look {match[1]} of the drawn frames, {worst:.4g} of all"]
            if float(match[1]) > worst + 6e-3
            else []
        )
        problems += (
            [f"look {worst:.4g} of {match[2]}"]
            if worst > float(match[2].rstrip(",")) * (1.0 + 1e-5)
            else []
        )
    return [problem for problem in problems if problem]


def _encoded(path: Path, stream: Path, options: Words) -> tuple[dict[str, Any], str] | None:
    """The JSON and the line of `bsm encode`; None: it refuses the mesh or the promise."""
    process = BSM("encode", path, "-o", stream, "-f", "--json", *options, text=True)
    if process.returncode:
        if process.returncode == 1 or "usage:" in process.stderr:
            raise AssertionError(f"{options}: {process.stderr}")
        return None
    facts: dict[str, Any] = json.loads(process.stdout)
    # Progress, too, where the machine is slow.
    events = map(json.loads, reversed(process.stderr.splitlines()))
    return facts, next(line["note"] for line in events if "note" in line)


def _compared(path: Path, stream: Path, *words: str) -> tuple[dict[str, Any] | None, str]:
    """The JSON of `bsm compare`, with looks if there is something to see, or its complaint."""
    process = BSM("compare", path, stream, "--json", "--look", *words, text=True)
    if process.returncode and "cannot be looked at" in process.stderr:
        process = BSM("compare", path, stream, "--json", *words, text=True)
    return (None if process.returncode else json.loads(process.stdout)), process.stderr


def _unlike(
    name: str,
    stated: float | None,
    measured: float | None,
    relative: float = 1e-4,
    absolute: float = 1e-9,
) -> str:
    """Say how a stated figure differs, if it does."""
    absolute = 1e-5 if name.endswith("_deg") else absolute
    if stated is None or measured is None:
        return "" if stated is measured else f"{name} is {measured}, not {stated}"
    alike = math.isclose(stated, measured, rel_tol=relative, abs_tol=absolute)
    return "" if alike else f"{name} is {measured:.6g}, not {stated:.6g}"


def cases(seed: int, folder: Path, *, frames: bool = False) -> Iterator[str]:
    """Encode one odd mesh, or sequence, with options that the seed draws; yield what differs."""
    random = np.random.default_rng(seed)
    mesh = odd(random)
    words = (MOVING if frames else STATIC)[seed % len(MOVING if frames else STATIC)]
    for name in ("normal", "color"):
        if f"{name}=" in " ".join(words) and not any(
            attribute.name == name for attribute in mesh.attributes
        ):
            mesh = odd(random, ("copies", name))
    if frames:
        problems = of_frames(
            moving(random, mesh, int(random.integers(1, 9))), mesh.faces, words, folder
        )
    else:
        problems = of_mesh(mesh, words, folder, "npz" if random.integers(2) else "ply")
    yield from (f"seed {seed}, {' '.join(words)}: {problem}" for problem in problems or ())


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("--count", type=int, default=200, help="of meshes (default: %(default)s)")
    parser.add_argument(
        "--seed", type=int, default=0, help="of the first one (default: %(default)s)"
    )
    parser.add_argument("--frames", action="store_true", help="sequences in place of meshes")
    parser.add_argument(
        "--turned",
        action="store_true",
        help="cones, globes, tubes and pinched ones, by each preset",
    )
    args = parser.parse_args()
    count, problems = 0, 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for seed in range(args.seed, args.seed + args.count):
            if args.turned:
                mesh = turned(np.random.default_rng(seed))
                each = {words: of_mesh(mesh, words, folder) for words in _OF_PRESETS}
                count += sum(findings is not None for findings in each.values())
                findings = [
                    f"seed {seed}, {' '.join(words)}: {p}"
                    for words, texts in each.items()
                    for p in texts or ()
                ]
            else:
                findings, count = list(cases(seed, folder, frames=args.frames)), count + 1
            problems += len(findings)
            print("\n".join(findings), end="\n" if findings else "", flush=True)
    print(
        f"{args.count} {'sequences' if args.frames else 'meshes'}, {count} streams, {problems} findings"
    )
    return 1 if problems else 0
