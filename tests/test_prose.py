"""Numbers that stand in sentences: ranges in documents, against what streams and the code say today."""

import json
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from bsm import Decoder, EncodeOptions, EndEvent, denoise, encode, read_mesh
from bsm.codec.blocks.overlap import block_size, grow_blocks, metis_partition
from bsm.codec.denoise.coarse import OVERLAP, RULES
from bsm.codec.geometry.metrics import Reference
from bsm.codec.static.ways.in_cells import CHAIN, SPREADS
from bsm.files.inspection import Skimmer, StreamInfo, inspect_stream
from tests.blocks import graph_of
from tests.codec.static.test_cells import stream
from tests.shapes import theta
from tools.replicate.quotes import KEPT

ROOT = Path(__file__).parents[1]
SCANS = ("bunny_34834", "gargoyle_10002", "horse_48485")


def numbers(document: str, pattern: str) -> tuple[float, ...]:
    """The numbers of a sentence, whose lines may be broken anywhere."""
    text = " ".join((ROOT / document).read_text("utf-8").split())
    match = re.search(pattern, text)
    assert match, f"{document} does not say {pattern}"
    return tuple(float(number.replace(",", "")) for number in match.groups())


@cache
def real_stream(path: Path) -> bytes:
    return encode(str(path), threads=1)


def shares(info: StreamInfo) -> dict[str, float]:
    """Percent of the bytes: blocks, the whole shape, and connectivity."""
    kinds, total = info.positions, info.sizes["total"]
    shape = info.sizes["connectivity"] + kinds["blocks"] + kinds["levels_of_cells"]
    sizes = {"blocks": kinds["blocks"], "shape": shape, "connectivity": info.sizes["connectivity"]}
    return {name: 100 * size / total for name, size in sizes.items()}


SHARES = {
    ("README.md", r"with ([\d.]+) to ([\d.]+) % of the bytes; without them a scan"): "blocks",
    ("docs/how-it-works.md", r"Blocks alone take ([\d.]+) to ([\d.]+) %"): "blocks",
    ("docs/how-it-works.md", r"the whole shape, after (\d+) to (\d+) % of the bytes"): "shape",
    (
        "docs/guides/streaming.md",
        r"connectivity comes first: (\d+) to (\d+) % of the default stream",
    ): "connectivity",
}


@pytest.mark.real
@pytest.mark.parametrize("name", SCANS)
def test_shares_of_scans_are_those_that_documents_tell(meshes: Path, name: str) -> None:
    info = inspect_stream(iter([real_stream(meshes / "static" / f"{name}.ply")]))
    assert info.header.base
    for (document, pattern), part in SHARES.items():
        least, most = numbers(document, pattern)
        assert least <= shares(info)[part] <= most, f"{document}: {part} of {name}"
    cells = info.header.vertices / info.header.base[0]
    for document, pattern in (
        ("codec/PAPER.md", r"cells of (\d+) to (\d+) vertices"),
        ("docs/how-it-works.md", CELL),
    ):
        least, most = numbers(document, pattern)
        assert least <= cells <= most


def test_measured_shares_lie_in_the_ranges_of_the_readme() -> None:
    """Those of sixteen scans, which `python -m tools.replicate --shares` measured and keeps."""
    kept = json.loads(KEPT.read_text("utf-8"))["numbers"]["shares"]
    least, most = numbers(
        "README.md", r"with ([\d.]+) to ([\d.]+) % of the bytes; without them a scan"
    )
    fewest, largest = map(float, kept["blocks"].split(" to "))
    assert least <= fewest < largest <= most
    least, most = numbers("README.md", r"without them a scan takes (\d+) to (\d+) % more")
    fewest, largest = (100 * (float(ratio) - 1) for ratio in kept["without"].split(" to "))
    assert least <= fewest < largest <= most


CELL = r"the vertices near it, (\d+) to (\d+)"


def test_cells_of_a_made_scan_are_as_large_as_documents_tell() -> None:
    info = inspect_stream(iter([stream()]))
    least, most = numbers(
        "docs/guides/streaming.md", r"cells of (\d+) to (\d+) vertices, in chains of at most four"
    )
    assert least <= info.header.vertices / info.header.base[0] <= most and CHAIN == 4


def test_constants_in_sentences_are_those_of_the_code() -> None:
    chains = numbers(
        "codec/PAPER.md",
        r"chains of at most (\d+) blocks of cells, (\d+) blocks of the mesh itself .*?, and (\d+) in",
    )
    assert chains == (CHAIN, EncodeOptions().key_interval, RULES.key_interval)
    rounds = {spread.rounds for spread in SPREADS}
    for document in ("codec/PAPER.md", "docs/how-it-works.md"):
        assert set(numbers(document, r"(\d+) or (\d+) rounds of smoothing")) == rounds


