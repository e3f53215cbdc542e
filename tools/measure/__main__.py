"""Every measurement of the repository: `python -m tools.measure WHAT ...`, and `WHAT --help` for what it asks.

look        bytes, distance and visible share of presets and options, against Draco at the same look
attributes  what attributes take, against Draco's
encoding    what encoding takes, in bytes and in time, over Draco's and another checkout's
targets     bytes with a target beside the preset, over the larger of what either takes alone
speed       links on which it is there first
bar         how true the time left is that the bar shows
sequences   moving meshes, against Draco frame by frame and principal components
fields      colours and fields that change in moving meshes, against zstd and Draco frame by frame
denoise     the scoreboard of denoising; `tables` writes it into docs/measured.md
figures     the tables of docs/measured.md
house       how large the repository is, beside its limits
paper       the tables of the paper, beside the numbers that it prints
"""

from __future__ import annotations

from tools.command import dispatch

COMMANDS = {
    "look": "look:main",
    "attributes": "attributes:main",
    "sequences": "sequences:main",
    "fields": "fields:main",
    "denoise": "denoise:main",
    "tables": "denoise:write_tables",
    "figures": "figures:main",
    "encoding": "encoding:encoding_command",
    "targets": "encoding:targets_command",
    "speed": "speed:main",
    "bar": "bar:main",
    "house": "house:main",
    "paper": "paper:main",
}
"""The function that does what a word asks for, and its module."""


def main() -> None:
    """Run one measurement, as a command of its own."""
    dispatch("tools.measure", COMMANDS, __doc__)


if __name__ == "__main__":
    main()
