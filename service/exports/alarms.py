"""The table of alarms."""

from collections.abc import Iterator, Sequence
from functools import partial
from operator import attrgetter

from service.exports.paging import pages
from service.exports.tables import Table, text, time
from service.storage.records import Alarm
from service.storage.repository import Repository

TABLE: Table[Alarm] = Table(
    "alarms",
    (
        time("raised_time", "when it was raised", attrgetter("raised_ns")),
        time("cleared_time", "when its cause was gone; empty while it stands", attrgetter("cleared_ns")),
        text("motor", "motor that it is about", attrgetter("motor")),
        text("ied", "relay that it is about", attrgetter("ied")),
        text("kind", "kind of alarm", attrgetter("kind")),
        text("subject", "record, file or cause that it is about", attrgetter("subject")),
        text("reason", "why it was raised", attrgetter("reason")),
        text("advice", "what to do", attrgetter("advice")),
        text("alarm_id", "id of the alarm", attrgetter("id")),
    ),
)


def alarms(
    repository: Repository,
    motors: Sequence[str] | None,
    *,
    relay: str | None = None,
    standing: bool | None = None,
) -> Iterator[Sequence[Alarm]]:
    """Return the alarms of these motors, one motor after another, or of all; latest first."""
    for motor in motors or (None,):
        yield from pages(partial(repository.alarms, motor=motor, relay=relay, standing=standing))
