"""`python -m tools.attack search [KIND...] --rounds N`: files that make readers slow, found step by step.

A file is a head, a unit that is repeated, and a tail, at first of a sound one, cut anywhere. Those that take most time
or memory for each byte are changed again, by what the reader's own source speaks of: the first round is of the same
files everywhere. Whatever takes more than it may, or lets out something else than an error of ours, is printed; then
the slowest, and all files of `readers` that are large in one place, are read once more at four times the size, which
must not take longer by more than `MOST_GROWTH`.
"""

from __future__ import annotations

import argparse
import ast
import base64
import json
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from random import Random

import bsm
from bsm.bitstream.limits import Limits
from tools.attack.readers import DATA_URI, HUGE_WORDS, Sample, _binary_of, _grown, _json_of, reading, samples, warm_up
from tools.attack.sweep import mutate
from tools.attack.taken import Taken, bounds, taken_by_each

SMALL, LARGE = 1 << 12, 1 << 16
"""Bytes of files that are searched, and of the slowest of them when they are to grow."""
AT_A_TIME, KEPT = 48, 24
MOST_GROWTH, LEAST_SECONDS = 4.5, 0.1
"""How much longer four times the bytes may take, and how long that is before it is asked."""
KINDS = (
    "npz",
    "vtp",
    "obj",
    "off",
    "ply of text",
    "ply",
    "stl of text",
    "stl",
    "npy",
    "pc2",
    "mdd",
    "gltf",
    "moving glb",
)


@dataclass(frozen=True)
class Repeated:
    """A file that can be made of any size; `#` in its head is how often the unit is there."""

    like: Sample
    head: bytes
    unit: bytes
    tail: bytes

    def of(self, size: int) -> Sample:
        """The file of about so many bytes."""
        count = max(1, (size - len(self.head) - len(self.tail)) // max(1, len(self.unit)))
        return replace(self.like, data=self.head.replace(b"#", b"%d" % count) + self.unit * count + self.tail)


@cache
def words() -> tuple[bytes, ...]:
    """All that the sources of readers speak of: their strings and bytes, but for sentences."""
    found: set[bytes] = set(HUGE_WORDS)
    for folder in ("files", "gltf"):
        for path in Path(bsm.__file__).parent.joinpath(folder).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text())):
                value = node.value if isinstance(node, ast.Constant) else b""
                word = value.encode(errors="replace") if isinstance(value, str) else value
                if isinstance(word, bytes) and 0 < len(word) < 40:
                    found.update((word, b"<" + word + b" ", b'"' + word + b'":'))
    return tuple(sorted(found))


def searched(kind: str, rounds: int, random: Random) -> Iterator[tuple[Repeated, Taken]]:
    """Files of a kind, each found from those before it that took most, and what reading it takes."""
    like = samples()[kind if kind != "gltf" else "glb"]
    if kind == "gltf":
        tree = _json_of(like.data)
        tree["buffers"][0]["uri"] = DATA_URI + base64.b64encode(_binary_of(like.data)).decode()
        like = Sample("gltf", json.dumps(tree).encode())
    best: list[tuple[float, Repeated]] = []
    for turn in range(rounds):
        wanted = "seconds" if turn % 2 else "memory"
        files = [
            _another(best[random.randrange(len(best))][1] if best else None, like, random) for _ in range(AT_A_TIME)
        ]
        for file, taken in zip(files, read([partial(file.of, SMALL) for file in files]), strict=True):
            yield file, taken
            best.append((getattr(taken, wanted) / (taken.size + 256), file))
        best = sorted(best, key=lambda one: -one[0])[:KEPT]


def _another(file: Repeated | None, like: Sample, random: Random) -> Repeated:
    """A file like another one, or cut anew from the sound one."""
    if file is None or random.random() < 0.2:
        first, last = sorted(random.randrange(len(like.data) + 1) for _ in range(2))
        last = min(last, first + random.choice((1, 8, 64, 1024)))
        return Repeated(like, like.data[:first], like.data[first:last], like.data[last:])
    part = random.choice(("head", "unit", "unit", "tail"))
    data, choice = getattr(file, part), random.randrange(5)
    place = random.randrange(len(data) + 1)
    if choice == 0:
        data = mutate(random, data)
    elif choice == 1:
        data = b"" if random.random() < 0.3 else data[:place]
    else:
        word = b"#" if choice == 2 and part == "head" else random.choice(words())
        data = data[:place] + word + data[place + random.choice((0, 0, 1, len(word))) :]
    return replace(file, **{part: data[:SMALL]})


def read(makes: Sequence[Callable[[], Sample]]) -> Iterator[Taken]:
    """What reading some files takes."""
    with tempfile.TemporaryDirectory() as folder:
        yield from taken_by_each([partial(reading, make, Path(folder), Limits()) for make in makes], seconds=30)


def growth(make: Callable[[int], Sample], most: float = MOST_GROWTH, times: int = 4) -> str | None:
    """How much longer a file takes at four times its size, if that is too much every time."""
    least = [float("inf")] * 2
    for _ in range(times):
        for number, taken in enumerate(read([partial(make, LARGE), partial(make, 4 * LARGE)])):
            least[number] = min(least[number], float("inf") if taken.escaped else taken.seconds)
        if least[1] < max(LEAST_SECONDS, most * least[0]):
            return None
    return (
        f"{least[0]:.3f} s at {LARGE} bytes, {least[1]:.3f} s at {4 * LARGE}: {least[1] / least[0]:.1f} times as long"
    )


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=f"of {', '.join(KINDS)}; all, if none is named")
    parser.add_argument(
        "--rounds", type=int, default=60, help=f"for each kind, of {AT_A_TIME} files (default: %(default)s)"
    )
    parser.add_argument("--most", type=float, default=MOST_GROWTH, help="growth at four times (default: %(default)s)")
    parser.add_argument("--seed", default="0", help="default: %(default)s")
    args = parser.parse_args()
    warm_up()
    findings = 0
    for kind in args.kinds or KINDS:
        seen: list[tuple[float, int, Repeated]] = []
        refused = 0
        for file, taken in searched(kind, args.rounds, Random(f"{args.seed}/{kind}")):
            seen.append((taken.seconds / (taken.size + 256), len(seen), file))
            refused += taken.outcome != "read"
            if problem := taken.problem(*bounds("default", taken)):
                findings += 1
                print(
                    f"{kind}: {problem}: {file.unit!r} behind {file.head[-300:]!r} before {file.tail[:300]!r}",
                    flush=True,
                )
        slowest = sorted(seen, key=lambda one: one[:2])[-3:]
        for *_, file in slowest:
            if problem := growth(file.of, args.most):
                findings += 1
                print(
                    f"{kind}: {problem}: {file.unit!r} behind {file.head[-300:]!r} before {file.tail[:300]!r}",
                    flush=True,
                )
        worst = 1e6 * slowest[-1][0] if slowest else 0.0
        print(f"{kind:12} {len(seen):7} files, {refused} refused, {worst:.1f} us a byte at most", flush=True)
    for name in _grown(1) if not args.kinds else ():
        if problem := growth(lambda size, name=name: _grown(size)[name](), args.most):  # type: ignore[misc]
            findings += 1
            print(f"{name}: {problem}", flush=True)
    print(f"{findings} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
