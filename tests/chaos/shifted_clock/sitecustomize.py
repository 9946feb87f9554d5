"""On a service's PYTHONPATH: its wall clock, in all its Python processes, is off by what a file says [s].

Only the wall clock: clocks that only go forward stay right, as when somebody sets a host's time.
So do the times of files.
"""

import os
import time
from pathlib import Path

_right_s, _right_ns = time.time, time.time_ns


def _offset_s() -> int:
    try:
        return int(Path(os.environ["CHAOS_CLOCK_OFFSET"]).read_text() or "0")
    except (OSError, ValueError):
        return 0


time.time = lambda: _right_s() + _offset_s()
time.time_ns = lambda: _right_ns() + _offset_s() * 1_000_000_000
