"""What gateways tell follows the database, and nothing old counts as good."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from threading import Event

import pytest

from core.condition.kinds import Kind, State
from core.units import NANOSECONDS_PER_DAY
from service.gateways.plant_state.device_health import DeviceHealth, health_of_motor
from service.gateways.plant_state.figures import PlantChange, Quality
from service.gateways.plant_state.following import PlantFollower
from service.gateways.plant_state.reading import NOT_JUDGED, read_plant_state
from service.gateways.plant_state.running_state import RunningState, running_state
from service.storage import Repository
from service.storage.change_counter import ChangeCounter
from service.storage.states import AlarmKind, LinkState
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS
from testing.waiting import wait_until

SILENCE_S = 4.0
"""Longer than a reading on a machine that does much else."""


@pytest.fixture
def follower(repository: Repository, monkeypatch: pytest.MonkeyPatch) -> Iterator[PlantFollower]:
    monkeypatch.setattr("service.gateways.plant_state.following.SHORTEST_PAUSE_S", 0.0)
    monkeypatch.setattr("service.gateways.plant_state.following.SHARE", 0)
    monkeypatch.setattr("service.gateways.plant_state.following.time.time_ns", lambda: NOW_NS)
    follower = PlantFollower(repository, period_s=0.01, silence_s=SILENCE_S)
    yield follower
    follower.close()


def next_change(follower: PlantFollower) -> PlantChange:
    change = follower.next_change(Event(), longest_s=20)
    assert change is not None
    return change


def test_the_first_change_has_the_whole_plant(repository: Repository, follower: PlantFollower) -> None:
    tell(repository, replace(FAULT, motor="PUMP-A1"))
    change = next_change(follower)
    pump, fan = change.now.motors["PUMP-A1"], change.now.motors["FAN-A2"]
    assert {motor.name for motor in change.motors} == {"PUMP-A1", "FAN-A2"}
    assert (pump.state, pump.phase, pump.mu_f) == (State.FAULT, "b", 0.0121)
    assert (pump.quality, pump.device_health) == (Quality.GOOD, DeviceHealth.FAILURE)
    assert pump.as_of_ns == NOW_NS
    assert (fan.state, fan.quality, fan.quality_reason) == (State.UNKNOWN, Quality.BAD, NOT_JUDGED)
    assert fan.device_health is DeviceHealth.CHECK_FUNCTION
    assert change.now.relays["A1_SEL710"].link is LinkState.UNKNOWN


def test_many_open_alarms_end_no_other(repository: Repository, follower: PlantFollower) -> None:
    """A relay raises a thousand alarms of a kind; a more urgent one comes beside them."""
    for number in range(1000):
        repository.raise_alarm(
            "A1_SEL710", AlarmKind.FILE_REFUSED, f"E{number}.CEV", "cut off", now_ns=NOW_NS + number
        )
    assert len(next_change(follower).alarms) == 1000
    repository.raise_alarm("A2_SEL710", AlarmKind.LINK_DOWN, "", "no answer", now_ns=NOW_NS + 10**9)
    change = next_change(follower)
    assert [alarm.kind for alarm in change.alarms] == [AlarmKind.LINK_DOWN]
    assert change.alarms_gone == ()


def test_only_what_differs_is_told_again(repository: Repository, follower: PlantFollower) -> None:
    tell(repository, HEALTHY)
    next_change(follower)
    assert follower.next_change(Event(), longest_s=0.1) is None
    set_link_state(repository, "A2_SEL710", LinkState.DOWN, now_ns=NOW_NS, reason="no answer")
    change = next_change(follower)
    assert [relay.name for relay in change.relays] == ["A2_SEL710"]
    assert change.relays[0].device_health is DeviceHealth.FAILURE
    # With the link goes what is known of its motor running.
    assert [(motor.name, motor.running, motor.running_ns) for motor in change.motors] == [
        ("FAN-A2", RunningState.UNKNOWN, NOW_NS)
    ]
    assert follower.next_change(Event(), longest_s=0.1) is None
    tell(repository, FAULT)
    (motor,) = next_change(follower).motors
    assert (motor.name, motor.state) == ("PUMP-A1", State.FAULT)


def test_an_old_condition_is_uncertain(repository: Repository) -> None:
    tell(repository, HEALTHY)
    later_ns = NOW_NS + 8 * NANOSECONDS_PER_DAY
    motor = read_plant_state(repository, now_ns=later_ns, stale_after_days=7).motors["PUMP-A1"]
    assert (motor.stale, motor.quality) == (True, Quality.UNCERTAIN)
    assert motor.device_health is DeviceHealth.CHECK_FUNCTION
    fresh = read_plant_state(repository, now_ns=later_ns, stale_after_days=9).motors["PUMP-A1"]
    assert (fresh.stale, fresh.quality) == (False, Quality.GOOD)


def test_nothing_is_good_while_the_database_is_silent_and_all_is_told_again_after(
    repository: Repository, follower: PlantFollower, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    assert next_change(follower).now.motors["PUMP-A1"].quality is Quality.GOOD
    database = tmp_path / "statorwatch.sqlite"
    follower.close()
    away = database.rename(tmp_path / "away.sqlite")
    database.mkdir()  # else SQLite would make an empty file
    repository._reading.dispose()
    silent = next_change(follower)
    assert {motor.quality for motor in silent.now.motors.values()} == {Quality.UNCERTAIN, Quality.BAD}
    assert silent.now.motors["PUMP-A1"].quality_reason == "the service's database does not answer"
    assert follower.problem is not None
    database.rmdir()
    away.rename(database)
    assert next_change(follower).now.motors["PUMP-A1"].quality is Quality.GOOD
    assert follower.problem is None


def test_a_query_that_hangs_leaves_nothing_good(
    repository: Repository, follower: PlantFollower, monkeypatch: pytest.MonkeyPatch
) -> None:
    tell(repository, HEALTHY)
    assert next_change(follower).now.motors["PUMP-A1"].quality is Quality.GOOD
    hangs, value = Event(), ChangeCounter.value

    def hanging(counter: ChangeCounter) -> object:
        assert hangs.wait(60)
        return value(counter)

    monkeypatch.setattr(ChangeCounter, "value", hanging)
    assert next_change(follower).now.motors["PUMP-A1"].quality is Quality.UNCERTAIN
    assert "the database has not answered for" in (follower.problem or "")
    hangs.set()
    assert next_change(follower).now.motors["PUMP-A1"].quality is Quality.GOOD
    assert follower.problem is None


def test_a_gateway_is_told_that_nothing_is_known_yet(
    repository: Repository, follower: PlantFollower, monkeypatch: pytest.MonkeyPatch
) -> None:
    may_read, value = Event(), ChangeCounter.value

    def waiting(counter: ChangeCounter) -> object:
        assert may_read.wait(60)
        return value(counter)

    monkeypatch.setattr(ChangeCounter, "value", waiting)
    assert follower.next_change(Event(), longest_s=0.05) is None
    assert follower.problem == "the plant's state has not been read yet"
    tell(repository, HEALTHY)
    may_read.set()
    next_change(follower)
    assert follower.problem is None


def test_a_bug_in_reading_ends_the_gateway(follower: PlantFollower, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ZeroDivisionError("a bug")

    monkeypatch.setattr("service.gateways.plant_state.following.read_plant_state", fail)
    with pytest.raises(ZeroDivisionError, match="a bug"):
        follower.next_change(Event(), longest_s=20)


def test_stopping_ends_the_wait(follower: PlantFollower) -> None:
    next_change(follower)
    stop = Event()
    stop.set()
    assert follower.next_change(stop) is None


@pytest.mark.parametrize(
    ("state", "kind", "stale", "expected"),
    [
        (State.HEALTHY, Kind.NONE, False, DeviceHealth.NORMAL),
        (State.WATCH, Kind.UNCLEAR, False, DeviceHealth.MAINTENANCE_REQUIRED),
        (State.FAULT, Kind.SHORTED_TURNS, True, DeviceHealth.FAILURE),
        (State.FAULT, Kind.SUPPLY, False, DeviceHealth.OFF_SPEC),
        (State.HEALTHY, Kind.NONE, True, DeviceHealth.CHECK_FUNCTION),
        (State.UNKNOWN, Kind.NONE, False, DeviceHealth.CHECK_FUNCTION),
        (State.FAULT, Kind.ROTOR, False, DeviceHealth.FAILURE),
    ],
)
def test_the_state_of_the_worst_part_is_the_health_of_a_motor(
    state: State, kind: Kind, stale: bool, expected: DeviceHealth
) -> None:
    assert health_of_motor(state, kind, stale=stale) is expected


def test_a_clock_that_jumps_makes_values_old_and_good_again_and_stops_nothing(
    repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    wall_ns = NOW_NS
    monkeypatch.setattr("service.gateways.plant_state.following.SHORTEST_PAUSE_S", 0.0)
    monkeypatch.setattr("service.gateways.plant_state.following.SHARE", 0)
    monkeypatch.setattr("service.gateways.plant_state.following.REFRESH_S", 0.05)
    monkeypatch.setattr("service.gateways.plant_state.following.time.time_ns", lambda: wall_ns)
    tell(repository, HEALTHY)
    follower = PlantFollower(repository, stale_after_days=7, period_s=0.01)
    try:
        assert next_change(follower).now.motors["PUMP-A1"].quality is Quality.GOOD
        wall_ns = NOW_NS + 3650 * NANOSECONDS_PER_DAY
        assert next_change(follower).now.motors["PUMP-A1"].quality is Quality.UNCERTAIN
        wall_ns = NOW_NS
        assert next_change(follower).now.motors["PUMP-A1"].quality is Quality.GOOD
        wall_ns = NOW_NS - 3650 * NANOSECONDS_PER_DAY
        ahead = next_change(follower).now.motors["PUMP-A1"]
        assert ahead.quality is Quality.UNCERTAIN
        assert ahead.quality_reason == "the latest record is of a later time than now: a clock is wrong"
        tell(repository, FAULT)
        wait_until(lambda: next_change(follower).now.motors["PUMP-A1"].state is State.FAULT)
        assert follower.problem is None
    finally:
        follower.close()


def test_what_has_changed_and_is_not_read_in_time_is_not_good(
    repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The database answers how many changes there were; the pause after a reading is not over."""
    monkeypatch.setattr("service.gateways.plant_state.following.SHORTEST_PAUSE_S", 3 * SILENCE_S)
    monkeypatch.setattr("service.gateways.plant_state.following.time.time_ns", lambda: NOW_NS)
    tell(repository, HEALTHY)
    follower = PlantFollower(repository, period_s=0.01, silence_s=SILENCE_S)
    try:
        assert next_change(follower).now.motors["PUMP-A1"].quality is Quality.GOOD
        tell(repository, FAULT)
        seen = [next_change(follower).now.motors["PUMP-A1"] for _ in range(2)]
        assert [(one.state, one.quality) for one in seen] == [
            (State.HEALTHY, Quality.UNCERTAIN),
            (State.FAULT, Quality.GOOD),
        ]
    finally:
        follower.close()


