"""The states of motors in the fleet, and which of them come first."""

from dataclasses import replace

import pytest

from core.condition.kinds import State
from core.diagnosis.verdict import Verdict
from core.machines.parameters import ParametersSource
from core.motor_condition.condition import motor_condition
from core.motor_condition.judging import rotor_part
from core.rotor.finding import RotorState
from core.rotor.trend import RotorCondition
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.storage.records import (
    CallingAlarms,
    ConditionEntry,
    FleetMotor,
    LatestFigures,
    MotorEntry,
)
from service.storage.states import AlarmPriority, LinkState
from service.web.fleet.filters import FleetFilter
from service.web.fleet.rows import FleetRow, counts, row_of
from service.web.fleet.states import FleetState, states_of
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, entry_of
from testing.service.plants import NOW_NS

DAY_NS = NANOSECONDS_PER_DAY
WEEK_NS = 7 * DAY_NS
NEVER = replace(entry_of(HEALTHY), state=State.UNKNOWN, as_of_ns=None, document=None, mu_f=None)


def seen(entry: ConditionEntry, days: float, stood: float | None = None) -> ConditionEntry:
    """A condition whose latest record is so many days old, and which was seen to stand so long ago."""
    stood_ns = None if stood is None else NOW_NS - round(stood * DAY_NS)
    return replace(entry, as_of_ns=NOW_NS - round(days * DAY_NS), stood_ns=stood_ns)


@pytest.mark.parametrize(
    ("entry", "expected"),
    [
        (seen(entry_of(HEALTHY), 1), ["healthy"]),
        (seen(entry_of(HEALTHY), 8), ["stale"]),
        (seen(entry_of(HEALTHY), 8, stood=1), ["not-running"]),
        (seen(entry_of(HEALTHY), 1, stood=2), ["healthy"]),
        (seen(entry_of(HEALTHY), 30, stood=8), ["stale"]),
        (seen(entry_of(FAULT), 1), ["fault"]),
        (seen(entry_of(FAULT), 8), ["fault", "stale"]),
        (seen(entry_of(FAULT), 8, stood=1), ["fault", "not-running"]),
        (seen(entry_of(DRIFTING), 8), ["watch", "stale"]),
        (NEVER, ["unknown"]),
        (replace(NEVER, stood_ns=NOW_NS - DAY_NS), ["not-running"]),
        (replace(NEVER, stood_ns=NOW_NS - 8 * DAY_NS), ["stale"]),
        (seen(replace(entry_of(HEALTHY), state=State.UNKNOWN), 1), ["unknown"]),
    ],
)
def test_what_is_known_and_whether_that_is_still_known(entry: ConditionEntry, expected: list[str]) -> None:
    assert list(states_of(entry, NOW_NS, WEEK_NS)) == expected


def motor_of(
    name: str, entry: ConditionEntry, *, alarms: CallingAlarms | None = None, site: str = "MILL"
) -> FleetMotor:
    entry = replace(entry, motor=name)
    motor = MotorEntry(name, f"{name} of the plant", site, "R1", None, ParametersSource.GIVEN)
    return FleetMotor(motor, entry, LinkState.UP, NOW_NS, None, alarms)


def row(
    name: str, entry: ConditionEntry, *, alarms: CallingAlarms | None = None, site: str = "MILL"
) -> FleetRow:
    return row_of(motor_of(name, entry, alarms=alarms, site=site), NOW_NS, 7.0)


def calling(urgency: int, priority: AlarmPriority) -> CallingAlarms:
    return CallingAlarms(1, urgency, "an-alarm", priority, NOW_NS)


def test_a_broken_rotor_counts_as_a_fault_beside_a_healthy_winding() -> None:
    motor = motor_of("PUMP", seen(entry_of(HEALTHY), 1))
    rotor = RotorCondition(RotorState.FAULT, -29.0, (-31.0, -27.0), None, WEEK_NS, (), ())
    whole = motor_condition(HEALTHY, (rotor_part(rotor),))
    entry = replace(
        motor.condition,
        state=whole.state,
        kind=whole.kind,
        since_ns=whole.since_ns,
        document=whole.as_dict(),
    )
    broken = row_of(replace(motor, condition=entry), NOW_NS, 7.0)
    sound = row_of(motor, NOW_NS, 7.0)
    assert broken.state is FleetState.FAULT
    assert broken.needs_attention
    assert (broken.kind, broken.since_ns) == (whole.finding, WEEK_NS)
    assert not sound.needs_attention
    assert broken.advice.startswith("Have the cage inspected")
    assert sorted((sound, broken), key=lambda one: one.attention)[0] is broken
    assert FleetFilter(state=FleetState.FAULT, text="rotor").chosen([sound, broken]) == [broken]
    assert counts([sound, broken])[FleetState.FAULT] == 1


