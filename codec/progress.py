"""How far work is, as far as anybody can tell."""

from collections.abc import Callable, Mapping

Progress = Callable[[int, int], None]
"""Is called with how much is done, and of how much in all."""

PARTS = 1000
STEP = 0.25  # of the rest, what a step of unknown length is thought to take


def silent(done: int, total: int) -> None:
    """No progress is reported."""


class Nearing:
    """Reports work of unknown length: each step takes its usual part of the rest."""

    def __init__(self, progress: Progress | None) -> None:
        self._progress, self._share = progress or silent, 0.0

    def at(self, share: float) -> None:
        """Report a share, which may be less than before."""
        self._share = share
        self._progress(int(PARTS * share), PARTS)

    def to(self, share: float) -> None:
        self.at(max(self._share, share))

    def by(self, part: float = STEP) -> None:
        self.to(self._share + part * (1.0 - self._share))

    def within(self, part: float = STEP) -> Progress:
        """Report a step of known length."""
        begin = self._share
        return lambda done, total: self.to(begin + part * (1.0 - begin) * done / max(total, 1))


class Stages:
    """Reports the progress of several stages as that of one task; each has the seconds that it is expected to take."""

    def __init__(self, progress: Progress | None, seconds: Mapping[str, float]) -> None:
        self._progress = progress or silent
        self._seconds = dict(seconds)
        self._shares = dict.fromkeys(seconds, 0.0)

    def expect(self, name: str, seconds: float) -> None:
        """Change how long a stage is expected to take, for instance as measured so far."""
        self._seconds[name] = seconds

    def report(self, name: str, share: float) -> None:
        """Report how much of a stage is done."""
        self._shares[name] = max(self._shares[name], share)
        total = sum(self._seconds.values())
        done = sum(seconds * self._shares[stage] for stage, seconds in self._seconds.items())
        self._progress(int(PARTS * done / total) if total > 0.0 else 0, PARTS)

    def of(self, name: str) -> Progress:
        """Return a function that reports the progress of a stage."""
        return lambda done, total: self.report(name, done / max(total, 1))
