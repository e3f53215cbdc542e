"""The trace of a search: its estimates and trials, with reasons."""

import time
from dataclasses import dataclass


@dataclass(frozen=True)
class Event:
    """One line of the trace, with its reason. Sizes are bytes, times milliseconds."""

    action: str  # "estimate", "code", "draw", "end"
    way: str = ""
    step: float = 0.0
    size: float = 0.0
    error: float = 0.0  # the largest share of a bound
    milliseconds: float = 0.0
    reason: str = ""

    def __str__(self) -> str:
        if self.action == "end":
            words = "end"
            if self.way:
                words += f" {self.way}"
            return f"{words}: {self.reason}"
        words = f"{self.action} {self.way}, step {self.step:.4g}, {self.size:.0f} bytes"
        if self.action == "draw":
            words += f", {self.error:.3f} of its bound"
        words += f", {self.milliseconds:.1f} ms"
        if self.reason:
            words += f": {self.reason}"
        return words


class Trace(list[Event]):
    """All lines of all searches, in their order."""

    def __init__(self) -> None:
        super().__init__()
        self._last = time.perf_counter()

    def note(self, action: str, way: str = "", **facts: float | str) -> None:
        """Add a line, with the time since the line before."""
        now = time.perf_counter()
        self.append(Event(action, way, milliseconds=1e3 * (now - self._last), **facts))  # type: ignore[arg-type]
        self._last = now
