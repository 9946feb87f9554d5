"""The trend of a motor at any scale: all of its records where they are few, else pieces of time."""

import json
from typing import Final

from sqlalchemy import Text, case, cast, func, literal, select
from sqlalchemy.orm import Session

from core.condition.kinds import State
from service.storage.models import MotorRow, ObservationRow
from service.storage.records import ConditionPoint
from service.storage.records.history import ThinnedTrend, TrendPiece
from service.storage.repository.conditions.observations import point
from service.storage.repository.sessions import Sessions, columns_of, found, has_as_many, rows_of

MOST_POINTS: Final = 1000
PIECES: Final = 400
"""A screen has few more columns of pixels than twice as many."""

WORST: Final = (State.UNKNOWN, State.HEALTHY, State.WATCH, State.FAULT)


class ThinnedTrendRows(Sessions):
    def thinned_trend(
        self,
        motor: str,
        *,
        from_ns: int | None = None,
        to_ns: int | None = None,
        most_points: int = MOST_POINTS,
        pieces: int = PIECES,
    ) -> ThinnedTrend:
        """Return a motor's trend, from_ns <= time < to_ns, thinned where it has more than most_points.

        Records that are not folded yet are not among them. Raises NotFoundError.
        """
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            said = [ObservationRow.motor == motor, ObservationRow.state.is_not(None)]
            first_ns, last_ns = _extent(session, motor)
            if first_ns is None or last_ns is None:
                return ThinnedTrend(from_ns or 0, to_ns or 0, 0)
            first_ns = first_ns if from_ns is None else from_ns
            end_ns = last_ns + 1 if to_ns is None else to_ns
            within = [ObservationRow.time_ns >= first_ns, ObservationRow.time_ns < end_ns]
            query = select(*columns_of(ConditionPoint, ObservationRow)).where(*said, *within)
            ids = select(ObservationRow.recording_id).where(*said, *within)
            if not has_as_many(session, ids, most_points + 1):
                order = (ObservationRow.time_ns, ObservationRow.recording_id)
                rows = rows_of(session, query.order_by(*order))
                return ThinnedTrend(first_ns, end_ns, len(rows), points=tuple(point(*row) for row in rows))
            step_ns = max(1, -(-(end_ns - first_ns) // pieces))
            seen = _pieces(session, motor, first_ns, end_ns, step_ns)
            return ThinnedTrend(first_ns, end_ns, sum(one.records for one in seen), pieces=seen)


def _extent(session: Session, motor: str) -> tuple[int | None, int | None]:
    """Return the times of the first and the last record; an index has both at its ends."""
    of_motor = select(ObservationRow.time_ns).where(ObservationRow.motor == motor).limit(1)
    first = of_motor.order_by(ObservationRow.time_ns, ObservationRow.recording_id)
    last = of_motor.order_by(ObservationRow.time_ns.desc(), ObservationRow.recording_id.desc())
    return session.scalar(first), session.scalar(last)


def _pieces(session: Session, motor: str, first_ns: int, end_ns: int, step_ns: int) -> tuple[TrendPiece, ...]:
    """Return what each piece of time says.

    Each is one look into the index, in the order of time: to group the records takes four times as long, and
    to hand them all to Python ten times.
    """
    begins = select(literal(first_ns).label("begin_ns")).cte("pieces", recursive=True)
    begins = begins.union_all(select(begins.c.begin_ns + step_ns).where(begins.c.begin_ns + step_ns < end_ns))
    array = func.json_array if session.get_bind().dialect.name == "sqlite" else func.json_build_array
    rank = case({state: number for number, state in enumerate(WORST)}, value=ObservationRow.state)
    told = (
        select(
            cast(
                array(
                    func.count(),
                    func.min(ObservationRow.mu_f),
                    func.max(ObservationRow.mu_f),
                    func.min(ObservationRow.mu_f_ci95_low),
                    func.max(ObservationRow.mu_f_ci95_high),
                    func.max(rank),
                ),
                Text,
            )
        )
        .where(ObservationRow.motor == motor, ObservationRow.state.is_not(None))
        .where(ObservationRow.time_ns >= begins.c.begin_ns)
        .where(ObservationRow.time_ns < begins.c.begin_ns + step_ns)
        .where(ObservationRow.time_ns < end_ns)
        .scalar_subquery()
    )
    rows = rows_of(session, select(begins.c.begin_ns, told).order_by(begins.c.begin_ns))
    figures = json.loads(f"[{','.join(text for _, text in rows)}]")  # at once: a tenth of the time of each
    return tuple(
        TrendPiece(begin_ns, begin_ns + step_ns, records, lowest, highest, low, high, WORST[worst])
        for (begin_ns, _), (records, lowest, highest, low, high, worst) in zip(rows, figures, strict=True)
        if records
    )
