"""What stands out from the first record on: the condition that it makes, alone and beside a change."""

from dataclasses import replace

import pytest

from core.condition.assessment import Change, Declared
from core.condition.kinds import Kind, State
from core.condition.verdict.judging import condition_of
from testing.machines.motors import REFERENCE as MOTOR
from tests.core.condition.verdict.assessments import (
    AS_OF_NS,
    SINCE_NS,
    assessment,
    change,
    judged,
    level,
    reference,
)


def test_a_standing_fault_is_one_from_the_first_record_on() -> None:
    standing = reference(standing=level(0.03, 0.005, winding=2), score=6.0)
    condition = judged(assessment(reference=standing, standing_fault=True))
    assert (condition.state, condition.kind, condition.phase) == (State.FAULT, Kind.SHORTED_TURNS, "c")
    assert condition.since_ns == standing.since_ns
    assert condition.mu_f == pytest.approx(0.03)
    assert condition.mu_f_ci95 == pytest.approx((0.03 - 0.0098, 0.03 + 0.0098))


def test_a_standing_asymmetry_that_is_not_sure_is_watched() -> None:
    standing = reference(standing=level(0.012, 0.004), score=3.8)
    condition = judged(assessment(reference=standing))
    assert (condition.state, condition.kind) == (State.WATCH, Kind.UNCLEAR)
    assert condition.candidates == (Kind.SHORTED_TURNS, Kind.VOLTAGE_CHANNEL)


def test_a_standing_asymmetry_that_a_person_declared_healthy_is_left() -> None:
    accepted = replace(reference(standing=level(0.012, 0.004), score=3.8), accepted=True)
    condition = judged(assessment(reference=accepted))
    assert (condition.state, condition.mu_f) == (State.HEALTHY, 0.0)
    assert condition.mu_f_ci95 == (0.0, accepted.standing.ci95[1])
    assert any("as shorted turns in phase b: 1.20 %" in reason for reason in condition.reasons)
    declared = replace(accepted, declared=Declared(0.032, (0.02, 0.04), "c"))
    told = judged(assessment(reference=declared))
    assert any("until then" in reason and "phase c: 3.20 %" in reason for reason in told.reasons)
    assert told.as_dict()["reference"]["accepted_level"] == 0.032  # type: ignore[index]  # a document


def test_a_standing_fault_that_grows_adds_up_where_it_is_one_winding() -> None:
    standing = reference(standing=level(0.03, 0.004, winding=1), score=7.0)
    grown = judged(
        assessment(
            change(Kind.SHORTED_TURNS, size=level(0.01, 0.003)), reference=standing, standing_fault=True
        )
    )
    assert grown.mu_f == pytest.approx(0.04)
    assert grown.mu_f_ci95 is not None
    assert grown.mu_f_ci95[1] == pytest.approx(0.04 + 1.96 * 0.005)
    elsewhere = judged(assessment(change(Kind.SHORTED_TURNS), reference=reference(score=7.0)))
    assert elsewhere.mu_f == pytest.approx(0.01)


def test_a_standing_fault_is_one_only_above_the_motors_limit() -> None:
    standing = reference(standing=level(0.06, 0.005), score=8.0)
    lenient = replace(MOTOR, limits=replace(MOTOR.limits, fault_level=0.1))
    found = assessment(reference=standing, standing_fault=True)
    condition = condition_of(lenient, found, AS_OF_NS)
    assert (condition.state, condition.kind) == (State.WATCH, Kind.SHORTED_TURNS)
    assert any("lies below the motor's limit" in reason for reason in condition.reasons)
    unsure = reference(standing=level(0.06, 0.04), score=3.8)
    judged_by_default = condition_of(MOTOR, assessment(reference=unsure, standing_fault=True), AS_OF_NS)
    assert judged_by_default.state is State.FAULT, "its interval reaches below the limit, its level does not"


