"""Takes from Python, and from those it starts, what other systems lack: `PYTHONPATH=tools/elsewhere pytest tests/bsm`.

No fcntl, resource or fork, no SIGALRM, memfd, /proc or symbolic links, and a platform that is not Linux. What Linux
cannot pretend remains: names in which upper and lower case differ, open files that can be removed, `/` in paths.
"""

import errno
import os
import random  # noqa: F401 - it looks at os once, when it is imported
import signal
import subprocess  # noqa: F401 - the same
import sys
import sysconfig
from typing import Any

MODULES = ("fcntl", "grp", "pty", "pwd", "resource", "syslog", "termios", "tty")
OF_OS = (
    "O_DIRECTORY O_NOFOLLOW O_CLOEXEC chown fchmod fork forkpty get_blocking getloadavg getpgid killpg memfd_create "
    "mkfifo pipe2 posix_spawn pread register_at_fork sched_getaffinity set_blocking setsid statvfs sysconf tcgetpgrp"
)
OF_SIGNAL = "ITIMER_REAL SIGALRM SIGCONT SIGHUP SIGPIPE SIGQUIT SIGTSTP SIGUSR1 SIGWINCH pthread_sigmask setitimer"


def _refuse(event: str, given: tuple[Any, ...]) -> None:
    """Find no file in /proc, and make no symbolic link."""
    if event == "open" and str(given[0]).startswith("/proc/"):
        raise FileNotFoundError(errno.ENOENT, "no such file on other systems", given[0])
    if event == "os.symlink":
        raise OSError(errno.EPERM, "a required privilege is not held", given[0])


def _stat(path: Any, **more: Any) -> os.stat_result:
    """Look at a file, but for those in /proc."""
    _refuse("open", (path,))
    return _known_stat(path, **more)


sysconfig.get_config_vars()
sys.modules |= dict.fromkeys(MODULES)  # type: ignore[arg-type]
for room, names in ((os, OF_OS), (signal, OF_SIGNAL)):
    for name in names.split():
        if hasattr(room, name):
            delattr(room, name)
_known_stat, os.stat = os.stat, _stat
sys.platform = "elsewhere"
sys.addaudithook(_refuse)
