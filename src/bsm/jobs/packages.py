"""Files of a package that refer to its meshes: they are copied with them, so that the package loads as before."""

import errno
from collections.abc import Iterator, Sequence
from pathlib import Path

from bsm.bitstream.errors import counted
from bsm.files.output import write_output
from bsm.ground.console import Console

SUFFIXES = (".urdf", ".xacro", ".srdf", ".sdf")
"""Descriptions of robots and their worlds."""
NAMES = ("package.xml", "model.config")
ROOTS = (b"<mujoco", b"<robot")
"""How a description in a file of another name begins."""
HEAD = 4096  # bytes in which the first element of a description is
MOST_BYTES = 16 << 20  # of a file that is copied


def copy_descriptions(
    folders: Sequence[str], output: str | None, console: Console, *, overwrite: bool
) -> None:
    """Copy the descriptions in folders and subfolders to the same places of another folder."""
    if output is None:
        return
    pairs: list[tuple[Path, Path]] = []
    for folder in folders:
        paths = _descriptions(folder)
        pairs += [(path, Path(output, path.relative_to(folder))) for path in paths]
    # All are looked at before the first is written.
    for source, target in pairs:
        if target.exists() and not overwrite and target.read_bytes() != source.read_bytes():
            raise FileExistsError(
                errno.EEXIST, "the file exists already, and differs; -f overwrites it", str(target)
            )
    for source, target in pairs:
        target.parent.mkdir(parents=True, exist_ok=True)
        write_output(str(target), source.read_bytes(), overwrite=True, follow=output)
    if pairs:
        names = ", ".join(sorted({source.name for source, _ in pairs}))
        console.note(f"copied {counted(files=len(pairs))} that refer to meshes: {names}")


def _descriptions(folder: str) -> Iterator[Path]:
    """Yield the descriptions in a folder and its subfolders, in order; links are left alone."""
    for path in sorted(Path(folder).rglob("*")):
        if path.is_symlink() or not path.is_file() or path.stat().st_size > MOST_BYTES:
            continue
        if path.suffix.lower() in SUFFIXES or path.name in NAMES or _is_description(path):
            yield path


def _is_description(path: Path) -> bool:
    if path.suffix.lower() != ".xml":
        return False
    with path.open("rb") as file:
        head = file.read(HEAD)
    return any(root in head for root in ROOTS)
