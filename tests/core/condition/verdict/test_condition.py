"""A motor's condition from what its records tell: states, kinds, levels and the document."""

import json
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.condition.assessment import STALE_AFTER_NS, Assessment, Change, Declared, Level, Reference
from core.condition.events import Event, EventKind
from core.condition.filter.state import START
from core.condition.kinds import BESIDE_STATOR, Kind, State
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from core.machines.parameters import ParametersSource
from core.units import NANOSECONDS_PER_DAY
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

KEYS = {
    *("motor", "state", "kind", "phase", "mu_f", "mu_f_ci95", "change", "change_ci95", "since"),
    *("growth_per_day", "forecast", "reference", "as_of", "stale", "advice", "reasons"),
}
"""The contract; further keys may stand beside them."""


def test_no_valid_record_is_unknown_and_stale() -> None:
    condition = judged(None)
    assert (condition.state, condition.kind, condition.stale) == (State.UNKNOWN, Kind.NONE, True)
    assert condition.as_dict()["reference"] == {"records": 0, "complete": False, "standing": None}


def test_an_event_after_the_latest_record_is_the_reason_of_not_knowing() -> None:
    event = Event(AS_OF_NS, EventKind.MAINTENANCE, "terminals tightened")
    (reason,) = condition_of(MOTOR, None, AS_OF_NS, ended_by=event).reasons
    assert "since the event maintenance (terminals tightened) of 2027-01-15T08:00:00Z" in reason


@pytest.mark.parametrize(
    ("probability", "words"),
    [(1.0, "more than 99 %"), (0.9901, "more than 99 %"), (0.985, "probability 98 %")],
)
def test_nothing_is_told_as_certain(probability: float, words: str) -> None:
    seen = change(Kind.VOLTAGE_CHANNEL, probabilities={Kind.VOLTAGE_CHANNEL: probability})
    (told, *_) = judged(assessment(replace(seen, size_ci95=(0.015, 0.025)))).reasons
    assert told.endswith(words)
    assert "by 2.00 % (95 % interval 1.50 % to 2.50 %) since" in told
    (told, *_) = judged(assessment(change(probabilities={Kind.CONNECTION: probability}))).reasons
    assert words.removeprefix("probability ") in told


