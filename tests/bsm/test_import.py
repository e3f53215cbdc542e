"""`import bsm`: the one supported name; and what to type for a library that is missing."""

import ast
import importlib
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import bsm
from bsm import DependencyError
from bsm.bitstream.errors import how_to_install, imported
from tests.bsm.program import ROOT, python


def test_it_loads_nothing_that_takes_time():
    printed = python(
        "-c", "import sys, bsm, bsm.cli; dir(bsm); print(*sys.modules)", text=True
    ).stdout
    loaded = set(printed.split())
    assert "bsm" in loaded
    assert not {"numpy", "scipy", "codec", "bsm.codec.denoise", "bsm.bitstream.container"} & loaded


@pytest.mark.parametrize("name", ["tools", "tests", "spec", "examples", "build"])
def test_nothing_of_a_checkout_but_the_product_is_of_it(name):
    assert len(bsm.__path__) == 1
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module(f"bsm.{name}")


def test_a_command_loads_nothing_that_speaks_http(tmp_path):
    stream = ROOT / "spec" / "vectors" / "1.0" / "good-sequence-learnt.bsm"
    words = ["decode", "-q", str(stream), "-o", str(tmp_path / "decoded.npz")]
    program = (
        f"import sys; from bsm.cli import main; code = main({words}); print(code, *sys.modules)"
    )
    code, *loaded = python("-c", program, text=True).stdout.split()
    assert code == "0" and "bsm.codec.decoding" in loaded
    assert not {"urllib.request", "http.client", "ssl", "scipy"} & set(loaded)


def test_every_name_is_there_and_has_a_docstring():
    for name in bsm.__all__:
        value = getattr(bsm, name)
        if inspect.isclass(value) or inspect.isfunction(value):
            assert inspect.getdoc(value), name
    assert set(bsm.__all__) == set(dir(bsm))
    with pytest.raises(AttributeError, match="elephant"):
        _ = bsm.elephant


def test_every_error_of_the_project_is_there():
    errors = {kind.__name__ for kind in (bsm.BsmError, *bsm.BsmError.__subclasses__())}
    assert len(errors) > 10 and errors <= set(bsm.__all__)


def test_type_checkers_see_the_same_names():
    tree = ast.parse(Path(bsm.__file__).with_suffix(".pyi").read_text())
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    seen = {alias.asname: node.module for node in imports for alias in node.names if alias.asname}
    assert seen == bsm._HOMES
    assert list(seen) == bsm.__all__[1:]


def test_an_error_names_the_extra_and_no_path():
    with pytest.raises(
        DependencyError, match=r"^x is missing; run: pip install 'bsm-codec\[eval\]'$"
    ):
        imported("no_such_module", "x is missing", "eval")


@pytest.mark.slow
def test_the_command_is_content_with_the_package_that_is_installed():
    if subprocess.run(
        [sys.executable, "-m", "pip", "--version"], capture_output=True, check=False
    ).returncode:
        pytest.skip("needs pip")
    words = how_to_install("progress").replace("'", "").split()[1:]
    command = [sys.executable, "-m", "pip", *words, "--no-index", "--dry-run"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "already satisfied: bsm-codec" in done.stdout, (
        done.stdout + done.stderr
    )
