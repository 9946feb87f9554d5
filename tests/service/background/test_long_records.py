"""Long records are asked for when they are due and their moment is right, one in the plant at a time."""

from dataclasses import replace

import pytest
from sqlalchemy import Engine, update
from sqlalchemy.orm import Session

from core.rotor.finding import RotorState
from core.units import NANOSECONDS_PER_DAY
from service.background.long_records import MOST_TRIGGERS, LongRecorder
from service.plant.series_rhythm import rhythm_of
from service.storage import Repository
from service.storage.models import RecordingRequestRow, RecordingRow, RotorFindingRow
from service.storage.records import RecordingRequest, Sample
from service.storage.states import LinkState, RecordingSource, RecordingState
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

HOUR_NS = 3600 * SECOND_NS
PUMP, FAN = "PUMP-A1", "FAN-A2"
RELAYS = {PUMP: "A1_SEL710", FAN: "A2_SEL710"}
RUNNING_A = {PUMP: 1.2, FAN: 8.0}


def recorder(
    repository: Repository,
    days: float = 7.0,
    *,
    long_record_days: float | None = None,
    long_record_s: float | None = None,
) -> LongRecorder:
    """long_record_...: of the pump alone."""
    pump, fan = two_motor_plant().motors
    motors = [replace(pump, long_record_days=long_record_days, long_record_s=long_record_s), fan]
    return LongRecorder(motors, repository, usual_days=days, usual_s=10.0, metering_period_s=10.0)


def asked(repository: Repository) -> list[RecordingRequest]:
    """What was asked for, oldest first."""
    return list(repository.recording_requests(limit=100).items)[::-1]


def run_steadily(
    repository: Repository, until_ns: int, *motors: str, swing: float = 0.0, level: float = 1.0
) -> None:
    """The motors have run for two minutes. swing: of the current, from one sample to the next."""
    for motor in motors or (PUMP, FAN):
        currents = [RUNNING_A[motor] * level * (1 + swing * (number % 2)) for number in range(12)]
        repository.add_samples(
            Sample(
                motor,
                until_ns - (12 - number) * 10 * SECOND_NS,
                {"ia_A": current, "ib_A": current, "ic_A": current},
            )
            for number, current in enumerate(currents)
        )


def joined(engine: Engine, request: RecordingRequest) -> None:
    with Session(engine) as session:
        session.execute(
            update(RecordingRequestRow)
            .where(RecordingRequestRow.id == request.id)
            .values(joined_recording_id="long", state="diagnosed")
        )
        session.commit()


@pytest.fixture
def ready(repository: Repository, engine: Engine) -> Repository:
    """Both links have been up for an hour, and the length of both relays' records is known."""
    for motor, relay in RELAYS.items():
        set_link_state(repository, relay, LinkState.UP, None, now_ns=NOW_NS - HOUR_NS)
        with Session(engine) as session:
            session.add(
                RecordingRow(
                    id=f"of {motor}",
                    motor=motor,
                    ied=relay,
                    source=RecordingSource.RELAY,
                    name="E1",
                    digest=None,
                    size_bytes=1,
                    state=RecordingState.DIAGNOSED,
                    attempts=1,
                    announced_ns=NOW_NS - HOUR_NS,
                    duration_s=1.28,
                    pre_trigger_s=0.4,
                )
            )
            session.commit()
    return repository


def test_motors_are_recorded_for_long_one_after_the_other_and_again_after_the_interval(
    ready: Repository, engine: Engine
) -> None:
    long_records = recorder(ready)
    run_steadily(ready, NOW_NS)
    long_records.request_due(NOW_NS)
    long_records.request_due(NOW_NS + SECOND_NS)
    (first,) = asked(ready)
    assert (first.origin, first.seconds) == ("schedule", 10.0)
    joined(engine, first)
    long_records.request_due(NOW_NS + 2 * SECOND_NS)
    _, second = asked(ready)
    assert {first.motor, second.motor} == {PUMP, FAN}
    joined(engine, second)
    week_ns = 7 * NANOSECONDS_PER_DAY
    run_steadily(ready, NOW_NS + week_ns)
    long_records.request_due(NOW_NS + week_ns - SECOND_NS)
    assert len(asked(ready)) == 2
    recorder(ready).request_due(NOW_NS + week_ns)
    assert [one.motor for one in asked(ready)] == [first.motor, second.motor, first.motor]


def test_none_is_made_where_the_interval_is_0_days(ready: Repository) -> None:
    run_steadily(ready, NOW_NS)
    recorder(ready, 0.0).request_due(NOW_NS)
    recorder(ready, 0.0, long_record_s=20.0).request_due(NOW_NS)
    assert asked(ready) == []


def test_a_motor_may_have_its_own_interval_and_length(ready: Repository, engine: Engine) -> None:
    run_steadily(ready, NOW_NS)
    own = recorder(ready, 0.0, long_record_days=1.0, long_record_s=20.0)
    own.request_due(NOW_NS)
    (first,) = asked(ready)
    assert (first.motor, first.seconds) == (PUMP, 20.0)
    joined(engine, first)
    run_steadily(ready, NOW_NS + NANOSECONDS_PER_DAY)
    own.request_due(NOW_NS + NANOSECONDS_PER_DAY)
    assert len(asked(ready)) == 2


def test_a_motor_that_is_never_recorded_for_long_by_its_own_entry_is_left_out(ready: Repository) -> None:
    run_steadily(ready, NOW_NS)
    recorder(ready, long_record_days=0.0).request_due(NOW_NS)
    assert [one.motor for one in asked(ready)] == [FAN]


