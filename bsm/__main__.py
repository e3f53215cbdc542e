"""`python -m bsm` is the command `bsm`."""

from bsm.cli import run

if __name__ == "__main__":
    run()
