"""The report of a run, and how --resume reads it."""

import errno
import json
import re
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import asdict, dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any

from bsm import __version__
from bsm.account.overview import report_kind, write_page, write_table
from bsm.bitstream.errors import FormatError, counted
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files import pipes
from bsm.files.output import write_output
from bsm.ground.console import Console
from bsm.jobs.task import Facts, Job, Task, Work

# None of these changes the bytes of an output, so a run with others may still be resumed.
_OF_ONE_RUN = {
    "quiet",
    "force",
    "threads",
    "input",
    "output",
    "replaceable",
    "doubtful",
    "fresh",
    "before",
}
_EVERY = 1.0  # seconds between two versions of a report, at least
_WAYS = ("input", "output")
_SHOWN = 20  # rows of a table, if fewer failed
# A report of a hundred thousand files takes seconds to write. Its pace follows that.
_SHARE = 0.02  # largest share of the time for writing reports


def options_of(task: Task) -> Facts:
    """Return the options on which outputs depend."""
    given = {name: value for name, value in asdict(task).items() if name not in _OF_ONE_RUN}
    text = json.dumps({"version": __version__, **given}, default=str, sort_keys=True)
    # There and back, so that they are equal to those that are read from a report: tuples become lists there.
    options: Facts = json.loads(text, parse_constant=str)  # JSON has no infinity
    return options


class Report:
    """The report of a run, rewritten as a whole during the run."""

    def __init__(
        self,
        path: str,
        command: str,
        options: Facts,
        jobs: Sequence[Job],
        earlier: Mapping[str, Facts],
        load: Callable[[str], TriangleMesh],
    ) -> None:
        self._path = path
        self._kind = report_kind(path)
        self._load = load
        self._head = {"command": command, "options": options}
        self._files = [
            earlier.get(job.output) or {"input": job.input, "output": job.output} for job in jobs
        ]
        self._open = set(range(len(jobs)))
        self._begin = time.perf_counter()
        self._next = 0.0
        self.write()

    def take(self, number: int, facts: Facts) -> None:
        self._files[number] = facts
        self._open.discard(number)
        # A page has pictures, which are drawn once, at the end.
        if self._kind != "html" and time.perf_counter() >= self._next:
            self.write()

    def write(self) -> None:
        begin = time.perf_counter()
        # As a whole and by renaming: a run that is killed while it writes leaves the report before.
        write_output(self._path, self._contents(begin), overwrite=True)
        end = time.perf_counter()
        self._next = end + max(_EVERY, (end - begin) / _SHARE)

    def _contents(self, now: float) -> bytes:
        if self._kind == "csv":
            return write_table(self._files)
        if self._kind == "html":
            return write_page(self._path, self._files, self._load)
        state = {
            "complete": not self._open,
            "seconds": now - self._begin,
            "totals": totals(self._files),
        }
        return (
            json.dumps(
                {**self._head, **state, "files": self._files}, indent=1, allow_nan=False
            ).encode()
            + b"\n"
        )


@dataclass(frozen=True)
class Earlier:
    outputs: Mapping[str, str | None]
    files: Mapping[str, Facts]


NOTHING = Earlier({}, {})


def read_report(path: str, command: str, options: Facts) -> Earlier:
    """Read an earlier report; return `NOTHING` if there is none."""
    try:
        report = json.loads(pipes.as_input(path).read_all())
        files = {entry["output"]: entry for entry in map(_entry, report["files"])}
        same = (report["command"], report["options"]) == (command, options)
        # Totals of hostile numbers, or infinities, would raise an error at the end of the new run. Better at its
        # beginning.
        json.dumps({**report, "totals": totals(list(files.values()))}, allow_nan=False)
    except FileNotFoundError:
        return NOTHING
    except (
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        ArithmeticError,
        RecursionError,
    ) as error:
        raise FormatError(
            f"{path}: this is not a report of bsm; name another with --report"
        ) from error
    digests = {name: entry.get("output_sha256") for name, entry in files.items()}
    # With other options the results do not count, but the files are still known as those of a run.
    if not same:
        files = {}
    return Earlier(digests, files)


def is_report(path: str) -> bool:
    """Return whether a file is the report of a run, by its first bytes."""
    if Path(path).suffix.lower() != ".json" or not Path(path).is_file():
        return False
    with Path(path).open("rb") as file:
        return re.match(rb'\s*\{\s*"command":', file.read(64)) is not None


