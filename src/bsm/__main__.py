"""`python -m bsm` is the command `bsm`."""

import gc
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
