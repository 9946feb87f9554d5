"""Compilation of functions with numba, with typed signatures and a cache beside the source."""

from collections.abc import Callable
from contextlib import ExitStack
from typing import Any, ParamSpec, TypeVar, cast

import numba
from numba.core import event

from core.machines.compile_cache import ProgramCache
from core.machines.compile_watch import entered

P = ParamSpec("P")
R = TypeVar("R")

FAST_MATH = {"contract", "reassoc", "nsz", "arcp"}
"""Changes that LLVM may make to sums.

The flags nnan and ninf are left out, because they assume that no NaN or infinity occurs.
"""


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function to machine code at the first call; later processes load the cached code.

    FAST_MATH lets the compiler contract and reorder sums, which fused multiply-add and vector lanes need: no
    result here depends on the sign of a zero or on the order of a sum. NaN and infinity keep their meaning,
    because a candidate without a finite answer has to be told from the others.

    The cache notices a change in the function's module and in those that it imports.

    Parameters
    ----------
    function : callable
        The function, in the part of Python that numba knows.

    Returns
    -------
    callable
        The compiled function.
    """
    return _cached(numba.njit(nogil=True, fastmath=FAST_MATH, error_model="numpy")(function), function)


def compiled_as_written(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function to machine code that computes in the order in which it is written.

    Sums that the compiler may reorder come out differently, in the last bit, according to whether the
    function was compiled in this process or loaded from the cache. This is for results that are compared
    bit by bit.

    Parameters
    ----------
    function : callable
        The function, in the part of Python that numba knows.

    Returns
    -------
    callable
        The compiled function.
    """
    return _cached(numba.njit(nogil=True, error_model="numpy")(function), function)


def _cached(dispatcher: Any, function: Callable[P, R]) -> Callable[P, R]:
    dispatcher._cache = ProgramCache(function)  # noqa: SLF001  # as its own enable_caching() does
    _compilations.of += 1
    return cast(Callable[P, R], dispatcher)


class _Compilations(event.Listener):  # type: ignore[misc]  # numba has no types
    """Tells those who watch. numba compiles one function at a time, and within it those that it calls."""

    def __init__(self) -> None:
        self.of = 0
        self._ready = self._depth = 0
        self._entered = ExitStack()

    def on_start(self, event: Any) -> None:  # noqa: ARG002 - as numba calls it
        self._depth += 1
        if self._depth == 1:
            self._entered = entered(self._ready, self.of)

    def on_end(self, event: Any) -> None:
        if isinstance(getattr(event.data["dispatcher"], "_cache", None), ProgramCache):
            self._ready = min(self._ready + 1, self.of)
        self._depth -= 1
        if self._depth == 0:
            self._entered.close()


_compilations = _Compilations()
event.register("numba:compile", _compilations)
