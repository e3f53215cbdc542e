"""Copies of the sources with kernels of their own, as `tools/checking_copy.sh` makes them."""

from pathlib import Path

from bsm import _core

HERE = Path(__file__).parents[1]


def refuse_other_kernels() -> None:
    """End the program if this is a copy, and the kernels are not its own: what is checked would be something else."""
    kernels = Path(_core.__file__)
    if (HERE / "sitecustomize.py").exists() and HERE not in kernels.parents:
        raise SystemExit(f"the kernels are those of {kernels}, not those of {HERE}")
