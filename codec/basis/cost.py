"""What dictionaries cost, in nanoseconds of a processor core and in bytes, before anything is done for them.

Mathematics states prices, stages pay them: `Steps` is how a price travels.

The numbers are those of one machine, an x86-64 server with AVX-512; `python -m tools.attack charges` says how true they
are of another. What they are for is to refuse what would take much longer than it is worth, so that a factor of two is
close enough; what counts is that nothing is left out.
"""

from collections.abc import Callable, Generator
from typing import TypeAlias

from bsm.codec.arrays import Basis
from bsm.codec.basis.laplacian import Fronts

ONCE = 5.0  # of each number of a dictionary, however often it is iterated
CARE = 6.0  # of each row and pair of columns of which one is made orthonormal by itself

Spend: TypeAlias = Callable[[float], None]
"""Is told of work before it is done, and may refuse it by raising `LimitError`."""


Price: TypeAlias = Callable[[int], float]  # work of one step for so many columns, nanoseconds
Steps: TypeAlias = Generator[Price, None, Basis]
"""A computation that yields the price of each step before it takes it, and returns its columns."""


def settle(steps: Steps, pay: Callable[[Price], None]) -> Basis:
    """The columns, shape (n, c), that `steps` lead to; each price is handed to `pay` before the step is taken."""
    while True:
        try:
            price = next(steps)
        except StopIteration as end:
            columns: Basis = end.value
            return columns
        pay(price)


def unpaid(steps: Steps) -> Basis:
    """The columns, shape (n, c), that `steps` lead to, whatever they cost."""
    return settle(steps, lambda price: None)


def up_to(most: int, steps: Steps) -> Steps:
    """`steps` of which nobody wants more than so many columns, whatever number they are priced for."""

    def cut(price: Price) -> Price:
        return lambda columns: price(min(columns, most))

    while True:
        try:
            price = next(steps)
        except StopIteration as end:
            columns: Basis = end.value
            return columns
        yield cut(price)


def free(work: float) -> None:
    """Encoders of one's own meshes have no allowance to spend."""


def factor_cost(fronts: Fronts) -> float:
    """Work of one factorisation, nanoseconds."""
    return float(fronts.sums[1]) / 6.0 + 50.0 * len(fronts.rows) + 4000.0


def solve_cost(fronts: Fronts, columns: int) -> float:
    """Work of one solution for so many columns, which are solved in panels of 64, a panel in vectors of 16."""
    return 50.0 + float(fronts.sums[0]) * (0.3 * -(-columns // 64) + 0.02 * _whole(columns))


def onorm_cost(rows: int, columns: int) -> float:
    """Work of one orthonormalisation, nanoseconds."""
    whole = _whole(columns)
    return rows * (3.0 + 0.4 * whole + whole * whole / 80.0) + 3000.0


def dictionary_cost(fronts: Fronts, columns: int, solutions: int) -> float:
    """Work of making a dictionary of columns that need no care."""
    rows = len(fronts.rows)
    rounds = solutions * solve_cost(fronts, columns) + (solutions + 1) * onorm_cost(rows, columns)
    return ONCE * rows * _whole(columns) + rounds


def careful_cost(fronts: Fronts, columns: int, solutions: int, care: int) -> float:
    """Work of making it anew, with so many columns, at most, made orthonormal one by one."""
    return dictionary_cost(fronts, columns, solutions) + CARE * len(fronts.rows) * columns * care


def completion_cost(rows: int, first: int, columns: int) -> float:
    """Work of completing so many first columns to more."""
    more = max(0, columns - first)
    return (first**3 / 3.0 + more * first * (first + rows)) / 15.0 + 2.0 * rows * columns + 1500.0


def iteration_memory(fronts: Fronts, columns: int) -> int:
    """Bytes for finding a dictionary, at most, that itself included."""
    rows, whole = len(fronts.rows), _whole(columns)
    return 8 * (6 * rows * whole + 2 * whole * whole + int(fronts.places[-1])) + 500 * rows


def _whole(columns: int) -> int:
    return -(-columns // 16) * 16
