"""Import the project with one constant of one module changed, wherever it is used: also as a default, also by name."""

from __future__ import annotations

import ast
import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any


class _Changed(SourceFileLoader):
    """Loads a module whose constant is multiplied."""

    def __init__(self, module: str, path: str, name: str, factor: float) -> None:
        super().__init__(module, path)
        self._name, self._factor = name, factor

    def get_code(self, fullname: str) -> CodeType:
        tree = ast.parse(self.get_data(self.path), self.path)
        body: list[ast.stmt] = []
        found = 0
        for node in tree.body:
            body.append(node)
            if isinstance(node, ast.Assign) and self._name in (getattr(target, "id", "") for target in node.targets):
                found += 1
                body += ast.parse(
                    f"from {__name__} import times; {self._name} = times({self._name}, {self._factor!r})"
                ).body
        if found != 1:
            raise LookupError(f"{fullname} has no constant {self._name}")
        tree.body = body
        return compile(ast.fix_missing_locations(tree), self.path, "exec")


class _Finder(MetaPathFinder):
    def __init__(self, module: str, name: str, factor: float) -> None:
        self._module, self._name, self._factor = module, name, factor

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        spec = PathFinder.find_spec(fullname, path, target)
        if fullname == self._module and spec is not None and spec.origin is not None:
            spec.loader = _Changed(fullname, spec.origin, self._name, self._factor)
            return spec
        return None


def change(module: str, name: str, factor: float) -> None:
    """From now on `module`, which must not have been imported yet, has its constant `name` times `factor`."""
    if module in sys.modules:
        raise RuntimeError(f"{module} has been imported before its constant could be changed")
    sys.meta_path.insert(0, _Finder(module, name, factor))


def measure(figure: str, path: Path) -> list[tuple[float, float]]:
    """A figure of a file, in a process whose constants are as they shall be."""
    from tools.constants.figures import FIGURES  # imports what may have been changed

    return FIGURES[figure](path)


def times(value: Any, factor: float) -> Any:
    """A number or each of several times a factor; whole ones stay whole, and above zero."""
    if isinstance(value, tuple):
        return tuple(times(item, factor) for item in value)
    return max(1, round(value * factor)) if isinstance(value, int) else value * factor
