"""Parameters followed while motors run: kept with their conditions, and listed."""

from dataclasses import fields
from typing import Any, Final

from sqlalchemy import Select, exists, select
from sqlalchemy.orm import Session

from core.starts.examined import StartParameters
from core.tracking.finding import TrackedParameters
from service.storage.models import Base, ConditionRow, MotorRow, ObservationRow, StartRow
from service.storage.records import Cursor, FollowedStart, Page, TrackedPoint
from service.storage.repository.conditions.fold_marks import mark
from service.storage.repository.history.start_documents import start_parameters
from service.storage.repository.sessions import (
    Order,
    Sessions,
    columns_of,
    found,
    latest_of,
    page_of,
    within,
)

_OBSERVATIONS: Final = Base.metadata.tables["observations"]
_NAMES: Final = [field.name for field in fields(TrackedPoint)]
_FIGURES: Final = [name for name in _NAMES if name not in ("recording_id", "time_ns")]
_ORDER: Final[Order] = (ObservationRow.time_ns, ObservationRow.recording_id)


class TrackingRows(Sessions):
    def tracked_parameters(self, motor: str) -> TrackedParameters | None:
        """Return what a motor's records tell of its parameters; None before they do.

        Raises NotFoundError.
        """
        with self._read() as session:
            document = found(session, ConditionRow, motor, "motor").parameters
            return None if document is None else TrackedParameters.from_dict(document)

    def tracked_trend(
        self,
        motor: str,
        *,
        limit: int,
        from_ns: int | None = None,
        to_ns: int | None = None,
        after: Cursor | None = None,
    ) -> Page[TrackedPoint]:
        """Return changes of a motor's parameters after each record, oldest first, from_ns <= time < to_ns.

        A record that is not folded yet is not there. Raises NotFoundError.
        """
        query = _of_motor(motor).where(*within(ObservationRow.time_ns, from_ns, to_ns))
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, _ORDER, _point, limit=limit, after=after)

    def latest_tracked_points(self, motor: str, *, limit: int) -> tuple[TrackedPoint, ...]:
        """Return changes of a motor's parameters after its latest records, oldest first."""
        with self._read() as session:
            return latest_of(session, _of_motor(motor), _ORDER, _point, limit=limit)


def followed_starts(
    session: Session, motor: str, after_ns: int, before_ns: int | None
) -> tuple[FollowedStart, ...]:
    """Return what a motor's starts tell of its rotor, of times after the one and before the other."""
    query = (
        select(StartRow.time_ns, StartRow.model)
        .where(StartRow.motor == motor, StartRow.time_ns > after_ns, StartRow.is_from_rest)
        .order_by(StartRow.time_ns, StartRow.recording_id)
    )
    if before_ns is not None:
        query = query.where(StartRow.time_ns < before_ns)
    found_starts = (
        followed_start(time_ns, None if model is None else start_parameters(model))
        for time_ns, model in session.execute(query)
    )
    return tuple(one for one in found_starts if one is not None)


def followed_start(time_ns: int, parameters: StartParameters | None) -> FollowedStart | None:
    """Return what a start tells of the rotor; None where it does not tell both resistances."""
    ratio = None if parameters is None else parameters.rotor_over_stator
    return None if ratio is None else FollowedStart(time_ns, *ratio)


def follow_again(session: Session, motor: str, time_ns: int) -> None:
    """Have a motor's parameters followed again where a start is new or gone before its latest record."""
    later = exists().where(ObservationRow.motor == motor, ObservationRow.time_ns >= time_ns)
    if session.scalar(select(later)):
        mark(session, motor, time_ns)


def _of_motor(motor: str) -> Select[*tuple[Any, ...]]:
    return select(*columns_of(TrackedPoint, ObservationRow)).where(
        ObservationRow.motor == motor, ObservationRow.state.is_not(None)
    )


def _point(*values: Any) -> TrackedPoint:
    return TrackedPoint(**dict(zip(_NAMES, values, strict=True)))
