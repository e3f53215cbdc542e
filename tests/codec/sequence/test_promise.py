"""Promises that hold in every frame, on what is decoded."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pytest

import bsm
from bsm import Contract
from bsm.codec.arrays import Matrix
from bsm.codec.look.foreseen import Foresight
from bsm.codec.look.measure import LookMetric
from bsm.codec.sequence.step_search import Measured, StepSearch, Tried, _evening, _foretold
from bsm.codec.sequence.targets import compare_sequences
from bsm.codec.static.units import Units
from tests.motion import bending

UNITS = Units((0.0, 0.0, 0.0), 1.0)
FAR = Contract(0.02)


def kept(
    positions: np.ndarray, faces: np.ndarray, promise: Contract, **changes: int
) -> tuple[int, np.ndarray, np.ndarray, np.ndarray]:
    """Bytes, the frames in the decoder's order, what is decoded, and the faces."""
    options = bsm.SequenceOptions(block_size=100, promise=promise, threads=1, **changes)
    encoder = bsm.SequenceEncoder(faces, options, len(positions))
    data = b"".join(encoder.chunks(positions))
    decoded, found = bsm.decode_sequence(data, threads=1)
    return len(data), positions[:, encoder.vertex_order], decoded, found


def looks(original: np.ndarray, decoded: np.ndarray, faces: np.ndarray) -> list[float]:
    pairs = zip(original, decoded, strict=True)
    return [LookMetric(bsm.TriangleMesh(a, faces), threads=1).look(b).moving for a, b in pairs]


def farthest(original: np.ndarray, decoded: np.ndarray) -> float:
    """In diagonals of the first frame."""
    return float(
        np.linalg.norm(decoded - original, axis=2).max()
        / np.linalg.norm(np.ptp(original[0], axis=0))
    )


@pytest.mark.parametrize("gop", [3, 256])
def test_every_frame_looks_the_same(gop: int) -> None:
    _, original, decoded, faces = kept(*bending(5), Contract(0.01, look=1.0), gop=gop)
    found = looks(original, decoded, faces)
    assert max(found) <= 1.0 and farthest(original, decoded) <= 0.01
    assert max(found) > 0.7  # with little to spare


@pytest.mark.parametrize("absolute", [False, True])
def test_no_vertex_is_farther_off_than_reported(absolute: bool) -> None:
    positions, faces = bending(12)
    diagonal = float(np.linalg.norm(np.ptp(positions[0], axis=0)))
    bound = 0.002
    promise = Contract(bound * diagonal if absolute else bound, absolute=absolute)
    _, original, decoded, _ = kept(positions, faces, promise)
    assert 0.7 * bound < farthest(original, decoded) <= bound


@pytest.mark.parametrize("look", [1.0, float("inf")])
def test_low_delay_keeps_promises_frame_by_frame(look: float) -> None:
    positions, faces = bending(6)
    positions[5] += 0.004 * np.random.default_rng(0).standard_normal(positions[5].shape)
    _, original, decoded, found = kept(
        positions, faces, Contract(0.002, look=look), low_delay=1, gop=4
    )
    assert 0.0014 < farthest(original, decoded) <= 0.002
    assert max(looks(original, decoded, found)) <= look


@pytest.mark.parametrize(
    "promise", [Contract(0.002), Contract(0.1, look=1.0), Contract(1e-3, absolute=True)]
)
@pytest.mark.parametrize("low_delay", [0, 1])
def test_a_search_that_takes_a_step_too_coarse_is_caught(
    promise: Contract, low_delay: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        StepSearch,
        "run",
        lambda search, encode, *_, **__: encode(0.04, np.ones(len(search._frames))),
    )
    with pytest.raises(bsm.VerificationError, match=r"is off by|has look"):
        kept(*bending(4), promise, low_delay=low_delay)


