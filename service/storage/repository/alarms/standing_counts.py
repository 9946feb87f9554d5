"""The numbers of standing alarms, kept in the transaction that raises or clears them."""

from collections import Counter
from collections.abc import Iterable

from sqlalchemy import event
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from service.storage.models import StandingAlarmCountRow
from service.storage.states import AlarmKind

_CHANGES = "changes of standing alarm counts"


def count_raised(session: Session, relay: str, kind: AlarmKind) -> None:
    """Count an alarm that stands now."""
    _changes(session)[relay, kind] += 1


def count_cleared(session: Session, cleared: Iterable[tuple[str, AlarmKind]]) -> None:
    """Count alarms, by relay and kind, that do not stand any more."""
    _changes(session).subtract(cleared)


def _changes(session: Session) -> Counter[tuple[str, AlarmKind]]:
    changes: Counter[tuple[str, AlarmKind]] = session.info.setdefault(_CHANGES, Counter())
    return changes


@event.listens_for(Session, "before_commit")
def _write_changes(session: Session) -> None:
    """Write the changed counts last in a transaction and in one order.

    So writers wait for each other briefly, and in no circle: the motors of a relay change its counts at once.
    """
    changes: Counter[tuple[str, AlarmKind]] = session.info.pop(_CHANGES, Counter())
    if not changes:
        return
    session.flush()
    insert = sqlite.insert if session.get_bind().dialect.name == "sqlite" else postgresql.insert
    for (relay, kind), change in sorted(changes.items()):
        if change:
            session.execute(
                insert(StandingAlarmCountRow)
                .values(ied=relay, kind=kind, number=change)
                .on_conflict_do_update(
                    index_elements=[StandingAlarmCountRow.ied, StandingAlarmCountRow.kind],
                    set_={"number": StandingAlarmCountRow.number + change},
                )
            )