def test_a_growth_that_is_not_certain_has_no_time() -> None:
    flat = tuple((AS_OF_NS - (99 - k) * NANOSECONDS_PER_DAY // 24, 0.003) for k in range(100))
    condition = judged(assessment(change(Kind.SHORTED_TURNS, size=level(0.003, 0.0002)), levels=flat))
    assert condition.forecast.days is None
    assert any("may never reach 0.50 %" in reason for reason in condition.reasons)
    assert not any("grows by" in reason for reason in condition.reasons)


def test_no_change_is_healthy_from_the_first_record_on() -> None:
    early = judged(assessment(reference=reference(records=1, complete=False)))
    assert (early.state, early.kind, early.change) == (State.HEALTHY, Kind.NONE, None)
    late = judged(assessment())
    assert (late.state, late.phase, late.change, late.since_ns) == (State.HEALTHY, None, 0.0, None)


def test_how_many_records_a_reference_still_needs_is_told() -> None:
    early = judged(assessment(reference=reference(records=4, complete=False)))
    assert any(f"still being learnt (4 of {START} records)" in reason for reason in early.reasons)
    learnt = judged(assessment(reference=reference(records=START, complete=False)))
    assert any("changes can be seen from the next record on" in reason for reason in learnt.reasons)


def test_a_nameplate_alone_is_never_healthy_and_on_watch_at_most() -> None:
    typical = replace(MOTOR, parameters_source=ParametersSource.TYPICAL)
    quiet = condition_of(typical, assessment(), AS_OF_NS)
    assert (judged(assessment()).state, quiet.state) == (State.HEALTHY, State.UNKNOWN)
    assert quiet.advice.startswith("collecting; commission me.")
    assert quiet.mu_f == judged(assessment()).mu_f
    grown = assessment(change(Kind.SHORTED_TURNS, size=level(0.03)))
    shorted = condition_of(typical, grown, AS_OF_NS)
    assert (judged(grown).state, shorted.state) == (State.FAULT, State.WATCH)
    assert shorted.kind is Kind.SHORTED_TURNS
    assert shorted.advice.endswith("from its data sheet.")
    for one in (quiet, shorted, condition_of(typical, None, AS_OF_NS)):
        assert one.reasons[0].startswith("collecting; commission me: the parameters are typical")


def test_what_sensors_leave_is_in_the_interval_and_not_in_the_level() -> None:
    healthy = judged(assessment())
    assert healthy.mu_f == pytest.approx(0.0, abs=1e-4)
    assert healthy.mu_f_ci95 == pytest.approx((0.0, 0.004 + 1.96 * 0.005), abs=1e-4)


@pytest.mark.parametrize(
    ("named", "size", "state", "kind", "phase"),
    [
        ((Kind.SHORTED_TURNS,), level(0.0065), State.FAULT, Kind.SHORTED_TURNS, "b"),
        ((Kind.SHORTED_TURNS,), level(0.0055), State.WATCH, Kind.SHORTED_TURNS, "b"),
        ((Kind.SHORTED_TURNS, Kind.CONNECTION), level(0.0065), State.FAULT, Kind.UNCLEAR, "b"),
        ((Kind.CONNECTION, Kind.SHORTED_TURNS), level(0.0055), State.WATCH, Kind.UNCLEAR, "b"),
        ((Kind.SHORTED_TURNS, Kind.VOLTAGE_CHANNEL), level(0.02), State.WATCH, Kind.UNCLEAR, "b"),
        ((Kind.VOLTAGE_CHANNEL,), level(0.02), State.WATCH, Kind.VOLTAGE_CHANNEL, "a"),
        ((Kind.CURRENT_CHANNEL,), level(0.02), State.WATCH, Kind.CURRENT_CHANNEL, "a"),
        ((Kind.CONNECTION,), level(0.02), State.WATCH, Kind.CONNECTION, "a"),
    ],
)
def test_only_shorted_turns_above_the_limit_are_a_fault(
    named: tuple[Kind, ...], size: Level, state: State, kind: Kind, phase: str
) -> None:
    condition = judged(assessment(change(*named, size=size)))
    assert (condition.state, condition.kind, condition.phase) == (state, kind, phase)
    assert condition.since_ns == SINCE_NS
    assert condition.candidates == (named if len(named) > 1 else ())


@pytest.mark.parametrize(
    ("value", "named", "state"),
    [
        (0.0055, (Kind.SHORTED_TURNS,), State.FAULT),
        (0.0055, (Kind.SHORTED_TURNS, Kind.CONNECTION), State.FAULT),
        (0.003, (Kind.SHORTED_TURNS,), State.WATCH),
        (0.0055, (Kind.CONNECTION,), State.WATCH),
    ],
)
def test_what_was_called_a_fault_stays_one_until_it_is_surely_below_the_limit(
    value: float, named: tuple[Kind, ...], state: State
) -> None:
    seen = change(*named, size=level(value))
    assert judged(assessment(seen)).state is State.WATCH
    condition = judged(assessment(replace(seen, surely_above=0.0051)))
    assert condition.state is state
    assert any("stays a fault" in reason for reason in condition.reasons) == (state is State.FAULT)


def test_an_open_change_is_watched_with_its_candidates() -> None:
    probabilities = {Kind.SUPPLY: 0.005, Kind.CONNECTION: 0.295, Kind.SHORTED_TURNS: 0.7}
    condition = judged(assessment(change(probabilities=probabilities)))
    assert (condition.state, condition.kind, condition.phase) == (State.WATCH, Kind.UNCLEAR, None)
    assert condition.candidates == (Kind.SHORTED_TURNS, Kind.CONNECTION)
    assert condition.change == 0.01
    assert condition.mu_f_ci95 is not None
    assert condition.mu_f_ci95[0] == 0.0  # it may be a joint


def test_a_change_that_is_no_shorted_turns_leaves_the_level() -> None:
    condition = judged(assessment(change(Kind.VOLTAGE_CHANNEL)))
    healthy = judged(assessment())
    assert (condition.mu_f, condition.mu_f_ci95) == (healthy.mu_f, healthy.mu_f_ci95)
    assert (condition.change, condition.change_ci95, condition.size) == (0.0, None, 0.02)


def test_a_surprise_is_watched_until_it_is_confirmed() -> None:
    condition = judged(assessment(unconfirmed=True))
    assert (condition.state, condition.kind, condition.candidates) == (State.WATCH, Kind.UNCLEAR, ())
    assert "confirm" in condition.reasons[0]


def test_another_impedance_has_no_size() -> None:
    seen = replace(change(Kind.PARAMETERS), size=None, channel=None)
    condition = judged(assessment(seen))
    assert condition.size is None
    assert "has changed since" in condition.reasons[0]


def test_time_ages_a_condition_and_nothing_else() -> None:
    condition = judged(assessment())
    assert not condition.seen_at(AS_OF_NS + STALE_AFTER_NS).stale
    late = condition.seen_at(AS_OF_NS + STALE_AFTER_NS + 1)
    assert late == replace(condition, stale=True)
    assert late == condition_of(MOTOR, assessment(), AS_OF_NS + STALE_AFTER_NS + 1)


def test_a_level_that_grows_has_a_forecast() -> None:
    grows = tuple((AS_OF_NS - (99 - k) * NANOSECONDS_PER_DAY // 24, 3e-5 * k) for k in range(100))
    named = change(Kind.SHORTED_TURNS, size=level(0.003, 0.0002))
    condition = judged(assessment(named, levels=grows))
    assert condition.forecast.limit == MOTOR.limits.fault_level
    assert condition.forecast.days is not None
    assert condition.forecast.days[1] == pytest.approx(0.002 / 3e-5 / 24, rel=0.2)
    assert condition.forecast.growth_per_day == pytest.approx(24 * 3e-5, rel=0.05)
    assert any("grows by" in reason for reason in condition.reasons)
    above = judged(assessment(change(Kind.SHORTED_TURNS, size=level(0.012)), levels=grows))
    assert above.forecast.limit == 0.02


KINDS = st.sampled_from([kind for kind in Kind if kind not in {Kind.NONE, *BESIDE_STATOR}])
SURE = {0: (0.98, 0.01, 0.01), 1: (0.01, 0.98, 0.01), 2: (0.0, 0.04, 0.96)}
LEVELS = st.builds(
    lambda value, deviation, winding, axis: Level(value, deviation, winding, None, SURE[winding], axis),
    st.floats(-0.01, 0.3),
    st.floats(1e-6, 0.05),
    st.sampled_from([0, 1, 2]),
    st.none() | st.floats(-30.0, 30.0),
)
CHANGES = st.builds(
    Change,
    since_ns=st.integers(AS_OF_NS - 10**17, AS_OF_NS),
    detected_ns=st.just(AS_OF_NS),
    probabilities=st.dictionaries(KINDS, st.floats(0.0, 1.0)),
    named=st.lists(KINDS, max_size=2, unique=True).map(tuple),
    level=LEVELS,
    channel=st.none() | st.sampled_from([0, 1, 2]),
    size=st.none() | st.floats(-0.1, 0.1),
    surely_above=st.floats(0.0, 0.1),
    size_ci95=st.none() | st.tuples(st.floats(-0.2, 0.0), st.floats(0.0, 0.2)),
)
STANDING = st.builds(
    lambda found, low, high: replace(found, interval=(low, low + high)),
    LEVELS, st.floats(0.0, 0.1), st.floats(0.0, 0.2),
)  # fmt: skip
REFERENCES = st.builds(
    Reference,
    records=st.integers(1, 10**6),
    complete=st.booleans(),
    since_ns=st.none() | st.integers(0, AS_OF_NS),
    detectable=st.none() | st.floats(0, 0.1),
    standing=STANDING,
    standing_score=st.floats(0, 50),
    from_bus=st.booleans(),
    accepted=st.booleans(),
    declared=st.none()
    | st.builds(
        Declared,
        st.floats(0.0, 0.3),
        st.tuples(st.floats(0.0, 0.1), st.floats(0.1, 0.5)),
        st.sampled_from(["a", "b", "c"]),
    ),
)
ASSESSMENTS = st.builds(
    Assessment,
    as_of_ns=st.just(AS_OF_NS),
    reference=REFERENCES,
    change=st.none() | CHANGES,
    standing_fault=st.booleans(),
    statistic=st.floats(0, 100),
    threshold=st.just(16.0),
    unconfirmed=st.booleans(),
    called_above=st.floats(0.0, 0.1),
    held_score=st.floats(0.0, 50.0),
)


@given(st.none() | ASSESSMENTS)
def test_the_document_tells_the_whole_condition(found: Assessment | None) -> None:
    condition = judged(found)
    document = condition.as_dict()
    assert set(document) >= KEYS
    assert Condition.from_dict(json.loads(json.dumps(document, allow_nan=False))) == condition


@given(ASSESSMENTS)
def test_what_is_told_agrees_with_itself(found: Assessment) -> None:
    condition = judged(found)
    assert condition.mu_f is not None
    assert condition.mu_f_ci95 is not None
    assert 0.0 <= condition.mu_f_ci95[0] <= condition.mu_f <= condition.mu_f_ci95[1]
    assert (condition.state is State.HEALTHY) == (condition.kind is Kind.NONE)
    assert condition.state is not State.FAULT or condition.phase is not None
    assert condition.state is not State.HEALTHY or condition.mu_f <= MOTOR.limits.fault_level
    assert condition.reasons


def test_turns_that_lie_in_one_of_two_phases_are_told_with_both() -> None:
    open_phase = Level(0.02, 0.0005, 0, phases=(0.717, 0.003, 0.28))
    found = judged(assessment(change(Kind.SHORTED_TURNS, size=open_phase)))
    assert (found.state, found.kind, found.phase) == (State.FAULT, Kind.SHORTED_TURNS, None)
    assert found.phase_probabilities == (0.717, 0.003, 0.28)
    assert any(
        reason.startswith("shorted turns in phase a (72 %) or c (28 %) since") for reason in found.reasons
    )
    assert "of phase" not in found.advice
    again = Condition.from_dict(found.as_dict())
    assert (again.phase, again.phase_probabilities) == (None, (0.717, 0.003, 0.28))
