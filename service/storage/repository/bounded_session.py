"""Sessions that see the rows of some sites alone, whatever is asked through them.

What belongs to no site, such as an alarm of the service itself, is not seen either. Tables that tell nothing
of the plant are seen whole.
"""

from collections.abc import Callable, Collection, Sequence
from functools import cache, partial
from typing import Any

from sqlalchemy import Engine, event, select
from sqlalchemy.orm import ORMExecuteState, Session, with_loader_criteria
from sqlalchemy.sql.base import ExecutableOption

from service.storage.models import (
    AlarmRow,
    ApiTokenRow,
    AuditEntryRow,
    AuditForwardingRow,
    AuditHeadRow,
    BackupRow,
    Base,
    DiscardedFolderRow,
    FailedLoginRow,
    GatewayRow,
    IedRow,
    JobRunnerRow,
    LoginLinkRow,
    MotorRow,
    PasskeyRow,
    RecordingRow,
    RecoveryCodeRow,
    SiteRow,
    StateCountRow,
    UsedOnceRow,
    UserRow,
    UserSessionRow,
)

OF_NO_SITE: frozenset[type[Base]] = frozenset(
    {
        ApiTokenRow,
        AuditEntryRow,
        AuditForwardingRow,
        AuditHeadRow,
        BackupRow,
        DiscardedFolderRow,
        FailedLoginRow,
        GatewayRow,
        JobRunnerRow,
        LoginLinkRow,
        PasskeyRow,
        RecoveryCodeRow,
        StateCountRow,
        UsedOnceRow,
        UserRow,
        UserSessionRow,
    }
)
"""Tables of the service and its users. Routes that show them ask for all sites, or are about people."""


class BoundedSession(Session):
    """Reads the rows of `sites`. Raises LookupError for a statement that goes past the mapped classes."""

    def __init__(self, engine: Engine, sites: Collection[str]) -> None:
        super().__init__(engine)
        self.bounds = bounds(frozenset(sites))


@event.listens_for(BoundedSession, "do_orm_execute")
def _bound(state: ORMExecuteState) -> None:
    session = state.session
    if not isinstance(session, BoundedSession):
        raise TypeError("expected a BoundedSession")
    if not state.is_select or not state.is_orm_statement:
        raise LookupError("a session of some sites reads mapped classes alone: other tables are not bounded")
    state.statement = state.statement.options(*session.bounds)


@cache
def bounds(sites: frozenset[str]) -> Sequence[ExecutableOption]:
    """Return what keeps the rows of other sites out of a statement, for each table."""
    return [
        with_loader_criteria(mapper.class_, condition, include_aliases=True)
        for mapper in Base.registry.mappers
        if (condition := _condition(mapper.class_, sites)) is not None
    ]


def _condition(table: type[Base], sites: frozenset[str]) -> Any:
    """Return what holds for the rows of a table at these sites; None where they are of no site.

    Raises LookupError for a table of which neither is known.
    """
    if table in OF_NO_SITE:
        return None
    if table is SiteRow:
        return SiteRow.name.in_(sites)
    for column, keys in _WAYS:
        if column in table.__table__.c:
            return getattr(table, column).in_(keys(sites))
    raise LookupError(f"table {table.__tablename__}: expected a column that leads to a site, or OF_NO_SITE")


def _keys(table: type[Base], sites: Collection[str]) -> Any:
    """Return a query for the keys of a table's rows at these sites."""
    (key,) = table.__table__.primary_key
    return select(key).where(table.__table__.c.site.in_(sites))


def _recordings(sites: Collection[str]) -> Any:
    columns = RecordingRow.__table__.c
    return select(columns.id).where(columns.motor.in_(_keys(MotorRow, sites)))


_WAYS: Sequence[tuple[str, Callable[[Collection[str]], Any]]] = (
    ("site", lambda sites: sites),
    ("motor", partial(_keys, MotorRow)),
    ("ied", partial(_keys, IedRow)),
    ("recording_id", _recordings),
    ("alarm", partial(_keys, AlarmRow)),
)
"""Columns that lead to a site, the nearest first; what of theirs is at given sites."""
