"""One typed way to machine code."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar, cast

from numba import njit

P = ParamSpec("P")
R = TypeVar("R")


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile `function` with Numba, cached on disk; it runs without the GIL, so relays work side by side."""
    return cast(Callable[P, R], njit(cache=True, nogil=True)(function))
