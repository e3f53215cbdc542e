"""How much of the paper came out: numbers that agree, and claims that hold."""

from __future__ import annotations

from dataclasses import dataclass

from tools.paper.exhibit import Exhibit


@dataclass(frozen=True)
class Score:
    """A line of the scoreboard."""

    name: str
    numbers: int
    agreeing: int
    claims: int
    holding: int

    @property
    def words(self) -> str:
        """The line in words."""
        said = []
        if self.numbers:
            said.append(f"{self.agreeing} of {self.numbers} numbers agree with the paper's")
        if self.claims:
            said.append(f"{self.holding} of {self.claims} claims hold")
        return ", ".join(said) or "no numbers in the paper"


def scores(exhibits: dict[str, Exhibit]) -> tuple[Score, ...]:
    """A line for each exhibit, and the sum of all as the last one."""
    lines = [
        Score(key, *exhibit.compared(), len(exhibit.claims), sum(claim.holds for claim in exhibit.claims))
        for key, exhibit in exhibits.items()
    ]
    return (
        *lines,
        Score(
            "in all",
            sum(line.numbers for line in lines),
            sum(line.agreeing for line in lines),
            sum(line.claims for line in lines),
            sum(line.holding for line in lines),
        ),
    )