def test_the_pause_after_a_slow_reading_has_an_end(
    repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.gateways.plant_state.following.SHARE", 10**9)
    monkeypatch.setattr("service.gateways.plant_state.following.LONGEST_PAUSE_S", 0.2)
    monkeypatch.setattr("service.gateways.plant_state.following.time.time_ns", lambda: NOW_NS)
    tell(repository, HEALTHY)
    follower = PlantFollower(repository, period_s=0.01)
    try:
        assert next_change(follower).now.motors["PUMP-A1"].state is State.HEALTHY
        tell(repository, FAULT)
        assert next_change(follower).now.motors["PUMP-A1"].state is State.FAULT
    finally:
        follower.close()


@pytest.mark.parametrize(
    ("link", "as_of_ns", "stood_ns", "expected"),
    [
        (LinkState.UP, 20, 10, RunningState.RUNNING),
        (LinkState.UP, 10, 20, RunningState.STANDING),
        (LinkState.UP, None, 20, RunningState.STANDING),
        (LinkState.UP, None, None, RunningState.UNKNOWN),
        (LinkState.DOWN, 20, 10, RunningState.UNKNOWN),
        (LinkState.UNKNOWN, 10, 20, RunningState.UNKNOWN),
    ],
)
def test_a_motor_runs_as_it_was_seen_last(
    link: LinkState, as_of_ns: int | None, stood_ns: int | None, expected: RunningState
) -> None:
    assert running_state(link, as_of_ns, stood_ns) is expected
