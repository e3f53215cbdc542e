"""How the types that `import bsm` hands out are called, wherever they live."""

from typing import TypeVar

Kind = TypeVar("Kind", bound=type)


def public(kind: Kind) -> Kind:
    """Let a type be printed and pickled by the name that users import it by, ``bsm.TriangleMesh`` for instance."""
    kind.__module__ = __name__.partition(".")[0]
    return kind
