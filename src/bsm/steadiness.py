"""Whether a stream means the same to all who decode it: what becomes of it where numbers are rounded otherwise.

Decoders agree on every integer; their positions are real numbers, and differ by rounding. Extreme options (a high
power, many iterations, a tiny shift) can make dictionaries that magnify rounding errors without bound. So a stream is
decoded twice, the second time with noise in the last seven bits on all that dictionaries and predictions
start from: if that moves it, another processor may, too (specification, M 15.4).
"""

import numpy as np

from bsm.bitstream.errors import NumericError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Matrix, Positions
from bsm.codec.sequence.decoder import SequenceDecoder
from bsm.codec.sequence.events import FrameEvent
from bsm.codec.signal.chain import Rounding, Trial, unchanged
from bsm.codec.static.decoder import Decoder
from bsm.files.stream import events, peek_header

NOISE = 2.0**-46
"""Of the greatest number of each column: what rounding does to a dictionary on its way, and room to spare."""
RMS, PEAK = 1e-9, 1e-8  # how far two decoders may be apart, in extents (M 15.2)


def shaken(values: Matrix) -> Matrix:
    """The values with noise, the same for the same shape."""
    size = NOISE * np.abs(values).max(axis=0, initial=0.0)
    noisy: Matrix = values + size * np.random.default_rng(0).uniform(-1.0, 1.0, values.shape)
    return noisy


def unsteadiness(stream: bytes, *, limits: Limits = DEFAULT_LIMITS, threads: int | None = None) -> tuple[float, float]:
    """How far noise moves what a stream decodes to.

    Parameters
    ----------
    stream, limits, threads
        The bytes of a mesh or a sequence; as `decode` takes them.

    Returns
    -------
    rms, peak : float
        Root mean square and greatest distance over all vertices (and frames), in extents: of the scale of the stream,
        the diagonal of the bounding box, and 2^-20 of the greatest coordinate, the greatest.

    Raises
    ------
    BsmError
        If the stream cannot be decoded.

    Examples
    --------
    >>> import bsm
    >>> rms, peak = bsm.unsteadiness(bsm.encode("bunny.ply"))
    >>> rms <= peak < 1e-8
    True
    """
    positions, scale = _decoded(stream, limits, threads, unchanged)
    moved, _ = _decoded(stream, limits, threads, shaken)
    if positions.size == 0:
        return 0.0, 0.0
    diagonal = float(np.linalg.norm(np.ptp(positions / 2, axis=0)) * 2)
    extent = max(scale, diagonal, 2.0**-20 * float(np.abs(positions).max()))
    apart = np.linalg.norm(moved / extent - positions / extent, axis=-1)
    return float(np.sqrt((apart**2).mean())), float(apart.max())


def check_steadiness(stream: bytes, *, limits: Limits = DEFAULT_LIMITS, threads: int | None = None) -> None:
    """Check that two decoders agree on a stream, whatever their rounding.

    Parameters
    ----------
    stream, limits, threads
        As `unsteadiness` takes them.

    Raises
    ------
    NumericError
        If they need not: see `unsteadiness`; other errors as of `decode`.

    Examples
    --------
    >>> import bsm
    >>> bsm.check_steadiness(bsm.encode("bunny.ply"))
    """
    rms, peak = unsteadiness(stream, limits=limits, threads=threads)
    if not (rms <= RMS and peak <= PEAK):
        raise NumericError(
            f"rounding errors move the positions of this stream by {peak:.1e} of its extent ({rms:.1e} in the mean), "
            "so that others may decode something else; take fewer iterations, a lower power or a larger shift"
        )


def _decoded(stream: bytes, limits: Limits, threads: int | None, rounding: Rounding) -> tuple[Positions, float]:
    """Positions, shape (n, 3), of all frames one below the other, and the header's scale."""
    header, _ = peek_header(iter([stream]))
    scale = header.scale if header else 1.0
    if header and header.gop_frames:
        with SequenceDecoder(limits, threads, trial=Trial(rounding)) as decoder:
            found = [e.positions for e in events(decoder, iter([stream])) if isinstance(e, FrameEvent)]
        return np.concatenate([np.empty((0, 3)), *found]), scale
    with Decoder(limits, threads, trial=Trial(rounding)) as static:
        static.receive_data(stream)
        return static.finish().positions, scale
