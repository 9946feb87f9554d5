"""Python functions called from C: no exception crosses, and none of them calls back into the library."""

import logging
import threading
from collections.abc import Callable
from typing import Final, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

log: Final = logging.getLogger("mms")
_inside: Final[set[int]] = set()
"""Threads inside a callback. Thread-local data would be created anew at every call from a C thread."""


def guarded(function: Callable[P, R], failure: R) -> Callable[P, R]:
    """Wrap a function for C, so that no exception reaches C.

    An exception is logged and `failure` returned in its place. Without this, ctypes prints the exception and
    hands C an undefined value.

    Parameters
    ----------
    function : callable
        The function.
    failure : object
        Return value in place of an exception.

    Returns
    -------
    callable
        The wrapped function.
    """

    def called_from_c(*args: P.args, **kwargs: P.kwargs) -> R:
        thread = threading.get_ident()
        outermost = thread not in _inside
        _inside.add(thread)
        try:
            return function(*args, **kwargs)
        except Exception:  # C can carry no exception of any kind
            log.exception("exception in a callback from the MMS library")
            return failure
        finally:
            if outermost:
                _inside.discard(thread)

    return called_from_c


def inside_callback() -> bool:
    """Tell whether this thread is the library's, inside one of our callbacks.

    A synchronous request there would wait for an answer that only this same thread can receive.

    Returns
    -------
    bool
        True inside a callback.
    """
    return threading.get_ident() in _inside
