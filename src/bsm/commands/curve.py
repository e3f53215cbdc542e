"""bsm curve: measure rate against error for several codecs; write JSON, and draw pictures from it."""

import argparse
import csv
import importlib.util
import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bsm.bitstream.errors import DependencyError, OptionError, how_to_install
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.commands.flags import adder, within
from bsm.evaluation import curve as rates
from bsm.files.mesh import read_mesh
from bsm.files.output import refuse_to_overwrite, write_output
from bsm.ground.console import Console, print_json

GROUPS = ("ours", "paper", "draco")
_NEEDS = {"ours": (), "draco": ("DracoPy",)}
_PAPER_NEEDS = ("pymetis", "zstandard")
Table = tuple[Sequence[str], Sequence[Sequence[str]]]
"""Columns, and rows of cells."""
Save = Callable[[dict[str, Table], Iterable[rates.Picture]], None]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = adder(parser)
    add("meshes", "MESH", "mesh files. Without any, only draw earlier results", nargs="*")
    add(
        "-o --output",
        "OUT",
        "folder for JSON and pictures, or one picture (.png, .svg, .pdf)",
        required=True,
    )
    which = (
        "comma-separated codecs: ours, paper (SVD and orthogonal iterations, 12 bits), draco, or "
    )
    add(
        "--codecs",
        "LIST",
        f"{which}single lines such as svd,oi-r2 (default: all)",
        default=",".join(GROUPS),
    )
    blocks = "number of blocks for the codecs of the paper (default: blocks of 500 vertices)"
    points = "points of another codec: CSV with the columns label, bpv, theta_deg or nmsve_db, and mesh if there are "
    add(
        "--points",
        "FILE",
        f"{points}several; kept with the other results. May be repeated",
        action="append",
        default=[],
    )
    add("--blocks", "K", blocks, type=within(1))
    add(
        "--repeat",
        "N",
        "repeat each measurement; the fastest counts (default 1)",
        type=within(1),
        default=1,
    )
    add("--csv", "", "also write the tables as FOLDER/*.csv")
    add("--latex", "", "also write the tables as FOLDER/*.tex (booktabs)")
    add("--pdf", "", "also write the pictures as PDF")
    add("--json", "", "print the comparison with Draco as JSON")


def run(args: argparse.Namespace, console: Console) -> None:
    output = Path(args.output)
    kind = output.suffix[1:].lower()
    if kind in ("json", "csv", "tex"):
        raise OptionError(f"{output}: -o must be a folder or a picture (.png, .svg, .pdf)")
    if kind not in rates.PICTURES or output.is_dir():
        _run(args, output, console, partial(_save, folder=output, args=args, console=console))
        return
    if not args.meshes or args.csv or args.latex or args.pdf:
        raise OptionError(
            f"{output} is one picture of meshes; for tables or earlier results, give a folder: -o curves"
        )
    refuse_to_overwrite(output, args.force)
    pictures: list[rates.Picture] = []
    with TemporaryDirectory() as folder:
        _run(args, Path(folder), console, lambda _, drawn: pictures.extend(drawn))
    if not pictures:
        raise OptionError(f"{output}: nothing to draw: all points are exact")
    picture = rates.in_a_row(output.stem, pictures)
    picture.save(output.parent, (output.suffix[1:],), overwrite=args.force, follow=True)
    console.note(str(output))


def _run(args: argparse.Namespace, folder: Path, console: Console, save: Save) -> None:
    # A run takes minutes to hours. It must not end at the last step, for want of a package.
    codecs = "ours"
    if args.meshes:
        codecs = args.codecs
    _refuse_missing(codecs)
    # All meshes are read before the first is measured, for the same reason, and so are the points of others.
    # Rates are those of the shape.
    chosen = [(Path(path).stem, read_mesh(path).mesh.bare) for path in args.meshes]
    facts = {result["mesh"]["name"]: result["mesh"] for result in rates.read_results(folder)}
    facts |= {name: rates.mesh_facts(mesh, name) for name, mesh in chosen}
    for path in args.points:
        for rival in rates.read_points(path, facts):
            rates.write_result(rival, folder)
    for name, mesh in chosen:
        measure = partial(_measure, mesh, name, args.repeat, folder, console)
        curves, ours = _chosen(args.codecs, len(mesh.positions), args.blocks)
        for curve in curves:
            measure(curve)
        if ours:
            # Last, since it is asked for the errors of the others' points.
            rivals = _rivals(rates.read_results(folder), name)
            measure(rates.our_curve(rivals))
    results = list(rates.read_results(folder))
    if not results:
        raise OptionError(f"{folder} contains no results; name meshes to measure")
    comparisons = _comparisons(results)
    tables = {"points": _measured(results)}
    if comparisons:
        tables["draco"] = _compared(comparisons)
    if args.json:
        print_json({"comparisons": comparisons})
    else:
        print(_words(tables))
    for row in comparisons:
        for measure, count in row["beaten"].items():
            if count:
                place = f"{row['mesh']}, {row['codec']}"
                left_out = f"its BD-rate by {measure} leaves out {count} of its points"
                console.note(f"{place}: {left_out}, which are larger and worse than another one")
    save(tables, rates.draw_all(results, args.codecs.split(",")))


def _rivals(results: Iterable[dict[str, Any]], name: str) -> Iterator[dict[str, Any]]:
    """Yield the results of other codecs for a mesh."""
    for result in results:
        if result["mesh"]["name"] == name and result["codec"] != "ours":
            yield result


