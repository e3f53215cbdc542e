"""The same bits on other processors: compile bsmdec, run it in an emulator, compare with the processor here.

    python -m tools.processors [--targets aarch64,s390x,...] [--folder FOLDER] [STREAM ...]

All vectors, if no stream is named. FOLDER keeps what is fetched and compiled (.cache/processors): Zig (PyPI: ziglang),
which is Clang for all targets, and QEMU (qemu-user-static, from PATH or by apt-get download). `x87` must not compile,
`fused` must refuse all streams. The exit code is 1 if a target does otherwise.
"""

import shutil
import subprocess
import sys
import venv
from dataclasses import dataclass
from pathlib import Path

from tools.amalgamate import ROOT, amalgamated, interface
from tools.command import parser_of

FINGERPRINT = ROOT / "tools/processors/fingerprint.c"


@dataclass(frozen=True)
class Target:
    """A processor: its name for Zig and for QEMU, and what is expected."""

    zig: str
    qemu: str
    flags: tuple[str, ...] = ()
    compiles: bool = True
    refuses: bool = False


TARGETS = {
    "aarch64": Target("aarch64-linux-musl", "aarch64"),
    "arm": Target("arm-linux-musleabihf", "arm"),  # 32 bits; vectors of NEON would flush
    "armsoft": Target("arm-linux-musleabi", "arm"),
    "i386": Target("x86-linux-musl", "i386"),  # 32 bits, SSE2
    "riscv64": Target("riscv64-linux-musl", "riscv64"),
    "ppc64le": Target("powerpc64le-linux-musl", "ppc64le"),
    "s390x": Target("s390x-linux-musl", "s390x"),  # big-endian
    "x87": Target("x86-linux-musl", "i386", ("-mcpu=i586",), compiles=False),
    "fused": Target("aarch64-linux-musl", "aarch64", ("-ffp-contract=fast",), refuses=True),
}


class NotHere(RuntimeError):
    """A compiler or an emulator is not here and cannot be fetched."""


def emulator(folder: Path, name: str) -> str:
    """Find QEMU for a processor, or fetch it."""
    for program in (f"qemu-{name}-static", f"qemu-{name}"):
        if found := shutil.which(program) or shutil.which(
            program, path=str(folder / "root/usr/bin")
        ):
            return found
    if shutil.which("apt-get") is None:
        raise NotHere(f"qemu-{name} is not here: install qemu-user-static")
    got = subprocess.run(
        ["apt-get", "download", "qemu-user-static"], cwd=folder, capture_output=True, check=False
    )
    for package in folder.glob("qemu-user-static_*.deb"):
        subprocess.run(["dpkg", "-x", package, folder / "root"], check=True)
    if got.returncode or not (folder / f"root/usr/bin/qemu-{name}-static").exists():
        raise NotHere("qemu-user-static cannot be fetched")
    return str(folder / f"root/usr/bin/qemu-{name}-static")


def zig(folder: Path) -> list[str]:
    """Command of a C compiler for all targets, fetched if it is not here."""
    python = folder / "venv/bin/python"
    if not (folder / "fetched").exists():
        venv.create(folder / "venv", with_pip=True)
        command = [str(python), "-m", "pip", "install", "-q", "ziglang"]
        if subprocess.run(command, capture_output=True, check=False).returncode:
            raise NotHere("ziglang cannot be fetched from PyPI")
        (folder / "fetched").touch()
    return [str(python), "-m", "ziglang", "cc"]


def program(folder: Path, name: str, compiler: list[str], *flags: str) -> Path | None:
    """Compile the fingerprint for a processor; None if the library does not compile."""
    made = folder / f"fingerprint-{name}"
    sources = [
        "-w",
        "-std=gnu11",
        f"-I{folder}",
        f"-I{ROOT}",
        str(FINGERPRINT),
        str(folder / "bsmdec.c"),
    ]
    run = subprocess.run(
        [*compiler, *flags, *sources, "-o", str(made), "-lm"],
        text=True,
        capture_output=True,
        check=False,
    )
    if run.returncode and "compile BSM with" not in run.stderr:
        raise RuntimeError(run.stderr)
    return None if run.returncode else made


def lines(command: list[str], folder: Path, streams: list[Path]) -> list[str]:
    """What a program prints of streams."""
    listed = folder / "streams.txt"
    listed.write_text("".join(f"{stream.resolve()}\n" for stream in streams))
    run = subprocess.run([*command, f"@{listed}"], text=True, stdout=subprocess.PIPE, check=False)
    return run.stdout.splitlines()


def prepare(folder: Path) -> None:
    """Write the library into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bsmdec.c").write_text(amalgamated())
    (folder / "bsmdec.h").write_text(interface())


def complaint(
    folder: Path, name: str, expected: list[str], streams: list[Path], level: str
) -> str | None:
    """Say in what a target is not as it must be."""
    target = TARGETS[name]
    run = emulator(folder, target.qemu)
    flags = ("-target", target.zig, "-fno-sanitize=undefined", "-static", level, *target.flags)
    made = program(folder, name, zig(folder), *flags)
    if (made is not None) != target.compiles:
        return "compiles" if made else "does not compile"
    if made is None:
        return None
    found = lines([run, str(made)], folder, streams)
    if target.refuses:
        return None if found and all(line.split()[1] == "5" for line in found) else "decodes"
    different = [
        line
        for line, other in zip(expected, [*found, *[""] * len(expected)], strict=False)
        if line != other
    ]
    return (
        f"{len(different)} of {len(expected)} differ, the first: {different[0].split()[0]}"
        if different
        else None
    )


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("streams", nargs="*", type=Path, metavar="STREAM")
    parser.add_argument("--targets", default=",".join(TARGETS), help="default: %(default)s")
    parser.add_argument("--folder", type=Path, default=ROOT / ".cache/processors")
    parser.add_argument("--level", default="-O2", help="of optimization (default: %(default)s)")
    args = parser.parse_args()
    folder, wrong = args.folder.resolve(), 0
    streams = args.streams or sorted((ROOT / "spec/vectors").glob("*/*.bsm"))
    prepare(folder)
    expected = lines([str(program(folder, "here", ["cc", "-O2"]))], folder, streams)
    for name in args.targets.split(","):
        found = complaint(folder, name, expected, streams, args.level)
        print(f"{name}: {found or f'as it must be, {len(streams)} streams'}", flush=True)
        wrong += found is not None
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
