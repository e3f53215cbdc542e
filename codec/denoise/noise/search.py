"""Whether a mesh is noisy, how much, and of what kind: all of it from the mesh itself.

Noise does not know the shape. So it is as strong in one place as in another (or follows the direction of the surface,
where a camera has put it, or covers only some places), it goes to both sides of the surface alike,
and no value has a preference. Detail and creases are strong in some places and weak in others. Only what looks like
noise in all these ways is taken for noise: the answer for anything else is "none", and "unknown" for small meshes.
"""

from dataclasses import replace

import numpy as np

from bsm.codec.arrays import Positions
from bsm.codec.denoise.noise.causes import Line, Steps, find_cells, find_grid, find_steps
from bsm.codec.denoise.noise.finding import UNEVEN, Evidence, Finding, is_random, lattice_step, look, spread
from bsm.codec.denoise.noise.probe import BOUND, FEWEST_IN_WINDOW, SHARE, Probe
from bsm.codec.denoise.noise.view import View, find_view, pixel
from bsm.codec.denoise.surface import Floats, Mask
from bsm.codec.geometry.metrics import mean_edge_length

FEWEST_WINDOWS, FEWEST_INNER = 5, 3  # fewest windows for an estimate, and fewest wholly inside a noisy part
FAINTEST = 0.05  # levels below, in mean edges, are left alone: the finest detail of real surfaces is as strong
MANY_WINDOWS = 20
FAINTEST_OF_FEW = {"white": 0.085, "correlated": 0.1, "impulses": 0.085, "local": 0.14}
"""With fewer windows their spread says less, and noise has to be this strong."""
SURELY_CORRELATED, FAINTEST_CORRELATED = 0.75, 0.075
"""Below this ratio of the finest frequencies to the fine ones fainter noise is believed: detail as even as noise reads
0.78 and more."""
BROADEST_OF_FEW = 1.06
"""And no stronger at lower frequencies than at both others: white noise reads 0.9 to 1.03, impulses 0.83 to 1.05,
fractal detail of made shapes 0.96 to 1.5."""
FAINT, SURE = 0.115, 0.15
"""Up to here it is still like the detail of the roughest surfaces; from here on it may be mixed with more shape."""
EVEN_FAINT, EVEN, EVEN_CORRELATED = 0.1, 0.145, 0.18
"""Largest spread of the levels of windows (logarithms) beyond chance: for faint, ordinary, and correlated noise, which
clean meshes have little of, as of impulses."""
SURELY_WHITE = (0.925, 1.4)
"""Faint noise whose finest frequencies are in this ratio to the fine ones is judged like ordinary noise: noise of 0.08
edges and more reads 0.93 to 1.03, impulses to 1.34, the rough clean meshes as even as noise 0.87 and less."""
IMPULSIVE = 1.04  # from this ratio on faint noise may be impulses, whose levels spread more by chance
WHITE = 0.82  # the finest frequencies carry as much white noise as the fine ones; below this ratio it is correlated
HEAVY = 1.25  # tails beyond the normal distribution's from which noise counts as impulses
LOCAL_LEVEL, LOCAL_STEP, LOCAL_SHARE = 0.12, 1.5, 0.1
"""Noise that is only here and there: how strong at least, over the rest at least, in how much of the mesh at least."""
SEEN_FAINT, SEEN_SURE, EVEN_SEEN = 0.12, 0.3, (0.24, 0.5)
"""Levels of noise in a picture, in pixels' widths, and how uneven they may be there: slanted surfaces are seen with
more of it. Clean surfaces read 0 to 0.2, and 0.3 and more of spread; cameras 0.35 to 0.7 and 0.1 to 0.4."""
TERRACED = 0.05  # fewer depths per vertex mean a camera with few depth levels
FUSED, EVEN_FUSED, NOT_BROADER = (0.065, 0.08), (0.15, 0.225), 1.04
"""Levels of the noise of views fused on a lattice, in mean edges, how uneven they may be there, and how much of it
broader filters may see. They read .07 to .11, .06 to .21 and .93 to 1.01; fields without noise .01 to .07, .23 and more
and 1.09 to 1.7."""
FUSED_UNEVEN, NARROWER = 0.45, 0.97
"""Fused views of a real camera: how uneven their noise may be, and how much of it broader filters may see then."""
MARCHED = 1.06
"""Mean edge, in steps of the lattice, that marching cubes do not reach: it is .94 to .97, of regular triangles 1.14."""
SMOOTH_VIEW = "the view of a camera, without its noise"
NEARBY = 4  # rings about a vertex that decide whether it is in or out
ROUNDED_SLANT, ROUNDED_SHARE = 0.98, 0.3
"""Surfaces along an axis show nothing of rounding; so much of the mesh has to lie otherwise."""
ROUNDED_LEVEL, ROUNDED_SEEN, ROUNDED_ZEROS = (0.025, 0.35), (0.4, 4.5), 0.15
"""Rounding that is worth a treatment, in mean edges; the least share of the expected evidence, creases included;
and the largest share of vertices with nothing of it: shapes that were drawn on a grid have many."""
ONE_CELL = 0.9  # share of the stairs of a binary volume, from which on all its walls are one cell thick
HEAVY_LEVEL, HEAVY_PASSES = 0.3, 8  # from here on normals are taken from a smoother version