def _comparisons(results: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Compare each curve with Draco's for the same mesh, where there is one."""
    draco = {result["mesh"]["name"]: result for result in results if result["codec"] == "draco"}
    comparisons = []
    for result in results:
        name = result["mesh"]["name"]
        if result["codec"] != "draco" and name in draco:
            comparisons.append(rates.compare_curves(draco[name], result))
    return comparisons


def _measure(
    mesh: TriangleMesh, name: str, repeats: int, folder: Path, console: Console, curve: rates.Curve
) -> None:
    with console.progress(f"{name}, {curve.label}") as progress:
        result = rates.run_curve(curve, mesh, name, repeats, progress, console.note)
    # After each curve, so that a run that is stopped keeps its results.
    rates.write_result(result, folder)


def _refuse_missing(codecs: str) -> None:
    """Raise an error that names all missing packages, before anything is measured."""
    packages = {name for word in codecs.split(",") for name in _NEEDS.get(word, _PAPER_NEEDS)}
    packages |= {"scipy", "matplotlib", "tabulate"}
    missing = sorted(name for name in packages if importlib.util.find_spec(name) is None)
    if missing:
        raise DependencyError(f"this needs {', '.join(missing)}; run: {how_to_install('eval')}")


def _save(
    tables: dict[str, Table],
    pictures: Iterable[rates.Picture],
    folder: Path,
    args: argparse.Namespace,
    console: Console,
) -> None:
    for name, (columns, rows) in tables.items():
        file = io.StringIO()
        csv.writer(file, lineterminator="\n").writerows([columns, *rows])
        texts = {}
        if args.csv:
            texts["csv"] = file.getvalue()
        if args.latex:
            texts["tex"] = rates.table(columns, rows, "latex_booktabs") + "\n"
        for suffix, text in texts.items():
            write_output(folder / f"{name}.{suffix}", text.encode(), overwrite=True, follow=False)
            console.note(str(folder / f"{name}.{suffix}"))
    console.note(f"{folder}: results as JSON")
    formats = [*rates.FORMATS]
    if args.pdf:
        formats.append("pdf")
    for picture in pictures:
        for path in picture.save(folder, formats):
            console.note(str(path))


def _chosen(names: str, vertices: int, blocks: int | None) -> tuple[list[rates.Curve], bool]:
    """The curves of other codecs, and whether ours is asked for, too."""
    block_size = 500  # vertices, as in the blocks of the paper's figures
    if blocks:
        block_size = round(vertices / blocks)
    paper = rates.paper_curves(block_size)
    groups: dict[str, tuple[rates.Curve, ...]] = {
        "ours": (),
        "paper": paper,
        "draco": (rates.DRACO,),
    }
    for line in paper:
        groups[line.name] = (line,)
    chosen = names.split(",")
    unknown = [name for name in chosen if name not in groups]
    if unknown:
        raise OptionError(f"unknown codec {', '.join(unknown)} ({', '.join(groups)})")
    curves: list[rates.Curve] = []
    for name in chosen:
        curves += groups[name]
    return curves, "ours" in chosen


def _measured(results: Sequence[dict[str, Any]]) -> Table:
    def setting(result: dict[str, Any], point: dict[str, Any]) -> str:
        target = point["settings"].get("target")
        if not target:
            return f"{result['codec']}"
        return f"{result['codec']}, {target['value']:.4g}{rates.UNITS[target['kind']]}"

    digits = {"bpv_total": 3, "bpv_paper": 2, "nmsve_db": 2, "nmsve_paper_db": 2, "theta_deg": 2}
    digits |= {"encode_seconds": 3, "decode_seconds": 3}
    rows = []
    for result in results:
        for point in result["points"]:
            numbers = [rates.number(point.get(name), count) for name, count in digits.items()]
            rows.append((result["mesh"]["name"], setting(result, point), *numbers))
    columns = ("mesh", "codec", "bpv, file", "bpv, paper", "NMSVE, dB", "as printed, dB", "theta")
    return (*columns, "encode, s", "decode, s"), rows


def _compared(comparisons: Sequence[dict[str, Any]]) -> Table:
    rows = []
    for row in comparisons:
        cells = [row["mesh"], row["codec"]]
        for angle in ("7", "10"):
            cells += [rates.number(row["bytes_at_theta"][angle], 3)]
        for name in rates.UNITS:
            cells += [_signed_percent(row["bd_rate_percent"][name])]
        rows.append(tuple(cells))
    return (
        "mesh",
        "codec",
        "bytes at 7°",
        "bytes at 10°",
        "BD-rate, theta",
        "BD-rate, NMSVE",
    ), rows


def _signed_percent(rate: float | None) -> str:
    if rate is None:
        return "-"
    return f"{rate:+.1f} %"


def _words(tables: dict[str, Table]) -> str:
    measured = rates.table(*tables["points"])
    if "draco" not in tables:
        return measured
    read = "Bytes as a share of Draco's at the same mean angle; BD-rate: the mean difference of bytes at equal error."
    read += "\nIn the plots, points further left are smaller, and lower points are closer. Right of its knee, a line "
    read += "takes 3 bits per vertex to halve the error."
    return f"{measured}\n\nAgainst Draco, whole files (smaller is better):\n\n{rates.table(*tables['draco'])}\n\n{read}"
