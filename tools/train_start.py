"""Learn what models of congruent grids start from (`spec/start.bin`, V 17.10) from the grids of other meshes.

    python -m tools.train_start MESH... [--output spec/start.bin] [--rounds 9]

Meshes are encoded by default; streams (`*.bsm`) are taken as they are, and blocks or quick grids left out. In each
round, every grid is coded from the present start, which then moves twice as far as to the mean of the states at the
end. So the start comes to be one from which few steps lead to any of these meshes. The printed bytes are those of all
payloads, before the numbers are rounded. Needs a C compiler.
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from bsm.files.mesh import read_mesh
from tools.amalgamate import ROOT, amalgamated, interface

Numbers = npt.NDArray[np.float64]
NODES, PAIRS, ROW, INPUTS, PREDICTIONS, SUMS, SIZES, TERMS, TWINS = 66, 18, 16, 12, 7, 48, 12, 7, 282
WHOLE = 8, 5  # rows of weights of whole vertices, and inputs
UNIT = 4096
COUNT, MOST_SEEN, PRIOR, STRIDE = 16, 60, 2.0, 2.0


@dataclass(frozen=True, eq=False)
class Start:
    """Weights of decisions, of learners and of whole vertices, 65536 for 1, and hit rates of rows of twins."""

    weights: Numbers
    learners: Numbers
    hits: Numbers
    whole: Numbers

    @property
    def numbers(self) -> tuple[Numbers, ...]:
        """The bytes of the file, but for their signs."""
        hits = np.clip(np.floor(self.hits * 16.0), 0.0, 15.0)
        weights, learners, whole = (np.rint(part / UNIT) for part in (self.weights, self.learners, self.whole))
        return weights[:, :INPUTS], learners, hits, whole

    def moved(self, ends: Sequence[Start], seen: Numbers) -> Start:
        """Return a start nearer to the ends, by what they have learnt; `seen` tells how often each hit rate was."""
        weights = _toward(self.weights, np.array([end.weights for end in ends]))
        learners = _toward(self.learners, np.array([end.learners for end in ends]))
        whole = _toward(self.whole, np.array([end.whole for end in ends]))
        hits = (PRIOR * self.hits + sum(seen * np.array([end.hits for end in ends]))) / (PRIOR + seen.sum(axis=0))
        return Start(weights, learners, hits, whole)


def _toward(start: Numbers, ends: Numbers) -> Numbers:
    learnt = (ends != np.rint(start)).any(axis=2, keepdims=True)
    moved: Numbers = start + STRIDE * (learnt * (ends - start)).sum(axis=0) / (PRIOR + learnt.sum(axis=0))
    return moved


def unlearnt() -> Start:
    """Return what models start from that have learnt nothing (V 4.3, V 9.1, V 9.3)."""
    weights, learners = np.zeros((NODES + PAIRS, ROW)), np.zeros((SUMS + SIZES, TERMS))
    weights[:NODES, :PREDICTIONS], weights[:NODES, PREDICTIONS + 1 : INPUTS] = 10532, 8000
    learners[:, 0], learners[SUMS:, 1] = 49152, 8192
    return Start(weights, learners, np.full(TWINS, 0.5), np.full(WHOLE, 20480.0))


def ends_of(program: Path, start: Start, streams: Iterable[Path]) -> tuple[list[Start], Numbers, int]:
    """Return the states at the ends of all grids, how often each hit rate was learnt, and the bytes of all payloads."""
    slots = (np.rint(start.hits * 2.0**22).astype(np.uint32) << 10) + COUNT
    weights, learners, whole = (np.rint(part).astype(np.int32) for part in (start.weights, start.learners, start.whole))
    parts = weights, learners, slots, whole
    given = program.with_name("start")
    given.write_bytes(b"".join(part.tobytes() for part in parts))
    printed = subprocess.run([program, given, *streams], capture_output=True, check=True).stdout
    rows = np.frombuffer(printed, np.int32).reshape(-1, sum(part.size for part in parts) + 1)
    *states, sizes = np.split(rows, np.cumsum([part.size for part in parts]), axis=1)
    words = states[2].view(np.uint32)
    parts_of_ends = states[0], states[1], (words >> 10) / 2.0**22, states[3]
    shapes = start.weights.shape, start.learners.shape, start.hits.shape, start.whole.shape
    ends = [Start(*map(np.reshape, each, shapes)) for each in zip(*parts_of_ends, strict=True)]
    return ends, np.minimum(words & 1023, MOST_SEEN).astype(float) - COUNT, int(sizes.sum())


def built(folder: Path) -> Path:
    """Compile the program that codes grids from a start."""
    (folder / "bsm.c").write_text(amalgamated(encodes=True))
    (folder / "bsmdec.h").write_text(interface())
    (folder / "bsmenc.h").write_text(interface(encodes=True))
    program, source = folder / "train_start", ROOT / "tools/train_start.c"
    flags = "-std=gnu11", "-O2", "-w", "-ffp-contract=off", "-DKERNEL_ONE_TARGET", "-DBSMDEC_WRITES", "-I", folder
    subprocess.run(["cc", *flags, source, "-o", program, "-lm", "-lpthread"], check=True)
    return program


def main(arguments: list[str] | None = None) -> int:
    """Train and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path, nargs="+", help="meshes or streams")
    parser.add_argument("--output", type=Path, default=ROOT / "spec/start.bin", help="file (spec/start.bin)")
    parser.add_argument("--rounds", type=int, default=9, help="times that all grids are coded (9)")
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program, start, streams = built(folder), unlearnt(), []
        for i, path in enumerate(chosen.meshes):
            if path.suffix != ".bsm":
                stream = folder / f"{i}.bsm"
                stream.write_bytes(encode(read_mesh(path).mesh, EncodeOptions()))
            streams.append(stream if path.suffix != ".bsm" else path)
        for turn in range(chosen.rounds):
            ends, seen, size = ends_of(program, start, streams)
            print(f"round {turn + 1}: {len(ends)} grids, {size} bytes", flush=True)
            start = start.moved(ends, seen)
    numbers = [part.astype(np.int8).tobytes() for part in start.numbers]
    chosen.output.write_bytes(b"".join(numbers))
    print(f"{chosen.output}: {chosen.output.stat().st_size} bytes")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
