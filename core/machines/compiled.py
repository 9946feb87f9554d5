"""Compilation of functions with numba, with typed signatures and a cache beside the source."""

from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar, cast

import numba

from core.machines.compile_cache import ProgramCache

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
    return cast(Callable[P, R], dispatcher)
