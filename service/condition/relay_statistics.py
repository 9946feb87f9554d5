"""The relay's own statistics of a motor beside what the service counted in the same time."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from core.load.metered import LEAST_CURRENT
from core.machines.parameters import Motor
from core.quality import rated_current_A
from core.relay_reports import MotorStatistics
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY, SECONDS_PER_HOUR
from service.storage import Repository
from service.storage.records import MeteredHours

SAME_SHARE: Final = 0.02
SAME_HOURS: Final = 0.5
"""Running hours that are no farther apart agree: those of the service are quarters of an hour."""

RESET: Final = "the relay's counters may have been set anew, or the relay was without supply"
BY_RECORD: Final = "the service knows a start by its record or report"
GAPS: Final = "of some of the time nothing was measured"


@dataclass(frozen=True, slots=True)
class ComparedStatistics:
    """Statistics of a relay, and what the service counted since then.

    counted_starts, metered: None where the report does not tell since when.  remarks: where both disagree,
    and what is the likely reason.
    """

    told: MotorStatistics
    counted_starts: int | None
    metered: MeteredHours | None
    remarks: Sequence[str]


def compared_statistics(repository: Repository, motor: Motor) -> ComparedStatistics | None:
    """Return the latest statistics of a motor's relay beside the service's own; None without a report."""
    told = repository.latest_relay_statistics(motor.name)
    if told is None:
        return None
    if told.since_ns is None:
        return ComparedStatistics(told, None, None, ("the report does not tell since when the relay counts",))
    starts = len(repository.times_of_starts(motor.name, from_ns=told.since_ns, to_ns=told.time_ns))
    metered = repository.metered_hours(
        motor.name,
        least_current_A=LEAST_CURRENT * rated_current_A(motor.nameplate),
        from_ns=told.since_ns,
        to_ns=told.time_ns,
    )
    return ComparedStatistics(told, starts, metered, tuple(_remarks(told, starts, metered)))


def _remarks(told: MotorStatistics, starts: int, metered: MeteredHours) -> Iterator[str]:
    if told.starts is not None and told.starts != starts:
        reason = _why_fewer(told, metered, BY_RECORD) if told.starts > starts else RESET
        yield f"the relay counts {told.starts} starts, the service {starts}: {reason}"
    if told.running_s is None:
        return
    hours = told.running_s / SECONDS_PER_HOUR
    if abs(hours - metered.running_hours) > max(SAME_HOURS, SAME_SHARE * hours):
        reason = _why_fewer(told, metered, GAPS) if hours > metered.running_hours else RESET
        own = f"the service {metered.running_hours:.1f} h"
        yield f"the relay counts {hours:.1f} h running, {own}: {reason}"


def _why_fewer(told: MotorStatistics, metered: MeteredHours, otherwise: str) -> str:
    """Return the likely reason why the service counts less than the relay."""
    if metered.first_ns is None:
        return "the service has measured nothing in that time"
    if told.since_ns is not None and metered.first_ns > told.since_ns + NANOSECONDS_PER_DAY:
        return f"the service has measured values from {rfc3339(metered.first_ns)[:16]}Z on only"
    return otherwise
