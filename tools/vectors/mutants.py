"""Clauses and constants of the core that no vector notices.

    python -m tools.vectors.mutants 60 --seed 1    change 60 places of the reference decoder, one by one; 0: all

A mutant has one number that is larger by one, or by a fiftieth, one comparison that takes equals otherwise, or one sum
that is a difference, and must treat some vector otherwise than the decoder that it came from does. The command ends
with 1 if there is one that no vector notices.
"""

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

from tools.command import parser_of
from tools.vectors.store import read_manifest

SPEC = Path(__file__).parents[2] / "spec"
MODULES = "reference_integers", "reference_decoder", "reference_paper"
MEMORY = 4 << 30
INSTEAD = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "+": "-", "-": "+"}
SAME = {
    "contexts have other numbers, no two of them the same": """
        «49» * sign_class|49 * sign_class(x, first) «+»|7 * sign_class(y, unit) «+»|12 * b «+» 3|3 * f «+» step
        «16» * s +|16 * s «+» 4|4 * f «+» w|«49» * c3(late)|49 * c3(late) «+»|7 * c3(early) «+»|12 * b «+» o
        «8» * (clamp(guess|0, 191) >> 2) «+» degree|«3» * (12|min(a, 11) «+» o)|«12» * min(a|o) «+» min(w|«14» * (6
        («6» * min(len|, 5) «+» min(degree|min(degree, 5)) «+» 2|w) «+» (s > 8)|«24» * min(a|20) «+» s|«12» * b
        hits «+» 128|hits + «128»|«8» * (0 if step == 0|(hits > 0)) «+» 2|2 * f «+» (error|16 * ff «+» fn|«256» * ff
        256 * ff «+» 16|16 * fp «+» fn|(«16» + 2 * k|«3» * state(after|1 «+» 3|state(after[fan]) «+» state
        node + unary «+» 24|unary + «24»|«4» + x, given|«3» + s if x >= 0|«49» * c3|node «+» unary
        0, «28», 56|28, «56», 84|84, «85», 112|85, «112», 140|112, «140»|else valence «-» 2
        2 * best «+» (1|clamp(value - c, -3, 3) «+» 3""",
    "equals have the same effect": """
        x «>» high|if offset «<» len(stream)|corners «>» 0|(level «+» sum
        h «>» 0:  # V 5.8|size «>» 1|rest «<» 0 else|3 «-» w if rest|ratio «<=» 1|d.bit_length() - 6
        x «<» 4|return x if x < «4»|// n if a «>=» 0|count «<=» 65536|len(flaps) «>» 1 else shape
        len(found) «>» 1 else total|if g «>» 3|if u «>» v:|elif u «>» v|len(order) «>» 8|if r «<» cut and
        nodes[(k «+» 1) % 3].vertex)|(value «+» (1 << 31)) %|s if x «>=» 0|if x «>=» 1 else 0|(1 << «18», 0))[0]""",
    "room or numbers that nothing uses": """
        [0] * «14»)|[[0] * «3»|[[0] * 3 for _ in range(«4»)]|[0.0] * «4»|range(1, «4»)
        OrderedDict() for _ in range(«4»)|«20480»|«13653»|«5851»|«6»: 13653|«4»: 20480|«14»: 5851|Model(«3», 400
        faces, most=1 << «24»|d «<» 30|d < «30»|-2880, 2879) «+» 2880|range(8, «8» + self|range(-2880, «2880»)
        (width + «11»)|limit=«1023», rate|(1 << «31»)) % |(1 << «32»)|% (1 << 32) - (1 << «31»)""",
    "a rule behind it refuses the same": """
        stored «<=» beside and|[], 0, «3»)|[], 0, «2»)|index «<» header["blocks"]
        len(value) for _, value in pairs if type(value) is list) «<=» 256|if d + (1 << h) > 1 << «22»
        if end > 1 << «22»|kf, kn, kp = clamp(lf - ff, 0, «15»)|clamp(ln - fn, 0, «15»)|clamp(lp - fp, 0, «15»)
        (self.square >> 6) + 1), -(1 << «26»), 1|-(1 << 26), 1 << «26»)|d «+» (1|if d + (1 << h) «>» 1|if end «>» 1""",
    "no position of the core is -0, no angle tells sine from cosine": """
        (positions «+» 0.0)|(rows «-» k) * unit|k «<=» rows // 2""",
    "33 has the same size, the same bits, and 36 + 8 as many; size(64) = size(65)": """
        0, «32», 0, 32|typical, drift, error, ring, late, early = 0, 32, 0, «32»|if near else «64»""",
    "sizes beyond 23 differ in the second context alone": """
        min(size_class(typical), «23»)""",
    "messages, and codes of the command line": """
        dict(zip(ERRORS, («3», 4|(3, «4», 5|4, «5», 6|5, «6», 7|6, «7», 12|7, «12»|{«16»: "ext|«17»: "ext|«18»: "ext
        «19»: "ext|version {stream[«4»]|>> «4»}, and|{fans «+» dummies}""",
    "limits that no small stream comes to (M 14)": """
        = 1 << «28»|1 << 28, 1 << «23»|fans + dummies «>» most|size < «23»|len(payload) «<=» 65536|5 * rows
        s * solution|solution =|s = 3 if|value «>» most|65536 + 16 * faces|min(«4096», self|require_limit(8 * (6""",
    "equal once in 2^24 decisions (C 1.3)": """
        self.range «<» 1 << 24""",
    "guards against division by nothing": """
        dot(tilted, tilted) «+» 2|(areas «+» 2|(lengths «+» 2|2.0**-«200»""",
    "columns are nearly 0 before the second pass and nearly 1 behind it in all meshes that were looked at (M 8.8)": """
        times < «8»|times «<» 8|times == «4»|(times < «4»|times «<» 4|0 «<» square|square «<» np.inf|times «+» 1
        square «>» 0.25|square > «0.25»|lengths[begin + j] «<» c|c[j, j] «<» np.inf""",
}
"""Changes that make the same decoder, or one that no small stream tells from it, by marks in their lines, and why."""


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
    kept = [part for parts in SAME.values() for part in re.split(r"[|\n]", parts) if part.strip()]
    for node in ast.walk(tree):
        for number, begin, end in places_of(node, lines):
            line = lines[number - 1]
            marked = f"{line[:begin]}«{line[begin:end]}»{line[end:]}"
            if not any(part.strip() in (marked if "«" in part else line) for part in kept):
                yield Spot(module, number, begin, end, line, function.get(node))


