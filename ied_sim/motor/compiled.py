"""A typed decorator for functions compiled to machine code."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar, cast

from numba import njit

P = ParamSpec("P")
R = TypeVar("R")


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function with Numba, cached on disk. It runs without the GIL, so relays work side by side."""
    return cast(Callable[P, R], njit(cache=True, nogil=True)(function))
