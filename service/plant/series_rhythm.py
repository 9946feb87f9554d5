"""How often a relay is triggered, and how far apart, so that its records overlap and make up one long one."""

from dataclasses import dataclass
from math import ceil
from typing import Final

from service.plant.report_length import LEAST_PRE_TRIGGER_S

PRE_TRIGGER_USED: Final = 0.5
"""Share of the pre-trigger time between the end of a record and the next trigger.

The trigger may come so much too early, and the rest of the time too late, before records fail to overlap."""
MOST_TRIGGERS: Final = 100


@dataclass(frozen=True, slots=True)
class Rhythm:
    """How often a relay is triggered for a series, and how far apart [s]."""

    triggers: int
    period_s: float


class NoSeriesError(Exception):
    """A relay cannot make records that overlap; it says why."""


def rhythm_of(length: tuple[float, float] | None, seconds: float) -> Rhythm:
    """Return when to trigger for a record of so many seconds. Raises NoSeriesError.

    length: that of the relay's records, and the part of it before the trigger [s]; None where no record is
    known yet.
    """
    if length is None:
        raise NoSeriesError(
            "expected an earlier record, which tells how long its records are, found none; record the motor "
            "once, and ask again for a series"
        )
    duration_s, pre_trigger_s = length
    after_s = duration_s - pre_trigger_s
    if pre_trigger_s < LEAST_PRE_TRIGGER_S:
        raise NoSeriesError(
            f"expected records that begin {LEAST_PRE_TRIGGER_S:g} s or more before their trigger, found "
            f"{pre_trigger_s:.3g} s: records that follow each other would not overlap; set a longer "
            "pre-trigger time in the relay (PRE)"
        )
    period_s = after_s + PRE_TRIGGER_USED * pre_trigger_s
    triggers = max(1, ceil((seconds - duration_s) / period_s) + 1)
    if triggers > MOST_TRIGGERS:
        raise NoSeriesError(
            f"expected a series of at most {MOST_TRIGGERS} records, found {triggers} for {seconds:g} s; set "
            "longer records in the relay (LER)"
        )
    return Rhythm(triggers, period_s)
