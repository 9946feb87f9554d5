"""Alarms of motors follow confirmed states: one cause calls people once, growth calls them again."""

from dataclasses import replace

import pytest
from sqlalchemy import Engine
from sqlalchemy.orm import Session

from core.condition.events import Event, EventKind
from core.condition.forecast.outcome import Forecast
from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from service.alarms.kinds import AlarmKind, AlarmPriority
from service.configuration.alarms import AlarmSettings
from service.storage import Repository
from service.storage.models import MotorRow, ObservationRow
from service.storage.records import Actor, Alarm
from service.storage.records.actors import SERVICE
from service.storage.repository.alarms.conditions import settle_alarm
from service.storage.repository.conditions.observations import keep_observation
from service.storage.states import AlarmEvent, AlarmState
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, UNKNOWN, entry_of
from testing.service.observations import HOUR_NS, observation
from testing.service.plants import NOW_NS

ANN = Actor("ann", "command line")
RULES = AlarmSettings().condition_rules
TURNS = replace(DRIFTING, kind=Kind.SHORTED_TURNS, candidates=(), mu_f=0.004, mu_f_ci95=(0.003, 0.005))
CHANNEL = replace(DRIFTING, kind=Kind.VOLTAGE_CHANNEL, candidates=(), size=0.010, size_ci95=(0.009, 0.011))
CALM_FAULT = replace(FAULT, forecast=Forecast(0.02))


class Course:
    """A motor whose records come one by one, an hour apart."""

    def __init__(self, engine: Engine, repository: Repository) -> None:
        self._engine = engine
        self.repository = repository
        self.hours = 0

    @property
    def now_ns(self) -> int:
        return NOW_NS + self.hours * HOUR_NS

    def record(self, condition: Condition) -> None:
        """Have another record come, from which on this is said."""
        self.hours += 1
        with Session(self._engine) as session, session.begin():
            keep_observation(session, f"record {self.hours}", "PUMP-A1", observation(self.hours))
            row = session.get_one(ObservationRow, f"record {self.hours}")
            row.state, row.kind = condition.state, condition.kind
            session.flush()
            self._settle(session, condition)

    def tell(self, kind: EventKind, condition: Condition) -> None:
        """Have somebody tell of the motor, from which on this is said."""
        self.repository.add_event(
            "PUMP-A1", Event(self.now_ns + 1, kind, "why"), by=SERVICE, now_ns=self.now_ns
        )
        with Session(self._engine) as session, session.begin():
            self._settle(session, condition)

    def _settle(self, session: Session, condition: Condition) -> None:
        motor = session.get_one(MotorRow, "PUMP-A1")
        settle_alarm(session, motor, entry_of(condition), now_ns=self.now_ns, rules=RULES)

    def standing(self) -> tuple[Alarm, ...]:
        return self.repository.alarms(limit=10, motor="PUMP-A1", standing=True).items

    def forecast(self) -> Alarm:
        (alarm,) = [one for one in self.standing() if one.kind is AlarmKind.CONDITION_FORECAST]
        return alarm

    def alarm(self) -> Alarm:
        (alarm,) = self.standing()
        return alarm

    def calls(self) -> int:
        """How often people were called: an alarm that was not became unacknowledged."""
        alarms = self.repository.alarms(limit=100, motor="PUMP-A1").items
        return sum(
            change.after is AlarmState.UNACKNOWLEDGED and change.before is not AlarmState.UNACKNOWLEDGED
            for alarm in alarms
            for change in self.repository.alarm_changes(alarm.id, limit=100).items
        )

    def acknowledge(self) -> None:
        self.repository.acknowledge_alarm(self.alarm().id, by=ANN, now_ns=self.now_ns)


@pytest.fixture
def course(engine: Engine, repository: Repository) -> Course:
    return Course(engine, repository)


def test_a_single_record_on_watch_calls_nobody(course: Course) -> None:
    for condition in (HEALTHY, TURNS, HEALTHY, HEALTHY, TURNS, HEALTHY):
        course.record(condition)
    assert course.standing() == ()
    course.record(TURNS)
    assert course.alarm().kind is AlarmKind.CONDITION_WATCH
    assert course.alarm().priority is AlarmPriority.MEDIUM
    assert course.alarm().recording_id == "record 7"


