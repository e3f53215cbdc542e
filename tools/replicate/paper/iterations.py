"""What orthogonal iterations bring: starts, first blocks, powers, convergence, orthonormalization, and their cost."""

import math
import time
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from tools.laplacians import dense_laplacian
from tools.replicate.paper.dictionaries import BITS, SHIFT, Cut, Floats, iterated
from tools.replicate.paper.models import Study, fastest
from tools.replicate.paper.published import Line, claim, printed
from tools.replicate.rates import Row

SHARES, POWERS_TRIED = (0.05, 0.10, 0.15, 0.20, 0.25), (1, 2, 3)
STARTS = {
    "previous": "the block before",
    "random": "any block, in random order",
    "cold": "cosines, no warm start",
    "file": "the block before, rows as in the file",
}
"""Where the iteration of a block begins."""


def span(values: list[float]) -> str:
    """The least and the largest."""
    return f"{min(values):.2f} to {max(values):.2f}"


def warm_start(study: Study) -> Iterator[Row]:
    """dB above the exact basis of one iteration a block, by where it starts, by z and by c."""
    model = study.model("bunny")
    cut = Cut.of(model, 70, max(SHARES))
    in_file = Cut.of(model, 70, max(SHARES), file_order=True)
    shuffled = [0, *(1 + np.random.default_rng(0).permutation(len(cut.blocks) - 1)).tolist()]
    found: dict[tuple[str, int], list[float]] = {}
    shares = SHARES[1::2] if study.quick else SHARES
    for share in shares:
        width = round(share * cut.size)
        level = cut.decibels([basis[:, :width] for basis in cut.exact])
        for power in POWERS_TRIED:
            made = {
                "previous": cut.decibels(cut.chain(width, power)[0]),
                "random": cut.decibels(cut.chain(width, power, order=shuffled)[0]),
                "cold": cut.decibels(cut.cold(width, power)),
                "file": in_file.decibels(in_file.chain(width, power)[0]),
            }
            for start, error in made.items():
                found.setdefault((start, power), []).append(error - level)
    rows: list[Line] = [
        (f"z = {power}, from {STARTS[start]}", tuple(found[start, power]), ())
        for power in POWERS_TRIED
        for start in STARTS
    ]

    def beside(start: str) -> dict[int, Floats]:
        return {z: np.subtract(found[start, z], found["previous", z]) for z in POWERS_TRIED}

    gain, other, rows_of_file = (beside(start) for start in ("cold", "random", "file"))
    numbers = {f"{start} {power}": span(own) for (start, power), own in found.items()}
    for z in POWERS_TRIED:
        numbers |= {f"gain {z}": f"{gain[z].max():.2f}", f"loss {z}": f"{-gain[z].min():.2f}"}
        numbers[f"rows {z}"] = span(rows_of_file[z].tolist())
    moved = np.concatenate(list(other.values()))
    numbers["random"] = f"{np.abs(moved).max():.2f}"
    better, cases = sum(int((g > 0.05).sum()) for g in gain.values()), len(gain) * len(shares)
    numbers |= {"better": str(better), "cases": str(cases)}
    yield printed(
        "The paper, 4: gain of a warm start",
        [f"c = {100 * share:g} % of n_d" for share in shares],
        rows,
        f"{model.name} in {len(cut.blocks)} blocks: dB of NMSVE above the exact basis, one iteration a block.",
        claim(
            "The solution of the previous adjacent block is the best start",
            better > cases / 2 and moved.min() > 0.0,
            f"it is over 0.05 dB better than cosines in {better} of {cases} cases, and a random order changes it by "
            f"{moved.min():.2f} to {moved.max():.2f} dB.",
            model,
            value=100 * better / cases,
            unit="% of the cases over 0.05 dB better than cosines",
        ),
        numbers=numbers,
    )


