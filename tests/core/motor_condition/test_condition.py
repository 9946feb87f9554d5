"""The one condition of a motor: its worst part, and what one cause explains besides."""

from dataclasses import replace

import pytest

from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.motor_condition.condition import MotorCondition, Urgency, motor_condition
from core.motor_condition.judging import parameters_part, rotor_part, starts_part
from core.motor_condition.parts import Part, PartCondition, findings_beside_stator, parts_of
from core.rotor.finding import RotorState
from core.rotor.trend import RotorCondition
from core.starts.notable import StartSeen
from core.tracking.finding import DriftCause, TrackedParameters, TrackingState
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, UNKNOWN

BROKEN = rotor_part(RotorCondition(RotorState.FAULT, -29.0, (-30.0, -28.0), 30.0, 5, (), ("3 of 3",)))
EVEN = rotor_part(RotorCondition(RotorState.HEALTHY, -70.0, (-74.0, -66.0), None, 0, (), ()))
CHANNEL = replace(FAULT, state=State.WATCH, kind=Kind.VOLTAGE_CHANNEL, phase="a", mu_f_ci95=(0.0, 0.02))


def drift(*causes: DriftCause) -> PartCondition:
    return parameters_part(
        TrackedParameters(TrackingState.DRIFTING, (), 40, 0, True, None, None, causes, ())  # noqa: FBT003
    )


def state(found: MotorCondition, part: Part) -> State:
    one = found.of(part)
    assert one is not None
    return one.state


def test_a_motor_of_which_all_is_well_is_healthy() -> None:
    found = motor_condition(HEALTHY, (EVEN,))
    assert (found.state, found.kind, found.urgency) == (State.HEALTHY, Kind.NONE, Urgency.NONE)
    assert found.advice == HEALTHY.advice
    assert found.as_dict()["phase"] is None


def test_a_broken_cage_makes_a_motor_with_a_healthy_winding_a_fault() -> None:
    found = motor_condition(HEALTHY, (BROKEN,))
    assert (found.state, found.kind, found.since_ns) == (State.FAULT, Kind.ROTOR, 5)
    assert "broken rotor bars" in found.finding
    assert "cage inspected" in found.advice
    assert found.urgency is Urgency.WEEKS
    assert state(found, Part.STATOR) is State.HEALTHY
    assert findings_beside_stator(found.parts) == found.finding


def test_of_two_faults_the_winding_comes_first_and_both_are_named() -> None:
    found = motor_condition(FAULT, (BROKEN,))
    assert (found.state, found.kind, found.urgency) == (State.FAULT, Kind.SHORTED_TURNS, Urgency.DAYS)
    assert found.finding == f"shorted turns in phase b; {BROKEN.finding}"
    assert found.advice.startswith(FAULT.advice)
    assert "cage inspected" in found.advice
    assert found.as_dict()["phase"] == "b"


def test_a_fault_of_the_rotor_comes_before_a_winding_on_watch() -> None:
    found = motor_condition(DRIFTING, (BROKEN,))
    assert (found.state, found.kind) == (State.FAULT, Kind.ROTOR)
    document = found.as_dict()
    assert (document["phase"], document["candidates"]) == (None, [])


def test_a_broken_cage_explains_parameters_that_drift() -> None:
    drifting = drift(DriftCause.LEAKAGE)
    alone = motor_condition(HEALTHY, (EVEN, drifting))
    assert (alone.state, alone.kind) == (State.WATCH, Kind.PARAMETERS)
    found = motor_condition(HEALTHY, (BROKEN, drifting))
    explained = found.of(Part.PARAMETERS)
    assert explained is not None
    assert explained.explained_by is Part.ROTOR
    assert found.finding == BROKEN.finding


@pytest.mark.parametrize(
    ("causes", "part", "kind"),
    [
        ((DriftCause.WINDING_HOT,), Part.THERMAL, Kind.THERMAL),
        ((DriftCause.MAGNETISING,), Part.PARAMETERS, Kind.PARAMETERS),
        ((DriftCause.RATIO,), Part.MEASUREMENT, Kind.PARAMETERS),
        ((DriftCause.WINDING_HOT, DriftCause.ROTOR), Part.PARAMETERS, Kind.PARAMETERS),
    ],
)
def test_a_drift_is_of_the_part_that_its_one_cause_is_of(
    causes: tuple[DriftCause, ...], part: Part, kind: Kind
) -> None:
    found = motor_condition(HEALTHY, (EVEN, drift(*causes)))
    assert (found.state, found.kind, state(found, part)) == (State.WATCH, kind, State.WATCH)


def test_a_wrong_channel_is_of_the_measurement_and_says_what_it_hides() -> None:
    found = motor_condition(CHANNEL, (EVEN,))
    assert (found.state, found.kind, found.as_dict()["phase"]) == (State.WATCH, Kind.VOLTAGE_CHANNEL, "a")
    assert state(found, Part.MEASUREMENT) is State.WATCH
    stator = found.of(Part.STATOR)
    assert stator is not None
    assert (stator.state, stator.finding) == (
        State.HEALTHY,
        "no shorted turns are seen; beside it, 2.00% of the turns would not be",
    )
    assert findings_beside_stator(found.parts) == ""


def test_a_motor_of_which_nothing_is_known_is_not_healthy_and_its_rotor_counts_all_the_same() -> None:
    assert motor_condition(UNKNOWN, (EVEN,)).state is State.UNKNOWN
    assert motor_condition(UNKNOWN, (BROKEN,)).state is State.FAULT


def test_hard_starts_put_a_motor_on_watch() -> None:
    hard = StartSeen(time_ns=7, within_hour=4, allowed=2, heat=None)
    found = motor_condition(HEALTHY, (EVEN, starts_part([hard], None, None)))
    assert (found.state, found.kind, found.since_ns) == (State.WATCH, Kind.STARTS, 7)
    assert any(reason.startswith("starts: 4 starts in the hour") for reason in found.reasons)


@pytest.mark.parametrize("stator", [HEALTHY, FAULT, DRIFTING, CHANNEL, UNKNOWN])
def test_parts_are_read_back_from_the_document(stator: Condition) -> None:
    found = motor_condition(stator, (BROKEN, drift(DriftCause.RATIO)))
    document = found.as_dict()
    assert parts_of(document) == found.parts
    assert Condition.from_dict(document).mu_f == stator.mu_f


def test_a_supply_on_which_no_motor_should_run_is_urgent_and_no_fault_of_the_motor() -> None:
    supply = PartCondition(Part.SUPPLY, State.FAULT, "unbalanced voltage", advice="Have it put right today.")
    found = motor_condition(HEALTHY, (EVEN, supply))
    assert (found.state, found.kind, found.urgency) == (State.WATCH, Kind.SUPPLY, Urgency.TODAY)
    assert state(found, Part.SUPPLY) is State.FAULT
    with_joint = motor_condition(replace(FAULT, state=State.WATCH, kind=Kind.CONNECTION), (supply,))
    assert with_joint.kind is Kind.CONNECTION
    assert with_joint.urgency is Urgency.TODAY
