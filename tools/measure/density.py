"""How dense the Python reads: expressions and statements a line, and names that say nothing about their value.

A limit on size alone makes lines dense. Libraries that are known to read well have 3.6 to 5.3 expressions and
statements a line, 2 to 9 conditional expressions and 2 to 36 comprehensions in 1,000 lines, and .5 to 18 bare
participles in 1,000 names.
"""

import ast
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

PARTICIPLES = frozenset(
    {
        "asked",
        "called",
        "done",
        "found",
        "given",
        "held",
        "kept",
        "known",
        "left",
        "made",
        "meant",
        "named",
        "near",
    }
    | {"other", "own", "said", "seen", "sent", "shown", "some", "taken", "told", "wanted", "whole"}
)
"""Words that are names without a noun."""
COMPREHENSIONS = (ast.ListComp, ast.GeneratorExp, ast.SetComp, ast.DictComp)
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


@dataclass(frozen=True)
class Density:
    """Counts over some sources."""

    lines: int = 0
    """Lines of code: neither blank, nor comments, nor docstrings."""
    nodes: int = 0
    """Expressions and statements."""
    conditionals: int = 0
    """Conditional expressions."""
    comprehensions: int = 0
    names: Counter[str] = field(default_factory=Counter)
    """How often each name stands."""

    def __add__(self, other: "Density") -> "Density":
        """Add the counts of other sources."""
        return Density(
            self.lines + other.lines,
            self.nodes + other.nodes,
            self.conditionals + other.conditionals,
            self.comprehensions + other.comprehensions,
            self.names + other.names,
        )

    @property
    def figures(self) -> tuple[float, float, float, float]:
        """Nodes a line; conditionals and comprehensions in 1,000 lines; participles in 1,000 names."""
        lines = max(self.lines, 1)
        participles = sum(self.names[word] for word in PARTICIPLES)
        return (
            self.nodes / lines,
            1000 * self.conditionals / lines,
            1000 * self.comprehensions / lines,
            1000 * participles / max(self.names.total(), 1),
        )


def measure_density(text: str) -> Density:
    """Count what a source in Python has."""
    nodes = list(ast.walk(ast.parse(text)))
    described = _docstring_lines(nodes)
    lines = 0
    for number, line in enumerate(text.split("\n"), 1):
        content = line.strip()
        if content and not content.startswith("#") and number not in described:
            lines += 1
    return Density(
        lines,
        _count(nodes, (ast.expr, ast.stmt)),
        _count(nodes, (ast.IfExp,)),
        _count(nodes, COMPREHENSIONS),
        Counter(
            _name(node) for node in nodes if isinstance(node, ast.Name | ast.arg | ast.Attribute)
        ),
    )


def _count(nodes: Iterable[ast.AST], kinds: tuple[type[ast.AST], ...]) -> int:
    return sum(isinstance(node, kinds) for node in nodes)


def _name(node: ast.Name | ast.arg | ast.Attribute) -> str:
    if isinstance(node, ast.Name):
        return node.id
    return node.arg if isinstance(node, ast.arg) else node.attr


def _docstring_lines(nodes: Iterable[ast.AST]) -> set[int]:
    numbers: set[int] = set()
    for node in nodes:
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            docstring = node.body[0]
            numbers.update(range(docstring.lineno, (docstring.end_lineno or docstring.lineno) + 1))
    return numbers
