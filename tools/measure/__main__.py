"""What `tools.replicate` does not measure: `python -m tools.measure WHAT ...`, and `WHAT --help` for what it asks.

attributes  what attributes take, against Draco's
assets      what decoding assets with normals and texture coordinates takes, over Draco's
speed       what encoding and decoding take, over Draco's and a file of figures; of MESHes, decoding by bsmdec
regret      bytes of the default over the least of all ways, each searched alone and for long
targets     bytes by each kind of target, and how much of it is used, of made meshes or of MESHes
fields      colors and fields that change in moving meshes, against zstd and Draco frame by frame
denoising   how denoising does on noise of known cause, beside Taubin's filter
house       how large the repository is and how it reads, beside the last release
"""

from tools.command import dispatch

COMMANDS = {
    "attributes": "attributes:main",
    "assets": "assets:main",
    "fields": "fields:main",
    "speed": "speed:main",
    "regret": "regret:main",
    "targets": "targets:main",
    "denoising": "denoising:main",
    "house": "house:main",
}
"""The function that does what a word asks for, and its module."""


def main() -> None:
    """Run one measurement, as a command of its own."""
    dispatch("tools.measure", COMMANDS, __doc__)


if __name__ == "__main__":
    main()
