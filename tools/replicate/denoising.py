"""The scoreboard of denoising: automatic against fixed schemes, clean meshes, scans, and sequences.

Rivals are guided filtering, bilateral normal filtering and the paper's scheme. "Fixed" ones run for numbers of
iterations that a user might ask for; an "oracle" stops a rival at its best.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from pathlib import Path

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces, Positions
from bsm.codec.denoise import FrameDenoiser
from bsm.codec.denoise.filters import Filter, Filtered, Filters
from bsm.codec.denoise.surface import VERTEX_ITERATIONS, bilateral_normals, follow_normals
from bsm.codec.geometry.metrics import Reference, mean_edge_length
from bsm.files.mesh import read_mesh
from tools.noise import (
    correlated_along_normals,
    denoise_automatically,
    gaussian_along_axis,
    gaussian_along_normals,
    gaussian_in_part,
    gaussian_isotropic,
    gaussian_with_range,
    impulsive,
    ripples_along_normals,
    rounded,
    uniform_along_normals,
)
from tools.replicate.fetch import Source
from tools.replicate.motion import bent
from tools.replicate.rates import Row, spread
from tools.scans import CAMERAS, view

SEED, LEVEL, FRAMES = 11, 0.2, 12
"""Of noise: how strong in mean edges; and the frames of a sequence."""
KINDS: dict[str, Callable[[Positions, Faces], Positions]] = {
    "white": lambda positions, faces: gaussian_along_normals(positions, faces, LEVEL, SEED),
    "isotropic": lambda positions, faces: gaussian_isotropic(positions, faces, LEVEL, SEED),
    "uniform": lambda positions, faces: uniform_along_normals(positions, faces, LEVEL, SEED),
    "impulses": lambda positions, faces: impulsive(positions, faces, LEVEL, 0.5, SEED),
    "few impulses": lambda positions, faces: impulsive(positions, faces, LEVEL, 0.1, SEED),
    "one axis": lambda positions, faces: gaussian_along_axis(positions, faces, LEVEL, SEED),
    "correlated": lambda positions, faces: correlated_along_normals(positions, faces, LEVEL, SEED),
    "ripples": lambda positions, faces: ripples_along_normals(positions, faces, LEVEL, SEED, 4.0),
    "range": lambda positions, faces: gaussian_with_range(positions, faces, LEVEL, SEED),
    "rounded": lambda positions, faces: rounded(positions, faces, 0.5 * LEVEL, SEED),
    "half clean": lambda positions, faces: gaussian_in_part(positions, faces, LEVEL, 0.5, SEED),
}
GUIDED = {
    "guided": Filter("none", 0.1, 0.35, "patches"),
    "paper": Filter("positions", 0.1, 0.35, "patches"),
}
WIDTH = 0.35  # of the bilateral filter of normals
FIXED_ITERATIONS = {"guided": (5, 20), "paper": (5, 20), "bilateral normal": (10,)}
MOST, PATIENCE = 60, 5
PAIRS = {
    "fandisk_0.3_noisy": "fandisk_6475",
    "fandisk_0.7_noisy": "fandisk_6475",
    "twelve_dodecahedron_noisy": "twelve_dodecahedron",
    "armadillo_12502_0.2_noisy": "armadillo_12502",
    "block_noisy": "block",
    "nicolo_noisy": "nicolo",
    "fr_casting_0.2_noisy": "fr_casting",
    "fr_chinese_lion_0.2_noisy": "fr_chinese_lion",
    "trim_star_noisy": "trim_star",
    "sharpsphere_noisy": "sharpsphere",
    "julius_36201_noisy": "julius_36201",
    "bunny_34834_noisy": "bunny_34834",
}
"""Noisy files that papers share, in BSM_MESHES/noisy, and their clean partners."""


def denoise_mesh(source: Source) -> Row:
    """One mesh: clean, with each kind of noise, as two cameras see it, and in motion; or a pair of `PAIRS`."""
    facts = {"mesh": source.name, "group": source.group, "vertices": source.vertices}
    if source.group == "pairs":
        mesh = read_mesh(source.path).mesh
        clean = read_mesh(
            source.path.parents[1] / "static" / f"{PAIRS[source.name]}.ply"
        ).mesh.positions
        return facts | {
            "pair": against_oracle(mesh.positions, mesh.faces, Reference(clean, mesh.faces).theta)
        }
    mesh = source.mesh()
    clean, faces = mesh.positions, mesh.faces
    reference = Reference(clean, faces)
    same = denoise_automatically(clean, faces)[0]
    found: Row = {
        "turned": Reference(clean, faces).theta(same),
        "untouched": bool((same == clean).all()),
    }
    found["kinds"] = {}
    for kind, make in KINDS.items():
        noisy = make(clean, faces)
        best = min(best_fixed(noisy, faces, reference), reference.theta(noisy))
        found["kinds"][kind] = {
            "noisy": reference.theta(noisy),
            "rival": best,
            **ours(noisy, faces, reference.theta),
        }
    found["white"] = against_oracle(KINDS["white"](clean, faces), faces, reference.theta)
    found["scans"] = {}
    for camera, model in CAMERAS.items():
        scan = view(clean, faces, model, SEED)
        if len(scan.faces):
            found["scans"][camera] = against_oracle(scan.positions, scan.faces, scan.angle)
    return facts | found | {"frames": in_motion(bent(mesh, FRAMES), faces)}


def against_oracle(noisy: Positions, faces: Faces, angle_of: Callable[[Positions], float]) -> Row:
    """The angle before, behind the best rival that an oracle stops, and behind ours."""
    rival = min(_best(run, angle_of) for run in rivals(noisy, faces).values())
    return {"noisy": angle_of(noisy), "rival": rival, **ours(noisy, faces, angle_of)}


def ours(noisy: Positions, faces: Faces, angle_of: Callable[[Positions], float]) -> Row:
    """The angle behind ours, and the least and largest that are expected; none where they cannot be estimated, or
    nothing was filtered."""
    result, choice = denoise_automatically(noisy, faces)
    known = choice.steps and choice.reliable
    return {
        "ours": angle_of(result),
        "estimate": [choice.expected, choice.at_most] if known else None,
    }


def rivals(noisy: Positions, faces: Faces) -> dict[str, Iterator[Positions]]:
    """The positions after 0, 1, 2, ... iterations of each rival, without end."""
    surface = Filters(faces, len(noisy))
    filtered, topology = Filtered(noisy, surface), surface.topology
    normals = bilateral_normals(noisy, topology, WIDTH)
    followed = (
        follow_normals(noisy, topology, each, VERTEX_ITERATIONS, ~topology.boundary)
        for each in normals
    )
    return {name: filtered.iterates(rival) for name, rival in GUIDED.items()} | {
        "bilateral normal": followed
    }


def best_fixed(noisy: Positions, faces: Faces, reference: Reference) -> float:
    """The angle behind the best of the rivals with numbers of iterations that a user might ask for."""
    found = []
    for name, run in rivals(noisy, faces).items():
        done = -1
        for count in FIXED_ITERATIONS[name]:
            found.append(reference.theta(next(islice(run, count - done - 1, None))))
            done = count
    return min(found)


def in_motion(clean: npt.NDArray[np.float64], faces: Faces) -> dict[str, float]:
    """Errors of a sequence that is denoised as one, over those of its frames one by one."""
    noisy = np.stack(
        [gaussian_along_normals(frame, faces, LEVEL, seed) for seed, frame in enumerate(clean)]
    )
    alone = np.stack([denoise_automatically(frame, faces)[0] for frame in noisy])
    together = np.stack(list(FrameDenoiser(noisy[0], faces)(noisy)))
    measures: dict[str, Callable[[Positions], float]] = {
        "angle": lambda frames: float(
            np.mean([Reference(a, faces).theta(b) for a, b in zip(clean, frames, strict=True)])
        ),
        "position": lambda frames: float(np.sqrt(np.square(clean - frames).sum(axis=2).mean())),
        "flicker": lambda frames: flicker(clean, frames, faces),
    }
    return {name: of(together) / of(alone) for name, of in measures.items()}


def flicker(clean: Positions, frames: Positions, faces: Faces) -> float:
    """Mean length of the second difference in time of what differs from the clean frames, in mean edges."""
    error = frames - clean
    trembling = error[2:] - 2.0 * error[1:-1] + error[:-2]
    return float(np.sqrt(np.square(trembling).sum(axis=2)).mean()) / mean_edge_length(
        clean[0], faces
    )


def _best(run: Iterator[Positions], angle_of: Callable[[Positions], float]) -> float:
    best, at = np.inf, 0
    for count, positions in enumerate(islice(run, MOST + 1)):
        angle = angle_of(positions)
        if angle < best:
            best, at = angle, count
        elif count >= at + PATIENCE:
            break
    return float(best)


def pairs(folder: Path) -> list[Source]:
    """The noisy files that papers share, of those that are there."""
    paths = [folder / "noisy" / f"{name}.ply" for name in PAIRS]
    return [Source(path.stem, path, "pairs", 0) for path in paths if path.exists()]


def denoising_table(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """Ratios of angles, ours over the rival's, for each kind of noise and camera; those of sequences."""
    rows = [row for row in rows if row["group"] != "pairs"]
    found = []
    for label, rival, entries in (
        *((kind, "fixed", [(row["kinds"][kind], row) for row in rows]) for kind in KINDS),
        ("white", "oracle", [(row["white"], row) for row in rows]),
        *(
            (c, "oracle", [(row["scans"][c], row) for row in rows if c in row["scans"]])
            for c in CAMERAS
        ),
    ):
        if entries:
            found.append(
                spread(
                    label,
                    rival,
                    [(e["ours"] / max(e["rival"], 1e-9), row["mesh"]) for e, row in entries],
                )
            )
    every = [
        (entry, row) for row in rows for entry in row["kinds"].values() if entry.get("estimate")
    ]
    if every:
        found.append(
            spread("all", "estimates", [(missed(entry), row["mesh"]) for entry, row in every])
        )
    moving = {
        name: [(row["frames"][name], row["mesh"]) for row in rows] for name in rows[0]["frames"]
    }
    return found + [
        spread(f"{name} of sequences", "frames", values) for name, values in moving.items()
    ]