@pytest.mark.real
@pytest.mark.parametrize(("name", "place"), [("bunny_34834", 0), ("horse_48485", 1)])
def test_a_damaged_block_loses_what_the_page_of_streaming_tells(
    meshes: Path, name: str, place: int
) -> None:
    pattern = r"about 1,800 cells: ([\d,]+) vertices of the bunny, ([\d,]+) of the horse"
    told = numbers("docs/guides/streaming.md", pattern)[place]
    data, skimmer = real_stream(meshes / "static" / f"{name}.ply"), Skimmer()
    packets = [packet for chunk in (data, None) for packet in skimmer.receive(chunk)]
    missing, degraded = 0, 0
    for packet in packets:
        if packet.type != 6:
            continue
        damaged = bytearray(data)
        damaged[packet.offset + packet.length - 6] ^= 255
        with Decoder(tolerant=True, threads=1) as decoder:
            (end,) = (
                event for event in decoder.events([bytes(damaged)]) if isinstance(event, EndEvent)
            )
        missing, degraded = (
            max(missing, len(end.losses.missing)),
            max(degraded, len(end.losses.degraded)),
        )
    assert 0.85 * told < missing < 1.15 * told
    assert 0.5 * missing < degraded < 2.0 * missing  # "about as many again"


@pytest.mark.real
def test_the_scheme_of_the_paper_leaves_the_angles_that_are_told(meshes: Path) -> None:
    pytest.importorskip("pymetis", reason="needs METIS")
    coarse = numbers(
        "docs/guides/denoising.md", r"coarse step of `oi` leaves ([\d.]+) and ([\d.]+) degrees"
    )
    fine = numbers(
        "docs/guides/denoising.md", r"fandisk keeps ([\d.]+) degrees with `oi`, and ([\d.]+) with"
    )
    twelve = "twelve_dodecahedron", "twelve_dodecahedron_noisy"
    fandisk = "fandisk_6475", "fandisk_0.7_noisy"
    cases = (
        (twelve, {"method": "oi", "iterations": 0}, coarse[0]),
        (fandisk, {"method": "oi", "iterations": 0}, coarse[1]),
        (fandisk, {"method": "oi"}, fine[0]),
        (fandisk, {"method": "spectral"}, fine[1]),
    )
    for (clean, noisy), options, told in cases:
        original = read_mesh(meshes / "static" / f"{clean}.ply").mesh
        given = read_mesh(meshes / "noisy" / f"{noisy}.ply").mesh
        result = denoise(given, force=True, **options)
        assert theta(original.positions, result.positions, given.faces) == pytest.approx(
            told, abs=0.15
        )


@pytest.mark.real
def test_most_vertices_have_all_their_neighbors_in_one_block(meshes: Path) -> None:
    pytest.importorskip("pymetis", reason="needs METIS")
    alone, least, most = numbers(
        "codec/PAPER.md", r"(\d+) % of the vertices of fandisk .*? overlap (\d+) to (\d+) %"
    )
    mesh = read_mesh(meshes / "static" / "fandisk_6475.ply").mesh
    graph = graph_of(mesh)
    partition = metis_partition(graph, 15)
    degrees = np.diff(graph.offsets)
    rows = np.repeat(np.arange(graph.size), degrees)
    inside = np.bincount(
        rows[partition.labels[rows] == partition.labels[graph.neighbors]], minlength=graph.size
    )
    assert 100 * float(np.mean(inside == degrees)) == pytest.approx(alone, abs=3.0)
    blocks, largest = (
        grow_blocks(graph, partition, block_size(partition, OVERLAP)),
        np.zeros(graph.size, int),
    )
    for index in range(blocks.count):
        block = blocks.block(index)
        largest[block.vertices] = np.maximum(largest[block.vertices], block.degrees)
    assert least <= 100 * float(np.mean(largest == degrees)) <= most


@pytest.mark.real
def test_the_choice_of_distances_changes_nmsve_as_told(meshes: Path) -> None:
    """Equation 16 with d_ij of each mesh, and with those of the original in both."""
    (most,) = numbers("codec/PAPER.md", r"in both change it by less than ([\d.]+) decibels")
    clean = read_mesh(meshes / "static" / "fandisk_6475.ply").mesh
    noisy = read_mesh(meshes / "noisy" / "fandisk_0.7_noisy.ply").mesh
    graph = graph_of(clean)
    rows = np.repeat(np.arange(graph.size), np.diff(graph.offsets))

    def rough(positions: np.ndarray, measured: np.ndarray) -> np.ndarray:
        weights = 1.0 / np.linalg.norm(measured[rows] - measured[graph.neighbors], axis=1)
        sums = np.zeros_like(positions)
        np.add.at(sums, rows, weights[:, None] * positions[graph.neighbors])
        return positions - sums / np.bincount(rows, weights)[:, None]

    first, second = clean.positions, noisy.positions
    apart = np.linalg.norm(first - second)
    own = apart + np.linalg.norm(rough(first, first) - rough(second, second))
    others = apart + np.linalg.norm(rough(first, first) - rough(second, first))
    reference = Reference(first, clean.faces)
    assert own / (2 * graph.size) / reference.scale == pytest.approx(
        reference.nmsve(second), rel=1e-6
    )
    assert 0.1 < abs(10 * np.log10(own / others)) < most