def places_of(node: ast.AST, lines: list[str]) -> Iterator[tuple[int, int, int]]:
    """Where a node has what can be changed: line, and from where to where in it."""
    if (
        isinstance(node, ast.Constant)
        and type(node.value) in (int, float)
        and node.value not in (0, 1, 2)
    ):
        yield node.lineno, node.col_offset, node.end_col_offset or 0
    sides: list[ast.expr] = []
    if isinstance(node, ast.Compare):
        sides = [node.left, *node.comparators]
    elif isinstance(node, ast.BinOp):
        sides = [node.left, node.right]
    for left, right in itertools.pairwise(sides):
        line, begin = lines[right.lineno - 1], left.end_col_offset or 0
        between = left.end_lineno == right.lineno and line[begin : right.col_offset]
        if between and (found := re.fullmatch(r"[) ]*( [<>]=? | [+-] )[( ]*", between)):
            begin += found.start(1) + 1
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
    return hashlib.sha256(
        positions.tobytes() + faces.tobytes() + repr(skipped).encode()
    ).hexdigest()


@dataclass(frozen=True)
class Known:
    """A stream, its result, and the functions that are called for it."""

    stream: bytes
    right: str
    called: frozenset[tuple[str, int]]
    seconds: float


def known(decoder: Any, stream: bytes) -> Known:
    """What the decoder does with a stream."""
    called: set[tuple[str, int]] = set()
    sys.setprofile(
        lambda frame, *_: called.add((frame.f_code.co_filename, frame.f_code.co_firstlineno))
    )
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
                # One that goes on and on is ended.
                signal.setitimer(signal.ITIMER_PROF, 1 + 5 * vector.seconds)
                alike = outcome(decoder, vector.stream) == vector.right
    except BaseException:  # a mutant may fail in any way
        alike = False
    os._exit(0 if alike else 1)


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("count", type=int, help="how many places, chosen by chance; 0: all")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    sys.path.insert(0, str(SPEC))
    decoder = reference()
    streams = [known(decoder, vector.stream.read_bytes()) for vector in read_manifest()]
    streams.sort(key=lambda vector: vector.seconds)
    spots = [spot for module in MODULES for spot in spots_of(module)]
    chosen = random.Random(args.seed).sample(spots, args.count or len(spots))
    missed = 0
    for spot in chosen:
        if not is_noticed(spot, streams):
            missed += 1
            print(spot, flush=True)
    print(
        f"{missed} of {len(chosen)} changed places are noticed by no vector, of {len(spots)} that there are"
    )
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