def test_a_motor_that_wavers_has_one_alarm_that_ends_with_two_healthy_records(course: Course) -> None:
    for condition in (TURNS, TURNS, HEALTHY, TURNS, HEALTHY, TURNS):
        course.record(condition)
    assert len(course.standing()) == 1
    assert course.calls() == 1
    course.record(HEALTHY)
    course.record(HEALTHY)
    assert course.standing() == ()


def test_a_fault_is_told_at_once_and_supersedes_the_watch(course: Course) -> None:
    course.record(TURNS)
    course.record(TURNS)
    watch = course.alarm()
    course.record(CALM_FAULT)
    fault = course.alarm()
    assert (fault.kind, fault.priority) == (AlarmKind.CONDITION_FAULT, AlarmPriority.CRITICAL)
    assert course.repository.alarm(watch.id).state is AlarmState.NORMAL
    (latest, *_) = course.repository.alarm_changes(watch.id, limit=1).items
    assert latest.event is AlarmEvent.SUPERSEDED


def test_a_fault_that_becomes_milder_calls_nobody_who_knows_of_it(course: Course) -> None:
    course.record(CALM_FAULT)
    course.acknowledge()
    course.record(TURNS)
    assert course.alarm().kind is AlarmKind.CONDITION_FAULT  # one record is no proof
    course.record(TURNS)
    watch = course.alarm()
    assert (watch.kind, watch.state) == (AlarmKind.CONDITION_WATCH, AlarmState.ACKNOWLEDGED)
    assert watch.changed_by == "ann"


def test_growth_beyond_the_interval_reopens_an_acknowledged_alarm_and_only_that(course: Course) -> None:
    course.record(CALM_FAULT)  # 1.21 %, 0.90 % to 2.25 %
    course.record(replace(CALM_FAULT, mu_f=0.03, mu_f_ci95=(0.02, 0.04)))
    assert course.calls() == 1  # it calls already
    course.acknowledge()
    for level, low in ((0.031, 0.021), (0.040, 0.029), (0.0305, 0.0301)):
        course.record(replace(CALM_FAULT, mu_f=level, mu_f_ci95=(low, 0.05)))
        assert course.alarm().state is AlarmState.ACKNOWLEDGED
    course.record(replace(CALM_FAULT, mu_f=0.040, mu_f_ci95=(0.031, 0.05)))
    assert course.alarm().state is AlarmState.UNACKNOWLEDGED
    assert course.calls() == 2
    (reopened, *_) = course.repository.alarm_changes(course.alarm().id, limit=1).items
    assert reopened.event is AlarmEvent.REOPENED
    assert reopened.comment == "grown from 3.00% to 4.00%, 95 % interval above 3.10%"


def test_an_alarm_that_is_shelved_until_it_grows_calls_when_it_has(course: Course) -> None:
    course.record(CALM_FAULT)
    course.repository.shelve_alarm(course.alarm().id, by=ANN, now_ns=course.now_ns, growth=0.005)
    course.record(replace(CALM_FAULT, mu_f=0.0165, mu_f_ci95=(0.014, 0.02)))
    assert course.alarm().state is AlarmState.SHELVED
    course.record(replace(CALM_FAULT, mu_f=0.0175, mu_f_ci95=(0.016, 0.02)))
    assert course.alarm().state is AlarmState.UNACKNOWLEDGED


def test_another_kind_of_asymmetry_is_another_alarm(course: Course) -> None:
    course.record(DRIFTING)  # a voltage channel, or shorted turns
    course.record(CHANNEL)
    first = course.alarm()
    course.acknowledge()
    course.record(DRIFTING)
    course.record(CHANNEL)
    assert course.alarm().id == first.id  # it was told before
    course.record(TURNS)
    second = course.alarm()
    assert second.id != first.id
    assert (second.state, second.subject) == (AlarmState.UNACKNOWLEDGED, "shorted turns in phase c")
    assert course.repository.alarm(first.id).state is AlarmState.NORMAL
    assert course.calls() == 2


