"""The clock for leases: the time since this machine started, suspended time included.

`time.monotonic` stands still while the machine is suspended. A process that measured its lease by it would
go on after a resume as if no time had passed, while others have taken over what it held.
"""

import time


def boot_time_s() -> float:
    """Return the time since the machine started, also that in which it was suspended [s]."""
    return time.clock_gettime(time.CLOCK_BOOTTIME)