@pytest.mark.parametrize("changes", [{}, {"keep_order": True}, {"step": 0.01, "promise": None}])
def test_the_encoder_reports_errors_of_decoded_frames(changes: dict[str, Any]) -> None:
    positions, faces = bending(7)
    chosen = bsm.SequenceOptions(
        **{"block_size": 100, "promise": Contract(0.01, look=1.0), "threads": 1, "gop": 4} | changes
    )
    encoder = bsm.SequenceEncoder(faces, chosen, 7)
    decoded, found = bsm.decode_sequence(b"".join(encoder.chunks(positions)), threads=1)
    original = positions[:, encoder.vertex_order]
    assert encoder.kg == pytest.approx(compare_sequences(original, decoded, found).kg, rel=1e-9)
    foresight = Foresight(found)
    foreseen = [foresight.look(*pair) for pair in zip(original, decoded, strict=True)]
    seen = looks(original, decoded, found)
    # Short GOPs are drawn as a whole; without a promise only the frame is that is foreseen to look worst.
    expected = max(seen) if chosen.promise else seen[int(np.argmax(foreseen))]
    assert encoder.worst_look == pytest.approx(expected, rel=1e-4)


def test_few_frames_are_drawn_and_the_worst_is_among_them(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: set[int] = set()
    look = StepSearch._look

    def noted(search: StepSearch, index: int, decoded: Sequence[Matrix]) -> float:
        drawn.add(index)
        return look(search, index, decoded)

    monkeypatch.setattr(StepSearch, "_look", noted)
    positions, faces = bending(40)
    positions[23] += 0.01 * np.random.default_rng(0).standard_normal(positions[23].shape)
    _, original, decoded, found = kept(positions, faces, Contract(0.02, look=1.0))
    some = sorted({*range(0, 40, 6), *range(21, 26), *drawn})
    seen = dict(zip(some, looks(original[some], decoded[some], found), strict=True))
    assert max(seen.values()) <= 1.0 and len(drawn) < 30
    assert max(seen[index] for index in drawn) > 0.9 * max(seen.values())


class Encoding:
    """Frames of which one vertex is off by a share of the bound, and their size."""

    def __init__(self, frames: np.ndarray, step: float, share: float, size: float) -> None:
        self.frames, self.step, self.share, self.size = frames, step, share, round(size)

    def decoded_frames(self) -> Iterator[Matrix]:
        for frame in self.frames:
            decoded = frame.copy()
            decoded[0, 0] += self.share * FAR.farthest
            yield decoded


def search_of(
    frames: int = 4, kind: type[StepSearch] = StepSearch
) -> tuple[StepSearch, np.ndarray]:
    """A search for a bound on vertex errors, and its frames."""
    positions, faces = bending(frames)
    return kind(positions, faces, FAR, UNITS, 1), positions


def test_a_search_does_not_end_far_below_its_bound() -> None:
    """The share falls to an eighth where a fold closes, at a step below 0.00014."""
    search, frames = search_of()

    def encode(step: float, _: Matrix) -> Encoding:
        share = 1.35 * (step / 0.00014) ** 0.35 if step > 0.00014 else 0.13
        return Encoding(frames, step, share, 1.0 / step)

    encoding = search.run(encode, 0.0033, 1e-6, weighed=False)
    assert 0.88 * 0.00014 < encoding.step <= 0.00014


def test_a_search_ends_when_another_attempt_saves_less_than_its_price() -> None:
    for first, attempts in ((0.0005, 2), (0.00495, 1), (0.05, 2)):
        steps: list[float] = []
        search, frames = search_of()

        def encode(
            step: float, _: Matrix, steps: list[float] = steps, frames: np.ndarray = frames
        ) -> Encoding:
            steps.append(step)
            return Encoding(frames, step, step / 0.005, 1e6 / math.sqrt(step))

        encoding = search.run(encode, first, 1e-6, weighed=True)
        assert 0.9 * 0.005 < encoding.step <= 0.005 and len(steps) == attempts


@pytest.mark.parametrize("hidden", [4, 17])
def test_a_frame_in_doubt_is_drawn_before_an_encoding_is_returned(
    hidden: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A frame that errors of normals do not tell of is found, and the search goes on from it."""
    look = StepSearch._look

    def worse(search: StepSearch, index: int, decoded: Sequence[Matrix]) -> float:
        return look(search, index, decoded) * (1.5 if index == hidden else 1.0)

    monkeypatch.setattr(StepSearch, "_look", worse)
    positions, faces = bending(20)
    positions[hidden] += 0.003 * np.random.default_rng(0).standard_normal(positions[hidden].shape)
    _, original, decoded, found = kept(positions, faces, Contract(0.02, look=1.0))
    assert max(looks(original[[hidden]], decoded[[hidden]], found)) <= 1.001 / 1.5


def test_weights_follow_the_farthest_vertices_where_these_are_nearest_to_their_bound() -> None:
    positions, faces = bending(10)
    search = StepSearch(positions, faces, Contract(0.02, look=1.0), UNITS, 1)
    distances = np.full(10, 0.2)
    distances[6] = 1.5
    measured = Measured(distances, np.full(10, 0.5), {0: 0.5})
    tried = Tried(Encoding(positions, 0.003, 0.5, 1000.0), 0.003, np.zeros(10), measured)
    step, weights = search._following(tried, 1, 0.0)
    assert int(weights.argmax()) == 6 and step < 0.003
    # After the first attempt, one that breaks a bound counts on no relief.
    later, _ = search._following(tried, 2, 0.0)
    assert later == pytest.approx(0.003 / 1.5)


def test_frames_that_are_only_expected_to_exceed_the_bound_are_drawn_before_an_encoding_is_thrown_away() -> (
    None
):
    """One frame of ten looks much better than its error of normals tells: all others would seem to exceed."""
    foreseen = np.full(10, 1.0)
    foreseen[4] = 0.5
    attempts = []

    class Expecting(StepSearch):
        def _measure(self, decoded: Sequence[Matrix]) -> Measured:
            attempts.append(decoded)
            before = {frame: math.log(0.5) for frame in range(10) if frame != 4}
            return Measured(np.full(10, 0.5), foreseen, {4: 0.99}, before)

        def _look(self, index: int, decoded: Sequence[Matrix]) -> float:
            return 0.99 if index == 4 else 0.5

    positions, faces = bending(10)
    search = Expecting(positions, faces, Contract(0.02, look=1.0), UNITS, 1)
    search.run(
        lambda step, _: Encoding(positions, step, 0.5, 1.0 / step), 0.0033, 1e-6, weighed=True
    )
    assert len(attempts) < 5 and search.worst_look == pytest.approx(0.99)


@pytest.mark.parametrize("least", [0.0, 0.0004])
def test_a_search_that_runs_out_of_attempts_ends_in_a_finer_stream(least: float) -> None:
    """The bound is kept only far below the steps that attempts lead to; one below `least` cannot be coded."""
    for first, finest in ((0.1, 1e-6), (0.003, 0.001)):
        search, frames = search_of()

        def encode(step: float, _: Matrix, frames: np.ndarray = frames) -> Encoding:
            if step < least:
                raise bsm.OptionError("the step is too fine")
            return Encoding(frames, step, 1.001 if step > 0.0005 else 0.5, 1.0 / step)

        assert 0.0004 <= search.run(encode, first, finest, weighed=True).step <= 0.0005
    search, frames = search_of()
    with pytest.raises(bsm.TargetError, match="cannot be kept in every frame"):
        search.run(
            lambda step, _: Encoding(frames, step, 2.0, 1.0 / step), 0.003, 0.001, weighed=True
        )


def test_where_the_smallest_stream_fails_the_next_one_is_taken() -> None:
    class Doubting(StepSearch):
        def _is_certain(self, tried: Tried[Encoding]) -> bool:
            return tried.step < 0.0047

    steps: list[float] = []
    search, frames = search_of(kind=Doubting)

    def encode(step: float, _: Matrix) -> Encoding:
        steps.append(step)
        return Encoding(frames, step, step / 0.005, 1e6 / math.sqrt(step))

    encoding = search.run(encode, 0.0046, 1e-6, weighed=True)
    assert encoding.step == min(steps) == 0.0046 and len(steps) == 2


def test_looks_are_of_positions_in_the_unit_of_the_mesh() -> None:
    """Far from the origin positions are rounded, which users see."""
    y, x = np.mgrid[0:19, 0:19].astype(float)
    index = np.arange(361).reshape(19, 19)
    left = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, :-1]], axis=-1).reshape(-1, 3)
    right = np.stack([index[1:, :-1], index[:-1, 1:], index[1:, 1:]], axis=-1).reshape(-1, 3)
    frames = np.repeat(np.stack([x, y, 0.0 * x], axis=-1).reshape(1, -1, 3) + 5e5, 9, axis=0)
    promise = Contract(0.02, look=0.105236)
    _, original, decoded, faces = kept(
        frames, np.concatenate([left, right]), promise, low_delay=4, gop=17
    )
    assert max(looks(original, decoded, faces)) <= promise.look * (1 + 1e-6)


def test_what_was_seen_of_a_series_foretells_the_rest() -> None:
    random, seen = np.random.default_rng(0), np.arange(0, 200, 5)
    noise = 0.04 * random.standard_normal(200)
    for series, limit in (
        (noise, 0.05),
        (noise + np.linspace(0.0, 2.0, 200), 0.15),
        (noise + noise.cumsum(), 0.5),
    ):
        mean, variance = _foretold(seen, series[seen], np.zeros(len(seen)), 200)
        others = np.setdiff1d(np.arange(200), seen)
        assert mean[seen] == pytest.approx(series[seen]) and variance[seen].max() < 1e-9
        scores = (series - mean)[others] / np.sqrt(variance[others])
        assert 0.3 < scores.std() < 1.3 and np.sqrt(variance[others]).mean() < limit
        doubted, more = _foretold(seen, series[seen], np.full(len(seen), 0.05**2), 200)
        assert (more[seen] > 0.02**2).all() and np.abs(doubted - mean).max() < 0.2


def test_frames_that_look_worse_weigh_more() -> None:
    weights = _evening(np.where(np.arange(40) < 20, 0.5, 1.0))
    assert weights.mean() == pytest.approx(0.0) and weights[30] - weights[5] == pytest.approx(
        np.log(2.0)
    )
    assert np.array_equal(_evening(np.zeros(3)), np.zeros(3))


@pytest.mark.parametrize("promise", [None, Contract(0.01, look=1.0)])
def test_the_progress_of_a_search_grows_to_the_whole(promise: Contract | None) -> None:
    positions, faces = bending(6)
    reports: list[float] = []
    options = bsm.SequenceOptions(block_size=100, promise=promise, threads=1, gop=3)
    chunks = bsm.SequenceEncoder(faces, options, 6).chunks(
        positions, lambda done, count: reports.append(done / count)
    )
    assert b"".join(chunks)
    assert reports[0] < 0.4 and reports[-1] == max(reports) == 1.0 and len(set(reports)) > 3
    # Frames in doubt may be more than a search let expect.
    assert promise or reports == sorted(reports)


def test_frames_of_which_nothing_is_seen_are_no_obstacle() -> None:
    positions, faces = bending(4)
    positions[2] = positions[2, :1]  # all vertices at one place
    _, original, decoded, _ = kept(positions, faces, Contract(0.01, look=1.0))
    assert farthest(original, decoded) <= 0.01


def test_what_cannot_be_kept_is_an_error() -> None:
    with pytest.raises(bsm.TargetError, match="cannot be kept"):
        kept(*bending(3), Contract(1e-9))
    for bounds in (Contract(0.01, by_part=0.01), Contract(0.01, angle=5.0)):
        with pytest.raises(bsm.OptionError, match="vertex errors and looks only"):
            bsm.SequenceOptions(promise=bounds)


@pytest.mark.parametrize("width", [0.0, 1.0])
def test_faces_without_area_are_encoded(width: float) -> None:
    frames = np.stack([np.linspace(0, width, 6)[:, None] * [k, 0, 0] for k in range(1, 5)])
    _, original, decoded, _ = kept(
        frames, np.array([[0, 1, 2], [3, 4, 5]], np.int32), Contract(0.01, look=1.0)
    )
    assert np.abs(original - decoded).max() <= 0.01
