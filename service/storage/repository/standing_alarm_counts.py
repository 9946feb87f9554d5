"""The numbers of standing alarms, kept in the transaction that raises or clears them."""

from collections import Counter
from collections.abc import Iterable

from sqlalchemy import update
from sqlalchemy.orm import Session

from service.storage.models import StandingAlarmCountRow
from service.storage.states import AlarmKind


def count_raised(session: Session, relay: str, kind: AlarmKind) -> None:
    """Count an alarm that stands now. Whoever calls it has locked the relay's row."""
    row = session.get(StandingAlarmCountRow, (relay, kind))
    if row is None:
        session.add(StandingAlarmCountRow(ied=relay, kind=kind, number=1))
    else:
        _add(session, relay, kind, 1)


def count_cleared(session: Session, cleared: Iterable[tuple[str, AlarmKind]]) -> None:
    """Count alarms, by relay and kind, that do not stand any more."""
    for (relay, kind), number in sorted(Counter(cleared).items()):
        _add(session, relay, kind, -number)


def _add(session: Session, relay: str, kind: AlarmKind, change: int) -> None:
    session.execute(
        update(StandingAlarmCountRow)
        .where(StandingAlarmCountRow.ied == relay, StandingAlarmCountRow.kind == kind)
        .values(number=StandingAlarmCountRow.number + change)
    )