def read_results(path: str) -> list[Facts]:
    """Return the checked results of a report, one for each input of its run."""
    try:
        return [_entry(result) for result in json.loads(pipes.as_input(path).read_all())["files"]]
    except (
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        ArithmeticError,
        RecursionError,
    ) as error:
        raise FormatError(f"{path}: this is not a report of bsm") from error


def find_output(report: str, output: str) -> str:
    """Return where an output is: as the report names it, or in the folder of a report that was moved with it."""
    path = Path(output)
    if pipes.is_url(output) or path.exists():
        return output
    folder = Path(report).parent
    moved = (
        folder.joinpath(*path.parts[first:]) for first in range(path.is_absolute(), len(path.parts))
    )
    return str(next(filter(Path.exists, moved), path))


_MOST_BYTES = 1 << 63
# A report is a file, which anybody can edit. Fields that are computed with are checked by type and range.
_FIELDS: Mapping[str, Callable[[Any], bool]] = {
    **dict.fromkeys(
        ("input_bytes", "output_bytes"),
        lambda value: type(value) is int and 0 <= value < _MOST_BYTES,
    ),
    **dict.fromkeys(
        ("seconds", "max_error_relative", "max_error", "kg"),
        lambda value: type(value) in (int, float),
    ),
    **dict.fromkeys(
        ("input", "output", "output_sha256", "unit"), lambda value: isinstance(value, str)
    ),
    **dict.fromkeys(
        ("input_parts", "output_parts"),
        lambda value: all(type(size) is int for size in value.values()),
    ),
    "error": lambda value: isinstance(value, str) and bool(value.strip()),
    "exit": lambda value: type(value) is int and 0 < value < 256,
}


def _entry(given: Any) -> Facts:
    """Check the entry of a file; raise an error that `read_report` catches."""
    entry = dict(given)
    needed = {"input", "output"}
    if "error" in entry:
        needed |= {"error", "exit"}
    for name, fits in _FIELDS.items():
        if (name in needed or entry.get(name) is not None) and not fits(entry[name]):
            raise ValueError(f"{name} is {entry[name]!r}")
    _cells(entry, entry.get("unit", ""))
    return entry


def recorded(work: Work, task: Task, console: Console) -> Facts:
    """Do a task and record the state of input and output; skip it if both are as in `task.before`."""
    # The state before the work: an input that changes meanwhile is then done again by the next run.
    state, before = pipes.state_of(task.input), task.before
    as_before = before is not None and state is not None and before.get("input_state") == state
    # Dates tell whether an input changed, since inputs may be large; outputs are small enough for their digests.
    if before and as_before and before.get("output_sha256") == pipes.digest_of(before["output"]):
        return {**before, "resumed": True}
    apart = replace(console, kept=[])
    if task.output in task.doubtful:
        facts = _compared(work, task, apart)
    else:
        facts = work(task, apart)
    return {
        "notes": apart.kept,
        **facts,
        "input_state": state,
        "output_sha256": pipes.digest_of(facts["output"]),
    }


def _compared(work: Work, task: Task, console: Console) -> Facts:
    """The output exists: recompute and compare, in case a killed run wrote it."""
    path = Path(task.output)
    # The run may have been killed after the output got its name, and before the report had it. Encoding gives the same
    # bytes each time, so doing it again tells whether the file is ours.
    refuse = FileExistsError(
        errno.EEXIST, "the output differs from the report; -f overwrites it", task.output
    )
    if not path.is_file() or path.is_symlink():
        raise refuse
    with tempfile.TemporaryDirectory() as folder:
        second = str(Path(folder, path.name))
        facts = work(replace(task, output=second), console)
        if pipes.digest_of(second) != pipes.digest_of(task.output):
            raise refuse
    return {**facts, "output": task.output}


def totals(files: Sequence[Facts]) -> Facts:
    done = [facts for facts in files if facts.keys() - {"input", "output"} and "error" not in facts]
    taken, given = _bytes_of(done, "input"), _bytes_of(done, "output")
    ratio: float | None = None
    if given:
        ratio = taken / given
    return {
        "files": len(files),
        "done": len(done),
        "resumed": sum("resumed" in facts for facts in done),
        "failed": sum("error" in facts for facts in files),
        "input_bytes": taken,
        "output_bytes": given,
        "ratio": ratio,
        "largest_error": largest_error(done),
    }


def _bytes_of(files: Sequence[Facts], way: str) -> int:
    """Return the bytes of inputs or outputs; a file beside several of them counts once."""
    parts = [facts.get(f"{way}_parts") or {} for facts in files]
    again = sum(sum(each.values()) for each in parts) - sum(
        dict(chain.from_iterable(map(dict.items, parts))).values()
    )
    return sum(facts.get(f"{way}_bytes") or 0 for facts in files) - again