def first_block(study: Study) -> Iterator[Row]:
    """dB above the exact basis by which block comes first."""
    model = study.model("bunny")
    cut = Cut.of(model, 70, 0.10)
    count, level = len(cut.blocks), cut.decibels(cut.exact)
    starts = sorted({(count * step) // 4 for step in range(4)} | {count - 1})
    rows: list[Line] = []
    for power in (1, 2):
        orders = [[(start + step) % count for step in range(count)] for start in starts]
        above = [
            cut.decibels(cut.chain(cut.width, power, order=order)[0]) - level for order in orders
        ]
        rows.append((f"z = {power}", tuple(above), ()))
    apart = max(max(own) - min(own) for _, own, _ in rows)
    yield printed(
        "The paper, 4: choice of the first block",
        [f"block {start} first" for start in starts],
        rows,
        f"{model.name} in {count} blocks, c = 10 %: dB of NMSVE above the exact basis.",
        claim(
            "The first block does not matter",
            apart < 0.05,
            f"the choice changes it by {apart:.3f} dB at most.",
            model,
            value=apart,
            unit="dB apart at most",
        ),
        numbers={"apart": f"{apart:.3f}"},
    )


def subspace_error(exact: Floats, basis: Floats) -> float:
    """The tangent of the largest angle between two subspaces."""
    inside = exact.T @ basis
    outside = basis - exact @ inside
    return float(np.linalg.norm(outside @ np.linalg.inv(inside), 2))


LATE = (60, 75)
"""Iterations between which the rate is taken, when faster parts are gone."""


def convergence(study: Study) -> Iterator[Row]:
    """How much the angle to the exact subspace shrinks in an iteration, and what the eigenvalues say."""
    model = study.model("bunny")
    cut = Cut.of(model, 70, 0.15)
    chosen, found = (
        cut.blocks[:: 10 if study.quick else 4],
        {power: list[tuple[float, float]]() for power in POWERS_TRIED},
    )
    for block in chosen:
        values, vectors = np.linalg.eigh(dense_laplacian(block))
        low, high = round(0.08 * block.size), round(0.12 * block.size)
        # Before the widest gap.
        width = low + int(np.argmax(np.diff(values[low : high + 1]) / values[low:high])) + 1
        weights = 1.0 / (values + SHIFT)
        for power in POWERS_TRIED:
            basis = np.linalg.qr(np.random.default_rng(width).normal(size=(block.size, width)))[0]
            errors: list[float] = []
            for _ in range(LATE[1]):
                basis = np.linalg.qr(vectors @ (weights[:, None] ** power * (vectors.T @ basis)))[0]
                errors.append(
                    subspace_error(vectors[:, :width], basis) if len(errors) + 1 in LATE else 0.0
                )
            rate = (errors[-1] / errors[LATE[0] - 1]) ** (1.0 / (LATE[1] - LATE[0]))
            found[power].append(
                (float(rate), float((weights[width] / weights[width - 1]) ** power))
            )
    rows: list[Line] = []
    for power, pairs in found.items():
        seen, said = np.median(np.array(pairs), axis=0)
        rows.append(
            (f"z = {power}", (float(seen), float(said), max(abs(a - b) for a, b in pairs)), ())
        )
    worst = max(own[2] for _, own, _ in rows)
    yield printed(
        "The paper, 4: rate of convergence",
        ("measured", "(lambda_c+1 / lambda_c)^z", "farthest apart"),
        rows,
        f"{len(chosen)} blocks of {model.name}, c by the widest gap around 10 %: factor of the tangent of the largest "
        "angle to the exact subspace in one iteration, from random columns; medians.",
        claim(
            "OI converges like (lambda_c+1 / lambda_c)^z",
            worst < 0.03,
            f"within {worst:.3f} on every block.",
            model,
            value=worst,
            unit="off at most",
        ),
        numbers={"worst": f"{worst:.3f}"},
    )


def cholesky_columns(values: Floats) -> Floats:
    """Q with a positive diagonal of R, by the Cholesky factor of the Gram matrix."""
    lower = np.linalg.cholesky(values.T @ values)
    return np.ascontiguousarray(np.linalg.solve(lower, values.T).T)


def gram_schmidt(values: Floats) -> Floats:
    """Q by modified Gram-Schmidt."""
    columns = values.copy()
    for at in range(columns.shape[1]):
        columns[:, at] /= np.linalg.norm(columns[:, at])
        rest = columns[:, at + 1 :]
        rest -= np.outer(columns[:, at], columns[:, at] @ rest)
    return columns


def householder(values: Floats) -> Floats:
    """Q by Householder reflections (LAPACK), its columns turned so that R has a positive diagonal."""
    columns, upper = np.linalg.qr(values)
    return np.asarray(columns * np.where(np.diag(upper) < 0.0, -1.0, 1.0))


ONORMS: dict[str, Callable[[Floats], Floats]] = {
    "Householder (LAPACK)": householder,
    "modified Gram-Schmidt": gram_schmidt,
    "Cholesky": cholesky_columns,
}


def orthonormalization(study: Study) -> Iterator[Row]:
    """Three ways to make R^2 U orthonormal in double precision, and the kernel of the codec."""
    model = study.model("bunny")
    cut = Cut.of(model, 70, 0.10)
    pairs = list(zip(cut.blocks, cut.blocks[1:], strict=False))[:: 10 if study.quick else 4]
    found: dict[str, list[tuple[float, float, float]]] = {
        name: [] for name in (*ONORMS, "the codec's kernel")
    }
    for before, block in pairs:
        start = cut.exact[cut.blocks.index(before)]
        if len(start) != block.size:
            continue
        solved = np.linalg.inv(dense_laplacian(block) + SHIFT * np.eye(block.size))
        values, best = solved @ (solved @ start), householder(solved @ (solved @ start))
        works: dict[str, Callable[[], Floats]] = {
            name: partial(onorm, values) for name, onorm in ONORMS.items()
        }
        works["the codec's kernel"] = partial(iterated, block, start, 2)
        for name, work in works.items():
            begin = time.thread_time()
            columns = work()
            seconds = time.thread_time() - begin
            off = np.abs(columns.T @ columns - np.eye(columns.shape[1])).max()
            found[name].append(
                (
                    1e3 * seconds,
                    float(off),
                    float(np.linalg.norm(columns - best @ (best.T @ columns), 2)),
                )
            )
    rows: list[Line] = [
        (name, tuple(np.median(np.array(own), axis=0).tolist()), ()) for name, own in found.items()
    ]
    yield printed(
        "The paper, 4: orthonormalization",
        ("ms a block", "U^T U - I at most", "sine to Householder's subspace"),
        rows,
        f"{len(pairs)} blocks of {model.name}, R^2 from the block before, c = 10 %; medians. Three in double precision "
        "by numpy; the kernel in single precision, its time with factorization and solutions.",
    )


TURNS = 4
"""Rounds for each repetition: all ways are timed in turns, so that a busy moment does not fall on one of them."""


def iterations_or_powers(study: Study) -> Iterator[Row]:
    """One iteration of R^z beside z iterations of R."""
    model = study.model("bunny")
    ways, rows, numbers = ((1, 1), (2, 1), (1, 2), (3, 1), (1, 3)), list[Line](), dict[str, str]()
    cut = Cut.of(model, 70, 0.20)
    ratios: dict[int, list[float]] = {2: [], 3: []}
    apart: dict[int, list[float]] = {2: [], 3: []}
    for share in (0.10, 0.20):
        width = round(share * cut.size)
        level = cut.decibels([basis[:, :width] for basis in cut.exact])
        runs = [[cut.chain(width, *way) for way in ways] for _ in range(TURNS * study.repeats)]
        seconds = {way: min(run[k][1] for run in runs) for k, way in enumerate(ways)}
        above = {
            way: [cut.decibels(bases, bits=bits) - level for bits in (0, BITS)]
            for way, (bases, _) in zip(ways, runs[0], strict=True)
        }
        for power, iterations in ways:
            label = f"c = {100 * share:g} %, R^{power}, t = {iterations}"
            rows.append((label, (*above[power, iterations], seconds[power, iterations]), ()))
            numbers[f"{power} {iterations} {100 * share:g}"] = f"{above[power, iterations][0]:.3f}"
        for z in ratios:
            ratios[z].append(seconds[z, 1] / seconds[1, z])
            apart[z].append(above[z, 1][0] - above[1, z][0])
    numbers |= {f"time {z}": span(own) for z, own in ratios.items()}
    yield printed(
        "The paper, 8.1: one iteration of R^z, or z iterations of R",
        ("dB above exact", "the same with 12 bits", "s, all blocks"),
        rows,
        f"{model.name} in {len(cut.blocks)} blocks, from the block before; the least of {TURNS * study.repeats} times, "
        "in turns. Spans are equal but for rounding.",
        claim(
            "One iteration of R^2 has a lower error than two of R",
            max(apart[2]) < -0.01,
            f"R^2 is at most {max(map(abs, apart[2])):.3f} dB from R twice, R^3 at most {max(map(abs, apart[3])):.3f} "
            "dB from R three times.",
            model,
            value=max(apart[2]),
            unit="dB more than two of R",
        ),
        claim(
            "One iteration of R^z is faster than z of R",
            max(*ratios[2], *ratios[3]) < 0.95,
            f"R^2 takes {span(ratios[2])} of the time of R twice, R^3 {span(ratios[3])} of that of R three times.",
            model,
            value=max(*ratios[2], *ratios[3]),
            unit="of its time at most",
        ),
        numbers=numbers,
    )


TIMED, WIDTHS, SHIFTS = (140, 70, 35), (0.05, 0.10, 0.20, 0.40), (1e-4, SHIFT, 0.125, 1.0, 10.0)
"""Segments whose blocks are timed, c over n_d, and delta."""


def complexity(study: Study) -> Iterator[Row]:
    """How the seconds of a block grow with its vertices and with c, for OI and for SVD."""
    model = study.model("bunny")
    cuts = [Cut.of(model, count, max(WIDTHS)) for count in TIMED]
    narrow, middle = round(WIDTHS[1] * cuts[0].size), cuts[1]
    cases = [(cut, narrow) for cut in cuts] + [
        (middle, round(share * middle.size)) for share in WIDTHS
    ]
    ours, theirs = list[float](), list[float]()
    for cut, width in cases:
        laplacian = dense_laplacian(cut.blocks[len(cut.blocks) // 2])
        # The first block of a chain is exact, and not timed.
        ours.append(
            min(cut.chain(width, 1)[1] for _ in range(study.repeats)) / (len(cut.blocks) - 1)
        )
        theirs.append(fastest(partial(np.linalg.svd, laplacian), study.repeats))

    def powers(sizes: list[int], seconds: list[float]) -> list[float]:
        # Of a small mesh, the blocks of two cuts may have one size.
        steps = np.diff(np.log(sorted(dict(zip(sizes, seconds, strict=True)).items())), axis=0)
        return (steps[:, 1] / steps[:, 0]).tolist() or [math.nan]

    count, sizes = len(cuts), [cut.size for cut in cuts]
    by_size, exact = powers(sizes, ours[:count]), powers(sizes, theirs[:count])
    by_width = powers([width for _, width in cases[count:]], ours[count:])
    yield printed(
        "The paper, 8.1: seconds by the size of blocks and by c",
        ("OI, R, ms a block", "SVD, ms a block"),
        [
            (f"n_d = {cut.size}, c = {width}", (1e3 * own, 1e3 * other), ())
            for (cut, width), own, other in zip(cases, ours, theirs, strict=True)
        ],
        f"{model.name}, one iteration of R from the block before; seconds of one thread with order, factors and Onorm. "
        "From row to row, OI's time grows with n_d to the power of "
        f"{span(by_size)} and with c to that of {span(by_width)}. SVD's grows with n_d to the power of {span(exact)}.",
        claim(
            "OI takes O(n_d c^2), SVD O(n_d^3)",
            max(by_size) < 1.5 and max(by_width) < 2.2 and max(exact) > 2.2,
            "the powers are those above.",
            model,
            value=max(by_size),
            unit="the power of n_d at most, OI",
        ),
        numbers={"size": span(by_size), "width": span(by_width), "svd": span(exact)},
    )


def shifts(study: Study) -> Iterator[Row]:
    """dB above the exact basis by delta."""
    model = study.model("bunny")
    cut = Cut.of(model, 70, 0.10)
    level = cut.decibels(cut.exact)
    rows: list[Line] = [
        (
            f"delta = {shift:.3g}",
            tuple(
                cut.decibels(cut.chain(cut.width, power, shift=shift)[0]) - level
                for power in POWERS_TRIED
            ),
            (),
        )
        for shift in SHIFTS
    ]
    first = [own[0] for _, own, _ in rows]
    yield printed(
        "The paper, 4: delta",
        [f"z = {power}" for power in POWERS_TRIED],
        rows,
        f"{model.name} in {len(cut.blocks)} blocks, c = 10 %, one iteration a block: dB of NMSVE above exact bases. "
        "The paper gives no delta. By its text it makes L definite; it also sets the quality.",
        numbers={"small": f"{first[0]:.2f}", "own": f"{first[1]:.2f}", "large": f"{first[3]:.2f}"},
    )