def find_noise(positions: Positions, probe: Probe) -> Finding:
    edge = mean_edge_length(positions, probe.topology.faces)
    if int(probe.windows.valid.sum()) < FEWEST_WINDOWS:
        return Finding("unknown", 0.0, np.zeros(probe.topology.n), edge, "too few vertices to tell noise from shape")
    evidence = look(positions, probe, edge, passes=2)
    if np.nanquantile(evidence.levels, 0.75) > HEAVY_LEVEL:
        evidence = look(positions, probe, edge, passes=HEAVY_PASSES)
    for test in (_cells, _rounded, _seen, _fused, one_axis, _everywhere, _here_and_there):
        finding = test(positions, evidence)
        if finding is not None:
            return finding
    level = float(np.nanmedian(evidence.levels))
    reason = "its roughness follows the shape, as detail and edges do and noise does not"
    if level < FAINTEST:
        reason = f"at most {level:.3f} mean edges of noise, no more than a clean mesh has detail"
    return Finding("none", 0.0, np.zeros(probe.topology.n), edge, reason)


def _cells(positions: Positions, evidence: Evidence) -> Finding | None:
    """On the edges between cells of a volume."""
    cells = find_cells(positions)
    if cells is None:
        return None
    if cells.thin > ONE_CELL:
        reason = "its walls are one cell of a binary volume thick, too thin to tell their shape"
        return Finding("none", 0.0, np.zeros(len(positions)), evidence.edge, reason, bound=cells)
    levels = cells.levels(evidence.normals)
    sizes = " x ".join(f"{step:.3g}" for step in cells.steps)
    reason = f"stairs along x, y and z of a binary volume of cells of {sizes}; no vertex leaves its half-cell"
    return Finding("cells", float(np.median(levels)), levels, evidence.edge, reason, bound=cells)


def _rounded(positions: Positions, evidence: Evidence) -> Finding | None:
    """Known from the coordinates, and as strong as the cells are large."""
    grid = find_grid(positions)
    if grid is None:
        return None
    expected = grid.levels(evidence.normals) / evidence.edge
    slanted = evidence.probe.counted & (np.abs(evidence.normals).max(axis=1) < ROUNDED_SLANT) & (expected > 0.0)
    level = float(np.median(expected))
    if slanted.sum() < ROUNDED_SHARE * len(slanted) or not ROUNDED_LEVEL[0] < level < ROUNDED_LEVEL[1]:
        return None
    seen = np.abs(evidence.along[slanted] / expected[slanted])
    if not ROUNDED_SEEN[0] < np.quantile(seen, SHARE) / BOUND < ROUNDED_SEEN[1] or (seen < 0.1).mean() > ROUNDED_ZEROS:
        return None
    reason = f"positions rounded to a grid of {float(grid.steps.max()) / evidence.edge:.2f} mean edges"
    return Finding("grid", level * evidence.edge, expected * evidence.edge, evidence.edge, reason, bound=grid)


