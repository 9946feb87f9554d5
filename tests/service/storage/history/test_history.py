"""A motor's past: its trend thinned without losing an outlier, and what its latest records showed."""

from random import Random

import pytest
from sqlalchemy.orm import Session

from core.condition.kinds import Kind, State
from service.storage import NotFoundError, Repository
from service.storage.records.history import TrendPiece
from service.storage.repository.conditions.observations import observation_row
from testing.service.observations import HOUR_NS, observation
from testing.service.plants import NOW_NS

MOTOR = "PUMP-A1"


def add(repository: Repository, levels: list[tuple[float, float | None, State | None]]) -> None:
    """Add a record for each hour, level and state; without a state it is not folded yet."""
    with Session(repository._writing) as session, session.begin():
        for number, (hour, level, state) in enumerate(levels):
            row = observation_row(f"record-{number}", MOTOR, observation(hour))
            if state is not None:
                row.state, row.kind, row.mu_f = state, Kind.NONE, level
                if level is not None:
                    row.mu_f_ci95_low, row.mu_f_ci95_high = level / 2.0, 2.0 * level
            session.add(row)


def test_few_records_are_told_as_they_are(repository: Repository) -> None:
    add(repository, [(0.0, 0.001, State.HEALTHY), (1.0, 0.02, State.FAULT), (2.0, None, None)])

    trend = repository.thinned_trend(MOTOR, most_points=2)

    assert (trend.records, trend.pieces) == (2, ())
    assert [(point.mu_f, point.state) for point in trend.points] == [
        (0.001, State.HEALTHY),
        (0.02, State.FAULT),
    ]
    assert trend.points[1].recording_id == "record-1"


def test_many_records_are_told_piece_by_piece_and_no_outlier_is_lost(repository: Repository) -> None:
    random = Random(1)
    levels = [
        (hour + random.random() * (40.0 if hour > 60 else 0.5), random.random() * 0.01, State.HEALTHY)
        for hour in range(80)
    ]
    levels[31] = (levels[31][0], 0.2, State.FAULT)
    add(repository, [*levels, (200.0, None, None)])

    trend = repository.thinned_trend(MOTOR, most_points=79, pieces=12)

    assert trend.records == 80
    assert trend.points == ()
    assert len(trend.pieces) <= 12
    expected = by_hand(levels, trend.from_ns, trend.to_ns, 12)
    assert [(one.from_ns, one.to_ns, one.records, one.state) for one in trend.pieces] == [
        (one.from_ns, one.to_ns, one.records, one.state) for one in expected
    ]
    assert [figures(one) for one in trend.pieces] == [pytest.approx(figures(one)) for one in expected]
    assert max(piece.highest or 0.0 for piece in trend.pieces) == 0.2
    assert [piece.state for piece in trend.pieces].count(State.FAULT) == 1


def figures(piece: TrendPiece) -> list[float | None]:
    return [piece.lowest, piece.highest, piece.ci95_low, piece.ci95_high]


def by_hand(
    levels: list[tuple[float, float, State]], from_ns: int, to_ns: int, number: int
) -> list[TrendPiece]:
    step_ns = -(-(to_ns - from_ns) // number)
    pieces = []
    for begin_ns in range(from_ns, to_ns, step_ns):
        those = [
            (level, state)
            for hour, level, state in levels
            if begin_ns <= NOW_NS + round(hour * HOUR_NS) < min(begin_ns + step_ns, to_ns)
        ]
        if those:
            found = [level for level, _ in those]
            states = {state for _, state in those}
            worst = State.FAULT if State.FAULT in states else State.HEALTHY
            low, high = min(found), max(found)
            end_ns = begin_ns + step_ns
            pieces.append(TrendPiece(begin_ns, end_ns, len(those), low, high, low / 2.0, 2.0 * high, worst))
    return pieces


def test_a_part_of_the_time_is_asked_for(repository: Repository) -> None:
    add(repository, [(hour, 0.001 * hour, State.HEALTHY) for hour in range(10)])
    trend = repository.thinned_trend(MOTOR, from_ns=NOW_NS + 2 * HOUR_NS, to_ns=NOW_NS + 5 * HOUR_NS)
    assert [point.mu_f for point in trend.points] == pytest.approx([0.002, 0.003, 0.004])
    assert (trend.from_ns, trend.to_ns) == (NOW_NS + 2 * HOUR_NS, NOW_NS + 5 * HOUR_NS)


def test_a_motor_without_records_has_an_empty_trend(repository: Repository) -> None:
    trend = repository.thinned_trend(MOTOR)
    assert (trend.records, trend.points, trend.pieces) == (0, (), ())
    with pytest.raises(NotFoundError):
        repository.thinned_trend("NO-SUCH")


def test_the_latest_records_come_oldest_first_with_what_was_said_then(repository: Repository) -> None:
    add(repository, [(0.0, 0.001, State.HEALTHY), (1.0, 0.02, State.FAULT), (2.0, None, None)])

    seen = repository.latest_records(MOTOR, limit=2)

    assert [one.recording_id for one in seen] == ["record-1", "record-2"]
    assert seen[0].observation == observation(1.0)
    assert seen[0].figures is not None
    assert (seen[0].figures.mu_f, seen[0].figures.state) == (0.02, State.FAULT)
    assert seen[1].figures is None
    (earlier,) = repository.latest_records(MOTOR, limit=5, before_ns=NOW_NS + HOUR_NS)
    assert earlier.recording_id == "record-0"
