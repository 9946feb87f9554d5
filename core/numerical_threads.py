"""How many threads the library of linear algebra has.

Matrices are small here, and there is a worker for each core: more threads only wait for each other, which
takes processor time too.
"""

import os
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import cache, wraps
from typing import TYPE_CHECKING, Final, ParamSpec, TypeVar

if TYPE_CHECKING:
    from threadpoolctl import ThreadpoolController

P = ParamSpec("P")
R = TypeVar("R")

NAME: Final = "OPENBLAS_NUM_THREADS"
"""The environment variable that says how many."""


def use_one_thread() -> None:
    """Have one, unless the environment says otherwise. To be called before numpy is imported.

    It holds for this process and for those that it starts.
    """
    os.environ.setdefault(NAME, "1")


def on_one_thread(function: Callable[P, R]) -> Callable[P, R]:
    """Have the library use one thread while the function runs, whoever calls it.

    Other threads of the process that compute meanwhile have one each, too.
    """

    @wraps(function)
    def held(*args: P.args, **kwargs: P.kwargs) -> R:
        with _one_thread():
            return function(*args, **kwargs)

    return held


def _one_thread() -> AbstractContextManager[object]:
    if os.environ.get(NAME) == "1":
        return nullcontext()
    limit: AbstractContextManager[object] = _controller().limit(limits=1, user_api="blas")
    return limit


@cache
def _controller() -> "ThreadpoolController":
    """Return what finds the libraries that are loaded: numpy's, at the first call of what computes."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
