"""Filter that keeps the library's log of certificates out of standard error: some thirty lines a handshake.

The wheel's library is built with that log on, and there is no switch.
"""

import atexit
import os
import sys
import threading
from collections.abc import Iterator
from typing import Final

_STDERR: Final = 2
_MARK: Final = b"TLS: "
_CHUNK: Final = 65_536
_LAST_LINES_S: Final = 1.0


def filter_tls_log_from_stderr() -> None:
    """Filter the library's TLS log from standard error from now on.

    Call it once a process, before anything holds `sys.stderr`. Python writes to the same place as before.
    What C code writes passes through a thread, so the last words of a process that dies in C may be lost;
    whoever waits for the process still learns the signal.
    """
    real = os.dup(_STDERR)
    reading, writing = os.pipe()
    os.dup2(writing, _STDERR)
    os.close(writing)
    sys.stderr = os.fdopen(os.dup(real), "w", buffering=1, encoding="utf-8", errors="backslashreplace")
    passing_on = threading.Thread(target=_pass_on, args=(reading, real), name="stderr", daemon=True)
    passing_on.start()

    @atexit.register
    def pass_on_the_rest() -> None:
        os.dup2(real, _STDERR)
        passing_on.join(_LAST_LINES_S)


def _pass_on(reading: int, real: int) -> None:
    with os.fdopen(reading, "rb", buffering=_CHUNK) as lines:
        for line in without_tls_log(lines):
            os.write(real, line)


def without_tls_log(lines: Iterator[bytes]) -> Iterator[bytes]:
    """Leave out the lines of the library's TLS log.

    A log entry begins with "TLS: "; indented or empty lines continue it.

    Parameters
    ----------
    lines : iterator of bytes
        Lines of standard error.

    Yields
    ------
    bytes
        The other lines.
    """
    in_note = False
    for line in lines:
        in_note = line.startswith(_MARK) or (in_note and (line.startswith(b"  ") or not line.strip()))
        if not in_note:
            yield line