def largest_error(files: Sequence[Facts]) -> str:
    """The largest vertex error of files, in words; and distance of surfaces."""
    worst: dict[str, Facts] = {}
    unit = _unit(files)
    name, whole = "max_error", ""
    if not unit:
        name, whole = "max_error_relative", " of the diagonal"
    for facts in files:
        if facts.get("max_error_relative") is not None:
            kind = ""
            if facts.get("error_of") == "surfaces":
                kind = ", surfaces apart"
            # Distances of surfaces and errors of vertices are two measures, and have each a worst file.
            worst[kind] = max(worst.get(kind, facts), facts, key=lambda one: float(one[name]))
    return " and ".join(
        f"{_length(facts, unit)}{whole} ({facts['input']}{kind})" for kind, facts in worst.items()
    )


def _unit(files: Sequence[Facts]) -> str:
    """The unit that the errors of all files have; where they differ, errors are relative."""
    units: set[str] = {
        facts.get("unit", "") for facts in files if facts.get("max_error_relative") is not None
    }
    # Millimeters and inches have no common largest error.
    if len(units) != 1:
        return ""
    return units.pop()


def _length(facts: Facts, unit: str) -> str:
    if unit:
        return f"{facts['max_error']:.3g} {unit}"
    return f"{100 * facts['max_error_relative']:.3g} %"


def table(files: Sequence[Facts]) -> Iterator[str]:
    """Bytes, ratio, error and time of files, failures first, then the largest errors; lines of text."""
    # Failures and large errors first: a table of a thousand files is read from its top.
    rows = sorted(
        files, key=lambda facts: ("error" not in facts, -(facts.get("max_error_relative") or 0.0))
    )
    rows = rows[: max(_SHOWN, sum("error" in facts for facts in rows))]
    users = Counter(
        part for facts in files for way in _WAYS for part in facts.get(f"{way}_parts") or ()
    )
    shared = {part for part, count in users.items() if count > 1}
    unit, notes = _unit(files), sum(len(facts.get("notes") or ()) for facts in files)
    width = max([len(facts["input"]) for facts in rows] + [5])
    yield f"{'input':{width}} {'bytes':>12} {'to':>12} {'ratio':>7} {'error':>10} {'seconds':>8}"
    for facts in rows:
        yield f"{facts['input']:{width}} {_cells(_alone(facts, shared), unit)}"
    # Bytes of a shared image would count in each row, and the rows would add up to more than the sum.
    if shared:
        sizes = " -> ".join(str(_bytes_of_parts(files, way, shared)) for way in _WAYS)
        yield f"{counted(files=len(shared))} of several rows, which count once: {sizes} bytes"
    if left := len(files) - len(rows):
        yield f"and {left} more, with smaller errors, in the report"
    if notes:
        yield f"{counted(notes=notes)} on these files in the report"


def _alone(facts: Facts, shared: Set[str]) -> Facts:
    """The facts of a file without the bytes of those that others use, too."""
    less = {
        f"{way}_bytes": sum(
            size for part, size in (facts.get(f"{way}_parts") or {}).items() if part in shared
        )
        for way in _WAYS
    }
    return facts | {name: facts[name] - size for name, size in less.items() if size}


def _bytes_of_parts(files: Sequence[Facts], way: str, shared: Set[str]) -> int:
    """The bytes of the parts that several inputs or outputs share, each counted once."""
    sizes: dict[str, int] = {}
    for facts in files:
        sizes |= facts.get(f"{way}_parts") or {}
    return sum(size for part, size in sizes.items() if part in shared)


def _cells(facts: Facts, unit: str) -> str:
    if "error" in facts:
        return f"failed: {facts['error'].splitlines()[-1].removeprefix(facts['input'] + ': ')}"
    taken, given, farthest = map(facts.get, ("input_bytes", "output_bytes", "max_error_relative"))
    ratio, error, seconds = "", "", f"{facts.get('seconds') or 0.0:.2f}"
    if taken and given:
        ratio = f"{taken / given:.2f}"
    if farthest is not None:
        error = _length(facts, unit)
    if "resumed" in facts:
        seconds = "as it was"
    return f"{_size_cell(taken)} {_size_cell(given)} {ratio:>7} {error:>10} {seconds:>8}"


def _size_cell(size: int | None) -> str:
    if size is None:
        return " " * 12
    return f"{size:>12}"
