"""A motor's rotor over all its records: what follows from each is kept with it.

The records that count can tell of the rotor, and no joined recording that tells more stands for them. Each
has the condition of the rotor from it on. So the present condition is read from a few rows, however many
there are, and a record that comes, goes or changes has a few others judged again: those right after it, or
all, where the baseline of its load changes.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from sqlalchemy import (
    BigInteger,
    ColumnElement,
    Select,
    String,
    bindparam,
    func,
    select,
    tuple_,
    union_all,
    update,
)
from sqlalchemy.orm import Session

from core.rotor.finding import LOAD_BINS, LOAD_OSCILLATION, RotorState
from core.rotor.trend import (
    BASELINE_RECORDS,
    LATEST_RECORDS,
    JudgedRecord,
    LoadBin,
    RotorCondition,
    baseline_dB,
    rotor_condition,
    state_after,
)
from service.storage.models import Base, RotorFindingRow

_FINDINGS: Final = Base.metadata.tables["rotor_findings"]
_KEY: Final = (RotorFindingRow.time_ns, RotorFindingRow.recording_id)
_LATEST_FIRST: Final = tuple(column.desc() for column in _KEY)
_FIGURES: Final = (
    RotorFindingRow.state,
    RotorFindingRow.severity_dB,
    RotorFindingRow.severity_dB_ci95_low,
    RotorFindingRow.severity_dB_ci95_high,
    RotorFindingRow.load_bin,
)
_ROWS_AT_ONCE: Final = 1000
TOLD_STATES: Final = tuple(state for state in RotorState if state is not RotorState.UNSUPPORTED)
"""Of findings that count, and of the condition from them on."""
_BEFORE_ALL: Final = (-(2**63), "")
"""Comes before every key."""


def _course(*columns: Any) -> Select[*tuple[Any, ...]]:
    return select(*columns).where(
        RotorFindingRow.motor == bindparam("of_motor"), RotorFindingRow.condition.is_not(None)
    )


def _place(name: str) -> ColumnElement[Any]:
    return tuple_(bindparam(f"{name}_ns", type_=BigInteger), bindparam(f"{name}_id", type_=String))


# To put a statement together takes longer than to carry it out: they are made once, for any motor.
_LATEST: Final = (
    _course(*_KEY, *_FIGURES, RotorFindingRow.reasons).order_by(*_LATEST_FIRST).limit(LATEST_RECORDS)
)
_OF_BINS: Final = _course(RotorFindingRow.load_bin, func.count()).group_by(RotorFindingRow.load_bin)
_FIRST_OF_BINS: Final = union_all(
    *(
        select(
            _course(RotorFindingRow.load_bin, RotorFindingRow.recording_id, RotorFindingRow.severity_dB)
            .where(RotorFindingRow.load_bin == load_bin)
            .order_by(*_KEY)
            .limit(BASELINE_RECORDS)
            .subquery()
        )
        for load_bin in range(LOAD_BINS)
    )
)
_BEFORE_PLACE: Final = (
    _course(RotorFindingRow.recording_id, *_FIGURES)
    .where(tuple_(*_KEY) < _place("at"))
    .order_by(*_LATEST_FIRST)
    .limit(LATEST_RECORDS - 1)
)
_FROM_PLACE: Final = (
    _course(RotorFindingRow.recording_id, *_FIGURES)
    .where(tuple_(*_KEY) >= _place("at"))
    .order_by(*_KEY)
    .limit(LATEST_RECORDS)
)
_LAST_IN_STATE: Final = (
    _course(*_KEY).where(RotorFindingRow.condition == bindparam("state")).order_by(*_LATEST_FIRST).limit(1)
)
_FIRST_IN_STATE: Final = (
    _course(RotorFindingRow.time_ns)
    .where(
        RotorFindingRow.condition == bindparam("state"),
        *(tuple_(*_KEY) > _place(f"after_{other}") for other in range(len(TOLD_STATES) - 1)),
    )
    .order_by(*_KEY)
    .limit(1)
)
_JUDGED: Final = (
    update(_FINDINGS)
    .where(_FINDINGS.c.recording_id == bindparam("of_recording"))
    .values(condition=bindparam("judged"))
)


class Place(NamedTuple):
    """Where a record is among those of its motor."""

    time_ns: int
    recording_id: str


@dataclass(frozen=True, slots=True)
class _Baseline:
    """Baseline of a load bin, and the records that make it; those are not compared with it."""

    level_dB: float | None
    recording_ids: frozenset[str]


def course_condition(session: Session, motor: str, *, dates_healthy: bool = True) -> RotorCondition:
    """Return what all records of a motor say of its rotor together.

    dates_healthy: whether it is looked up since when a healthy rotor is so, too.
    """
    baselines = _baselines(session, motor)
    latest = session.execute(_LATEST, {"of_motor": motor}).all()
    judged = [
        _judged(baselines, recording_id, *figures, reasons=reasons)
        for _, recording_id, *figures, reasons in reversed(latest)
    ]
    bins = [
        LoadBin(load_bin, records, baselines[load_bin].level_dB)
        for load_bin, records in sorted(session.execute(_OF_BINS, {"of_motor": motor}).all())
    ]
    state = state_after(judged)
    is_dated = dates_healthy or state is not RotorState.HEALTHY
    return rotor_condition(judged, since_ns(session, motor, state) if is_dated else None, bins)


def latest_time_ns(session: Session, motor: str) -> int | None:
    """Return the time of a motor's latest record that tells of its rotor; None without any."""
    latest = session.execute(_LATEST, {"of_motor": motor}).first()
    return None if latest is None else latest.time_ns


