"""Python functions called from C: no exception crosses, and none of them calls back into the library."""

import logging
import threading
from collections.abc import Callable
from typing import Final, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

log: Final = logging.getLogger("mms")
_thread = threading.local()


def guarded(function: Callable[P, R], failure: R) -> Callable[P, R]:
    """`function` for C: an exception is logged and `failure` returned in its place.

    Without this, ctypes prints the exception and hands C an undefined value.
    """

    def called_from_c(*args: P.args, **kwargs: P.kwargs) -> R:
        _thread.depth = getattr(_thread, "depth", 0) + 1
        try:
            return function(*args, **kwargs)
        except Exception:  # whatever it is, C cannot carry it
            log.exception("exception in a callback from the MMS library")
            return failure
        finally:
            _thread.depth -= 1

    return called_from_c


def inside_callback() -> bool:
    """Whether this thread is the library's, inside one of our callbacks.

    A synchronous request there would wait for an answer only this same thread can receive.
    """
    return getattr(_thread, "depth", 0) > 0