def missed(entry: Row) -> float:
    """The factor between the angle that came and the nearest of the estimate."""
    least, most = entry["estimate"]
    return float(max(least / entry["ours"], entry["ours"] / most, 1.0))


def denoising_note(rows: Sequence[Row]) -> str:
    """What the table counts, and what became of clean meshes."""
    rows = [row for row in rows if row["group"] != "pairs"]
    worse = [entry["ours"] > entry["noisy"] for row in rows for entry in row["kinds"].values()]
    return (
        f"{len(rows)} fetched meshes, of {min(row['vertices'] for row in rows):,} to "
        f"{max(row['vertices'] for row in rows):,} vertices, with noise of {LEVEL} mean edges. Some constants were "
        "chosen on them. Numbers are mean angles to the clean normals by the automatic mode, over those of the best "
        "rival. Rivals are guided filtering, bilateral normal filtering and the paper's scheme. They have fixed "
        "numbers of iterations, or an oracle stops them. Sequences are over their frames one by one. Estimates count "
        "the factor between the angle that came and the nearest of the range that bsm denoise prints. Without noise "
        f"{sum(row['untouched'] for row in rows)} of {len(rows)} come back bit for bit, and normals turn by at most "
        f"{max(row['turned'] for row in rows):.2f} degrees. {sum(worse)} of {len(worse)} noisy meshes become worse."
    )


def pairs_table(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """Angles on the files that papers share."""
    return [
        (
            row["mesh"],
            *(f"{row['pair'][k]:.2f}" for k in ("noisy", "rival", "ours")),
            " to ".join(
                dict.fromkeys(f"{angle:.1f}" for angle in row["pair"].get("estimate") or ())
            ),
        )
        for row in rows
        if row["group"] == "pairs"
    ]
