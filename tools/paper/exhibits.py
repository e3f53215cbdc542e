"""All exhibits by name, in the order of the paper."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from bsm.bitstream.errors import OptionError
from tools.paper.coherence import coherence
from tools.paper.compression import boundary, dynamic, rates
from tools.paper.denoising import coarse_to_fine, companions, hand, normals
from tools.paper.exhibit import Cell, Column, Exhibit, Table
from tools.paper.iterations import powers, times
from tools.paper.overlap import overlap
from tools.paper.segments import degrees, number_of_segments, segmentation, transition
from tools.paper.sequences import sequences
from tools.paper.study import ROLES, Study

EXHIBITS: dict[str, Callable[[Study], Exhibit]] = {
    "segmentation": segmentation,
    "degrees": degrees,
    "boundary": boundary,
    "transition": transition,
    "segments": number_of_segments,
    "overlap": overlap,
    "coherence": coherence,
    "normals": normals,
    "sequences": sequences,
    "rates": rates,
    "dynamic": dynamic,
    "coarse-to-fine": coarse_to_fine,
    "companions": companions,
    "hand": hand,
    "times": times,
    "powers": powers,
}


def make_exhibits(study: Study, names: Sequence[str]) -> dict[str, Exhibit]:
    """Some of `EXHIBITS`."""
    unknown = [name for name in names if name not in EXHIBITS]
    if unknown:
        raise OptionError(f"no exhibit is called {', '.join(unknown)}; there are {', '.join(EXHIBITS)}")
    return {name: EXHIBITS[name](study) for name in names}


def models_table(study: Study) -> Table:
    """Which mesh plays which model of the paper."""
    columns = (Column("vertices", 0, 0.01, "The stand-in has another size."),)
    rows = []
    for role, about in ROLES.items():
        model = study.model(role)
        label = f"{about.name}: {model.name}" + (f" ({about.remark})" if about.remark and study.folder else "")
        rows.append((label, (Cell(float(model.size), float(about.vertices) or None),)))
    return Table("Models", "the paper's model: the mesh used here", columns, tuple(rows))