def judge_added(session: Session, motor: str, place: Place) -> None:
    """Judge again what follows from a finding that was added: nothing else has changed."""
    session.flush()
    after = _baselines(session, motor)
    # A finding that is not of its load's first ones leaves every baseline as it was.
    if any(place.recording_id in one.recording_ids and one.level_dB is not None for one in after.values()):
        _judge_all(session, motor, after)
    else:
        _judge_from(session, motor, place, after)


@contextmanager
def judged_again(session: Session, motor: str) -> Iterator[list[Place]]:
    """Judge again what follows from the findings that the block changes; it appends where they are."""
    before = _baselines(session, motor)
    places: list[Place] = []
    yield places
    session.flush()
    after = _baselines(session, motor)
    # The level may stay while other records make it: one that does so no more is compared from now on.
    if any(old.level_dB is not None and old != after[load_bin] for load_bin, old in before.items()):
        _judge_all(session, motor, after)
        return
    for place in places:
        _judge_from(session, motor, place, after)


def _judge_from(session: Session, motor: str, place: Place, baselines: dict[int, _Baseline]) -> None:
    """Judge the records at a place and after it that it tells upon."""
    at = {"of_motor": motor, "at_ns": place.time_ns, "at_id": place.recording_id}
    before = session.execute(_BEFORE_PLACE, at).all()
    behind = session.execute(_FROM_PLACE, at).all()
    judged = [_judged(baselines, *row) for row in (*reversed(before), *behind)]
    conditions = {
        row.recording_id: state_after(judged[max(0, end - LATEST_RECORDS) : end])
        for end, row in enumerate(behind, len(before) + 1)
    }
    _write(session, conditions)


def _judge_all(session: Session, motor: str, baselines: dict[int, _Baseline]) -> None:
    query = _course(RotorFindingRow.recording_id, RotorFindingRow.condition, *_FIGURES)
    latest: deque[JudgedRecord] = deque(maxlen=LATEST_RECORDS)
    changed = {}
    for recording_id, condition, *figures in session.execute(query.order_by(*_KEY), {"of_motor": motor}):
        latest.append(_judged(baselines, recording_id, *figures))
        state = state_after(latest)
        if state is not condition:
            changed[recording_id] = state
    _write(session, changed)


def _write(session: Session, conditions: dict[str, RotorState]) -> None:
    values = [{"of_recording": one, "judged": state} for one, state in conditions.items()]
    for first in range(0, len(values), _ROWS_AT_ONCE):
        session.connection().execute(_JUDGED, values[first : first + _ROWS_AT_ONCE])


def _baselines(session: Session, motor: str) -> dict[int, _Baseline]:
    first: dict[int, dict[str, float]] = {load_bin: {} for load_bin in range(LOAD_BINS)}
    for load_bin, recording_id, severity_dB in session.execute(_FIRST_OF_BINS, {"of_motor": motor}):
        first[load_bin][recording_id] = severity_dB
    return {
        load_bin: _Baseline(baseline_dB(list(own.values())), frozenset(own))
        for load_bin, own in first.items()
    }


def since_ns(session: Session, motor: str, state: RotorState) -> int | None:
    """Return the time of a motor's first record after the last one with another condition of its rotor."""
    if state not in TOLD_STATES:  # no record counts
        return None
    after: dict[str, int | str] = {}
    for number, other in enumerate(one for one in TOLD_STATES if one is not state):
        last = session.execute(_LAST_IN_STATE, {"of_motor": motor, "state": other}).first()
        after[f"after_{number}_ns"], after[f"after_{number}_id"] = _BEFORE_ALL if last is None else last
    found: int | None = session.scalar(_FIRST_IN_STATE, {"of_motor": motor, "state": state, **after})
    return found


def _judged(
    baselines: dict[int, _Baseline],
    recording_id: str,
    state: RotorState,
    severity_dB: float,
    low_dB: float,
    high_dB: float,
    load_bin: int,
    *,
    reasons: Sequence[str] = (),
) -> JudgedRecord:
    baseline = baselines[load_bin]
    return JudgedRecord(
        state,
        severity_dB,
        (low_dB, high_dB),
        None if recording_id in baseline.recording_ids else baseline.level_dB,
        load_swings=any(reason.startswith(LOAD_OSCILLATION) for reason in reasons),
    )
