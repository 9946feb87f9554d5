"""The numbers of standing alarms, kept in the transaction that raises or clears them."""

from collections import Counter
from collections.abc import Iterable

from sqlalchemy import update
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from service.storage.models import StandingAlarmCountRow
from service.storage.states import AlarmKind


def count_raised(session: Session, relay: str, kind: AlarmKind) -> None:
    """Count an alarm that stands now; whoever else counts one of this kind at this relay waits."""
    insert = sqlite.insert if session.get_bind().dialect.name == "sqlite" else postgresql.insert
    session.execute(
        insert(StandingAlarmCountRow)
        .values(ied=relay, kind=kind, number=1)
        .on_conflict_do_update(
            index_elements=[StandingAlarmCountRow.ied, StandingAlarmCountRow.kind],
            set_={"number": StandingAlarmCountRow.number + 1},
        )
    )


def count_cleared(session: Session, cleared: Iterable[tuple[str, AlarmKind]]) -> None:
    """Count alarms, by relay and kind, that do not stand any more."""
    for (relay, kind), number in sorted(Counter(cleared).items()):
        session.execute(
            update(StandingAlarmCountRow)
            .where(StandingAlarmCountRow.ied == relay, StandingAlarmCountRow.kind == kind)
            .values(number=StandingAlarmCountRow.number - number)
        )
