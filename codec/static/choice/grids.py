"""Positions on grids: places that are rounded, or chosen for the normals, or images of others."""

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial

import numpy as np
import numpy.typing as npt

from bsm._core import rounded as places_on
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import MOST_GRID, Header
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Levels, Matrix, Positions, distinct
from bsm.codec.geometry.mesh import box_around, extent_of, squares_of
from bsm.codec.geometry.turns import UNTURNED, Turn, turn_of, turned_by
from bsm.codec.static.choice.bounds import COARSEST, SEEN, SPIKE, Bounds
from bsm.codec.static.choice.congruence import (
    lattice,
    motions_of,
    off_whole,
    planes_of,
    transforms_of,
)
from bsm.codec.static.choice.trials import BYTES, DOUBT, Estimate, Trial, ladder_of, on_ladder
from bsm.codec.static.preamble_encoding import Draft, Prepared
from bsm.codec.static.targets import SLACK
from bsm.codec.static.units import single
from bsm.codec.static.ways.grid import (
    SAMPLE,
    Raster,
    encode_going,
    encode_grid,
    grid_of,
    sampled_size,
)

# Vertices: of larger meshes, images would take more than some decoders grant.
MOST_CONGRUENT = 1 << 19
# How often the usual step is halved: where images are near to places, finer steps may be cheaper.
HALVES = 0, 1, 2, 7
UNSURE = 1.0  # standard deviation of what a wider step saves with images, over the guess
MENDINGS = 3  # codings in which vertices of folded edges stay where they are
STAYING = 1.05  # times the bytes with images to which vertices go: those where they stay


def grid_draft(
    prepared: Prepared,
    grid: Raster,
    places: Levels,
    brief: bool = False,
    targets: Matrix | None = None,
    decoded: Positions | None = None,
) -> Draft:
    """The stream of places on a grid, shape (n, 3), none negative; some may come to be elsewhere (`wanted`).

    `decoded`, if known, are the positions of the places.
    """
    grid = replace(grid, light=grid.light or prepared.light)
    header = Header(**prepared.fields, **grid.fields)
    faces = prepared.linked if brief else prepared.mesh.faces  # if others follow
    coded: Iterable[packets.Grid] = ()
    if targets is None:
        coded = encode_grid(faces, grid, places)
    else:
        coded, places = encode_going(faces, grid, places, targets)
    if decoded is None or targets is not None:
        decoded = grid.positions(places)
    return Draft(header, (*prepared.before_grid, *coded), decoded, places, brief)


def may_repeat(prepared: Prepared) -> bool:
    """Whether congruent parts are sought."""
    return prepared.congruence and 0 < prepared.graph.size <= MOST_CONGRUENT


def repeating(prepared: Prepared, grid: Raster, places: Levels, draft: Draft) -> Draft:
    """Return a draft of places, or their stream with images of congruent parts, if that is smaller."""
    transforms = transforms_of(prepared, grid)
    with_images = replace(grid, transforms=transforms)
    if not len(transforms):
        if prepared.light:
            return draft
        sampled = partial(sampled_size, prepared.mesh.faces, coded=places)
        if len(places) > SAMPLE and sampled(with_images) >= sampled(grid):
            return draft
    with_repeats = grid_draft(
        prepared, with_images, places, not prepared.light, decoded=draft.decoded
    )
    return min(draft, with_repeats, key=lambda draft: draft.size)


def paying(prepared: Prepared, draft: Draft) -> Draft:
    """A draft without quarters of its transforms, and with whole vertices split, which decode slowly, if that pays."""
    places = draft.places
    header = draft.header
    if places is None or not header.congruence:
        return draft
    grid = grid_of(header)
    transforms = transforms_of(prepared, grid)[: header.transforms]

    def code(pieces: list[Levels], *, whole: bool) -> Draft:
        raster = replace(grid, transforms=np.concatenate(pieces), whole=whole)
        return grid_draft(prepared, raster, places, draft.may_be_brief, decoded=draft.decoded)

    pieces = [part for part in np.array_split(transforms, 4) if len(part)]
    count = len(pieces)
    if count:
        split = code(pieces, whole=False)
        if split.size < (1.0 - SLACK) * draft.size:
            draft = split
    for i in range(count - 1, max(count - 3, 0), -1):
        rest = pieces[:i] + pieces[i + 1 :]
        smaller = code(rest, whole=draft.header.whole)
        if smaller.size >= draft.size:
            break  # the quarters before explain more vertices
        draft, pieces = smaller, rest
    return draft


