"""What `bsm denoise` says of a mesh: what was found, what moved and how far, in plain words and in the mesh's unit."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import Metadata

if TYPE_CHECKING:
    from bsm.codec.denoise import AutomaticChoice, Step


def found(choice: AutomaticChoice | None, goal: str, edge: float, unit: str) -> list[str]:
    """Lines on the noise, and on what was done about it; none where nothing was chosen."""
    if choice is None:
        return []
    lines = []
    if choice.outliers:
        lines.append(f"put back   {choice.outliers} vertices that stood out by themselves")
    if choice.ripples:
        waves = ", ".join(f"{length * edge:.2g}" for length in choice.ripples)
        lines.append(f"took away  waves of {waves} {unit}".rstrip() + " across the whole mesh")
    if not choice.steps:
        if not (choice.outliers or choice.ripples):
            said = "steadied   " if choice.kind == "unsteady" else "left       as it was: "
            lines.append(f"{said}{choice.reason}")
            if choice.kind == "none":
                lines.append("           if you see noise nevertheless, ask for a filter: --fine guided --iterations 3")
        return lines
    noise = choice.noise
    lines.append(f"found      {choice.reason}")
    said = f"noise      {noise.normal:.2f} edges ({length(noise.normal * edge, unit)})"
    if goal == "shape":
        said += f"; vertices about {choice.untreated:.2f} -> {choice.expected:.2f} edges off"
    elif choice.kind != "unsteady":
        said += (
            f"; normals about {choice.untreated:.0f} -> {choice.expected:.0f} degrees off, more where there is detail"
        )
    lines.append(said)
    for step, times in Counter(choice.steps).items():
        share = times / len(choice.steps) * (1.0 - choice.learnt)
        if share > 0.0:
            lines.append(f"chosen     {100.0 * share:.0f} % {_described(step)}")
    if choice.learnt > 0.0:
        lines.append(f"chosen     {100.0 * choice.learnt:.0f} % learnt normals")
    return lines


def moved(before: Positions, after: Positions) -> dict[str, float]:
    """How many vertices moved, and how far: the mean over those, and the farthest."""
    far = np.linalg.norm(after - before, axis=1)
    touched = far > 0.0
    mean = float(far[touched].mean()) if touched.any() else 0.0
    return {"vertices": int(touched.sum()), "mean": mean, "farthest": float(far.max(initial=0.0))}


def moved_line(facts: dict[str, float], vertices: int, unit: str) -> str:
    """How far vertices moved, in words."""
    if not facts["vertices"]:
        return "moved      no vertex"
    who = "all vertices" if facts["vertices"] == vertices else f"{facts['vertices']:.0f} of {vertices} vertices"
    return f"moved      {who}, by {length(facts['mean'], unit)} on average, {length(facts['farthest'], unit)} at most"


def unit_of(metadata: Metadata) -> str:
    """The unit that a mesh says it has."""
    unit = metadata.get("unit")
    return unit if isinstance(unit, str) else ""


def length(value: float, unit: str) -> str:
    """A length as people write it."""
    return f"{value:.2g} {unit}".rstrip()


def _described(step: Step) -> str:
    recipe = step.recipe
    guide = {
        "patches": "guided normal filter",
        "own": "bilateral normal filter",
        "local": "local bilateral normal filter",
    }[recipe.guide]
    begun = f"hand-over of {recipe.hand_over}, c = {100 * recipe.keep:g} % of a block"
    if not recipe.needs_coarse:
        begun = "no hand-over"
    return f"{begun}; {step.iterations} iterations of the {guide}, sigma_r {recipe.sigma_r:g}"