def _seen(positions: Positions, evidence: Evidence) -> Finding | None:
    """On a grid of pixels, and as strong in one place of the picture as in another."""
    probe = evidence.probe
    view = find_view(positions, probe)
    if view is None:
        return None
    along = probe.fine(view.heights(positions, probe.topology)[:, None])[:, 0]
    levels = probe.levels(along)[probe.windows.valid]
    level = float(np.median(levels))
    steps = find_steps(view, positions, probe)
    if steps is not None:
        return _stepped(steps, replace(view, terraced=True), positions, evidence)
    if level < FAINTEST:
        return Finding("none", 0.0, np.zeros(probe.topology.n), evidence.edge, SMOOTH_VIEW)
    allowed = np.interp(level, [SEEN_FAINT, SEEN_SURE], EVEN_SEEN)
    if level < SEEN_FAINT or spread(levels, probe.windows) > allowed or not is_random(along[probe.counted] / level):
        return None
    rays = positions - view.eye
    width = pixel(view.plane(positions), probe.topology) * (rays @ view.axis)
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    amount = level * width * np.abs(np.einsum("ij,ij->i", rays, evidence.normals))
    terraced = min(len(np.unique(column)) for column in positions.T) < TERRACED * len(positions)
    reason = f"noise of a camera, along its rays{', in steps of depth' if terraced else ''}"
    return Finding(
        "view",
        float(np.median(amount)),
        amount,
        evidence.edge,
        reason,
        view=replace(view, level=level, terraced=terraced),
    )


def _stepped(steps: Steps, view: View, positions: Positions, evidence: Evidence) -> Finding:
    depth = (positions - view.eye) @ steps.axis
    width = pixel(view.plane(positions), evidence.probe.topology) * ((positions - view.eye) @ view.axis)
    heights = steps.step * (np.square(depth) if steps.inverse else 1.0) * np.ones(len(depth))
    amount = heights / np.sqrt(12.0)
    axis = "xyz"[int(np.argmax(np.abs(steps.axis)))]
    what = "inverse depth" if steps.inverse else "depth"
    reason = f"steps of {steps.step:.3g} in the {what} of one view, along {axis}; no vertex moves by over half of one"
    view = replace(view, level=float(np.median(heights / np.abs(width))) ** 2)
    return Finding("steps", float(np.median(amount)), amount, evidence.edge, reason, view=view, bound=steps)


def _fused(positions: Positions, evidence: Evidence) -> Finding | None:
    """On the lattice of a field of distances, and as strong in one place as in another."""
    valid = evidence.probe.windows.valid
    levels = evidence.levels[valid]
    level = float(np.median(levels))
    real = level < FUSED[0] or spread(levels, evidence.probe.windows) > np.interp(level, FUSED, EVEN_FUSED)
    if level < FAINTEST or (real and spread(levels, evidence.probe.windows) > FUSED_UNEVEN):
        return None
    if evidence.edge > MARCHED * lattice_step(positions):
        return None
    broad = _levels(evidence, evidence.probe.broad(positions / evidence.edge))[valid]
    random = is_random(_standardised(evidence, evidence.probe.counted))
    if not random or not np.nanquantile(broad / levels, 0.25) <= (NARROWER if real else NOT_BROADER):
        return None
    amount = np.full(len(positions), level * evidence.edge)
    kind, reason = ("uneven fused", " of a real camera") if real else ("fused", "")
    return Finding(kind, level * evidence.edge, amount, evidence.edge, f"noise of views{reason} fused on a lattice")


def _everywhere(positions: Positions, evidence: Evidence) -> Finding | None:
    """As strong in one place as in another."""
    windows, chosen = evidence.probe.windows, evidence.probe.counted
    levels = evidence.levels[windows.valid]
    level = float(np.median(levels))
    if level < FAINTEST or not is_random(_standardised(evidence, chosen)):
        return None
    kind, whiteness = _color(positions, evidence, windows.valid, chosen)
    if len(levels) < MANY_WINDOWS:
        broad = _levels(evidence, evidence.probe.broad(positions / evidence.edge))
        share = float(np.quantile(broad[windows.valid] / levels, 0.25))
        least = FAINTEST_CORRELATED if whiteness < SURELY_CORRELATED else FAINTEST_OF_FEW[kind]
        if level < least or (level < SURE and share > BROADEST_OF_FEW * max(whiteness, 1.0)):
            return None
    if spread(levels, windows) > _allowed(level, kind, whiteness):
        return None
    amount = np.full(len(positions), level * evidence.edge)
    return Finding(kind, level * evidence.edge, amount, evidence.edge, "noise all over", whiteness=whiteness)


