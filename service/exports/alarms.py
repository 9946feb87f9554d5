"""The table of alarms."""

from collections.abc import Iterator, Sequence
from functools import partial
from operator import attrgetter

from service.exports.paging import pages
from service.exports.tables import Table, number, text, time, whole
from service.storage.records import Alarm
from service.storage.repository import Repository
from service.storage.states import AlarmState

TABLE: Table[Alarm] = Table(
    "alarms",
    (
        time("raised_time", "when it was raised, the latest time", attrgetter("raised_ns")),
        time("cleared_time", "when its cause was gone; empty while it stands", attrgetter("cleared_ns")),
        text("priority", "priority", attrgetter("priority")),
        text("state", "what people and the plant's design made of it", attrgetter("state")),
        text("site", "site that it is about", attrgetter("site")),
        text("motor", "motor that it is about", attrgetter("motor")),
        text("ied", "relay that it is about", attrgetter("ied")),
        text("kind", "kind of alarm", attrgetter("kind")),
        text("subject", "record, file or cause that it is about", attrgetter("subject")),
        text("reason", "why it was raised", attrgetter("reason")),
        text("advice", "what to do", attrgetter("what_to_do")),
        number("value", "", "how bad its cause is, if it can grow", attrgetter("value")),
        whole("raises", "1", "how often it was raised", attrgetter("raises")),
        time("changed_time", "when its state changed", attrgetter("changed_ns")),
        text("changed_by", "who changed its state", attrgetter("changed_by")),
        text("comment", "what they said", attrgetter("comment")),
        time("shelved_until_time", "when its shelving ends", attrgetter("shelved_until_ns")),
        number("shelved_above", "", "value that ends its shelving", attrgetter("shelved_above")),
        text("suppressed_because", "why it calls nobody", attrgetter("suppressed_because")),
        text("part_of", "alarm that tells this one and others in one line", attrgetter("part_of")),
        text("recording_id", "recording that it is about", attrgetter("recording_id")),
        text("alarm_id", "id of the alarm", attrgetter("id")),
    ),
)


def alarms(
    repository: Repository,
    motors: Sequence[str] | None,
    *,
    relay: str | None = None,
    standing: bool | None = None,
    part_of: str | None = None,
) -> Iterator[Sequence[Alarm]]:
    """Return the alarms of these motors, one motor after another, or of all; latest first."""
    for motor in motors or (None,):
        of_motor = partial(repository.alarms, motor=motor, relay=relay, standing=standing, part_of=part_of)
        yield from pages(of_motor)


def open_alarms(
    repository: Repository,
    *,
    site: str | None = None,
    relay: str | None = None,
    motor: str | None = None,
    state: AlarmState | None = None,
) -> Iterator[Sequence[Alarm]]:
    """Return the alarms that are not over, what to act on first at the top."""
    return pages(partial(repository.open_alarms, site=site, relay=relay, motor=motor, state=state))
