"""Check a result without the clean mesh.

In each window the movement is compared with the noise in the finest frequencies of the input: if vertices moved by more
than the noise, the filter removed shape as well.
"""

import numpy as np

from bsm.codec.arrays import Mask, Positions
from bsm.codec.denoise.noise.finding import Finding
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.noise.search import FAINTEST

MOST, MOST_FUSED, MOST_UNKNOWN = 1.9, 3.0, 1.25
"""Movement along the normals over noise, above which a window has lost more than noise: where noise is known, which
varies by chance between windows if neighbors share it, and with the slant in scans of one view; in fused views, whose
broad noise is stronger where few views meet; and where noise is not known."""
MOST_CORRELATED = 4.0  # at most, correlated noise over its finest frequencies, a ratio that is the same everywhere
DETAIL_LOST = {"shading": 0.075, "shape": 0.03, "both": 0.03}
"""Noise may hold detail where rehearsals for a goal lose more roughness than this (a logarithm)."""
NOISE_ALONE, DETAIL_SLOPE, DETAIL_MOST = 1.03, 4.0, 0.4
"""Its level over that in the finest frequencies without detail, the share of movements that is not made for each unit
more, and the largest one."""
REACHED = 0.5  # share of the level of the noise from which on a window counts for the whole
FAILED_SHARE = 0.3  # a result that fails in more of the mesh fails as a whole


def judge(noisy: Positions, result: Positions, finding: Finding, probe: Probe) -> tuple[Mask, str]:
    """Return which vertices may take the result, by its movement in each window, and why it may not as a whole."""
    everywhere = np.ones(len(noisy), dtype=np.bool_)
    windows = probe.windows
    if finding.kind == "cells":
        return everywhere, ""  # within the bound of the cause
    unsure = finding.kind == "unknown" and bool(windows.valid.any())
    if not finding.noisy and not unsure:
        # No statistics here: they may be what is missing.
        if np.linalg.norm(noisy - result, axis=1).max(initial=0.0) <= FAINTEST * finding.edge:
            return everywhere, ""
        return ~everywhere, f"{finding.reason}, and the result moves vertices nevertheless"
    normals = probe.smooth_normals(result, passes=0)
    removed = probe.levels(np.einsum("ij,ij->i", noisy - result, normals))
    found = probe.levels(np.einsum("ij,ij->i", probe.fine(noisy), normals))
    known = found if unsure else windows.means(finding.levels)
    # Rounding is known from its grid, and may hide from the finest frequencies where it has merged vertices.
    present = np.where(known > 0.0, np.maximum(found, (1.0 if finding.kind == "grid" else 0.5) * known), 0.0)
    ratio = removed / np.maximum(present, FAINTEST * finding.edge)
    # Where an axis hardly reaches, windows are put back one by one but do not count against the whole.
    judged = windows.valid & (known > max(0.0, REACHED * finding.level))
    movement = float(np.median(ratio[judged])) if judged.any() else 0.0
    shared = MOST_CORRELATED if finding.kind in ("correlated", "view", "fused") else 1.0
    usual = MOST_FUSED if finding.kind == "fused" else MOST
    most = MOST_UNKNOWN if unsure else usual * min(max(movement, 1.0), shared)
    bad = windows.valid & ~(ratio <= most)
    failed = float(bad[judged].mean()) if judged.any() else 0.0
    reason = f"the result moves vertices by {movement:.2f} times the noise, and takes shape away with it"
    return ~bad[windows.labels], reason if failed > FAILED_SHARE else ""


def restraint(finding: Finding, finest: float) -> float:
    """How much of a movement to make where white noise, of this level in the finest frequencies, may hold detail."""
    excess = finding.level / finest - NOISE_ALONE if finest > 0.0 else 0.0
    return 1.0 - min(max(DETAIL_SLOPE * excess, 0.0), DETAIL_MOST)
