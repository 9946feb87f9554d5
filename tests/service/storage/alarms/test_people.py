"""People and causes at the same time, restarts, and what is kept of alarms."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from threading import Barrier

import pytest
from sqlalchemy import Engine, func, select, update
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_DAY
from service.alarms.kinds import AlarmKind
from service.storage import Repository, connect
from service.storage.errors import AlarmActionError
from service.storage.models import AlarmChangeRow
from service.storage.records import Actor, Alarm, AlarmPlace, AlarmSpec
from service.storage.repository.alarms import causes, changes
from service.storage.states import AlarmState
from service.timing.backoff import Backoff
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant

RELAY = "A1_SEL710"
KIND = AlarmKind.FILE_REFUSED
ANN, BOB = Actor("ann", "127.0.0.1"), Actor("bob", "command line")


def raised(repository: Repository, subject: str = "X", now_ns: int = NOW_NS) -> Alarm:
    return repository.raise_alarm(RELAY, KIND, subject, "outside", now_ns=now_ns)


def at_once(*deeds: Callable[[], object]) -> list[object]:
    """What several threads get that begin together."""
    together = Barrier(len(deeds))

    def begin(deed: Callable[[], object]) -> object:
        together.wait(10)
        try:
            return deed()
        except AlarmActionError as error:
            return error

    with ThreadPoolExecutor(len(deeds)) as pool:
        return list(pool.map(begin, deeds))


def test_of_two_who_acknowledge_at_once_the_second_learns_who_was_first(repository: Repository) -> None:
    for number in range(5):
        alarm = raised(repository, str(number))
        acknowledge = partial(repository.acknowledge_alarm, alarm.id, now_ns=NOW_NS + 1, comment="on my way")
        found = at_once(partial(acknowledge, by=ANN), partial(acknowledge, by=BOB))
        (refused,) = (one for one in found if isinstance(one, AlarmActionError))
        first = repository.alarm(alarm.id).changed_by
        assert f"it is acknowledged (by {first}: on my way)" in str(refused)
        assert len(repository.alarm_changes(alarm.id, limit=9).items) == 2


def test_an_acknowledgement_and_the_end_of_the_cause_at_once_leave_nothing_open(
    repository: Repository,
) -> None:
    for number in range(5):
        alarm = raised(repository, str(number))
        acknowledge = partial(repository.acknowledge_alarm, alarm.id, by=ANN, now_ns=NOW_NS + 1)
        clear = partial(repository.clear_alarms, RELAY, [alarm.id], now_ns=NOW_NS + 1)
        at_once(acknowledge, clear)
        assert repository.alarm(alarm.id).state is AlarmState.NORMAL


def test_several_services_end_a_shelving_once(repository: Repository, engine: Engine) -> None:
    ids = [raised(repository, str(number)).id for number in range(20)]
    for one in ids:
        repository.shelve_alarm(one, until_ns=NOW_NS + 5, by=ANN, now_ns=NOW_NS)
    services = [Repository(engine) for _ in range(3)]
    ended = at_once(
        *(lambda service=service: service.end_shelvings(now_ns=NOW_NS + 5) for service in services)
    )
    assert sum(number for number in ended if isinstance(number, int)) == 20
    with Session(engine) as session:
        query = select(func.count()).where(AlarmChangeRow.event == "shelving-ended")
        assert session.scalar(query) == 20


def test_what_people_did_outlives_a_restart(
    repository: Repository, engine: Engine, database_url: str
) -> None:
    shelved, away = raised(repository, "shelved"), raised(repository, "away")
    repository.shelve_alarm(shelved.id, until_ns=NOW_NS + 5, by=ANN, now_ns=NOW_NS, comment="Friday")
    repository.take_alarm_out_of_service(away.id, by=BOB, now_ns=NOW_NS)
    before = repository.open_alarms(limit=10)
    engine.dispose()
    again = connect(database_url)
    restarted = Repository(again)
    assert restarted.open_alarms(limit=10) == before
    assert raised(restarted, "away", NOW_NS + 1).state is AlarmState.OUT_OF_SERVICE
    assert restarted.end_shelvings(now_ns=NOW_NS + 5) == 1
    assert restarted.alarm(shelved.id).state is AlarmState.UNACKNOWLEDGED
    again.dispose()


@pytest.mark.parametrize(
    ("done", "state"),
    [
        ("nothing", AlarmState.RETURNED_UNACKNOWLEDGED),
        ("acknowledged", AlarmState.NORMAL),
        ("shelved", AlarmState.SHELVED),
    ],
)
def test_a_late_fold_that_clears(repository: Repository, done: str, state: AlarmState) -> None:
    """The motor is found healthy by a record that came late: whatever people did before holds."""
    tell(repository, FAULT)
    (alarm,) = repository.alarms(limit=2, motor="PUMP-A1").items
    if done == "acknowledged":
        repository.acknowledge_alarm(alarm.id, by=ANN, now_ns=NOW_NS)
    if done == "shelved":
        repository.shelve_alarm(alarm.id, until_ns=NOW_NS + 99, by=ANN, now_ns=NOW_NS)
    tell(repository, HEALTHY, now_ns=NOW_NS + 7)
    found = repository.alarm(alarm.id)
    assert (found.state, found.cleared_ns) == (state, NOW_NS + 7)


def test_only_so_many_that_are_cleared_are_kept_and_none_that_is_set_aside(
    repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(causes, "MOST_CLEARED", 3)
    shelved = raised(repository, "shelved")
    repository.shelve_alarm(shelved.id, until_ns=NOW_NS + NANOSECONDS_PER_DAY, by=ANN, now_ns=NOW_NS)
    for number in range(6):
        one = raised(repository, str(number), NOW_NS + number)
        repository.clear_alarms(RELAY, [one.id, shelved.id], now_ns=NOW_NS + number)
    found = repository.alarms(limit=10).items
    assert [one.subject for one in found] == ["5", "4", "3", "shelved"]


def test_only_so_many_changes_of_an_alarm_are_kept_and_all_that_nobody_was_told_of(
    repository: Repository, engine: Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(changes, "MOST_CHANGES", 5)
    for number in range(10):
        alarm = raised(repository, now_ns=NOW_NS + number)
        repository.clear_alarms(RELAY, [alarm.id], now_ns=NOW_NS + number)
    assert (alarm.raises, len(repository.alarm_changes(alarm.id, limit=99).items)) == (10, 20)
    with Session(engine) as session, session.begin():
        session.execute(update(AlarmChangeRow).values(routed_ns=NOW_NS))
    raised(repository, now_ns=NOW_NS + 20)
    assert len(repository.alarm_changes(alarm.id, limit=99).items) == 5


def test_a_motor_that_leaves_the_plant_has_its_alarm_suppressed_until_it_is_back(
    repository: Repository,
) -> None:
    spec = AlarmSpec(AlarmKind.MISSING_DATA, "none for a week", one_of_kind=True)
    alarm = repository.raise_alarm_at(AlarmPlace(motor="PUMP-A1"), spec, now_ns=NOW_NS)
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=plant.motors[1:]))
    assert repository.begin_suppressions(now_ns=NOW_NS + 1) == 1
    found = repository.alarm(alarm.id)
    assert (found.state, found.suppressed_because) == (
        (AlarmState.SUPPRESSED, "motor PUMP-A1 is out of service")
    )
    repository.clear_alarms_at(AlarmPlace(motor="PUMP-A1"), spec.kind, now_ns=NOW_NS + 2)
    again = repository.raise_alarm_at(AlarmPlace(motor="PUMP-A1"), spec, now_ns=NOW_NS + 3)
    assert (again.id, again.state, again.raises) == (alarm.id, AlarmState.SUPPRESSED, 2)
    assert repository.begin_suppressions(now_ns=NOW_NS + 4) == 0
    assert repository.end_suppressions(now_ns=NOW_NS + 4) == 0
    repository.sync_plant(plant)
    assert repository.end_suppressions(now_ns=NOW_NS + 5) == 1
    assert repository.alarm(alarm.id).state is AlarmState.UNACKNOWLEDGED


def test_the_alarms_of_a_relay_that_leaves_the_plant_are_suppressed(repository: Repository) -> None:
    alarm = raised(repository)
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, relays=plant.relays[1:], motors=plant.motors[1:]))
    assert repository.begin_suppressions(now_ns=NOW_NS + 1) == 1
    assert repository.alarm(alarm.id).suppressed_because == f"relay {RELAY} is out of service"


def test_a_quarantine_suppresses_what_follows_from_it_alone(repository: Repository) -> None:
    follows = raised(repository)
    tell(repository, FAULT)
    backoff = Backoff(60.0, 60.0)
    repository.set_aside(RELAY, "crashed a gateway", backoff=backoff, now_ns=NOW_NS + 1)
    (fault,) = repository.alarms(limit=2, motor="PUMP-A1").items
    assert fault.state is AlarmState.UNACKNOWLEDGED, "the motor's fault is as true as before"
    assert [one.kind for one in repository.open_alarms(limit=9, state=AlarmState.UNACKNOWLEDGED).items] == [
        AlarmKind.CONDITION_FAULT,
        AlarmKind.QUARANTINED,
    ]
    assert repository.alarm(follows.id).suppressed_because == f"relay {RELAY} is in quarantine"
    assert raised(repository, "new", NOW_NS + 2).state is AlarmState.SUPPRESSED
    over_ns = NOW_NS + 62 * SECOND_NS
    assert repository.end_suppressions(now_ns=NOW_NS + 3) == 0
    assert repository.end_suppressions(now_ns=over_ns) == 2, "the quarantine has ended by its time"
    assert repository.alarm(follows.id).state is AlarmState.UNACKNOWLEDGED


def test_a_long_or_odd_subject_is_one_cause(repository: Repository) -> None:
    odd = "a\0b\ud800" + "x" * 10_000
    first, second = raised(repository, odd), raised(repository, odd, NOW_NS + 1)
    assert first.id == second.id
