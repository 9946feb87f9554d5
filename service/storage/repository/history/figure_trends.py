"""The trend of each figure of the catalogue, and all figures of a subject, record by record."""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, Final, TypeVar

from sqlalchemy import ColumnElement, String, case, null, select, type_coerce
from sqlalchemy.orm import InstrumentedAttribute

from core.normal_distribution import NORMAL_95
from core.quantities import BY_NAME, Quantity, Role, Subject, beside, of_subject
from service.storage.models import (
    FIGURE_SUBJECTS,
    DiagnosisRow,
    MotorRow,
    ObservationRow,
    RecordFiguresRow,
    RotorFindingRow,
    details_of,
)
from service.storage.records import Cursor, Page
from service.storage.records.history import SubjectPoint, TrendPoint
from service.storage.repository.sessions import Order, Sessions, found, page_of, within

Point = TypeVar("Point")
Row = type[DiagnosisRow] | type[ObservationRow] | type[RotorFindingRow] | type[RecordFiguresRow]

_ROWS: Final[Mapping[Subject, Row]] = MappingProxyType(
    {
        Subject.STATOR: DiagnosisRow,
        Subject.CONDITION: ObservationRow,
        Subject.ROTOR: RotorFindingRow,
        Subject.PARAMETERS: ObservationRow,
        **dict.fromkeys(FIGURE_SUBJECTS, RecordFiguresRow),
    }
)
_WORDS: Final[Mapping[Subject, tuple[Any, ...]]] = MappingProxyType(
    {
        # The value of a Verdict is read in a fourth of the time of the Verdict.
        Subject.STATOR: (type_coerce(DiagnosisRow.verdict, String), *(null(),) * 4),
        Subject.CONDITION: (null(), ObservationRow.state, ObservationRow.kind, ObservationRow.phase, null()),
        Subject.ROTOR: (null(), RotorFindingRow.state, null(), null(), RotorFindingRow.reasons),
        Subject.PARAMETERS: (null(),) * 5,
        **{subject: (*(null(),) * 4, details_of(subject)["reasons"]) for subject in FIGURE_SUBJECTS},
    }
)
"""What is said beside a figure: verdict, state, kind, phase and reasons."""


class FigureTrendRows(Sessions):
    def trend(
        self,
        motor: str,
        quantity: str,
        *,
        limit: int,
        from_ns: int | None = None,
        to_ns: int | None = None,
        after: Cursor | None = None,
        descending: bool = False,
    ) -> Page[TrendPoint]:
        """Return a figure of each record that tells of its subject, oldest first, from_ns <= time < to_ns.

        quantity: the name of one that has a trend (core.quantities.TRENDED).  descending: newest first
        instead.  Records of a motor that stands, starts, stops or trips tell nothing of its winding; those
        that are not folded yet, nothing of its condition. Raises NotFoundError.
        """
        figure = BY_NAME[quantity]
        columns = (*_figures(figure), *_WORDS[figure.subject])
        return self._points(
            motor, figure.subject, columns, TrendPoint, from_ns, to_ns, limit, after, descending=descending
        )

    def subject_trend(
        self,
        motor: str,
        subject: Subject,
        *,
        limit: int,
        from_ns: int | None = None,
        to_ns: int | None = None,
        after: Cursor | None = None,
    ) -> Page[SubjectPoint]:
        """Return all figures of a subject of each record, in the order of the catalogue, oldest first.

        Raises NotFoundError.
        """
        columns = tuple(_column(one) for one in of_subject(subject))
        return self._points(motor, subject, columns, _subject_point, from_ns, to_ns, limit, after)

    def _points(
        self,
        motor: str,
        subject: Subject,
        columns: tuple[Any, ...],
        to_point: Callable[..., Point],
        from_ns: int | None,
        to_ns: int | None,
        limit: int,
        after: Cursor | None,
        *,
        descending: bool = False,
    ) -> Page[Point]:
        row = _ROWS[subject]
        time = _time(row)
        query = select(time, row.recording_id, *columns).where(
            row.motor == motor, *_tells(subject), *within(time, from_ns, to_ns)
        )
        last = DiagnosisRow.id if row is DiagnosisRow else row.recording_id
        order: Order = (time, last)
        with self._read() as session:
            points = page_of(session, query, order, to_point, limit=limit, after=after, descending=descending)
            if not points.items:  # a motor that has any is known
                found(session, MotorRow, motor, "motor")
            return points


def _column(quantity: Quantity) -> Any:
    row = _ROWS[quantity.subject]
    return getattr(row, quantity.name if row is RecordFiguresRow else quantity.attribute)


def _time(row: Row) -> InstrumentedAttribute[int]:
    return DiagnosisRow.recorded_ns if row is DiagnosisRow else row.time_ns  # type: ignore[union-attr]


def _tells(subject: Subject) -> list[ColumnElement[bool] | InstrumentedAttribute[bool]]:
    """Return the conditions of a row that tells of a subject; indexes answer them."""
    match subject:
        case Subject.STATOR:
            return [DiagnosisRow.current, DiagnosisRow.says_nothing.is_(False)]
        case Subject.CONDITION | Subject.PARAMETERS:
            return [ObservationRow.state.is_not(None)]
        case Subject.ROTOR:
            return []
        case Subject.LOAD:  # looked for together with the air gap, whose index answers
            return [details_of(Subject.AIR_GAP).is_not(None)]
        case Subject.LOSSES:  # looked for together with the supply, whose index answers
            return [details_of(Subject.SUPPLY).is_not(None)]
        case _:
            return [details_of(subject).is_not(None)]


def _figures(quantity: Quantity) -> tuple[Any, ...]:
    """Return a figure, its interval, its scatter and its detection limit; null where there is none."""
    value = _column(quantity)
    parts = {role: _column(one) for role, one in beside(quantity.name).items()}
    low, high = parts.get(Role.CI95_LOW, null()), parts.get(Role.CI95_HIGH, null())
    if Role.MARGIN in parts:
        low, high = value - parts[Role.MARGIN], value + parts[Role.MARGIN]
    if Role.STANDARD_DEVIATION in parts:  # of amplitudes, which are never below zero
        half = NORMAL_95 * parts[Role.STANDARD_DEVIATION]
        low, high = case((value > half, value - half), (value <= half, 0.0)), value + half
    scatter = (parts.get(role, null()) for role in (Role.SCATTER95_LOW, Role.SCATTER95_HIGH))
    return (value, low, high, *scatter, parts.get(Role.DETECTION_LIMIT, null()))


def _subject_point(time_ns: int, recording_id: str, *values: Any) -> SubjectPoint:
    return SubjectPoint(time_ns, recording_id, values)
