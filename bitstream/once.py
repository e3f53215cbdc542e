"""`functools.cached_property` without the lock that a class shares in Python 3.11, which threads and forks wait for."""

from collections.abc import Callable
from copy import copy
from typing import Any, Generic, TypeVar, overload

Value = TypeVar("Value")
Self = TypeVar("Self")


class cached_property(Generic[Value]):
    """A method that is called at the first access; its result is kept as an attribute of the same name."""

    def __init__(self, work: Callable[[Any], Value]) -> None:
        self._work = work
        self.__doc__ = work.__doc__

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self: Self, instance: None, owner: type | None = None) -> Self: ...
    @overload
    def __get__(self, instance: object, owner: type | None = None) -> Value: ...
    def __get__(self, instance: object | None, owner: type | None = None) -> Any:
        if instance is None:
            return self
        value = self._work(instance)
        # A descriptor without __set__ gives way to the attribute: after the first access no call is left. Two threads
        # may both compute the value; it is the same.
        instance.__dict__[self._name] = value
        return value


def with_results(instance: Self, **known: Any) -> Self:
    """Return a copy with other fields and results of cached properties; all else that was computed stays."""
    other = copy(instance)
    for name, value in known.items():
        if name not in vars(instance) and not hasattr(type(instance), name):
            raise AttributeError(name)
        # Not setattr, which a frozen class refuses: this copy is still ours alone.
        object.__setattr__(other, name, value)
    return other
