"""The one door to the compiler: numba with a typed signature, cached beside the source."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar, cast

import numba

P = ParamSpec("P")
R = TypeVar("R")


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile to machine code at the first call; later processes load the cached code.

    `fastmath` lets the compiler contract and reorder sums (needed for fused multiply-add and vector lanes);
    no result here depends on signed zeros, infinities or the order of a sum.

    The cache notices a change in the file of a function, not in those of the functions it calls: after
    editing one, remove __pycache__.
    """
    return cast(
        Callable[P, R],
        numba.njit(cache=True, nogil=True, fastmath=True, error_model="numpy")(function),
    )