def rounded(prepared: Prepared, bits: int) -> Draft:
    """Round every position to a grid with `bits` bits along the longest side of the bounding box."""
    return grid_draft(prepared, *_rounded(prepared, bits=bits))


def rounded_to_cells(prepared: Prepared, cell: float, origin: tuple[float, float, float]) -> Draft:
    """Every position at the nearest place of a grid that is given: at ``origin + k * cell``, k whole numbers."""
    return grid_draft(prepared, *_rounded(prepared, cell=cell, origin=origin))


def exact(prepared: Prepared) -> Draft:
    """Every position, which is one of single precision, to the bit: a grid, and which float of its cell each is."""
    grid, places = _rounded(prepared)
    grid = replace(grid, exact=True)
    positions = prepared.mesh.positions.astype(np.float32).astype(np.float64)
    header = Header(**prepared.fields, **grid.fields)
    coded = encode_grid(prepared.mesh.faces, grid, places, positions)
    return Draft(header, (*prepared.before_grid, *coded), positions, places)


def _rounded(
    prepared: Prepared,
    bits: int = 0,
    cell: float = 0.0,
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> tuple[Raster, Levels]:
    """A grid of so many bits, of given cells, or of exact floats, and the places on it, shape (n, 3)."""
    positions = np.ascontiguousarray(prepared.mesh.positions, np.float64)
    given_origin = np.array(origin, np.float64)
    corner, step, largest, places = places_on(positions, bits, cell, given_origin)
    return Raster(corner, step, largest), places


def made_on(positions: Matrix, within: float) -> float | None:
    """The step of the coarsest grid from the lower corner on that all positions are on, within so much or rounding."""
    extent = float(extent_of(positions).max())
    rounding = float(np.spacing(np.float32(np.abs(positions).max())))
    noise = max(4.0 * rounding, within) / extent
    for sample in (positions[:: 1 + len(positions) // SAMPLE], positions):
        values = distinct((sample - sample.min(axis=0)) / extent)
        values = values[values > noise]
        step = reach = float(values.min(initial=math.inf))
        while len(values) and reach < 4.0 * values[-1]:
            lowest = values[: np.searchsorted(values, reach, side="right")]
            counts = np.rint(lowest / step)
            remainders = np.abs(lowest - counts * step)
            large = remainders[remainders > step / 8.0]
            if len(large):  # then the step divides that, too, as Euclid has it
                step = float(large.min())
                reach = max(step, float(values[0]))
            else:
                step = float(counts @ lowest / (counts @ counts))
                reach *= 4.0
            if step < 8.0 * noise:
                return None
        if not len(values):
            return None
        nearest = np.rint(values / step) * step
        if (np.abs(values - nearest) > noise).any():
            return None
    return step * extent


def spacing_of(positions: Matrix, faces: Faces) -> float:
    """The spacing of rows and columns of a regular mesh, or what divides both, down to an eighth; 0: there is none."""
    sample = faces[:: 1 + len(faces) // SAMPLE]
    extent = extent_of(positions)
    sides = positions[sample] - positions[np.roll(sample, 1, axis=1)]
    spans = np.abs(sides).reshape(-1, 3)
    noise = 1e-6 * float(extent.max())
    common = 0.0
    for axis in range(3):
        along = spans[:, axis]
        along = np.sort(along[along > 4.0 * noise])
        if 8 * len(along) <= len(spans):
            continue
        ends = np.searchsorted(along, (1.0 + 1e-4) * along + noise)
        alike = ends - np.arange(len(along))
        first = int(alike.argmax())
        # What more edges span than anything else.
        spacing = float(along[first : ends[first]].mean())
        off = off_whole(along / spacing) > 2.0 * SLACK
        # Without rows, seven in eight would be off.
        if off.mean() < 8.0 * SLACK and extent[axis] > 8.0 * spacing:
            common = _common_spacing(spacing, common or spacing)
    return common


def _common_spacing(spacing: float, other: float) -> float:
    """Return what divides both spacings, down to an eighth of the wider one; that, where nothing does."""
    parts = max(spacing, other) / np.arange(1.0, 9.0)
    spacings = min(spacing, other) / parts
    fits = off_whole(spacings) < SLACK / 4.0
    return float(parts[fits.argmax()])  # the first one, where none fits


class Frame:
    """The axes and the origin of the grids of a mesh; of a regular mesh, on its rows."""

    def __init__(
        self, prepared: Prepared, bounds: Bounds, turn: Turn = UNTURNED, spacing: float = 0.0
    ) -> None:
        self.prepared = prepared
        self.bounds = bounds
        self.turn = turn
        self.spacing = spacing
        units = prepared.units
        axes = turned_by(prepared.mesh.positions, turn, back=True)
        self.positions = prepared.positions
        if any(turn):
            self.positions = units.into(axes)
        low, _ = box_around(axes)
        if spacing:
            heights = self.positions - units.into(low)
            around = np.exp(2j * math.pi / spacing * heights).mean(axis=0)
            rows = np.angle(around) / (2.0 * math.pi) * spacing
            low = low + rows * units.scale
        self.hold: Callable[[float], float] = float
        narrow = low.astype(np.float32)
        rounding = np.spacing(np.abs(narrow)).max()
        if rounding < 1e-6 * units.scale:  # exact enough
            self.hold = single
            next_below = np.nextafter(narrow, np.float32(-np.inf))
            narrow = np.where(narrow > low, next_below, narrow)
            low = narrow.astype(np.float64)
        self._origin = low
        heights = self.positions - units.into(low)
        cell = float(heights.max()) / (MOST_GRID - 4)
        smallest = float(np.finfo(np.float32).smallest_subnormal)
        self.least = max(cell, smallest / units.scale)

    @cached_property
    def first(self) -> float:
        """The step that a search begins with, which is on the ladder."""
        # Where half a diagonal of cells is beyond the least reach, it is not the look that decides.
        least_reach = float(self.bounds.reaches.min())
        reach = 2.0 * least_reach / math.sqrt(3.0)
        step = min(self.bounds.first_step, COARSEST, reach)
        return float(self.dividing(max(on_ladder(step), self.least)))

    def dividing(self, step: npt.ArrayLike) -> Matrix:
        """Return the widest step up to a wanted one that divides the spacing of rows, if there is one."""
        if not self.spacing:
            return np.asarray(step)
        parts = np.ceil(self.spacing / np.asarray(step) - 2.0 * SLACK)
        return np.asarray(self.spacing / np.maximum(parts, 1.0))

    @cached_property
    def planes(self) -> list[Matrix]:
        axes = turned_by(self.prepared.mesh.positions, self.turn, back=True)
        return planes_of(axes, self.prepared.mesh.faces)

    @cached_property
    def motions(self) -> tuple[Matrix, Matrix, Matrix]:
        """Motions between congruent parts, as for the first step."""
        self._seek_motions()
        return self._motions_at(self.first)

    def _seek_motions(self) -> None:
        if not self.prepared.motions:  # the same ladder for all looks
            self._motions_at(self.bounds.usual_step)

    def _motions_at(self, step: float) -> tuple[Matrix, Matrix, Matrix]:
        cell = max(step, self.least) * self.prepared.units.scale
        return motions_of(self.prepared, cell, self.turn)

    @property
    def explained(self) -> float:
        """The share of vertices that may be images of others; 0: no parts are congruent."""
        if not may_repeat(self.prepared):
            return 0.0
        _, _, shares = self.motions
        unexplained = 1.0 - np.minimum(shares, 1.0)
        return 1.0 - float(np.prod(unexplained))

    def cells(self, step: float, mirrored: bool) -> tuple[float, Matrix]:
        """Return the length of a cell near a step, and the origin, in the unit of the mesh."""
        cell = single(max(step, self.least) * self.prepared.units.scale)
        if self.spacing or not mirrored or not may_repeat(self.prepared):
            return cell, self._origin
        self._seek_motions()
        least = self.least * self.prepared.units.scale
        cell, moved = lattice(self.prepared, self._origin, cell, least, self.turn, self.planes)
        return cell, np.array([self.hold(value) for value in moved])

    @cached_property
    def light_size(self) -> int:
        """About the bytes of rounded places at the first step."""
        return Gridded("grid", self).light_size

    @cached_property
    def with_images(self) -> Trial:
        """The trial of the first step, with images to which vertices go."""
        return Gridded("images", self, images=True, going=True).at(self.first)

    @property
    def moves_are_seen(self) -> bool:
        """Whether vertices are much farther off where they went to images, and images save less than a half."""
        moved = self.with_images
        grid, places = Gridded("grid", self).places(self.first)
        rounded_positions = self.prepared.units.into(grid.positions(places))
        moved_error = squares_of(moved.positions - self.prepared.positions).sum()
        rounded_error = squares_of(rounded_positions - self.prepared.positions).sum()
        if moved_error <= math.exp(2.0 * DOUBT) * rounded_error:
            return False
        return moved.draft.size > 0.5 * self.light_size


class Gridded:
    """Places on the grids of a frame.

    `worth`: the worth of a nat, in angles by which a step bends a mean face; 0: places are rounded. `images`: predict
    places from congruent parts; `going`: vertices also go to where images are. `made`: the one step that it has.
    """

    def __init__(
        self,
        name: str,
        frame: Frame,
        worth: float = 0.0,
        *,
        images: bool = False,
        going: bool = False,
        only_step: float = 0.0,
    ) -> None:
        self.name = name
        self.frame = frame
        self._prepared = frame.prepared
        self._bounds = frame.bounds
        self._shaper = frame.bounds.measures.shaper
        self._worth = worth
        self._images = images
        self._going = going
        self._made = only_step
        self.least = only_step or frame.least
        self.most = only_step or COARSEST

    @property
    def first(self) -> float:
        return self._made or self.frame.first

    @cached_property
    def ladder(self) -> Matrix:
        """The logarithms of the steps that may be tried."""
        if self._made:
            return np.log([self._made])
        if not self.frame.spacing:
            return ladder_of(self.least, self.most)
        ladder = ladder_of(self.first / math.e, self.most)
        steps = self.frame.dividing(np.exp(ladder))
        return np.asarray(np.log(distinct(steps)))

    @property
    def light_size(self) -> int:
        """About the bytes at the first step without images, by a quick coder."""
        grid, places = self.places(self.first)
        light_grid = replace(grid, light=True)
        draft = grid_draft(self._prepared, light_grid, places, may_repeat(self._prepared))
        return draft.size

    def estimate(self, rival: float) -> Estimate:
        """Return about how many bytes a trial at the first step takes."""
        fixed = len(self._prepared.connectivity.data)
        size = float(self.frame.light_size)
        varying = BYTES * self._prepared.graph.size
        if self._made:
            if not self._images:
                return Estimate(float(self.light_size), DOUBT, varying)
            trial = self.at(self._made)
            return Estimate(trial.draft.size, SLACK, varying, trial)
        if not self._images:
            return Estimate(size, DOUBT, varying, also=self._also(), kin="places")
        # Luck decides about bytes, so that shares of vertices tell little: the first trial is coded.
        coded = self.frame.with_images
        saving = min(varying, coded.draft.size - fixed) / 2.0
        if self._going:
            return Estimate(coded.draft.size, SLACK, saving, coded, self._also(HALVES), UNSURE)
        return Estimate(STAYING * coded.draft.size, 2.0 * SLACK, saving, slope_doubt=UNSURE)

    def _also(self, halves: tuple[int, ...] = (0,)) -> tuple[float, ...]:
        """The step with which a search for a look of 1 begins, and it halved so often, as far as they are finer.

        Where parts or spacings repeat, bytes hardly depend on steps, but on luck. The steps are the same for all looks.
        """
        if not self._images and not self.frame.spacing:
            return ()
        usual = self._bounds.usual_step
        steps = [max(on_ladder(usual / 2.0**half), self.least) for half in halves]
        return tuple(step for step in steps if step < 0.99 * self.first)

    def at(self, step: float) -> Trial:
        """Return the trial of a step."""
        width = float(self.frame.dividing(step))
        grid, places = self.places(width)
        if self._going:
            draft = self._draft(grid, places, self._wanted(grid, places))
            return self._coded_trial(width, grid, places, draft)
        decoded = grid.positions(places)
        code = partial(self._draft, grid, places, decoded=decoded)
        return self._trial(width, grid, places, decoded, code)

    def mended(self, trial: Trial) -> Trial | None:
        """Return a trial whose vertices of folded edges are where they fold least, and do not go to images."""
        if not self._going:
            return None
        grid, places = self.places(trial.step, unfolded=True)
        targets = self._wanted(grid, places)
        for _ in range(MENDINGS):
            folded = self._shaper.over(trial.positions)
            if not targets[folded, 3].any():
                break
            targets[folded, 3] = 0.0
            draft = self._draft(grid, places, targets)
            trial = self._coded_trial(trial.step, grid, places, draft)
        return trial

    def _coded_trial(self, step: float, grid: Raster, places: Levels, draft: Draft) -> Trial:
        return self._trial(step, grid, places, draft.decoded, lambda: draft)

    def _trial(
        self,
        step: float,
        grid: Raster,
        places: Levels,
        decoded: Positions,
        code: Callable[[], Draft],
    ) -> Trial:
        positions = np.ascontiguousarray(self._prepared.units.into(decoded))
        complete = partial(completed, self._prepared, grid, places, self._images)
        return Trial(step, positions, code, decoded=decoded, complete=complete)

    def places(self, step: float, *, unfolded: bool = False) -> tuple[Raster, Levels]:
        """Return a grid, and the place of each vertex on it."""
        frame = self.frame
        unit = self._prepared.units.scale
        length, origin = frame.cells(step, mirrored=not self._made)
        cell = length / unit
        low = self._prepared.units.into(origin)
        in_cells = (frame.positions - low) / cell
        places = np.floor(in_cells + 0.5).astype(np.int32)
        if self._worth:
            worth = self._worth * step / self._shaper.mean_edge
            least_reach = float(self._bounds.reaches.min())
            reach = min(least_reach, SPIKE * step)
            places = self._shaper.places(places, low, cell, worth, reach)
        # The coder decides where vertices go to images: it mends most folds.
        if self._bounds.metric is not None and (unfolded or not self._going):
            places = self._unfolded(places, low, cell)
        places = self._apart(places, low, cell)
        least = places.min(axis=0)  # some may be below the origin
        start = tuple(frame.hold(value) for value in origin + least * length)
        largest_places = tuple(int(value) for value in np.ptp(places, axis=0))
        grid = Raster(start, length, largest_places, turn=frame.turn)
        places = places - least
        # Pictures show faces without area; on coarse grids there are many.
        if self._bounds.metric is not None:
            largest = np.array(grid.largest, np.int32)
            targets = self._wanted(grid, places)
            places = self._prepared.linked.mended(places, largest, targets)
        return grid, places

    def _unfolded(self, places: Levels, low: Matrix, cell: float) -> Levels:
        """Return places from `low` on with fewer edges folded over."""
        turn = self.frame.turn
        reaches = np.minimum(self._bounds.reaches, SPIKE * cell)
        positions = turned_by(places * cell + low, turn)
        directions = turned_by(cell * np.eye(3), turn).reshape(1, 9)
        unfolded = self._shaper.unfold(positions, places, directions, reaches)
        if unfolded is None:
            return places
        return unfolded

    def _apart(self, places: Levels, low: Matrix, cell: float) -> Levels:
        """Return places from `low` on; vertices that would close a gap between parts move away, a cell or a few."""
        gaps = self._bounds.gaps
        turn = self.frame.turn
        if not len(gaps.ends):
            return places
        toward = turned_by(gaps.closing[:, 0], turn, back=True)
        largest = np.abs(toward).max(axis=1, keepdims=True)
        away = -np.rint(toward / largest).astype(np.int32)
        first_ends = gaps.ends[:, 0]
        second_ends = gaps.ends[:, 1]
        for attempt in range(3):
            moved = turned_by(places * cell + low - self.frame.positions, turn)
            wrong = gaps.closed(moved) > 1.0
            if not wrong.any():
                break
            if attempt == 0:  # at first, of one part
                wrong &= first_ends >= second_ends
            places[first_ends[wrong]] += away[wrong]
        return places

    def _draft(
        self,
        grid: Raster,
        places: Levels,
        targets: Matrix | None = None,
        decoded: Positions | None = None,
    ) -> Draft:
        """Return the stream of places; vertices go to images as `_wanted` has it."""
        may_be_brief = may_repeat(self._prepared) and not self._prepared.light
        if not self._images:
            return grid_draft(self._prepared, grid, places, may_be_brief, decoded=decoded)
        transforms = transforms_of(self._prepared, grid)
        if not len(transforms):
            targets = None
        grid = replace(grid, transforms=transforms)
        return grid_draft(self._prepared, grid, places, may_be_brief, targets, decoded)

    def _wanted(self, grid: Raster, places: Levels) -> Matrix:
        """Return where each vertex would be, in cells, and the square of how far off it may be, shape (n, 4)."""
        units = self._prepared.units
        gaps = self._bounds.gaps
        cell = grid.step / units.scale
        low = units.into(np.array(grid.origin))
        targets = (self.frame.positions - low) / cell
        reach = np.minimum(gaps.kept(self._bounds.reaches) / cell, SPIKE)
        # Who is past the middle of a gap leaves no room in it: there, all stay where they are.
        past = squares_of(places - targets) > np.square(reach)
        is_full = past[gaps.ends].any(axis=1)
        reach[gaps.ends[is_full]] = 0.0
        return np.column_stack([targets, np.square(reach)])


# Not a method: a trial that a frame keeps must not keep the frame.
def completed(
    prepared: Prepared, grid: Raster, places: Levels, with_images: bool, draft: Draft
) -> Draft:
    """Return the smallest stream of places: with images where they pay, and with as many as pay."""
    if may_repeat(prepared) and not with_images:
        draft = repeating(prepared, grid, places, draft)
    return paying(prepared, draft)


def best_frame(prepared: Prepared, bounds: Bounds) -> Frame:
    """Return the grids in the axes of the mesh, or of the part, if those take much fewer bytes at the first step."""
    usual = Frame(prepared, bounds)
    # Sent normals stay in the axes of the mesh, and may be predicted from the grid.
    if not may_repeat(prepared) or prepared.light or bounds.measures.normals is not None:
        return usual
    faces = prepared.mesh.faces
    sample = faces[:: 1 + len(faces) // (4 * SAMPLE)]
    turn = turn_of(prepared.positions, sample)
    if not any(turn):
        return usual
    turned = Frame(prepared, bounds, turn)
    usual_size = Gridded("grid", usual).at(usual.first).final.size
    turned_size = Gridded("grid", turned).at(usual.first).final.size
    if turned_size < (1.0 - SLACK) * usual_size:
        return turned
    return usual


def regular_frame(frame: Frame) -> Frame | None:
    """Return the frame on the rows of a regular mesh: at steps that divide their spacing, which others meet by luck,
    rows and columns take hardly any bytes. None: the mesh is irregular."""
    spacing = spacing_of(frame.positions, frame.prepared.mesh.faces)
    if spacing <= 2.0 * SLACK * frame.first:
        return None
    return Frame(frame.prepared, frame.bounds, frame.turn, spacing)


def made_steps(frame: Frame) -> list[float]:
    """Return the steps of the grids that the mesh was made on, or about, in single precision."""
    unit = frame.prepared.units.scale
    reaches = (0.0, SEEN * frame.bounds.measures.shaper.mean_edge * unit)
    steps = [made_on(frame.prepared.mesh.positions, reach) for reach in reaches]
    return sorted({step / unit for step in steps if step is not None})
