"""What reading asks of the kernel: `python -m tools.attack calls`; exit code 1 if a call was refused (needs strace).

Every attack on readers is read in isolation under a recorder. What is recorded after a process has closed its calls is
held against src/bsm/files/calls.csv.
"""

import csv
import platform
import re
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from bsm.files import isolation
from tools.command import parser_of

_TABLE = Path(isolation.__file__).with_name("calls.csv")
_LINE = re.compile(r"(\d+) +(?:(\w+)\(|<\.\.\. (\w+) resumed>|\+\+\+)(.*)")
_CLOSES = "PR_SET_SECCOMP"


def recorded(lines: Iterable[str]) -> tuple[Counter[str], Counter[str]]:
    """Calls of processes that have closed their calls, and those of them that were refused."""
    closed, calls, refused = set[str](), Counter[str](), Counter[str]()
    for line in lines:
        if not (match := _LINE.match(line)):
            continue
        process, begun, ended, rest = match.groups()
        if process in closed and not (begun or ended):
            closed.remove(process)  # it is over, and its number is given to others
        elif process in closed:
            calls.update([begun] if begun else [])
            refused[begun or ended] += "(errno 3" in rest
        elif _CLOSES in rest:
            closed.add(process)
    return calls, +refused


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument(
        "--every", type=int, default=200, metavar="N", help="of the numbers take one in N"
    )
    parser.add_argument(
        "--bytes", type=int, default=1 << 16, help="of a file that is grown (default: %(default)s)"
    )
    args = parser.parse_args()
    attack = [sys.executable, "-m", "tools.attack", "readers", "--limits", "service"]
    with tempfile.NamedTemporaryFile("r", errors="replace") as log:
        record = ["strace", "-f", "-q", "-e", "signal=none", "-o", log.name]
        # Exit code 1: under the recorder, some files take longer than they may.
        subprocess.run(
            [*record, *attack, "--every", str(args.every), "--bytes", str(args.bytes)], check=False
        )
        calls, refused = recorded(log)
    rows = csv.DictReader(_TABLE.read_text().splitlines())
    allowed = {row["call"] for row in rows if row["allowed"] == "yes" and row[platform.machine()]}
    for name, count in calls.most_common():
        print(f"{name:20}{count:9}{'  refused ' + str(refused[name]) if refused[name] else ''}")
    print(f"allowed and not asked for: {' '.join(sorted(allowed - calls.keys()))}")
    return 1 if refused or not calls or calls.keys() - allowed else 0
