"""How long a click can be undone by who made it."""

from typing import Final

from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_MINUTE

UNDO_MINUTES: Final = 10
"""So long after it a click can be undone, by who made it: afterwards others count on it."""
UNDO_NS: Final = round(UNDO_MINUTES * SECONDS_PER_MINUTE * NANOSECONDS_PER_SECOND)
