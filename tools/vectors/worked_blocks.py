"""What M 6 to M 10 give for two blocks, bit by bit, from the reference decoder: worked numbers of the specification."""

import importlib.util
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from tools.vectors.store import FOLDER

NAME = "good-hub"
SPEC = FOLDER.parents[1]
COLUMNS = 2
"""Of dictionaries, the first ones."""


def worked_blocks() -> str:
    """Return the text of the section, as it must stand in the document."""
    traced = list(_trace((FOLDER / f"{NAME}.bsm").read_bytes()))[:2]
    return "\n".join(line for number, block in enumerate(traced) for line in _lines(number, block))


def _reference() -> Any:
    """Load a copy of the reference decoder, which stands outside of any package."""
    sys.path.insert(0, str(SPEC))
    try:
        spec = importlib.util.spec_from_file_location(
            "traced_reference_decoder", SPEC / "reference_decoder.py"
        )
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(SPEC))
    return module


def _trace(stream: bytes) -> Iterator[dict[str, Any]]:
    """Decode a stream and note what comes before and behind each function of the dictionaries."""
    reference = _reference()
    blocks: list[dict[str, Any]] = []
    surroundings, solver, onorm = reference.surroundings, reference.Solver, reference.onorm

    def traced_surroundings(graph: Any, block: Any, known: Any) -> Any:
        springs, pulls = surroundings(graph, block, known)
        blocks.append({"vertices": block.vertices, "springs": springs, "orthonormal": []})
        return springs, pulls

    class TracedSolver(solver):  # type: ignore[valid-type,misc]
        def iterate(self, start: npt.NDArray[Any], solutions: int) -> npt.NDArray[Any]:
            entry = blocks[-1]
            entry |= {
                "order": self.order,
                "inverse": self.d,
                "start": start,
                "first": self.solve(start[self.order]),
            }
            result: npt.NDArray[Any] = super().iterate(start, solutions)
            entry["dictionary"] = result
            return result

    def traced_onorm(columns: npt.NDArray[Any], order: Any, alone: Any) -> npt.NDArray[Any]:
        result: npt.NDArray[Any] = onorm(columns, order, alone)
        blocks[-1]["orthonormal"].append(result)
        return result

    reference.surroundings, reference.Solver, reference.onorm = (
        traced_surroundings,
        TracedSolver,
        traced_onorm,
    )
    reference.decode(stream)
    yield from blocks


def _lines(number: int, block: dict[str, Any]) -> Iterator[str]:
    order = block["order"]
    by_order = [[block["inverse"][:, None]], [block["first"]], [block["orthonormal"][0]]]
    columns = [block["start"][order][:, :COLUMNS], *(entry[0][:, :COLUMNS] for entry in by_order)]
    columns.append(block["dictionary"][order][:, :COLUMNS])
    yield f"Block {number}. Row r is the vertex at place r:"
    yield ""
    yield "    " + " ".join(map(str, block["vertices"]))
    yield ""
    if block["springs"].any():
        yield "Stiffness s_r of its springs:"
        yield ""
        yield "    " + " ".join(f"{entry:g}" for entry in block["springs"])
        yield ""
    yield "Its rows in the order of elimination, with columns 0 and 1 of U(0), d_k, the same columns of R U(0), of"
    yield "U(1) = Onorm(R U(0)), and of U:"
    yield ""
    for place, row in enumerate(order):
        yield f"    {row:2}  " + "  ".join(" ".join(map(_hex, entry[place])) for entry in columns)
    yield ""


def _hex(value: Any) -> str:
    return f"{int(np.float32(value).view(np.uint32)):08x}"
