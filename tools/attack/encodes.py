"""Random streams on this processor: `python -m tools.attack.encodes SEED COUNT FOLDER [--streams OTHER]`.

Writes each stream and what it decodes to into FOLDER; decodes the streams in OTHER, which another processor has
written, as well. Everything follows from SEED, so streams of two processors can be compared byte by byte.
"""

import traceback
import warnings
from pathlib import Path
from random import Random

import numpy as np

from bsm.bitstream.errors import BsmError
from tools.attack.decoding import whole
from tools.attack.inputs import random_stream
from tools.attack.tally import Decoded
from tools.command import parser_of
from tools.copies import refuse_other_kernels


def random_streams(seed: str, count: int) -> list[bytes | str]:
    """Encode a number of seeds: a stream, a traceback if the encoder failed, nothing if it refused."""
    streams: list[bytes | str] = []
    for k in range(count):
        try:
            streams.append(random_stream(Random(f"{seed}/{k}")))
        except BsmError:
            streams.append(b"")
        except Exception:
            streams.append(traceback.format_exc(limit=-3))
    return streams


def store(path: Path, decoded: Decoded) -> None:
    """Write decoded arrays to a file; names of attributes come from strangers and are not used as names of files."""
    positions, faces, attributes = decoded
    numbered = {f"array {number}": values for number, values in enumerate(attributes.values())}
    np.savez(path, positions=positions, faces=faces, names=np.array([*attributes], str), **numbered)  # type: ignore[arg-type]


def stored(path: Path) -> Decoded:
    """What `store` has written."""
    with np.load(path) as file:
        attributes = {
            str(name): file[f"array {number}"] for number, name in enumerate(file["names"])
        }
        return file["positions"], file["faces"], attributes


def main() -> None:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("seed")
    parser.add_argument("count", type=int)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--streams", type=Path, required=True)
    args = parser.parse_args()
    refuse_other_kernels()
    warnings.simplefilter("ignore")
    args.folder.mkdir(parents=True, exist_ok=True)
    for k, stream in enumerate(random_streams(args.seed, args.count)):
        (args.folder / f"{k}.bsm").write_bytes(
            stream if isinstance(stream, bytes) else stream.encode()
        )
    for path in args.streams.glob("*.bsm"):
        if path.stat().st_size == 0:
            continue
        outcome = whole(path.read_bytes())
        if isinstance(outcome, BsmError):
            (args.folder / f"{path.stem}.txt").write_text(f"{type(outcome).__name__} {outcome}")
        else:
            store(args.folder / f"{path.stem}.npz", outcome)


if __name__ == "__main__":
    main()
