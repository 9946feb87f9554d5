"""Whether a motor may run until its planned stop, in a line at the head of its page."""

from dataclasses import dataclass

from core.time_stamps import nanoseconds
from service.api.conditions.schemas import UntilStop
from service.client.until_stop import answer_of
from service.storage.records import StopOf
from service.web.words import day


@dataclass(frozen=True, slots=True)
class StopLine:
    """What the page says. stop_ns: the planned stop.  answer: in a sentence.  reasons: what it rests on."""

    stop_ns: int
    of: StopOf
    answer: str
    reasons: tuple[str, ...]


def stop_line(found: UntilStop | None, now_ns: int) -> StopLine | None:
    """Return what the page says of a motor's planned stop; None without one."""
    if found is None:
        return None
    # Where there is no probability, or a part is beyond its limit, the sentence has the first reason itself.
    beside = found.reasons if found.probability else found.reasons[1:]
    of_parts = [f"{one.part}: {one.reason}" for one in found.parts]
    reasons = [*of_parts, *(one for one in beside if one not in of_parts)]
    likely_ns = None if found.likely_until is None else nanoseconds(found.likely_until)
    if likely_ns is not None and likely_ns > now_ns:
        reasons.insert(0, f"90 % likely until {day(likely_ns)}")
    return StopLine(
        nanoseconds(found.stop),
        found.of,
        answer_of(found.probability, found.reasons),
        tuple(reasons),
    )
