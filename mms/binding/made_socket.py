"""The socket that the MMS library makes when it connects, as one of our own.

The library keeps its socket to itself, but an event loop has to wait on it, and a connection that must end is
shut down there. So the socket is looked for right after it was made, under a lock that all connects of this
process share: it is the one that no earlier connect has made and that bears the library's marks.
"""

import errno
import os
import resource
import socket
import stat
import threading
from collections.abc import Callable, Iterator
from fcntl import F_DUPFD_CLOEXEC, fcntl
from itertools import chain
from pathlib import Path
from typing import Final

_DESCRIPTORS: Final = Path("/proc/self/fd")
_USER_TIMEOUT_MS: Final = 10_000
"""TCP_USER_TIMEOUT that the library gives each of its sockets; nobody else here sets this option so."""
_FIRST_OF_OURS: Final = 1024
"""The library waits for its sockets by select(2), which knows lower numbers only. Duplicates stand above."""
_NEARBY: Final = 8
"""Descriptors looked at before all are: others may have been opened meanwhile."""

_making: Final = threading.Lock()
_made: Final[set[int]] = set()
"""Inodes of the sockets that were found and are still held."""


class DescriptorsExhaustedError(OSError):
    """The library has no descriptor left that it can use."""


def made_socket(connect: Callable[[], object], peer: tuple[str, int]) -> socket.socket | None:
    """Find the socket that a call of the library makes.

    Parameters
    ----------
    connect : callable
        Calls a function of the library that makes one TCP socket and begins to connect it.
    peer : tuple of str and int
        IPv4 address and port to which it connects.

    Returns
    -------
    socket.socket or None
        A duplicate of the socket, to be given to `let_go`. None if the library has closed its socket again.

    Raises
    ------
    DescriptorsExhaustedError
        No socket can be made, or it has a number that the library cannot wait for. The caller destroys the
        connection.
    """
    with _making:
        lowest = _lowest_free()
        connect()
        for descriptor in chain(range(lowest, lowest + _NEARBY), _descriptors()):
            found = _duplicate(descriptor, peer)
            if found is None:
                continue
            if descriptor >= _FIRST_OF_OURS:
                found.close()
                raise DescriptorsExhaustedError(
                    f"the MMS library can use descriptors below {_FIRST_OF_OURS} only, and so many files are "
                    "open in this process: expected fewer relays a process"
                )
            _made.add(os.fstat(found.fileno()).st_ino)
            return found
    return None


def let_go(made: socket.socket) -> None:
    """Close the duplicate of a socket. The library's own stays open until the library closes it.

    Parameters
    ----------
    made : socket.socket
        The result of `made_socket`. A second call does nothing.
    """
    if made.fileno() < 0:
        return
    with _making:
        _made.discard(os.fstat(made.fileno()).st_ino)
        made.close()


def _lowest_free() -> int:
    """Return the number that the next file or socket gets."""
    try:
        lowest = os.open(os.devnull, os.O_RDONLY | os.O_CLOEXEC)
    except OSError as error:
        raise DescriptorsExhaustedError(_full(error)) from error
    os.close(lowest)
    return lowest


def _full(error: OSError) -> str:
    return f"no socket can be opened: {error.strerror}"


def _descriptors() -> Iterator[int]:
    """List the descriptors of this process, the latest first."""
    yield from sorted((int(entry.name) for entry in _DESCRIPTORS.iterdir()), reverse=True)


def _duplicate(descriptor: int, peer: tuple[str, int]) -> socket.socket | None:
    """Return a duplicate of the descriptor if it is a socket of the library that nobody has found yet."""
    try:
        found = os.fstat(descriptor)
    except OSError:  # no such descriptor
        return None
    if not stat.S_ISSOCK(found.st_mode) or found.st_ino in _made:
        return None
    try:
        candidate = socket.socket(fileno=fcntl(descriptor, F_DUPFD_CLOEXEC, _lowest_of_ours()))
    except OSError as error:
        if error.errno == errno.EMFILE:
            raise DescriptorsExhaustedError(_full(error)) from error
        return None  # closed meanwhile
    try:
        if _is_of_library(candidate, peer):
            return candidate
    except OSError:  # no TCP socket, or no connection any more
        pass
    candidate.close()
    return None


def _is_of_library(candidate: socket.socket, peer: tuple[str, int]) -> bool:
    if (candidate.family, candidate.type) != (socket.AF_INET, socket.SOCK_STREAM):
        return False
    if candidate.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT) != _USER_TIMEOUT_MS:
        return False
    if candidate.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN):
        return False
    try:
        return bool(candidate.getpeername() == peer)
    except OSError:  # it is not connected yet
        return True


def _lowest_of_ours() -> int:
    """Return the least number for a duplicate: above the library's if this process may open so many files."""
    soft, _hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    return _FIRST_OF_OURS if soft > 2 * _FIRST_OF_OURS else 0
