"""Every failure this project reports: one base class, and a class for each thing a caller may want to do about it."""

from __future__ import annotations

import importlib
from typing import Any, TypeVar


class BsmError(Exception):
    """Base of all errors of this project.

    Parameters
    ----------
    message : str
        The fault and its remedy.
    offset : int, optional
        Byte offset of the fault in the stream or file.
    frame : int, optional
        Number of the section of the stream, counted from 0.
    block : int, optional
        Number of the block concerned.

    Examples
    --------
    >>> import bsm
    >>> try:
    ...     bsm.decode(b"no stream")
    ... except bsm.BsmError as error:
    ...     type(error).__name__, error.offset
    ('FormatError', 0)
    """

    def __init__(
        self,
        message: str,
        *,
        offset: int | None = None,
        frame: int | None = None,
        block: int | None = None,
    ) -> None:
        self.message, self.offset, self.frame, self.block = message, offset, frame, block
        super().__init__(message)

    def located(
        self, *, offset: int | None = None, frame: int | None = None, block: int | None = None
    ) -> BsmError:
        """Add the places that are still unknown, and return the error."""
        # The place that was known where the error arose is closer than that of a caller.
        self.offset = offset if self.offset is None else self.offset
        self.frame = frame if self.frame is None else self.frame
        self.block = block if self.block is None else self.block
        return self

    def __str__(self) -> str:
        places = [("byte", self.offset), ("section", self.frame), ("block", self.block)]
        where = ", ".join(f"{name} {value}" for name, value in places if value is not None)
        return f"{self.message} [{where}]" if where else self.message


class FormatError(BsmError, ValueError):
    """The data is not a BSM stream, or the content of the file does not match its name.

    Examples
    --------
    >>> import bsm
    >>> bsm.decode("bunny.ply")
    Traceback (most recent call last):
    bsm.FormatError: ...
    """


class UnsupportedError(BsmError, NotImplementedError):
    """The stream uses a version or method that this decoder does not know.

    Examples
    --------
    >>> import bsm
    >>> issubclass(bsm.UnsupportedError, (bsm.BsmError, NotImplementedError))
    True
    """


class CorruptError(BsmError, ValueError):
    """A BSM stream that contradicts itself or its checksums.

    Examples
    --------
    >>> import bsm
    >>> stream = bytearray(bsm.encode("bunny.ply"))
    >>> stream[-40] ^= 1
    >>> bsm.decode(stream)
    Traceback (most recent call last):
    bsm.CorruptError: ...
    """


class TruncatedError(BsmError, EOFError):
    """The data ends before the end of the stream.

    Examples
    --------
    >>> import bsm
    >>> bsm.decode(bsm.encode("bunny.ply")[:-100])
    Traceback (most recent call last):
    bsm.TruncatedError: ...
    """


class LimitError(BsmError, OverflowError):
    """The stream asks for more memory or work than the caller's `Limits` allow.

    Examples
    --------
    >>> import bsm
    >>> bsm.decode("bunny.bsm", limits=bsm.Limits(vertices=100))
    Traceback (most recent call last):
    bsm.LimitError: ...
    """


class NumericError(BsmError, ArithmeticError):
    """A computation failed numerically: a singular system, or a value that is not finite.

    Examples
    --------
    >>> import bsm
    >>> issubclass(bsm.NumericError, (bsm.BsmError, ArithmeticError))
    True
    """


class MeshError(BsmError, ValueError):
    """The positions and faces are not a triangle mesh.

    Examples
    --------
    >>> import bsm
    >>> bsm.encode(([(0, 0, 0)], [(0, 1, 2)]))
    Traceback (most recent call last):
    bsm.MeshError: ...
    """


class OptionError(BsmError, ValueError):
    """An option is outside its legal range, or options exclude each other.

    Examples
    --------
    >>> import bsm
    >>> bsm.encode("bunny.ply", preset="finest")
    Traceback (most recent call last):
    bsm.OptionError: ...
    """


class HarmError(BsmError, ValueError):
    """The result would be worse than the input. `force` returns it anyway.

    Examples
    --------
    >>> import bsm
    >>> clean = bsm.load("bunny.ply")
    >>> bsm.denoise(clean, keep=0.01)
    Traceback (most recent call last):
    bsm.HarmError: ...
    """


class ArgumentError(BsmError, TypeError):
    """An argument has a wrong type, or a keyword does not exist.

    Examples
    --------
    >>> import bsm
    >>> bsm.encode("bunny.ply", prest="fine")
    Traceback (most recent call last):
    bsm.ArgumentError: unknown option prest for a mesh; did you mean preset?
    """


class TargetError(BsmError, ValueError):
    """A quality or size cannot be reached. The message names the best possible value.

    Attributes
    ----------
    best : float
        The best value as a number, in the unit of the target; infinity if there is none.

    Examples
    --------
    >>> import bsm
    >>> try:
    ...     bsm.encode("bunny.ply", size="10 B")
    ... except bsm.TargetError as error:
    ...     error.best > 10
    True
    """

    best = float("inf")


class VerificationError(BsmError, RuntimeError):
    """The decoded stream breaks the encoder's promise. This is a fault of the program; it writes nothing.

    Examples
    --------
    >>> import bsm
    >>> try:
    ...     data = bsm.encode("bunny.ply")
    ... except bsm.VerificationError as error:
    ...     print(error)  # to be reported
    """


class DependencyError(BsmError, ImportError):
    """An optional package is missing.

    Examples
    --------
    >>> import bsm
    >>> try:
    ...     widget = bsm.show("bunny.ply")
    ... except bsm.DependencyError as error:  # without anywidget
    ...     print(error)  # how to install it
    """


class BsmWarning(UserWarning):
    """A mesh loses or changes data; the command line prints it as a note.

    Examples
    --------
    >>> import bsm, warnings
    >>> with warnings.catch_warnings(record=True) as notes:
    ...     warnings.simplefilter("always", bsm.BsmWarning)
    ...     data = bsm.encode(([(0, 0, 0), (1, 0, 0), (0, 1, 0), (9, 9, 9)], [(0, 1, 2)]))
    >>> [str(note.message) for note in notes]
    ['left out 1 vertex that no face uses']
    """


# Set on the class, so that pickles name it, too: a pickle made today is read by releases that have moved the module.
for _error in (BsmError, BsmWarning, *BsmError.__subclasses__()):
    # Tracebacks show them by the name that users catch them by.
    _error.__module__ = __name__.partition(".")[0]
del _error

Kind = TypeVar("Kind", bound=type)


def public(kind: Kind) -> Kind:
    """Let a type be printed and pickled by the name that users import it by, ``bsm.TriangleMesh`` for instance."""
    kind.__module__ = __name__.partition(".")[0]
    return kind


def counted(**counts: int) -> str:
    """2 vertices, 1 face."""
    return ", ".join(
        f"{n} {what if n != 1 else what[:-1].replace('vertice', 'vertex')}"
        for what, n in counts.items()
    )


DISTRIBUTION = "bsm-codec"


def imported(module: str, why: str, extra: str) -> Any:
    """A module that an extra installs; `DependencyError` says why it is needed, and how it is installed."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        # The first error stays visible: a package may be there, and fail while it loads.
        raise DependencyError(f"{why}; run: {how_to_install(extra)}") from error


def how_to_install(extra: str) -> str:
    """The command that installs an extra; of a package that is installed it takes nothing from elsewhere."""
    return f"pip install '{DISTRIBUTION}[{extra}]'"
