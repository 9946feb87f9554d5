"""An alarm as a message tells it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from core.error_words import one_line
from core.terms import phrase

CALLS = ("raised", "reopened")
"""Somebody has to act on these."""


@dataclass(frozen=True, slots=True)
class ToldAlarm:
    """What happened to an alarm, and what it is about. Texts are on one line each, whoever wrote them."""

    id: str
    event: str
    time_ns: int
    by: str
    comment: str | None
    kind: str
    priority: str
    site: str | None
    ied: str | None
    motor: str | None
    subject: str
    reason: str
    advice: str | None
    recording_id: str | None
    state: str
    standing: bool
    raised_ns: int
    raises: int

    @property
    def place(self) -> str:
        """Return what the alarm is about: a motor, a relay, a site, or the service itself."""
        return self.motor or self.ied or self.site or "the service"

    @property
    def words(self) -> str:
        """Return the kind in words."""
        return phrase(self.kind)

    @property
    def calls(self) -> bool:
        """Tell whether somebody has to act."""
        return self.event in CALLS

    @property
    def what(self) -> str:
        """Return what happened, in words."""
        match self.event:
            case "raised":
                return self.words
            case "reopened":
                return f"{self.words}, worse than before"
            case "cleared":
                return f"{self.words} is over"
            case "acknowledged":
                return f"{self.words}, acknowledged by {self.by}"
        return f"{self.words}, {self.event}"


def told_alarms(document: Mapping[str, object]) -> Sequence[ToldAlarm]:
    """Return the alarms that a message's document lists, the most urgent first."""
    listed = document.get("alarms")
    return [_of(one) for one in listed] if isinstance(listed, list) else []


def _of(facts: Mapping[str, object]) -> ToldAlarm:
    def text(key: str) -> str | None:
        found = facts.get(key)
        return one_line(str(found)) if found is not None else None

    def number(key: str) -> int:
        found = facts.get(key)
        return found if isinstance(found, int) else 0

    return ToldAlarm(
        id=text("id") or "",
        event=text("event") or "",
        time_ns=number("time_ns"),
        by=text("by") or "",
        comment=text("comment"),
        kind=text("kind") or "",
        priority=text("priority") or "",
        site=text("site"),
        ied=text("ied"),
        motor=text("motor"),
        subject=text("subject") or "",
        reason=text("reason") or "",
        advice=text("advice"),
        recording_id=text("recording_id"),
        state=text("state") or "",
        standing=facts.get("standing") is True,
        raised_ns=number("raised_ns"),
        raises=number("raises"),
    )
