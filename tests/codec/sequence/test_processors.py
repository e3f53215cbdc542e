"""Decoders agree, whatever the processor, the library behind numpy, and the last digits of the first frame."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from bsm.bitstream.container import packets
from bsm.bitstream.container.gop import parse_gop_body
from bsm.bitstream.container.reader import Reader, Signal
from bsm.codec.arrays import Matrix, Positions
from bsm.codec.sequence import run_encoding
from bsm.codec.sequence.encoder import encode_sequence
from bsm.codec.sequence.gop import GopDecoder
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.tracks import Setting
from tests.shapes import torus

ROOT = Path(__file__).parents[3]
PROCESSORS = ("SkylakeX", "Prescott")
DECODE = (
    "import sys, numpy; from bsm.codec.sequence.decoder import decode_sequence;"
    "numpy.savez(sys.argv[1], *(decode_sequence(open(name, 'rb').read())[0] for name in sys.argv[2:]))"
)


def waving(frames: int, crumpled: bool) -> tuple[Positions, np.ndarray]:
    """A torus that waves; crumpled, a third of its vertices lie in few places, so that most triangles have no area."""
    mesh = torus(24, 14)
    still = mesh.positions.copy()
    if crumpled:
        still[::3] = np.round(still[::3], 0)
    angle = still[:, 0] * 2
    moves = [np.stack([0 * angle, np.sin(angle + t / 2), np.cos(angle - t)], axis=1) for t in range(frames)]
    return np.array([still + 0.1 * move for move in moves]), mesh.faces


def streams() -> list[bytes]:
    return [
        encode_sequence(
            *waving(6, crumpled), SequenceOptions(keep=keep, low_delay=low_delay, block_size=200, threads=1)
        )
        for keep in (1.0, 0.05, 0.005)
        for low_delay in (0, 1, 4)
        for crumpled in (False, True)
    ]


def test_processors_agree(tmp_path: Path) -> None:
    names = []
    for number, data in enumerate(streams()):
        names.append(str(tmp_path / f"{number}.bsm"))
        Path(names[-1]).write_bytes(data)
    found = []
    for processor in PROCESSORS:
        out = str(tmp_path / f"{processor}.npz")
        environment = {**os.environ, "OPENBLAS_CORETYPE": processor}
        subprocess.run([sys.executable, "-c", DECODE, out, *names], cwd=ROOT, env=environment, check=True, timeout=120)
        with np.load(out) as arrays:
            found.append([arrays[f"arr_{number}"] for number in range(len(names))])
    for other in found[1:]:
        for one, two in zip(found[0], other, strict=True):
            np.testing.assert_allclose(two, one, rtol=0, atol=1e-9)


@pytest.mark.parametrize("crumpled", [False, True])
@pytest.mark.parametrize("keep", [1.0, 0.05, 0.005])
@pytest.mark.parametrize("low_delay", [0, 1, 4])
def test_a_decoder_whose_first_frame_is_a_little_off_agrees(
    monkeypatch: pytest.MonkeyPatch, low_delay: int, keep: float, crumpled: bool
) -> None:
    seen: list[tuple[tuple, dict, Matrix]] = []
    real = run_encoding.make_setting

    def spy(scheme, faces, first_frame, **rest):  # type: ignore[no-untyped-def]
        seen.append(((scheme, faces), rest, first_frame))
        return real(scheme, faces, first_frame, **rest)

    monkeypatch.setattr(run_encoding, "make_setting", spy)
    options = SequenceOptions(keep=keep, low_delay=low_delay, block_size=200, threads=1)
    data = encode_sequence(*waving(6, crumpled), options)
    ((arguments, rest, first_frame),) = seen
    change = 1e-12 * np.random.default_rng(0).uniform(-1.0, 1.0, first_frame.shape)
    one, two = (decoded(data, real(*arguments, first, **rest)) for first in (first_frame, first_frame + change))
    assert 0.0 < np.abs(one - two).max() < 1e-9


def decoded(data: bytes, setting: Setting) -> Positions:
    """The frames of a stream in BSM units, by the dictionaries of a setting."""
    decoder, reader = GopDecoder(setting), Reader()
    reader.receive_data(data)
    reader.receive_eof()
    frames: list[Matrix] = []
    while (packet := reader.next_packet()) is not Signal.END_OF_STREAM:
        if isinstance(packet, packets.Gop):
            frames.extend(positions for positions, *_ in decoder.decode(parse_gop_body(packet.data, 1024)))
    return np.array(frames)