def test_a_standing_fault_stays_one_until_it_is_surely_below_the_limit() -> None:
    below = reference(standing=level(0.0045, 0.0005), score=4.0)
    assert judged(assessment(reference=below, standing_fault=True)).state is State.WATCH
    condition = judged(assessment(reference=below, standing_fault=True, called_above=0.0051))
    assert condition.state is State.FAULT
    assert any("stays a fault" in reason for reason in condition.reasons)
    surely = replace(below, standing=level(0.003, 0.0005))
    assert judged(assessment(reference=surely, standing_fault=True, called_above=0.0051)).state is State.WATCH


def test_a_standing_asymmetry_is_watched_until_its_score_has_fallen_for_sure() -> None:
    fallen = reference(standing=level(0.004, 0.001), score=3.0)
    assert judged(assessment(reference=fallen)).state is State.HEALTHY
    held = judged(assessment(reference=fallen, held_score=3.3))
    assert (held.state, held.kind) == (State.WATCH, Kind.UNCLEAR)


@pytest.mark.parametrize(
    "beside",
    [
        change(size=level(0.009, 0.004, winding=0), probabilities={Kind.SHORTED_TURNS: 0.5}),
        change(Kind.SHORTED_TURNS, size=level(0.01, 0.004, winding=0)),
        change(Kind.VOLTAGE_CHANNEL),
        change(Kind.CONNECTION, size=level(0.009, winding=0)),
    ],
)
def test_what_is_no_fault_beside_a_standing_fault_takes_nothing_back(beside: Change) -> None:
    standing = reference(standing=level(0.008, 0.003), score=4.0)
    assert judged(assessment(reference=standing, standing_fault=True)).state is State.FAULT
    assert judged(assessment(beside, reference=standing, standing_fault=True)).state is State.FAULT


def test_a_standing_fault_below_the_limit_takes_no_called_fault_back() -> None:
    called = replace(change(Kind.SHORTED_TURNS, size=level(0.0045, 0.0005)), surely_above=0.0051)
    below = reference(standing=level(0.0048, 0.001, winding=2), score=3.8)
    assert judged(assessment(called)).state is State.FAULT
    assert judged(assessment(called, reference=below, standing_fault=True)).state is State.FAULT


def test_an_open_change_does_not_lift_a_standing_fault_above_the_limit() -> None:
    below = reference(standing=level(0.003, 0.0005), score=4.0)
    open_change = change(size=level(0.003), probabilities={Kind.SHORTED_TURNS: 0.03})
    assert judged(assessment(open_change, reference=below, standing_fault=True)).state is State.WATCH


@pytest.mark.parametrize(
    ("value", "score", "state"),
    [(0.004, 3.1, State.HEALTHY), (0.004, 3.3, State.WATCH), (0.05, 2.8, State.WATCH)],
)
def test_a_standing_asymmetry_is_watched_before_it_is_sure(value: float, score: float, state: State) -> None:
    condition = judged(assessment(reference=reference(standing=level(value, 0.001), score=score)))
    assert condition.state is state
    assert condition.mu_f is not None
    assert state is not State.HEALTHY or condition.mu_f <= MOTOR.limits.fault_level


@pytest.mark.parametrize(("grown", "phase", "mu_f"), [(0.01, "c", 0.03), (0.05, "b", 0.05)])
def test_of_faults_in_two_windings_the_worse_is_told_alone(grown: float, phase: str, mu_f: float) -> None:
    standing = reference(standing=level(0.03, 0.004, winding=2), score=7.0)
    seen = change(Kind.SHORTED_TURNS, size=level(grown, 0.001))
    condition = judged(assessment(seen, reference=standing, standing_fault=True))
    assert (condition.state, condition.kind, condition.phase) == (State.FAULT, Kind.SHORTED_TURNS, phase)
    assert condition.mu_f == pytest.approx(mu_f)
    assert condition.since_ns == (standing.since_ns if phase == "c" else SINCE_NS)
