"""Where the tests find real meshes, and which of them they skip without."""

import os
import re
import signal
import traceback
from collections.abc import Generator
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
LACKING = re.compile(
    r"module '(os|signal)' has|privilege|platform \w+ is not|(named '|of )(fcntl|resource|termios)\b"
)


def pytest_configure(config: pytest.Config) -> None:
    """Let examples take their time, and signals reach programs under test."""
    # What a shell runs in the background passes on that it ignores them.
    for number in (signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)):
        if signal.getsignal(number) == signal.SIG_IGN:
            signal.signal(
                number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL
            )
    # How long an example takes says how busy the machine is; half as many as usual are enough every time.
    if config.pluginmanager.hasplugin("hypothesispytest"):
        from hypothesis import settings

        examples = int(os.environ.get("BSM_EXAMPLES", "50"))
        settings.register_profile("patient", deadline=None, max_examples=examples)
        settings.load_profile("patient")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, None, None]:
    """Skip a test that itself asks for what its system lacks, such as `os.mkfifo`; `bsm` must not ask for it."""
    try:
        yield
    except (AttributeError, ImportError, NotImplementedError, OSError) as error:
        modules = [
            frame.f_globals.get("__name__", "")
            for frame, _ in traceback.walk_tb(error.__traceback__)
        ]
        if not LACKING.search(str(error)) or any(
            name.partition(".")[0] == "bsm" for name in modules
        ):
            raise
        pytest.skip(f"not on this system: {error}")


pytest_runtest_setup = pytest_runtest_call  # fixtures, too


def mesh_folder() -> Path | None:
    """The folder of real meshes: BSM_MESHES, or shared/meshes beside the checkout."""
    candidates = [os.environ.get("BSM_MESHES"), HERE.parent.parent / "shared" / "meshes"]
    return next((Path(path) for path in candidates if path and Path(path).is_dir()), None)


@pytest.fixture(scope="session")
def meshes() -> Path:
    """The folder of real meshes; the test is skipped where there is none."""
    folder = mesh_folder()
    if folder is None:
        pytest.skip("no folder of real meshes: set BSM_MESHES")
    return folder
