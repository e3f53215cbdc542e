"""The table of ways to code a mesh. A new way is one class with the methods of `trials.Way`, and one row here."""

import math
from collections.abc import Iterator
from operator import attrgetter

from bsm.codec.static.choice.blocks import OnCells, OnVertices, Plain, Refined
from bsm.codec.static.choice.bounds import Bounds
from bsm.codec.static.choice.grids import Frame, Gridded, best_frame, made_steps, regular_frame
from bsm.codec.static.choice.settling import RATIO
from bsm.codec.static.choice.trials import Way
from bsm.codec.static.options import PRESETS, EncodeOptions
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.targets import ANY_ANGLE

# Of the vertices, that congruent parts explain, so that grids are coded with them in every trial.
FEWEST_IMAGES = 0.1
blocks_of = attrgetter("paper", "block_size", "overlap", "key_interval")


def ways_of(prepared: Prepared, bounds: Bounds, options: EncodeOptions) -> list[Way]:
    """Return the ways that may be smallest, the usual one first."""
    frame = best_frame(prepared, bounds)
    return [*_grids(frame, bounds, options), *_blocks(prepared, bounds, options)]


def _grids(frame: Frame, bounds: Bounds, options: EncodeOptions) -> Iterator[Way]:
    repeats = frame.explained >= FEWEST_IMAGES
    if repeats:
        yield Gridded("images", frame, images=True, going=True)
    else:
        yield Gridded("grid", frame)
    if options.effort == "quick":
        return
    if repeats and frame.moves_are_seen:
        yield Gridded("images, none moved", frame, images=True)
    along = frame
    if any(frame.turn):
        along = Frame(frame.prepared, bounds)
    for step in made_steps(along):
        yield Gridded("made", along, images=repeats, only_step=step)
    rows = None
    if bounds.contract.look < math.inf:
        rows = regular_frame(frame)
    if rows is None:
        yield Gridded("chosen", frame, worth=1.0)
        return
    yield Gridded("rows", rows)
    yield Gridded("rows, chosen", rows, worth=1.0)


def _blocks(prepared: Prepared, bounds: Bounds, options: EncodeOptions) -> Iterator[Way]:
    if options.effort == "quick" or not prepared.has_low_frequencies:
        return
    is_seen = bounds.contract.look < math.inf
    on_vertices = OnVertices(prepared, options, bounds)
    # Blocks that a user asks for are on the mesh itself; but a size begins with the default's own blocks.
    usual = [EncodeOptions()]
    if options.target and options.target.shrinks_with_step:
        usual.append(PRESETS["none"])
    is_usual = blocks_of(options) in map(blocks_of, usual)
    blocks: OnCells | OnVertices = on_vertices
    if is_seen and is_usual:
        blocks = OnCells(prepared, options, bounds)
    settled = is_seen or bounds.contract.angle == ANY_ANGLE
    refined = Refined("levels", prepared, bounds, blocks, settled=settled)
    yield refined
    if bounds.contract.visual < math.inf:  # it counts errors in all directions
        yield Refined("levels, even", prepared, bounds, blocks, ratio=math.sqrt(RATIO))
    if not is_seen:
        yield Plain(bounds, on_vertices, refined.first)