def test_what_was_taken_out_of_service_stays_so_whatever_is_seen(course: Course) -> None:
    course.record(CHANNEL)
    course.record(CHANNEL)
    course.repository.take_alarm_out_of_service(course.alarm().id, by=ANN, now_ns=course.now_ns)
    course.record(TURNS)
    assert course.alarm().state is AlarmState.OUT_OF_SERVICE
    assert course.alarm().subject == "shorted turns in phase c"


def test_a_motor_that_a_person_declares_healthy_has_no_alarm_at_once(course: Course) -> None:
    course.record(CALM_FAULT)
    course.tell(EventKind.REFERENCE_RESTARTED, HEALTHY)
    assert course.standing() == ()
    course.record(TURNS)
    assert course.standing() == ()  # what was before does not count
    course.record(TURNS)
    course.tell(EventKind.REWOUND, UNKNOWN)
    assert course.standing() == ()


def forecast(days: float, limit: float = 0.02) -> Condition:
    return replace(FAULT, forecast=Forecast(limit, (days / 2, days, 2 * days), 0.0004))


def test_a_limit_within_the_horizon_is_told_with_a_dead_band(course: Course) -> None:
    course.record(forecast(31.0))
    assert course.alarm().kind is AlarmKind.CONDITION_FAULT
    course.record(forecast(29.0))
    told = course.forecast()
    assert (told.subject, told.priority) == ("limit of 2.00%", AlarmPriority.HIGH)
    assert told.reason.startswith("the fault level will likely reach 2.00 % in 29 days (14 days to 58 days)")
    course.record(forecast(44.0))
    assert len(course.standing()) == 2
    course.record(forecast(46.0))
    assert course.alarm().kind is AlarmKind.CONDITION_FAULT


def test_a_limit_that_is_reached_gives_way_to_the_next_one(course: Course) -> None:
    course.record(forecast(5.0))
    first = course.forecast()
    course.record(forecast(10.0, limit=0.04))
    second = course.forecast()
    assert (second.subject, second.state) == ("limit of 4.00%", AlarmState.UNACKNOWLEDGED)
    assert course.repository.alarm(first.id).state is AlarmState.NORMAL
    course.record(forecast(40.0, limit=0.08))  # within the dead band, but of a limit that nobody was told of
    assert course.alarm().kind is AlarmKind.CONDITION_FAULT


def test_growth_that_has_stopped_takes_the_forecast_back_and_doubt_does_not(course: Course) -> None:
    course.record(forecast(5.0))
    course.record(replace(FAULT, forecast=Forecast(0.02, None, 0.0001)))
    assert len(course.standing()) == 2
    course.record(replace(FAULT, forecast=Forecast(0.02, None, -0.0001)))
    assert course.alarm().kind is AlarmKind.CONDITION_FAULT


def test_what_reads_too_little_is_worse_the_less_it_reads(course: Course) -> None:
    low = replace(CHANNEL, size=-0.010, size_ci95=(-0.011, -0.009))
    course.record(low)
    course.record(low)
    (alarm,) = course.standing()
    assert alarm.value == pytest.approx(0.010)


def test_a_level_in_another_measure_is_no_growth(course: Course) -> None:
    course.record(DRIFTING)
    course.record(replace(DRIFTING, mu_f=0.004, mu_f_ci95=(0.003, 0.005)))
    course.acknowledge()
    course.record(CHANNEL)  # an error of 1 % of a channel, after a fault level of 0.4 %
    assert course.alarm().state is AlarmState.ACKNOWLEDGED
    course.record(replace(CHANNEL, size=0.02, size_ci95=(0.019, 0.021)))
    assert course.alarm().state is AlarmState.UNACKNOWLEDGED


def test_states_that_a_record_has_alone_are_not_those_of_the_motor() -> None:
    assert RULES.kind_of([State.UNKNOWN, State.WATCH], None) is None
