"""`python -m bsm` is the command `bsm`."""

import gc
import os
import signal
import sys
import warnings
from typing import NoReturn


def run() -> NoReturn:
    """Run as a program; an interrupt is one from the first moment on, whatever is being imported."""
    # Looking for cycles among the objects of all modules, while they load and again at the end, would take longer than
    # decoding a small mesh.
    gc.set_threshold(100_000)
    if not sys.warnoptions:  # commands print notes; warnings of libraries are for those who write programs
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
    except KeyboardInterrupt:
        print("bsm: interrupted", file=sys.stderr)
        code = 130
    # What is left is the interpreter's own end.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    gc.freeze()
    sys.exit(code)


if __name__ == "__main__":
    run()
