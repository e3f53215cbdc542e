"""python -m tools.release.blender [-o bsm-blender.zip]: an extension for Blender 4.2 and later, with its wheels.

Without --wheel, this checkout and msgpack are made into wheels for the Python that runs this: it must have the version
of Blender's own (3.11 for 4.2 to 5.0). Install the zip in Blender: Edit > Preferences > Get Extensions > Install from
Disk.
"""

import argparse
import re
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from bsm import __version__

ROOT = Path(__file__).parents[2]
EXTENSION = ROOT / "plugins/blender/extension"


def main(words: Sequence[str] | None = None) -> None:
    """Make the zip and say where it is."""
    parser = argparse.ArgumentParser(prog="python -m tools.release.blender", description=__doc__)
    parser.add_argument("-o", "--output", type=Path, default=Path("bsm-blender.zip"))
    parser.add_argument(
        "--wheel",
        type=Path,
        action="append",
        default=[],
        help="put in these wheels, and build none",
    )
    args = parser.parse_args(words)
    with _wheels(args.wheel) as wheels:
        make_zip(args.output, wheels)
    print(args.output)


@contextmanager
def _wheels(given: list[Path]) -> Iterator[list[Path]]:
    if given:
        yield given
        return
    with tempfile.TemporaryDirectory() as folder:
        pip = [sys.executable, "-m", "pip"]  # which says what it does: compiling takes minutes
        subprocess.run([*pip, "wheel", "--no-deps", "-w", folder, str(ROOT)], check=True)
        subprocess.run(
            [*pip, "download", "--no-deps", "--only-binary", ":all:", "-d", folder, "msgpack"],
            check=True,
        )
        yield sorted(Path(folder).glob("*.whl"))


def make_zip(output: Path, wheels: Sequence[Path]) -> None:
    """An extension of the sources here, whose manifest names the wheels."""
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("blender_manifest.toml", manifest([wheel.name for wheel in wheels]))
        for source in sorted(EXTENSION.glob("*.py")):
            archive.write(source, source.name)
        archive.write(ROOT / "LICENSE", "LICENSE")
        for wheel in wheels:
            archive.write(wheel, f"wheels/{wheel.name}")


def manifest(wheels: Sequence[str]) -> str:
    """Return the manifest for Blender: the version of this package, and the names of the wheels."""
    numbers = re.findall(r"\d+\.\d+\.\d+", __version__)  # as Blender wants it
    text = (EXTENSION / "blender_manifest.toml").read_text()
    text = text.replace('version = "0.1.0"', f'version = "{numbers[0]}"', 1)
    names = "".join(f'    "./wheels/{name}",\n' for name in wheels)
    head, sign, tail = text.partition("\n[permissions]")
    return f"{head}\nwheels = [\n{names}]\n{sign}{tail}"


if __name__ == "__main__":
    main()
