"""Factors between units of time. Equations are in seconds, time stamps in nanoseconds."""

from typing import Final

NANOSECONDS_PER_SECOND: Final = 1_000_000_000
NANOSECONDS_PER_MILLISECOND: Final = 1_000_000
SECONDS_PER_MINUTE: Final = 60
SECONDS_PER_DAY: Final = 86_400
NANOSECONDS_PER_DAY: Final = SECONDS_PER_DAY * NANOSECONDS_PER_SECOND