def test_what_needs_attention_comes_first() -> None:
    grows = entry_of(replace(FAULT, forecast=replace(FAULT.forecast, growth_per_day=0.01)))
    rows = [
        row("healthy of today", seen(entry_of(HEALTHY), 0)),
        row("healthy of yesterday", seen(entry_of(HEALTHY), 1)),
        row("at rest", seen(entry_of(HEALTHY), 8, stood=0)),
        row("stale", seen(entry_of(HEALTHY), 8)),
        row("never seen", NEVER),
        row("watch", seen(entry_of(DRIFTING), 0)),
        row("fault", seen(entry_of(FAULT), 0)),
        row("fault that grows", seen(grows, 0)),
        row("low alarm", seen(entry_of(HEALTHY), 0), alarms=calling(30, AlarmPriority.LOW)),
        row("critical alarm", seen(entry_of(HEALTHY), 0), alarms=calling(33, AlarmPriority.CRITICAL)),
    ]
    assert [one.name for one in sorted(rows, key=lambda one: one.attention)] == [
        "critical alarm",
        "low alarm",
        "fault that grows",
        "fault",
        "watch",
        "never seen",
        "stale",
        "at rest",
        "healthy of yesterday",
        "healthy of today",
    ]


def test_a_count_is_the_number_of_motors_that_its_filter_shows() -> None:
    rows = [
        row("A", seen(entry_of(FAULT), 8)),
        row("B", seen(entry_of(HEALTHY), 8)),
        row("C", seen(entry_of(HEALTHY), 0), site="QUARRY"),
    ]
    for state, number in counts(rows).items():
        assert len(FleetFilter(state=state).chosen(rows)) == number
    assert counts(rows)[FleetState.STALE] == 1
    assert [one.name for one in FleetFilter(site="QUARRY").chosen(rows)] == ["C"]
    assert [one.name for one in FleetFilter(text="TURNS  no recent").chosen(rows)] == ["A"]
    assert FleetFilter(text="nowhere").chosen(rows) == []
    assert FleetFilter("Mill 1", FleetState.FAULT, "a&b").address() == "/?site=Mill+1&state=fault&text=a%26b"


def test_a_row_says_what_since_when_how_bad_how_sure_and_what_to_do() -> None:
    told = row("A", seen(entry_of(FAULT), 0))
    assert told.kind == "shorted turns, phase b"
    assert (told.level, told.interval) == (0.0121, (0.009, 0.0225))
    assert told.since_ns == FAULT.since_ns
    assert told.advice == FAULT.advice
    assert told.growth_per_day == 0.0004
    assert told.expected(NOW_NS) == "It likely reaches 2.00 % in about 20 days, on 2025-10-29."
    assert told.visible == 0.0045
    assert told.reference == pytest.approx((0.0, 0.0046))
    assert told.needs_attention


def test_a_motor_without_a_recent_record_gets_no_advice_that_nobody_knows_to_hold() -> None:
    assert row("A", seen(entry_of(HEALTHY), 0)).advice == ""
    stale = row("A", seen(entry_of(HEALTHY), 8))
    assert stale.advice.startswith("Last known: healthy.")
    assert "Nothing needs to be done" not in stale.advice
    assert "Nothing needs to be done" not in row("A", seen(entry_of(HEALTHY), 8, stood=0)).advice
    assert "Last known" not in row("A", NEVER).advice
    stood = row("A", replace(NEVER, stood_ns=NOW_NS - 8 * DAY_NS))
    assert stood.advice.startswith("No valid record yet. Have the motor recorded")
    assert stood.is_at_rest


def test_a_healthy_motor_whose_changes_could_not_be_seen_is_in_doubt() -> None:
    assert HEALTHY.reference is not None
    coarse = replace(HEALTHY, reference=replace(HEALTHY.reference, detectable=0.1687))
    motor = motor_of("B", seen(entry_of(coarse), 0))
    doubted = row_of(motor, NOW_NS, 7.0)
    assert doubted.state is FleetState.HEALTHY
    assert "a change below 17 % would not be seen." in doubted.doubt
    record = LatestFigures("B", NOW_NS, 0.02, 0.8, Verdict.FAULT)
    told = row_of(replace(motor, figures=record), NOW_NS, 7.0).doubt
    assert told.endswith("and its latest record by itself shows a fault.")
    plain = row("A", seen(entry_of(HEALTHY), 0))
    assert plain.doubt == ""
    assert sorted([plain, doubted], key=lambda each: each.attention) == [doubted, plain]


def test_a_key_has_no_part_of_a_name_and_a_digest_no_age() -> None:
    hostile = row('"><script>', seen(entry_of(HEALTHY), 0))
    assert hostile.key.replace("motor-", "").isalnum()
    motor = motor_of("A", seen(entry_of(HEALTHY), 0))
    later_ns = NOW_NS + 3600 * NANOSECONDS_PER_SECOND
    assert row_of(motor, NOW_NS, 7.0).digest == row_of(motor, later_ns, 7.0).digest
    assert row_of(motor, NOW_NS, 7.0).digest != row_of(motor, NOW_NS + 8 * DAY_NS, 7.0).digest
