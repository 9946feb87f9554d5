"""Linux capabilities of this process: what it does not need it gives up (capabilities(7))."""

import ctypes
import os
import sys
from collections.abc import Collection
from enum import IntEnum
from typing import Final

_VERSION_3: Final = 0x20080522
_WORDS: Final = 2
_SET_NO_NEW_PRIVILEGES: Final = 38


class Capability(IntEnum):
    """Those that a process of the service may have use for."""

    NET_BIND_SERVICE = 10
    """Ports below 1024."""
    NET_RAW = 13
    """Raw sockets."""


class _Header(ctypes.Structure):
    _fields_ = (("version", ctypes.c_uint32), ("process", ctypes.c_int))


class _Word(ctypes.Structure):
    _fields_ = (
        ("effective", ctypes.c_uint32),
        ("permitted", ctypes.c_uint32),
        ("inheritable", ctypes.c_uint32),
    )


def keep_only(kept: Collection[Capability]) -> None:
    """Give up all capabilities but these. Threads and processes that this thread starts have no others.

    No program that is started can bring one back, also not as root or by a file with capabilities. Nothing is
    inheritable then, so that nothing is ambient either. Raises OSError.
    """
    if sys.platform != "linux":
        return
    allowed = sum(1 << one for one in kept)
    libc = ctypes.CDLL(None, use_errno=True)
    _checked(libc.prctl(_SET_NO_NEW_PRIVILEGES, 1, 0, 0, 0))
    header, words = _Header(_VERSION_3, 0), (_Word * _WORDS)()
    _checked(libc.capget(ctypes.byref(header), words))
    given_up = False
    for place, word in enumerate(words):
        kept = word.permitted & (allowed >> (32 * place)) & 0xFFFFFFFF
        given_up |= word.permitted != kept
        word.permitted = word.effective = kept
        word.inheritable = 0
    if not given_up:
        return
    _checked(libc.capset(ctypes.byref(header), words))


def _checked(result: int) -> None:
    if result:
        number = ctypes.get_errno()
        raise OSError(number, f"capabilities: {os.strerror(number)}")