def _levels(evidence: Evidence, filtered: Floats) -> Floats:
    return evidence.probe.levels(np.einsum("ij,ij->i", filtered, evidence.normals))


def _allowed(level: float, kind: str, whiteness: float) -> float:
    """Faint white noise is what fine detail looks most like."""
    if kind != "correlated" and level < FAINT and not SURELY_WHITE[0] < whiteness < SURELY_WHITE[1]:
        return EVEN_FAINT
    share = min(max((level - SURE) / SURE, 0.0), 1.0)
    usual = EVEN_CORRELATED if kind == "correlated" or whiteness > IMPULSIVE else EVEN
    return usual + share * (UNEVEN - usual)


def _here_and_there(positions: Positions, evidence: Evidence) -> Finding | None:
    """Strong and even in some windows, weak in the others."""
    probe = evidence.probe
    windows = probe.windows
    levels = np.where(windows.valid, evidence.levels, 0.0)
    usual = levels[windows.valid]
    split = np.exp(_otsu(np.sort(np.log(np.maximum(usual, 0.02)))))
    above = levels > split
    inner = above & ~windows.beside(~above & windows.valid)
    if inner.sum() < FEWEST_INNER or above.sum() < LOCAL_SHARE * windows.count:
        return None
    strong, weak = levels[inner], levels[windows.valid & ~above]
    level = float(np.median(strong))
    least = LOCAL_LEVEL if len(usual) >= MANY_WINDOWS else FAINTEST_OF_FEW["local"]
    if level < least or level < LOCAL_STEP * np.median(weak):
        return None
    if spread(strong, windows) > _allowed(level, "white", 0.0):
        return None
    if not is_random(_standardised(evidence, inner[windows.labels] & probe.counted)):
        return None
    # Where windows of both sorts meet, the vertices decide: by what is about each of them.
    inside = inner[windows.labels]
    doubtful = (above & ~inner) | (~above & windows.beside(above))
    nearby = np.square(np.minimum(np.abs(evidence.along), 3.0 * level))
    for _ in range(NEARBY):
        nearby = probe.average @ nearby
    unsure = doubtful[windows.labels]
    inside[unsure] = nearby[unsure] > (0.5 * level) ** 2
    amount = np.where(inside, level * evidence.edge, 0.0)
    share = f"noise in {100.0 * inside.mean():.0f} % of the mesh"
    clear = bool(np.median(weak) < FAINTEST)
    return Finding("local", level * evidence.edge, amount, evidence.edge, share, clear=clear)


def _standardised(evidence: Evidence, chosen: Mask) -> Floats:
    scale = evidence.levels[evidence.probe.windows.labels[chosen]]
    good = scale > 0.0
    result: Floats = evidence.along[chosen][good] / scale[good]
    return result


def _color(positions: Positions, evidence: Evidence, valid: Mask, chosen: Mask) -> tuple[str, float]:
    """White, white with heavy tails, or correlated between neighbors; and the level of the finest over the fine."""
    probe = evidence.probe
    finest = _levels(evidence, probe.finest(positions / evidence.edge))
    ratio = float(np.quantile(finest[valid], 0.25) / np.quantile(evidence.levels[valid], 0.25))
    if ratio < WHITE:
        return "correlated", ratio
    values = np.abs(_standardised(evidence, chosen))
    tail = float(np.quantile(values, 0.95)) / 1.96
    heavy = tail > HEAVY and (ratio > IMPULSIVE or np.median(evidence.levels[valid]) > LOCAL_LEVEL)
    return ("impulses" if heavy else "white"), ratio


