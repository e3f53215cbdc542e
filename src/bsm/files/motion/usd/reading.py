"""Stages that are read: all frames, or the mesh at the first time."""

from dataclasses import replace

import numpy as np

from bsm.bitstream.errors import FormatError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.files.formats.polygons import MeshFile
from bsm.files.motion.frames import Frames, Wanted, between, painted_like
from bsm.files.motion.usd.stage import Stage
from bsm.files.parsing import as_format_error, require_counts
from bsm.files.table import START


@as_format_error("stage")
def read_usd(path: str, request: Wanted, limits: Limits = DEFAULT_LIMITS) -> Frames | None:
    """Return the frames of a stage, sampled at its rate or the one that is wanted; None if nothing moves."""
    stage = Stage(path, limits, runs=request.runs)
    times = stage.times
    if len(times) < 2:
        return None
    codes_per_second = stage.codes_per_second
    rate = request.rate or codes_per_second
    first, last = stage.span or (times[0], times[-1])
    duration = (last - first) * rate / codes_per_second  # in frames
    if not np.isfinite([first, last, codes_per_second, duration]).all():
        raise FormatError(
            f"the stage runs from {first:g} to {last:g} at {codes_per_second:g} codes per second"
        )
    # A little more, since 1/24 s is not exact in binary, and rounding would lose the last frame.
    count = int(np.floor(max(last - first, 0.0) * rate / codes_per_second + 1e-6)) + 1
    require_counts(limits, frames=count)
    first_frame = stage.frame(first)
    mesh = first_frame.mesh
    frame_times = [first + number * codes_per_second / rate for number in range(count)]
    times_inside = np.array([time for time in times if first <= time <= last])
    notes = [f"{count} frames at {rate:g} per second"]
    notes += between("time samples", (times_inside - first) * rate / codes_per_second, rate)
    if len(times_inside) < len(times):
        notes.append(
            f"{len(times) - len(times_inside)} time samples lie outside {first:g} to {last:g}"
        )
    notes += first_frame.notes
    meshes = None
    faces_may_change = request.runs and stage.changes
    if faces_may_change or any(part.shape.painted for part in stage.parts):
        meshes = (painted_like(mesh, stage.changed_mesh(time)) for time in frame_times)
    metadata = {**mesh.metadata}
    if first:
        metadata[START] = first * rate / codes_per_second
    frames = map(stage.points, frame_times)
    return Frames(mesh.faces, count, frames, mesh.attributes, tuple(notes), rate, metadata, meshes)


@as_format_error("stage")
def read_usd_mesh(path: str, limits: Limits = DEFAULT_LIMITS) -> MeshFile:
    """Return the mesh of a stage at its first time."""
    stage = Stage(path, limits)
    times = stage.times
    candidates = [*stage.span, *times, 0.0]
    first_frame = stage.mesh(candidates[0])
    if len(times) < 2:
        return first_frame
    return replace(
        first_frame, notes=(*first_frame.notes, "of the motion, the first time was taken")
    )
