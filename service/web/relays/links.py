"""A relay's link over some days: spans for the picture, and how much of the time it answered."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.units import NANOSECONDS_PER_DAY, SECONDS_PER_DAY
from service.pictures.link_timeline import LinkSpan, link_timeline
from service.storage.records import LinkChange
from service.storage.states import LinkState
from service.web.words import duration, percent

ALL_BUT_GAPS: Final = 0.99
"""A share of the time that is told as all of it: a service that starts again leaves gaps of seconds."""


@dataclass(frozen=True, slots=True)
class LinkHistory:
    """A link from a time until now.

    answered: the share of the known time in which the relay answered; None where nothing is known.
    known: the share of the whole time of which something is known.  outages: how often it stopped answering.
    """

    days: int
    spans: Sequence[LinkSpan]
    answered: float | None
    known: float
    outages: int

    @property
    def sentence(self) -> str:
        """Return the picture in words, for those who cannot see it too."""
        if self.answered is None:
            return f"No data of the link in the last {_days(self.days)}."
        times = {0: "no outage", 1: "one outage"}.get(self.outages, f"{self.outages} outages")
        whole = f"the last {_days(self.days)}"
        if self.known <= ALL_BUT_GAPS:
            known = duration(round(self.known * self.days * SECONDS_PER_DAY))
            whole = f"the {known} that are known of {whole}"
        return f"The relay answered {_share(self.answered)} of {whole}, with {times}."

    def picture(self, relay: str) -> str:
        """Return the link as SVG."""
        return link_timeline(f"Link of {relay}. {self.sentence}", self.spans)


def link_history(changes: Sequence[LinkChange], *, days: int, now_ns: int) -> LinkHistory:
    """Return what the changes of a link say of the last days. changes: oldest first, with the one before."""
    from_ns = now_ns - days * NANOSECONDS_PER_DAY
    spans = _spans(changes, from_ns, now_ns)
    known = {LinkState.UP: 0, LinkState.DOWN: 0, LinkState.QUARANTINED: 0}
    for span in spans:
        if span.state in known:
            known[LinkState(span.state)] += span.end_ns - span.begin_ns
    known_ns = sum(known.values())
    states = [change.state for change in changes if from_ns <= change.changed_ns <= now_ns]
    before = [change.state for change in changes if change.changed_ns < from_ns]
    outages = sum(
        after is not LinkState.UP and was is LinkState.UP
        for was, after in zip([*before[-1:], *states], [*before[-1:], *states][1:], strict=False)
        if after is not LinkState.UNKNOWN
    )
    return LinkHistory(
        days=days,
        spans=spans,
        answered=known[LinkState.UP] / known_ns if known_ns else None,
        known=known_ns / (now_ns - from_ns),
        outages=outages,
    )


def _spans(changes: Sequence[LinkChange], from_ns: int, now_ns: int) -> list[LinkSpan]:
    """Return what each part of the time was, without gaps: a change of the reason alone begins no span."""
    spans: list[LinkSpan] = []
    at_ns, state = from_ns, None
    for change in changes:
        begin_ns = min(max(change.changed_ns, from_ns), now_ns)
        if change.state.value == state:
            continue
        if begin_ns > at_ns:
            spans.append(LinkSpan(at_ns, begin_ns, state))
        at_ns, state = begin_ns, change.state.value
    if now_ns > at_ns:
        spans.append(LinkSpan(at_ns, now_ns, state))
    return spans


def _share(answered: float) -> str:
    """Return a share in per cent; one that is short of all, or more than nothing, says so."""
    if 0.9995 <= answered < 1.0:
        return "more than 99.9 %"
    if 0.0 < answered < 0.0005:
        return "less than 0.1 %"
    return percent(answered, 1)


def _days(number: int) -> str:
    return "day" if number == 1 else f"{number} days"
