"""bsm compare: measure the error of a mesh or sequence against an original with the same faces."""

import argparse
import errno
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, replace
from itertools import pairwise, repeat
from pathlib import Path
from typing import Any

import numpy as np

from bsm.account.comparison import (
    Errors,
    Pair,
    compare_meshes,
    errors_of,
    errors_of_frames,
    names_apart,
    one_each,
    order_of_used,
    pair,
    paired_frames,
    read_permutation,
)
from bsm.account.drawing import Panel, drawing, last_color
from bsm.account.images import compare_images
from bsm.account.overview import load_mesh, report_kind, write_page, write_table
from bsm.bitstream.errors import BsmError, MeshError, OptionError, counted
from bsm.bitstream.limits import as_limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute, Semantic
from bsm.codec.geometry.mesh import Metadata, TriangleMesh, require_sizes
from bsm.codec.geometry.metrics import (
    Reference,
    distances_to_surface,
    folded_edges,
    rms_over_edge,
    surface_distance,
)
from bsm.codec.look.measure import LOOK_VERSION, AttributeLook, Look, LookMetric, look_values
from bsm.codec.sequence.targets import Runs, compare_runs
from bsm.commands.flags import add_flags
from bsm.files.formats.polygons import without_compression_notes
from bsm.files.images import with_linked_images
from bsm.files.mesh import read_mesh, save_written, written_mesh
from bsm.files.motion.folder import names_many
from bsm.files.motion.frames import Wanted
from bsm.files.output import refuse_to_overwrite, write_output
from bsm.files.pipes import about, read_chunks, size_of
from bsm.files.sequence import open_sequence
from bsm.files.stream import SequenceStream, decode_whole, is_scene, is_stream, peek_header
from bsm.files.table import MESH_SUFFIXES, by_name, format_of_name
from bsm.ground.console import Console, Progress, as_json, finite, print_json, printable
from bsm.ground.exits import exit_of, worded
from bsm.ground.lengths import length, metres, unit_of
from bsm.ground.pictures import DEFAULT_VIEW, colors_of
from bsm.jobs.plan import STREAM_SUFFIXES, files_in
from bsm.jobs.report import largest_error
from bsm.jobs.task import Facts

