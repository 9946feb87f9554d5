"""Stamps of what pages show: a stamp is another one when the page would show anything else.

Each comes from a few figures that the database finds without reading through a table that grows.
"""

import hashlib
from collections.abc import Collection, Iterable, Mapping
from enum import StrEnum
from typing import Any

from sqlalchemy import ColumnElement, Executable, Select, bindparam, func, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from core.units import NANOSECONDS_PER_SECOND
from service.storage.change_counter import ChangeCounter
from service.storage.models import (
    AlarmChangeRow,
    AlarmRow,
    ApiTokenRow,
    BaselineRow,
    ConditionEventRow,
    ConditionRow,
    IedRow,
    JobRow,
    MotorRow,
    NotificationRow,
    QuarantineRow,
    RecordingRequestRow,
    RecordingRow,
    RelayFindingsRow,
    StateCountRow,
    UserRow,
    UserSessionRow,
)
from service.storage.models.alarms import is_open
from service.storage.repository.sessions import Sessions
from service.storage.states import JobState, RecordingState


class Subject(StrEnum):
    """What stamps there are, besides one for each motor."""

    FLEET = "fleet"
    ALARMS = "alarms"
    RELAYS = "relays"
    RECORDINGS = "recordings"
    PEOPLE = "people"


class ChangeStampRows(Sessions):
    def change_counter(self) -> ChangeCounter:
        """Return the database's counter of changes, with a connection of its own."""
        return ChangeCounter(self._reading)

    def change_stamps(self, subjects: Collection[Subject]) -> Mapping[Subject, str]:
        """Return the stamps of these subjects."""
        with self._read() as session:
            return {subject: _stamp(session, QUERIES[subject]) for subject in subjects}

    def motor_stamps(self, motors: Collection[str]) -> Mapping[str, str]:
        """Return the stamps of these motors. One that there is not has one, too."""
        found = dict.fromkeys(motors, _digest("no such motor"))
        query = select(MotorRow.name, *_of_motor()).where(MotorRow.name.in_(sorted(motors)))
        with self._read() as session:
            for name, *figures in session.execute(query):
                found[name] = _digest(figures)
        return found


def _seconds(times_ns: ColumnElement[Any] | InstrumentedAttribute[Any]) -> ColumnElement[Any]:
    """Return the sum of times in seconds: of nanoseconds, no integer of 64 bits holds it."""
    return func.sum(times_ns // NANOSECONDS_PER_SECOND)


def _counts(*tables: str) -> Executable:
    query = select(StateCountRow.counted_table, StateCountRow.state, StateCountRow.number)
    of_tables = query.where(StateCountRow.counted_table.in_(tables))
    return of_tables.order_by(StateCountRow.counted_table, StateCountRow.state)


_IS_QUEUED = JobRow.state == bindparam(None, JobState.QUEUED, type_=JobRow.state.type, literal_execute=True)
"""As the partial index says it: SQLite takes such an index for its own words only."""

_CONDITIONS = select(
    func.count(),
    func.sum(ConditionRow.version),
    _seconds(ConditionRow.stood_ns),
    func.count(ConditionRow.problem),
)
_MOTORS = select(func.count()).select_from(MotorRow).where(MotorRow.in_service)
_LINKS = (
    select(IedRow.link_state, func.count(), _seconds(IedRow.link_changed_ns), func.count(IedRow.link_reason))
    .where(IedRow.in_service)
    .group_by(IedRow.link_state)
    .order_by(IedRow.link_state)
)
_CLOCKS = select(_seconds(IedRow.clock_measured_ns), func.count(IedRow.clock_quality))
_QUARANTINES = select(func.count(), _seconds(QuarantineRow.until_ns), func.sum(QuarantineRow.times))
_FINDINGS = select(func.count(), _seconds(RelayFindingsRow.found_ns))
_ALARMS = select(func.max(AlarmChangeRow.sequence))
_MESSAGES = select(func.max(NotificationRow.created_ns), func.max(NotificationRow.finished_ns))
_LOGINS = select(func.count(), _seconds(UserSessionRow.created_ns))
_USERS = select(UserRow.name, UserRow.roles, UserRow.disabled).order_by(UserRow.name)
_TOKENS = select(func.count(), _seconds(ApiTokenRow.created_ns))

QUERIES: Mapping[Subject, tuple[Executable, ...]] = {
    Subject.FLEET: (_MOTORS, _CONDITIONS, _LINKS, _ALARMS),
    Subject.ALARMS: (_ALARMS, _MESSAGES),
    Subject.RELAYS: (_LINKS, _CLOCKS, _QUARANTINES, _FINDINGS, _counts("recordings")),
    Subject.RECORDINGS: (_counts("recordings", "jobs"),),
    Subject.PEOPLE: (_LOGINS, _USERS, _TOKENS),
}


def _of_motor() -> list[ColumnElement[Any]]:
    """Return what a motor's page shows, in figures, as columns beside that of the motor's name."""
    name = MotorRow.name
    on_the_way = RecordingRow.state.in_((RecordingState.ANNOUNCED, RecordingState.FETCHED))
    latest_request = (
        select(RecordingRequestRow.state)
        .where(RecordingRequestRow.motor == name)
        .order_by(RecordingRequestRow.requested_ns.desc(), RecordingRequestRow.id.desc())
        .limit(1)
    )
    queries: list[Select[Any]] = [
        *(
            select(column).where(ConditionRow.motor == name)
            for column in (ConditionRow.version, ConditionRow.stood_ns, ConditionRow.problem)
        ),
        select(IedRow.link_state).where(IedRow.name == MotorRow.ied),
        *(
            select(figure).where(AlarmRow.motor == name, is_open())
            for figure in (func.count(AlarmRow.id), func.max(AlarmRow.changed_ns))
        ),
        select(func.max(RecordingRow.announced_ns)).where(RecordingRow.motor == name),
        select(func.count(RecordingRow.id)).where(RecordingRow.motor == name, on_the_way),
        select(func.max(RecordingRequestRow.requested_ns)).where(RecordingRequestRow.motor == name),
        latest_request,
        *(
            select(func.max(column)).where(ConditionEventRow.motor == name)
            for column in (ConditionEventRow.made_ns, ConditionEventRow.withdrawn_ns)
        ),
        select(BaselineRow.chosen_ns).where(BaselineRow.motor == name),
        select(func.count(JobRow.id)).where(JobRow.motor == name, _IS_QUEUED),
    ]
    return [query.scalar_subquery() for query in queries]


def _stamp(session: Session, queries: Iterable[Executable]) -> str:
    return _digest([session.execute(query).all() for query in queries])


def _digest(figures: object) -> str:
    return hashlib.blake2b(repr(figures).encode(), digest_size=9).hexdigest()
