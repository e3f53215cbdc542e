"""Clauses and constants of the core that no vector notices.

    python -m tools.vectors.mutants 60 --seed 1    change so many places of the reference decoder, one by one; 0: all

A mutant has one number that is larger by one, or by a fiftieth, one comparison that takes equals otherwise, or one sum
that is a difference, and must treat some vector otherwise than the decoder that it came from does. The command ends
with 1 if there is one that no vector notices.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import itertools
import os
import random
import re
import resource
import signal
import sys
import time
import types
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tools.vectors.store import read_manifest

SPEC = Path(__file__).parents[2] / "spec"
MODULES = "reference_integers", "reference_decoder"
MEMORY = 4 << 30
INSTEAD = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "+": "-", "-": "+"}
SAME = {
    "return x if x < 4 else min(2 * bits": {4: "size(4) is 4 either way (V 10.2)"},
    "for level in self.x[u]), len(near)) if near else 64": {64: "size(64) = size(65), and nothing else asks (V 11.3)"},
    "mean, typical, drift, error, ring, late, early": {32: "33 has the same size, the same bits, and 36 + 8 as many"},
    "if d + (1 << h) > 1 << 22": {22: "a level beyond is refused as out of range (V 11.1)"},
    "if end > 1 << 22": {22: "a value beyond is refused as outside the grid (V 7.2)"},
    "self.kind_weights.setdefault((e.set, kind), [0] * 14)": {14: "room that nothing uses"},
    "self.ring = [[0] * 3": {3: "room that nothing uses"},
    "self.count, self.sum = [0] * vertices": {3: "room that nothing uses"},
    "mesh, x, shape = self.mesh, self.x": {4: "room that nothing uses"},
}
"""Numbers that may be larger and make the same decoder, by their lines, and why."""


@dataclass(frozen=True)
class Spot:
    """A number, a comparison or a sum in the source of a module."""

    module: str
    line: int
    begin: int
    end: int
    text: str  # the whole line
    function: tuple[str, int] | None  # which has it, by its module and first line

    @property
    def changed(self) -> str:
        """The number, a little larger; the operator, another."""
        found = self.text[self.begin : self.end]
        if found in INSTEAD:
            return INSTEAD[found]
        value = ast.literal_eval(found)
        return repr(value + 1 if isinstance(value, int) else value * 1.02 or 0.02)

    def __str__(self) -> str:
        return f"{self.module}:{self.line} {self.text[self.begin : self.end]} -> {self.changed} | {self.text.strip()}"


def spots_of(module: str) -> Iterator[Spot]:
    """All but those that are the `SAME`, and 0, 1 and 2, which are places and factors more often than law."""
    source = (SPEC / f"{module}.py").read_text()
    lines = source.splitlines()
    tree = ast.parse(source)
    function = {
        inner: (module, outer.lineno)
        for outer in ast.walk(tree)
        if isinstance(outer, ast.FunctionDef)
        for statement in outer.body
        for inner in ast.walk(statement)
    }
    for node in ast.walk(tree):
        for number, begin, end in places_of(node, lines):
            line = lines[number - 1]
            if not any(part in line and line[begin:end] in map(str, found) for part, found in SAME.items()):
                yield Spot(module, number, begin, end, line, function.get(node))


def places_of(node: ast.AST, lines: list[str]) -> Iterator[tuple[int, int, int]]:
    """Where a node has what can be changed: line, and from where to where in it."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float) and node.value not in (0, 1, 2):
        yield node.lineno, node.col_offset, node.end_col_offset or 0
    sides: list[ast.expr] = []
    if isinstance(node, ast.Compare):
        sides = [node.left, *node.comparators]
    elif isinstance(node, ast.BinOp):
        sides = [node.left, node.right]
    for left, right in itertools.pairwise(sides):
        between = left.end_lineno == right.lineno and lines[right.lineno - 1][left.end_col_offset : right.col_offset]
        if between and (found := re.fullmatch(r"[) ]*( [<>]=? | [+-] )[( ]*", between)):
            begin = left.end_col_offset + found.start(1) + 1
            yield right.lineno, begin, begin + len(found[1]) - 2


def reference(spot: Spot | None = None) -> Any:
    """The reference decoder, with one number changed."""
    for name in MODULES:
        lines = (SPEC / f"{name}.py").read_text().splitlines()
        if spot and spot.module == name:
            lines[spot.line - 1] = spot.text[: spot.begin] + spot.changed + spot.text[spot.end :]
        module = sys.modules[name] = types.ModuleType(name)
        module.__file__ = str(SPEC / f"{name}.py")
        exec(compile("\n".join(lines), name, "exec"), module.__dict__)
    return module


def outcome(decoder: Any, stream: bytes) -> str:
    """What a decoder makes of a stream."""
    try:
        positions, faces, skipped = decoder.decode(stream)
    except tuple(decoder.EXIT_CODES) as error:
        return type(error).__name__
    return hashlib.sha256(positions.tobytes() + faces.tobytes() + repr(skipped).encode()).hexdigest()


@dataclass(frozen=True)
class Known:
    """A stream, what comes of it, and the functions that are called for it."""

    stream: bytes
    right: str
    called: frozenset[tuple[str, int]]
    seconds: float


def known(decoder: Any, stream: bytes) -> Known:
    """What the decoder does with a stream."""
    called: set[tuple[str, int]] = set()
    sys.setprofile(lambda frame, *_: called.add((frame.f_code.co_filename, frame.f_code.co_firstlineno)))
    outcome(decoder, stream)
    sys.setprofile(None)
    begin = time.process_time()
    right = outcome(decoder, stream)
    return Known(stream, right, frozenset(called), time.process_time() - begin)


def is_noticed(spot: Spot, vectors: list[Known]) -> bool:
    """Whether a mutant, in a process of its own, does anything else."""
    child = os.fork()
    if child:
        return os.waitpid(child, 0)[1] != 0
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    try:
        decoder, alike = reference(spot), True
        for vector in vectors:
            if alike and (spot.function is None or spot.function in vector.called):
                signal.setitimer(signal.ITIMER_PROF, 1 + 5 * vector.seconds)  # one that goes on and on is ended
                alike = outcome(decoder, vector.stream) == vector.right
    except BaseException:  # a mutant may fail in any way
        alike = False
    os._exit(0 if alike else 1)


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m tools.vectors.mutants", description=__doc__)
    parser.add_argument("count", type=int, help="how many places, chosen by chance; 0: all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--lines", nargs="*", help="only places in these lines, as MODULE:LINE")
    args = parser.parse_args()
    sys.path.insert(0, str(SPEC))
    decoder = reference()
    streams = [known(decoder, vector.stream.read_bytes()) for vector in read_manifest()]
    streams.sort(key=lambda vector: vector.seconds)
    spots = [spot for module in MODULES for spot in spots_of(module)]
    if args.lines:
        spots = [spot for spot in spots if f"{spot.module}:{spot.line}" in args.lines]
    chosen = random.Random(args.seed).sample(spots, args.count or len(spots))
    missed = 0
    for spot in chosen:
        if not is_noticed(spot, streams):
            missed += 1
            print(spot, flush=True)
    print(f"{missed} of {len(chosen)} changed places are noticed by no vector, of {len(spots)} that there are")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