def _otsu(ordered: Floats) -> float:
    """The value that parts sorted numbers into the two most different groups."""
    count = len(ordered)
    sums = np.cumsum(ordered)
    below = np.arange(1, count)
    if count < 2:
        return float(ordered[0]) if count else 0.0
    difference = sums[:-1] / below - (sums[-1] - sums[:-1]) / (count - below)
    place = int(np.argmax(below * (count - below) * difference**2))
    return float(0.5 * (ordered[place] + ordered[place + 1]))


AXIS_LEVEL, AXIS_ALONE, AXIS_EVEN = 0.1, 1.25, (0.55, 1.7)
"""Noise along an axis, in mean edges; how much stronger than across; and its ratio beside the axis to that at its ends:
noise along normals reads 0 to 0.8 there, triangles that are longer one way 1.8 and more."""
AXIS_MOST = 5.0  # deviations that a vertex has been moved by at most
SNAP = 0.995  # cosine from which on it is an axis of the coordinates
DEPTH_WORTH, DEPTH_MOST = 0.7, 3.0
"""Noise that grows with depth: the rest of the spread, and the logarithm of the ratio between both ends."""


def one_axis(positions: Positions, evidence: Evidence) -> Finding | None:
    """Noise of `positions`, shape (n, 3), along one direction, whichever way the surface faces."""
    probe, chosen = evidence.probe, evidence.probe.counted
    fine = probe.fine(positions / evidence.edge)
    length = np.linalg.norm(fine, axis=1)
    calm = fine * np.minimum(1.0, np.quantile(length[chosen], 0.8) / np.maximum(length, 1e-300))[:, None]
    values, vectors = np.linalg.eigh(calm[chosen].T @ calm[chosen] / chosen.sum())
    if values[2] < AXIS_ALONE**2 * values[1]:
        return None
    axis = vectors[:, 2] * np.sign(vectors[np.abs(vectors[:, 2]).argmax(), 2])
    near = np.abs(axis).max() > SNAP
    axis = np.round(axis) if near else axis
    along, facing = fine @ axis, np.abs(probe.smooth_normals(positions, HEAVY_PASSES) @ axis)
    beside, ends = (chosen & (facing < 0.35)), (chosen & (facing >= 0.7))
    if min(beside.sum(), ends.sum()) < FEWEST_IN_WINDOW:
        return None
    level = float(np.quantile(np.abs(along[ends]), SHARE)) / BOUND
    share = float(np.quantile(np.abs(along[beside]), SHARE)) / BOUND / level if level > 0.0 else 0.0
    if level < AXIS_LEVEL or not AXIS_EVEN[0] < share < AXIS_EVEN[1]:
        return None
    windows = probe.windows
    levels, depth = probe.levels(along)[windows.valid], positions @ axis
    depth = (depth - depth.min()) / (np.ptp(depth) or 1.0)
    uneven, growth = spread(levels, windows), None
    rate = np.polyfit(windows.means(depth)[windows.valid], np.log(np.maximum(levels, 1e-9)), 1)[0]
    even = levels / np.exp(rate * (windows.means(depth)[windows.valid] - 0.5))
    if abs(rate) < DEPTH_MOST and spread(even, windows) < DEPTH_WORTH * uneven:
        growth, levels, uneven = np.exp(rate * (depth - 0.5)), even, spread(even, windows)
    level = float(np.sqrt(max(np.median(levels) ** 2 - values[1], 0.0)))  # the shape's own part is as strong across
    amount = level * evidence.edge * (np.ones(len(depth)) if growth is None else growth)
    if uneven > UNEVEN or level < AXIS_LEVEL or not is_random(along[chosen] / amount[chosen] * evidence.edge):
        return None
    reason = f"noise along one axis ({', '.join(f'{component:.2f}' for component in axis)})"
    if growth is not None:
        reason += f", {growth.max() / growth.min():.1f} times as strong at one end as at the other"
    bound = Line(axis, AXIS_MOST * float(amount.max()))
    facing = np.abs(evidence.normals @ axis)
    return Finding(
        "axis", level * evidence.edge, amount * facing, evidence.edge, reason, axis=axis, growth=growth, bound=bound
    )
