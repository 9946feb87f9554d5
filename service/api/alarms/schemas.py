"""Documents of alarms, of what people do about them, and of their key figures."""

from datetime import UTC, datetime
from typing import Annotated
from urllib.parse import quote
from uuid import UUID

from pydantic import BeforeValidator, Field, computed_field, model_validator

from core.units import NANOSECONDS_PER_SECOND
from service.api.document import Document, Listed, Reason, RequestDocument
from service.api.times import Time, TimeParameter
from service.storage.states import AlarmEvent, AlarmKind, AlarmPriority, AlarmState

MOST_AT_ONCE = 100
"""So many alarms may be acknowledged in one request."""


class AlarmLinks(Document):
    """Where to look further: addresses of this API. null: the alarm is not about one."""

    motor: str | None
    ied: str | None
    recording: str | None
    part_of: str | None


class Alarm(Document):
    """What somebody has to look after; its cause stands while `cleared_time` is null.

    state: what people and the plant's design have made of it. site, ied, motor: null where it is not about
    one. subject: the record or file it is about, as printable text, empty where it is about the relay; of a
    motor's condition (`condition-...`), its cause. cause, consequence: of all of its kind, in a sentence.
    advice: what to do. recording: the one that shows it.
    value: how bad the cause is, where it can grow; seen_value: when somebody acknowledged or shelved it.
    raised_time: the latest; raises: how often. changed_...: the latest change of the state, by whom and with
    which comment. shelved_until, shelved_above: the time and the value that end the shelving.
    suppressed_because: why the plant's design suppresses it. part_of: the alarm that tells it with others.
    links: addresses of its motor, relay, recording and of that alarm.
    """

    id: str
    site: str | None
    ied: str | None
    motor: str | None
    kind: AlarmKind
    priority: AlarmPriority
    state: AlarmState
    standing: bool
    subject: str
    reason: str
    cause: str
    consequence: str
    advice: str = Field(validation_alias="what_to_do")
    recording: str | None = Field(validation_alias="recording_id")
    value: float | None
    seen_value: float | None
    raised_time: Time = Field(validation_alias="raised_ns")
    raises: int
    cleared_time: Time | None = Field(validation_alias="cleared_ns")
    changed_time: Time = Field(validation_alias="changed_ns")
    changed_by: str
    comment: str | None
    shelved_until: Time | None = Field(validation_alias="shelved_until_ns")
    shelved_above: float | None
    suppressed_because: str | None
    part_of: str | None

    @computed_field
    def links(self) -> AlarmLinks:
        """Return where to look further."""
        return AlarmLinks(
            motor=_address("motors", self.motor),
            ied=_address("ieds", self.ied),
            recording=_address("recordings", self.recording),
            part_of=_address("alarms", self.part_of),
        )


def _address(collection: str, name: str | None) -> str | None:
    return None if name is None else f"/api/v1/{collection}/{quote(name, safe='')}"


class AlarmChange(Document):
    """One thing that happened to an alarm; `sequence` goes up with each, of all alarms."""

    sequence: int
    time: Time = Field(validation_alias="changed_ns")
    event: AlarmEvent
    before: AlarmState
    after: AlarmState
    by: str
    comment: str | None


class Remark(RequestDocument):
    """What somebody says who does something about an alarm; nothing needs to be said."""

    comment: Reason | None = None


class AcknowledgementRequest(Remark):
    """Several alarms that somebody takes notice of, by their ids."""

    alarms: Annotated[list[UUID], Field(min_length=1, max_length=MOST_AT_ONCE)]


class Refusal(Document):
    """An alarm that could not be acknowledged, and why."""

    alarm: str
    detail: str


class Acknowledgements(Document):
    """The alarms that were acknowledged, and those for which that was not possible."""

    acknowledged: Listed[Alarm]
    refused: Listed[Refusal]


class UndoRequest(Document):
    """Alarms whose acknowledgement was a mistake."""

    alarms: Annotated[list[UUID], Field(min_length=1, max_length=MOST_AT_ONCE)]


class UndoneAcknowledgements(Document):
    """The alarms that call again, and those for which that was not possible."""

    undone: Listed[Alarm]
    refused: Listed[Refusal]


class ShelvingRequest(Remark):
    """What ends the shelving: a time, or growth of the alarm's value by so much; the first of both."""

    until: TimeParameter | None = None
    growth: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None

    @model_validator(mode="after")
    def _has_an_end(self) -> "ShelvingRequest":
        if self.until is None and self.growth is None:
            raise ValueError("expected `until`, a time, or `growth`: a shelving always has an end")
        return self


def _date(nanoseconds: object) -> object:
    if not isinstance(nanoseconds, int):
        return nanoseconds
    return f"{datetime.fromtimestamp(nanoseconds // NANOSECONDS_PER_SECOND, UTC):%Y-%m-%d}"


Date = Annotated[str, BeforeValidator(_date), Field(json_schema_extra={"format": "date"})]


class AlarmsOfDay(Document):
    """How often alarms called for somebody on a day of UTC."""

    date: Date = Field(validation_alias="day_ns")
    calls: int


class AlarmCause(Document):
    """A cause of alarms, and how often it called."""

    site: str | None
    ied: str | None
    motor: str | None
    kind: AlarmKind
    subject: str
    calls: int


class AlarmFigures(Document):
    """Key figures of the alarms between two times.

    days: how often alarms called for somebody, oldest day first; calls_per_day: on average. frequent: the
    causes that called most often. chattering: those that called three times within an hour or more often,
    with how often they did. open: how many alarms are in each state. standing_long: those whose cause has
    stood for longer than a day, oldest first, the first of `standing_long_in_all`.
    """

    from_time: Time = Field(validation_alias="from_ns")
    to_time: Time = Field(validation_alias="to_ns")
    calls_per_day: float
    days: Listed[AlarmsOfDay]
    frequent: Listed[AlarmCause]
    chattering: Listed[AlarmCause]
    open: dict[AlarmState, int] = Field(validation_alias="by_state")
    standing_long: Listed[Alarm]
    standing_long_in_all: int
