"""Landlock of Linux: it limits the files that a reader of untrusted files, or one of its libraries, can open."""

import importlib
import itertools
import os
import platform
import sys
import sysconfig
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

PROCESSORS = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
"""Processors whose calls of the kernel are known, and their numbers in seccomp."""


# Cached, since every file asks, and the answer cannot change while the process runs.
@cache
def lack() -> str | None:
    """Return what this system lacks to keep files of others from readers."""
    if sys.platform != "linux":
        return "Linux"
    try:
        landlock: Any = importlib.import_module("landlockpy")
    except ImportError:
        return "landlockpy: pip install landlockpy"
    if platform.machine() not in PROCESSORS:
        return "a processor of x86-64 or ARM"
    if not landlock.supported():
        return "a kernel with Landlock"
    return None


def folders_of(paths: Iterable[str]) -> set[str]:
    """Return the folders of files, and of the targets of links."""
    folders: set[str] = set()
    for path in paths:
        folders |= {os.path.dirname(os.path.abspath(path)), os.path.dirname(os.path.realpath(path))}
    return folders


# Landlock takes only a list of allowed paths. Python and its packages must still be loaded, and a mesh may name other
# files in its folder.
def close_files(folders: set[str]) -> None:
    """Let this process read nothing but the files in these folders, and those of Python and its packages."""
    landlock: Any = importlib.import_module("landlockpy")
    read_rights = landlock.AccessFS.READ_FILE | landlock.AccessFS.READ_DIR
    scope = landlock.Scope.SIGNAL | landlock.Scope.ABSTRACT_UNIX_SOCKET
    with landlock.Ruleset(scoped=scope) as rules:
        for path in itertools.chain(libraries(), folders):
            with suppress(OSError):  # the folder may have been removed meanwhile
                if os.path.isdir(path):
                    rules.allow_path(path, read_rights)
                else:
                    rules.allow_path(path, landlock.AccessFS.READ_FILE)
        rules.restrict()


# Cached, since listing the folders of all modules takes longer than reading a small file.
@cache
def libraries() -> tuple[str, ...]:
    """Return the folders of Python, of packages and of libraries; not all of `sys.path`, where a checkout may be."""
    installed = {path for path in sys.path if Path(path).name in ("site-packages", "dist-packages")}
    python = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    loaded: set[str] = set()
    for module in list(sys.modules.values()):
        loaded.update(list(getattr(module, "__path__", ())))
    system = {"/usr", "/lib", "/lib64", "/etc/ld.so.cache", "/dev/null", "/dev/urandom"}
    return tuple(filter(os.path.exists, installed | python | loaded | system))
