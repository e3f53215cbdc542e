"""`python -m bsm` is the command `bsm`."""

from __future__ import annotations

import _thread
import gc
import os

# An interrupt before `run` prints a traceback, so no module that loads slowly is imported up here.
import signal
import sys
import time
import warnings

_interrupts: list[int] = []


def _interrupt(number: int, _: object) -> None:
    """End as Python's own handler does, and remember it: extension modules make other errors of it while they load."""
    _interrupts.append(number)
    raise KeyboardInterrupt


def _interrupt_again(lost: sys.UnraisableHookArgs) -> None:
    """Repeat an interrupt that came where Python drops errors, such as in the callback of a lock of imports."""
    if lost.exc_type is KeyboardInterrupt:
        _thread.start_new_thread(_interrupt_soon, ())
    else:
        sys.__unraisablehook__(lost)


def _interrupt_soon() -> None:
    time.sleep(1e-3)
    _thread.interrupt_main()


def run() -> None:
    """Run as a program; an interrupt is one from the first moment on, whatever is being imported."""
    signal.signal(signal.SIGINT, _interrupt)
    sys.unraisablehook = _interrupt_again
    # Looking for cycles among the objects of all modules, while they load and again at the end, would take longer than
    # decoding a small mesh.
    gc.set_threshold(100_000)
    if not sys.warnoptions:  # commands print notes; library warnings are for programmers
        warnings.simplefilter("ignore")
    # Where standard streams are closed, no file that is opened may take their places.
    while (free := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(free)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    try:
        from bsm.cli import main

        code = main()
    except BaseException:
        if not _interrupts:
            raise
        print("bsm: interrupted", file=sys.stderr)
        code = 130
    # What is left is the interpreter's own end.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    gc.freeze()
    sys.exit(code)


if __name__ == "__main__":
    run()