@pytest.mark.parametrize(("swing", "level"), [(0.15, 1.0), (0.0, 0.001)], ids=["its load moves", "it stands"])
def test_a_motor_waits_for_a_steady_load_and_others_do_not_wait_for_it(
    ready: Repository, swing: float, level: float
) -> None:
    run_steadily(ready, NOW_NS, PUMP, swing=swing, level=level)
    run_steadily(ready, NOW_NS, FAN, swing=0.05)
    recorder(ready).request_due(NOW_NS)
    assert [one.motor for one in asked(ready)] == [FAN]


def test_a_motor_of_which_nothing_is_measured_is_not_recorded_for_long(ready: Repository) -> None:
    run_steadily(ready, NOW_NS - HOUR_NS)
    recorder(ready).request_due(NOW_NS)
    assert asked(ready) == []


@pytest.mark.parametrize("state", [LinkState.DOWN, LinkState.UP])
def test_a_link_that_is_down_or_was_lately_is_spared(ready: Repository, state: LinkState) -> None:
    set_link_state(ready, RELAYS[PUMP], LinkState.DOWN, "no answer", now_ns=NOW_NS - 60 * SECOND_NS)
    set_link_state(ready, RELAYS[PUMP], state, "no answer", now_ns=NOW_NS - 30 * SECOND_NS)
    run_steadily(ready, NOW_NS)
    recorder(ready).request_due(NOW_NS)
    assert [one.motor for one in asked(ready)] == [FAN]


def test_a_relay_whose_records_were_never_read_is_not_asked(repository: Repository) -> None:
    set_link_state(repository, RELAYS[PUMP], LinkState.UP, None, now_ns=NOW_NS - HOUR_NS)
    run_steadily(repository, NOW_NS)
    recorder(repository).request_due(NOW_NS)
    assert asked(repository) == []


def test_a_series_that_a_person_asked_for_goes_first_and_counts(ready: Repository, engine: Engine) -> None:
    by_hand = ready.request_recording(PUMP, now_ns=NOW_NS, seconds=5.0)
    run_steadily(ready, NOW_NS + SECOND_NS)
    recorder(ready).request_due(NOW_NS + SECOND_NS)
    assert asked(ready) == [by_hand]
    joined(engine, by_hand)
    recorder(ready).request_due(NOW_NS + 2 * SECOND_NS)
    assert [one.motor for one in asked(ready)] == [PUMP, FAN]


def test_what_failed_is_tried_again_later_and_later(ready: Repository) -> None:
    own = recorder(ready, 0.0, long_record_days=7.0)
    tried_ns = [NOW_NS]
    for hours in (1, 2, 4):
        due_ns = tried_ns[-1]
        run_steadily(ready, due_ns)
        own.request_due(due_ns)
        latest = asked(ready)[-1]
        assert latest.requested_ns == due_ns
        ready.fail_recording_request(latest.id, "no record", now_ns=due_ns + SECOND_NS)
        run_steadily(ready, due_ns + hours * HOUR_NS - SECOND_NS)
        own.request_due(due_ns + hours * HOUR_NS - SECOND_NS)
        assert len(asked(ready)) == len(tried_ns)
        tried_ns.append(due_ns + hours * HOUR_NS)


def test_two_services_ask_once(ready: Repository) -> None:
    run_steadily(ready, NOW_NS)
    first, second = recorder(ready), recorder(ready)
    first.request_due(NOW_NS)
    second.request_due(NOW_NS)
    assert len(asked(ready)) == 1


def test_a_relay_with_records_too_short_is_not_asked_by_itself(ready: Repository, engine: Engine) -> None:
    """In records of 0.5 s, 0.1 s of it before the trigger, 10 s are a series of 23."""
    with Session(engine) as session:
        short = update(RecordingRow).where(RecordingRow.motor == PUMP)
        session.execute(short.values(duration_s=0.5, pre_trigger_s=0.1))
        session.commit()
    assert rhythm_of((0.5, 0.1), 10.0).triggers > MOST_TRIGGERS
    assert rhythm_of((1.28, 0.4), 10.0).triggers <= MOST_TRIGGERS
    run_steadily(ready, NOW_NS)
    recorder(ready).request_due(NOW_NS)
    assert [one.motor for one in asked(ready)] == [FAN]


@pytest.mark.parametrize(("assessed_day", "due_day"), [(None, 30), (-5, 30), (28, 58)])
def test_while_the_rotor_is_not_assessed_a_long_interval_is_a_month(
    ready: Repository, engine: Engine, assessed_day: int | None, due_day: int
) -> None:
    own = recorder(ready, 0.0, long_record_days=90.0)
    run_steadily(ready, NOW_NS)
    own.request_due(NOW_NS)
    (first,) = asked(ready)
    joined(engine, first)
    if assessed_day is not None:
        with Session(engine) as session:
            time_ns = NOW_NS + assessed_day * NANOSECONDS_PER_DAY
            state = RotorState.HEALTHY
            session.add(
                RotorFindingRow(
                    recording_id="E", motor=PUMP, time_ns=time_ns, state=state, condition=state,
                    duration_s=10.0, reasons=(),
                )
            )  # fmt: skip
            session.commit()
    for day in range(1, 91):
        now_ns = NOW_NS + day * NANOSECONDS_PER_DAY
        set_link_state(ready, RELAYS[PUMP], LinkState.UP, None, now_ns=now_ns - HOUR_NS)
        run_steadily(ready, now_ns, PUMP)
        own.request_due(now_ns)
        if len(asked(ready)) == 2:
            assert day == due_day
            return
    raise AssertionError("no long record was asked for")