# STL and OFF have colors of faces at best, and the map has one for each vertex.
COLORED = ("ply", "obj", "glb")  # formats that hold colors of vertices
ATTRIBUTE_LOOKS: dict[Semantic, str] = {"texcoord": "checker", "color": "colors"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_flags(parser, "compare", "limits")


_FIGURES = Path(__file__).with_name("figures.txt").read_text("utf-8").splitlines()
EXPLAINED = dict(line.split(": ", 1) for line in _FIGURES)


def run(args: argparse.Namespace, console: Console) -> int:
    # Two commands in one: trees are compared file by file, with one line each.
    if args.recursive:
        return _compare_trees(args, console)
    if args.report:
        raise OptionError(
            "--report is for folders, with -r; --json prints the result of one comparison"
        )
    _compare_one(args, console)
    return 0


def _compare_trees(args: argparse.Namespace, console: Console) -> int:
    """Compare the files of two folders, with a line for each, and the largest error; return the code of a failure."""
    if args.map or args.picture or args.permutation or args.surface:
        raise OptionError(
            "-r compares whole folders; leave out --surface, --picture, --map and --permutation"
        )
    if args.report:
        report_kind(args.report)
        refuse_to_overwrite(args.report, args.force)
    paths = files_in([args.original], (*MESH_SUFFIXES, *STREAM_SUFFIXES))
    rows: list[Facts] = []
    for _, original_path in paths:
        path = str(original_path)
        facts: Facts = {"input": path}
        try:
            sentence_of_pair = _compare_files(facts, args, console)
        # One file that cannot be compared must not end the run: the others are compared, and the exit code tells of the
        # failure.
        except (BsmError, OSError) as error:
            facts |= {"error": worded(error), "exit": exit_of(error).code}
            sentence_of_pair = f"not compared: {facts['error']}"
        rows.append(facts)
        if not args.json:
            print(f"{path}: {sentence_of_pair}")
    good = [facts for facts in rows if "error" not in facts]
    if args.report:
        write_output(args.report, _report_of(rows, args), overwrite=args.force)
    if args.json:
        print_json({"files": rows})
    else:
        line = f"{len(good)} of {counted(files=len(rows))} compared"
        worst = largest_error(good)
        if worst:
            line += f"; largest vertex error {worst}"
        print(line)
    # The code of the first failure, as in all commands that take many inputs.
    return next((int(facts["exit"]) for facts in rows if "error" in facts), 0)


def _compare_files(facts: Facts, args: argparse.Namespace, console: Console) -> str:
    """Compare an input with the file of its name; add to its facts, and return them as a sentence."""
    path = facts["input"]
    facts["output"] = counterpart = _same_name(path, args)
    original = _load_used(path, args, console)
    decoded = _load_used(counterpart, args, console)
    facts |= {"input_bytes": size_of(path), "output_bytes": size_of(counterpart)}
    if args.look:
        facts["look"] = LookMetric(original).compare(decoded).distance
    images = compare_images(original.metadata, decoded.metadata)
    if images:
        facts["images"] = [image.facts() for image in images]
    facts |= _compared(original, decoded, pair(original, decoded), args, console)
    unit = unit_of(original.metadata) or unit_of(decoded.metadata)
    if unit:
        facts["unit"] = unit
    text = sentence(facts, unit)
    if args.look:
        text = f"look {facts['look']:.3g}; {text}"
    return text


def _report_of(results: list[Facts], args: argparse.Namespace) -> bytes:
    """Return the results of two folders in the format that the name of the report tells."""
    kind = report_kind(args.report)
    if kind == "csv":
        return write_table(results)
    if kind == "html":
        return write_page(f"{args.original} and {args.decoded}", results, load_mesh)
    return json.dumps({"files": results}, indent=1).encode() + b"\n"


def _same_name(path: str, args: argparse.Namespace) -> str:
    """The file in B that has the name of one in A, whatever its format."""
    place = Path(args.decoded, Path(path).relative_to(args.original))
    endings = (*STREAM_SUFFIXES, *MESH_SUFFIXES)
    bare = place.with_suffix("")
    # An output may keep the suffix of its input (part.obj.bsm) or replace it (part.bsm). The name as it stands comes
    # first.
    candidates = [place]
    candidates += [Path(f"{place}{end}") for end in endings]
    candidates.append(bare)
    candidates += map(place.with_suffix, endings)
    for candidate in candidates:
        if candidate.is_file():
            return str(candidate)
    raise FileNotFoundError(errno.ENOENT, "no file of this name, in any format", str(bare))


def _compare_one(args: argparse.Namespace, console: Console) -> None:
    # Sequences first: a folder or npz is none of the mesh formats, and an error about those would mislead.
    try:
        if _compare_sequences(args, console):
            return
    except BsmError as error:
        if Path(args.original).is_dir() and Path(args.decoded).is_dir():
            error.message += "; to compare the files of two folders by their names, add -r"
        raise
    with console.progress("reading") as progress:
        pair_as_read = (_load(args.original, args, console), _load(args.decoded, args, console))
        # Only a note: the numbers are right as they are, but they may not be what the user takes them for.
        for name, normal_form in (("up", str.lower), ("unit", metres)):
            ours, theirs = (str(mesh.metadata.get(name, "")) for mesh in pair_as_read)
            if ours and theirs and normal_form(ours) != normal_form(theirs):
                console.note(
                    f"positions are compared as they are, and {name} is {printable(ours)} and {printable(theirs)}"
                )
        original, decoded = (mesh.without_isolated_vertices()[0] for mesh in pair_as_read)
        distance: Look | None = None
        more: dict[str, float] = {}
        if args.look or args.picture:
            progress.stage("comparing pictures")
            # The look comes before the errors of vertices: it needs no matching faces, and those may end with an error.
            distance, more = _seen(args, original, decoded, console)
        progress.stage("comparing")
        try:
            order = None
            if args.permutation:
                order = order_of_used(read_permutation(args.permutation), *pair_as_read)
            compared = _compared(original, decoded, pair(original, decoded, order), args, console)
        except MeshError as error:
            # Look and surface are measured without matching vertices. If the user asked for one of them, the command
            # has an answer.
            if distance is None and not args.surface:
                raise
            console.note(f"vertices are not compared: {str(error).partition(';')[0]}")
            compared = {}
            if args.surface:
                compared = _apart(original, decoded)
    attributes, images = (
        compared.pop("attributes", {}),
        compare_images(original.metadata, decoded.metadata),
    )
    apart = names_apart(original, decoded)
    if args.json:
        facts: dict[str, Any] = {}
        if distance:
            facts["look"] = asdict(distance) | more | {"version": LOOK_VERSION}
        if images:
            facts["images"] = [image.facts() for image in images]
        if attributes:
            facts["attributes"] = attributes
        print_json({**compared, **facts, **apart})
        return
    if "max_error" in compared:
        print(sentence(compared, unit_of(original.metadata) or unit_of(decoded.metadata)))
    looks: dict[str, float] = {}
    if distance:
        looks["look"] = distance.distance
        looks |= {f"look_{name}": value for name, value in more.items()}
    for line in explained(compared | looks):
        print(line)
    for line in _lines_of(attributes):
        print(line)
    paths = {"only_in_original": args.original, "only_in_decoded": args.decoded}
    for where, names in apart.items():
        print(printable(f"only in {paths[where]}: {', '.join(names)}"))
    for image in images:
        print(printable(str(image)))


def _lines_of(attributes: dict[str, Errors | None]) -> Iterator[str]:
    for name, errors in attributes.items():
        words = "missing"
        if errors:
            words = ", ".join(f"{what} {value:.4g}" for what, value in errors.items())
        yield f"{printable(name)}: {words}"


def _seen(
    args: argparse.Namespace, original: TriangleMesh, decoded: TriangleMesh, console: Console
) -> tuple[Look, dict[str, float]]:
    """Return the look of a mesh, and that in flat shading, of texture coordinates and of colors; write the picture."""
    # An output that exists is refused before minutes of drawing, not after them.
    if args.picture:
        refuse_to_overwrite(args.picture, args.force)
    looker = LookMetric(original)
    distance, more = looker.compare(decoded), {"flat": looker.flat(decoded)}
    for semantic, name in ATTRIBUTE_LOOKS.items():
        values = look_values(original, semantic)
        if values is None:
            continue
        under_it = AttributeLook(original, semantic, values).compare(decoded)
        if under_it is not None:
            more[name] = under_it
    if args.picture:
        titles = (Path(args.original).name, Path(args.decoded).name)
        meshes = [Panel(mesh, title) for mesh, title in zip((original, decoded), titles)]
        # From the side where the difference is largest: any other might show nothing of it.
        picture = drawing(
            (*meshes, _errors_of(original, decoded)), original, console, looker.view(decoded)
        )
        write_output(args.picture, picture, overwrite=args.force)
    return distance, more


def _errors_of(original: TriangleMesh, decoded: TriangleMesh) -> Panel:
    """The error of each vertex; where the faces differ, its distance from the surface of the original."""
    try:
        paired = pair(original, decoded)
    except MeshError:
        # One direction is enough for colors: each vertex that is drawn has a distance.
        far = distances_to_surface(decoded.positions, original.positions, original.faces)
        return Panel(decoded, "distance from the original", far)
    return Panel(
        paired.original,
        "error",
        np.linalg.norm(paired.positions - paired.original.positions, axis=1),
    )


def explained(numbers: dict[str, Any]) -> list[str]:
    lines = []
    for name, value in numbers.items():
        number = "-inf"
        if value is not None:
            number = f"{value:.6g}"
        lines.append(f"{name:<18} {number:<12} {EXPLAINED.get(name, '')}".rstrip())
    return lines


def _compared(
    original: TriangleMesh,
    decoded: TriangleMesh,
    paired: Pair,
    args: argparse.Namespace,
    console: Console,
) -> dict[str, Any]:
    if paired.joined:
        console.note("vertices at one position are merged for this comparison")
    if args.map:
        _write_map(args, paired.original, paired.positions, original.metadata, console)
    compared = compare_meshes(original, decoded, paired)
    result = {name: value for name, value in asdict(compared).items() if name != "attributes"}
    attributes = errors_of(compared.attributes, original)
    before, after, faces = paired.original.positions, paired.positions, paired.original.faces
    result |= {
        "folded_before": folded_edges(before, faces),
        "folded_after": folded_edges(after, faces),
    }
    if args.surface:  # what the literature on denoising measures
        result |= {
            "mnd": Reference(before, faces).mnd(after),
            "rms_over_edge": rms_over_edge(before, after, faces),
        }
        result |= _apart(original, decoded)
    return {**{name: finite(value) for name, value in result.items()}, "attributes": attributes}


def _apart(original: TriangleMesh, decoded: TriangleMesh) -> dict[str, float]:
    """The distances between two surfaces."""
    require_sizes(np.concatenate([original.positions, decoded.positions]), done="compared")
    # Squares of distances overflow for coordinates beyond 1e150, and would come out as "no distance".
    distances = surface_distance(
        original.positions, original.faces, decoded.positions, decoded.faces
    )
    relative = distances.hausdorff / (original.diagonal or 1.0)
    return {
        "hausdorff": distances.hausdorff,
        "surface_distance": distances.mean,
        "hausdorff_relative": relative,
    }


def sentence(compared: dict[str, Any], unit: str) -> str:
    # Not a sentence full of zeros: equality is what users of lossless streams look for.
    parts, share = ["all vertices are equal"], 100.0 * compared["max_error_relative"]
    if share > 0.0:
        # The ratio of both relative figures gives the length without asking for the diagonal again.
        rms = compared["rms_relative"] / compared["max_error_relative"] * compared["max_error"]
        parts = [
            f"largest vertex error {length(compared['max_error'], unit)}, {share:.3g} % of the diagonal",
            f"root mean square {length(rms, unit)}",
            f"mean normal error {compared['angle_deg']:.3g} degrees, weighted by area",
        ]
    if compared["flattened"]:
        parts.append(f"{counted(triangles=compared['flattened'])} flattened by rounding")
    if compared["merged"]:
        parts.append(f"{counted(vertices=compared['merged'])} merged by rounding")
    return "; ".join(parts)


def _load(path: str, args: argparse.Namespace, console: Console) -> TriangleMesh:
    """A mesh file or a stream."""
    with about(path):
        if is_stream(path):
            # Streams of a batch may have their images beside them. Without these, all images would count as missing.
            return with_linked_images(decode_whole(read_chunks(path), as_limits(args.limits)), path)
        source = read_mesh(path)
    for note in without_compression_notes(source.notes):
        console.note(f"{path}: {note}")
    return source.mesh


def _load_used(path: str, args: argparse.Namespace, console: Console) -> TriangleMesh:
    """A mesh file or a stream, without its isolated vertices."""
    return _load(path, args, console).without_isolated_vertices()[0]


def _compare_sequences(args: argparse.Namespace, console: Console) -> bool:
    paths, changing = (args.original, args.decoded), Wanted(runs=True)
    with console.progress("reading") as progress:
        sides = []
        for path in paths:
            request = None
            if names_many(path):
                request = changing
            sides.append(_load_sequence(path, args, request))
        if sides == [None, None]:
            return False
        # An animated glTF can be meant either way. It is a sequence where the other one is.
        for number, path in enumerate(paths):
            if sides[number] is None:
                sides[number] = _load_sequence(path, args, changing)
        original, decoded = sides
        if original is None or decoded is None:
            moving, still = paths
            if original is None:
                moving, still = still, moving
            # If the still one cannot be read at all, that is the better message.
            _load(still, args, console)  # what cannot be read says so
            raise MeshError(f"{moving} is a sequence, but {still} is a single mesh")
        if args.map:
            raise OptionError(
                "--map is for single meshes; for sequences, --picture draws the error of each frame"
            )
        progress.stage("comparing")
        text = _compared_sequences(args, original, decoded, progress)
    print(text)
    return True


Attributes = Sequence[Attribute]
Frames = list[tuple[Positions, Faces, Attributes]]


def _runs_of(original: Frames, decoded: Frames) -> Iterator[tuple[Frames, Frames]]:
    """Frames between which the faces of neither side change: one may have fewer runs, if faces lose their area."""
    starts = [0]
    for number, (one, second) in enumerate(
        zip(pairwise(original), pairwise(decoded), strict=True), 1
    ):
        # Equal faces, not the same array: some readers make new ones for each frame.
        if any(len(a[0]) != len(b[0]) or not np.array_equal(a[1], b[1]) for a, b in (one, second)):
            starts.append(number)
    for begin, end in pairwise([*starts, len(original)]):
        yield original[begin:end], decoded[begin:end]


def _load_sequence(path: str, args: argparse.Namespace, request: Wanted | None) -> Frames | None:
    """The frames and faces of a file, folder or stream; None if it is a mesh."""
    with about(path):
        pieces = _pieces_of_stream(path)
        if pieces is not None:
            header, chunks = peek_header(pieces)
            if header is None or not header.gop_frames:
                return None
            stream = SequenceStream(chunks, limits=as_limits(args.limits))
            return [
                (frame, stream.faces, stream.attributes) for _, frame in stream.changing_frames()
            ]
        source = open_sequence(path, request=request)
        if source is None:
            return None
        if source.meshes is None:
            return [(frame, source.faces, source.attributes) for frame in source.frames]
        return [(mesh.positions, mesh.faces, mesh.attributes) for mesh in source.meshes]


def _pieces_of_stream(path: str) -> Iterator[bytes] | None:
    """The bytes of a stream, or of that in a scene that moves; None if there is none."""
    if not Path(path).is_file():
        return None
    if is_scene(path):
        # Looked up by name: the module takes long to load, and few inputs are scenes.
        moving = by_name("bsm.gltf.document", "read_document")(path).moving
        if moving:
            return iter([moving])
    if is_stream(path):
        return read_chunks(path)
    return None


def _compared_sequences(
    args: argparse.Namespace, original: Frames, decoded: Frames, progress: Progress
) -> str:
    """Return the errors of a sequence, as text."""
    if len(original) != len(decoded):
        raise MeshError(
            f"{args.original} has {len(original)} frames and {args.decoded} {len(decoded)}"
        )
    pairs = list(_runs_of(original, decoded))
    if args.permutation and len(pairs) > 1:
        raise OptionError("--permutation is the order of one mesh, and the faces change")
    order = None
    if args.permutation:
        order = read_permutation(args.permutation)
    runs: list[tuple[Positions, Positions, Faces]] = []
    attributes: dict[str, Errors | None] = {}
    for first, second in pairs:
        (before, (ours, *_), values), (after, (theirs, *_), decoded_values) = (
            zip(*first),
            zip(*second),
        )
        paired = paired_frames(np.array(before), ours, np.array(after), theirs, order)
        used, faces = one_each(paired.before, paired.after, paired.faces, len(theirs))
        count = sum(len(before) for before, _, _ in runs)
        for name, errors in errors_of_frames(
            values, decoded_values, (ours, theirs), paired, count
        ).items():
            earlier = attributes.get(name, errors)
            # None stands for a missing attribute, and once it is missing in some run, the whole must say so.
            larger = (errors and earlier) and max(errors, earlier, key=lambda one: one["max_error"])
            attributes[name] = larger or None
        runs.append((paired.before[:, used], paired.after[:, used], faces))
    compared, of_frames = compare_runs(runs)
    result = asdict(compared)
    if args.look:
        progress.stage("comparing all frames")
        result.update(_looks(runs, progress))
        progress.stage("comparing")
    if Path(args.decoded).is_file() and is_stream(args.decoded):
        samples = sum(len(positions) for positions, _, _ in decoded)
        # By the size of the file itself, so that everything counts: header, metadata and checksums.
        result["bpvf_total"] = 8 * Path(args.decoded).stat().st_size / samples
    if args.picture:
        from bsm.evaluation.curve import frame_errors

        refuse_to_overwrite(args.picture, args.force)
        write_output(
            args.picture, frame_errors(of_frames, Path(args.decoded).name), overwrite=args.force
        )
    if args.json:
        numbers: dict[str, Any] = {name: finite(value) for name, value in result.items()}
        if attributes:
            numbers["attributes"] = attributes
        return as_json({**numbers, "frames": of_frames})
    worst = max(range(len(of_frames)), key=lambda number: of_frames[number]["max_error_relative"])
    lines = explained(result)
    lines.append(f"{'worst_frame':<18} {worst:<12} the frame with the largest vertex error")
    return "\n".join([*lines, *_lines_of(attributes)])


def _looks(runs: Runs, progress: Callable[[int, int], None]) -> dict[str, float]:
    """Return the look distances of the worst frame and the mean of all visible frames; see `codec.look`."""
    distances = []
    pairs: list[tuple[Positions, Positions, Faces]] = []
    for first, second, faces in runs:
        pairs += zip(first, second, repeat(faces, len(first)), strict=True)
    for number, (before, after, faces) in enumerate(pairs):
        progress(number, len(pairs))
        # A frame may have collapsed to nothing visible, as at the end of an explosion. The others still count.
        with suppress(MeshError):
            distances.append(LookMetric(TriangleMesh(before, faces)).look(after))
    if not distances:
        raise MeshError("the sequence cannot be looked at: its faces have no area in any frame")
    moving = [look.moving for look in distances]
    return {
        "look_worst": max(moving),
        "look_mean": float(np.mean(moving)),
        "unlike_worst": max(look.unlike for look in distances),
    }


def _write_map(
    args: argparse.Namespace,
    original: TriangleMesh,
    positions: Positions,
    metadata: Metadata,
    console: Console,
) -> None:
    """Write the original with the distance of each vertex from `positions`, shape (n, 3), as colors."""
    path, overwrite = args.map, args.force
    kind = format_of_name(path)
    if Path(path).suffix.lower() == ".png":
        kind = "png"
    if kind not in ("png", *COLORED):
        raise OptionError(
            f"{path}: a map of distances is a picture (.png) or a mesh (.{', .'.join(COLORED)})"
        )
    refuse_to_overwrite(path, overwrite)
    distances = np.linalg.norm(positions - original.positions, axis=1)
    top, largest = last_color(distances), float(distances.max(initial=0.0))
    unit = unit_of(metadata)
    console.note(
        f"{path}: red is {length(top, unit)} and more; the largest error is {length(largest, unit)}"
    )
    if kind == "png":
        labelled = replace(original, metadata=metadata)
        # Errors on the far side would be hidden, so the picture shows both.
        behind = DEFAULT_VIEW * np.array([[-1.0], [1.0], [-1.0]])
        panel = Panel(labelled, f"error of {Path(args.decoded).name}", distances)
        picture = drawing([panel], labelled, console, DEFAULT_VIEW, behind)
        write_output(path, picture, overwrite=overwrite)
        return
    color = Attribute(
        "color", np.rint(colors_of(distances / top)).astype(np.uint8), "vertex", "color"
    )
    # The distances themselves are kept as well: other programs can choose their own colors.
    mesh = replace(original.bare, attributes=(color, Attribute("distance", distances)))
    save_written(path, written_mesh(mesh, kind, path), overwrite=overwrite)
