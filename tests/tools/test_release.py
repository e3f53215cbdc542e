"""What makes releases: versions that agree, wheels that are what they should be, README's commands from a wheel.

The wheels themselves are made and tried by `python -m tools.release`.
"""

import zipfile
from pathlib import Path

import pytest

import bsm
from tools import pythons
from tools.release.__main__ import fits
from tools.release.cross import FOREIGN, zig
from tools.release.imports import check_imports
from tools.release.trial import _from_wheel, readme_commands
from tools.release.versions import OTHERS, check_versions, notes, sections
from tools.release.wheels import check_contents

ROOT = Path(__file__).parents[2]


def test_versions_agree_and_the_change_log_has_a_section():
    assert check_versions(ROOT) == bsm.__version__
    assert len(notes(ROOT, bsm.__version__)) > 1000
    assert sections(ROOT)[0][0] == bsm.__version__


def test_versions_that_differ_are_refused(tmp_path):
    for name in ("src/bsm/__init__.py", "CHANGELOG.md", *OTHERS):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(
            (ROOT / name).read_text().replace(bsm.__version__, "9.9.9", name == "CHANGELOG.md")
        )
    with pytest.raises(SystemExit, match=r"9\.9\.9 in CHANGELOG"):
        check_versions(tmp_path)


MANUAL = "bsm_codec-1.data/data/share/man/man1/bsm-encode.1"


@pytest.mark.parametrize(
    ("names", "message"),
    [
        ([MANUAL, "bsm/py.typed", "bsm/_core.abi3.so"], None),
        ([MANUAL, "bsm/py.typed", "bsm/_core.pyd"], None),
        ([MANUAL, "bsm/py.typed"], "not what"),
        (["bsm/py.typed", "bsm/_core.abi3.so"], "not what"),
        ([MANUAL, "bsm/py.typed", "bsm/_core.abi3.so", "codec/geometry.py"], "codec"),
        ([MANUAL, "bsm/py.typed", "bsm/_core.abi3.so", "bsm/codec/isa.c"], "isa.c"),
        ([MANUAL, "bsm/py.typed", "bsm/_core.cpython-311-aarch64-linux-gnu.so"], None),
        ([MANUAL, "bsm/py.typed", "bsm/_core.cpython-311-x86_64-linux-gnu.so"], "not what"),
    ],
)
def test_wheels_are_looked_into(names, message, tmp_path):
    with zipfile.ZipFile(tmp_path / "a-linux_aarch64.whl", "w") as wheel:
        for name in (*names, "bsm_codec-1.dist-info/METADATA"):
            wheel.writestr(name, "")
    if message is None:
        check_contents(tmp_path / "a-linux_aarch64.whl")
    else:
        with pytest.raises(SystemExit, match=message):
            check_contents(tmp_path / "a-linux_aarch64.whl")


def test_each_python_has_its_wheel():
    old, new = (
        Path(f"bsm_codec-1-{tags}-manylinux_2_34_x86_64.whl")
        for tags in ("cp311-cp311", "cp312-abi3")
    )
    assert (
        fits(old, (3, 11))
        and fits(new, (3, 13))
        and not fits(new, (3, 11))
        and not fits(old, (3, 12))
    )
    assert not any(
        fits(Path(f"a-cp312-abi3-{end}.whl"), (3, 13))
        for end in ("manylinux_2_28_aarch64", "macosx_11_0_x86_64")
    )


@pytest.mark.slow
def test_an_extension_may_ask_for_the_stable_abi_only(tmp_path):
    for module in ("abi3info", "pefile", "ziglang"):
        pytest.importorskip(module, reason=f"no {module} here (extra release)")
    (tmp_path / "a.def").write_text("LIBRARY python3.dll\nEXPORTS\nPyLong_No\nPyLong_FromLong\n")
    (tmp_path / "a.c").write_text(
        "int DllMainCRTStartup(void) { return PyLong_FromLong(PyLong_No()); }\n"
    )
    zig(tmp_path, "dlltool", "-m", "i386:x86-64", "-d", "a.def", "-l", "a.lib")
    words = ("-target", FOREIGN[0].zig, "-shared", "-nostdlib", "-w", "-std=gnu89")
    zig(tmp_path, "cc", *words, "a.c", "a.lib", "-o", "_core.pyd")
    with zipfile.ZipFile(tmp_path / "a.whl", "w") as wheel:
        wheel.write(tmp_path / "_core.pyd", "bsm/_core.pyd")
    with pytest.raises(SystemExit, match=r"what may not be there: PyLong_No$"):
        check_imports(tmp_path / "a.whl", FOREIGN[0])


def test_readmes_commands_install_the_wheel_instead():
    for command in readme_commands(ROOT):
        line = _from_wheel(command, Path("/x/a.whl"))
        assert "'/x/a.whl[" in line and "'.[" not in line and "--only-binary" in line


def test_pythons_are_found_and_are_new_enough():
    found = pythons.pythons()
    assert found and min(found) >= (3, 11) and pythons.lowest("numpy") == "1.26"
