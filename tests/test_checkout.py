"""A checkout without symbolic links, as git makes it on Windows, builds a package that has everything."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

import pytest

import bsm._core
from tools.release.versions import address, with_absolute_links

ROOT = Path(__file__).parents[1]
WITHOUT_CMAKE = ("wheel.cmake=false", "wheel.py-api=", "wheel.platlib=false")


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    if not shutil.which("git") or not (ROOT / ".git").exists():
        pytest.skip("no git here")
    pytest.importorskip("scikit_build_core")
    folder = tmp_path_factory.mktemp("clone") / "bsm"
    subprocess.run(
        ["git", "clone", "-q", "--shared", "-c", "core.symlinks=false", ROOT, folder], check=True
    )
    assert not [path for path in folder.rglob("*") if path.is_symlink()]
    return folder


def wheel_of(checkout, output, *settings):
    given = [word for setting in settings for word in ("-C", setting)]
    command = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "-q",
        "--no-build-isolation",
        "--no-deps",
        *given,
        "-w",
        output,
    ]
    subprocess.run(
        [*command, checkout], check=True, env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}
    )
    (wheel,) = output.iterdir()
    return wheel


def installed(wheel, folder):
    """The package, as the wheel has it, without those of this environment that are not installed but linked."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def python(package, *words):
    """Run Python with this package before all others, and without the hooks of editable installations."""
    paths = [str(package), *(sysconfig.get_path(name) for name in ("purelib", "platlib"))]
    code = f"import sys; sys.path[:0] = {paths!r}; import runpy; sys.argv = {list(map(str, words))!r}; "
    code += "runpy.run_module('bsm', run_name='__main__', alter_sys=False)"
    return subprocess.run(
        [sys.executable, "-S", "-c", code], check=False, capture_output=True, text=True
    )


def check_package(package, tmp_path):
    (tmp_path / "a.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
    )
    for words in (
        ("encode", tmp_path / "a.obj", "-o", tmp_path / "a.bsm"),
        ("view", tmp_path / "a.obj", "--save", tmp_path / "page.html"),
        ("view", tmp_path / "a.obj", "--static", tmp_path / "site"),
    ):
        done = python(package, "bsm", *words)
        assert done.returncode == 0, done.stderr
    page = (tmp_path / "page.html").read_text()
    assert page.count("AGFzbQ") == 1, "the decoder in WebAssembly is inside"
    for name in ("encode.wasm", "encode-moving.wasm", "grid.wasm", "kernels.wasm"):
        assert (tmp_path / "site" / name).read_bytes().startswith(b"\0asm"), name


def test_a_checkout_without_links_is_installed_and_viewed(checkout, tmp_path):
    wheel, again = (
        wheel_of(checkout, tmp_path / name, *WITHOUT_CMAKE) for name in ("wheel", "again")
    )
    assert wheel.read_bytes() == again.read_bytes()
    package = installed(wheel, tmp_path / "package")
    built = {path.name for path in (package / "bsm" / "viewer" / "built").iterdir()}
    assert built == {"encode.wasm", "encode-moving.wasm", "grid.wasm", "kernels.wasm"}
    assert not list(package.rglob("*.[ch]"))
    licenses = "".join(
        path.read_text("utf-8") for path in package.glob("*.dist-info/licenses/**/*.txt")
    )
    assert all(
        words in licenses for words in ("three.js authors", "Wenzel Jakob", "Thibaut Goetghebuer")
    )
    shutil.copy(bsm._core.__file__, package / "bsm")
    check_package(package, tmp_path)


def test_the_source_distribution_has_each_file_once_and_the_same_bytes_again(tmp_path):
    pytest.importorskip("scikit_build_core")
    made = []
    for name in ("one", "two"):
        code = (
            f"import scikit_build_core.build as build; build.build_sdist({str(tmp_path / name)!r})"
        )
        subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT, capture_output=True)
        made.append(next((tmp_path / name).iterdir()))
    with tarfile.open(made[0]) as archive:
        names = [member.name.partition("/")[2] for member in archive if member.isfile()]
        assert all(member.isfile() for member in archive)
    assert len(names) == len(set(names)) and "codec/decoding.py" in names
    assert not [name for name in names if name.startswith(("src/bsm/codec", "src/bsm/bitstream"))]
    assert made[0].read_bytes() == made[1].read_bytes()


def test_a_published_readme_has_no_relative_link():
    text = with_absolute_links((ROOT / "README.md").read_text("utf-8"), "https://host/bsm")
    links = re.findall(r"\]\(([^)]*)\)", text)
    assert len(links) > 20 and all(link.startswith(("https://", "#")) for link in links)
    assert "](https://host/bsm/raw/main/tools/front.png)" in text
    assert "](https://host/bsm/blob/main/docs/guides/presets.md#where" in text
    assert address(ROOT).startswith("https://")


@pytest.mark.long
def test_a_checkout_without_links_is_compiled(checkout, tmp_path):
    package = installed(wheel_of(checkout, tmp_path / "wheel"), tmp_path / "package")
    (data,) = package.glob("*.data")
    assert (data / "data/share/man/man1/bsm-encode.1").is_file()
    check_package(package, tmp_path)
