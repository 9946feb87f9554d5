"""A motor's condition from what its records tell: states, kinds, levels and the document."""

import json
from collections.abc import Mapping
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.condition.assessment import STALE_AFTER_NS, Assessment, Change, Declared, Level, Reference
from core.condition.events import Event, EventKind
from core.condition.filter.state import START
from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition, condition_of
from core.machines.parameters import ParametersSource
from core.machines.winding_frame import Winding
from core.units import NANOSECONDS_PER_DAY
from testing.machines.motors import REFERENCE as MOTOR

AS_OF_NS = 1_800_000_000_000_000_000
SINCE_NS = AS_OF_NS - 3 * NANOSECONDS_PER_DAY

KEYS = {
    *("motor", "state", "kind", "phase", "mu_f", "mu_f_ci95", "change", "change_ci95", "since"),
    *("growth_per_day", "forecast", "reference", "as_of", "stale", "advice", "reasons"),
}
"""The contract; further keys may stand beside them."""


def level(value: float, deviation: float = 0.0005, winding: Winding = 1) -> Level:
    return Level(value, deviation, winding, path_ratio=0.5)


def reference(
    *, records: int = 60, standing: Level | None = None, score: float = 0.8, complete: bool = True
) -> Reference:
    return Reference(
        records=records,
        complete=complete,
        since_ns=AS_OF_NS - 30 * NANOSECONDS_PER_DAY,
        detectable=0.004 if complete else None,
        standing=level(0.004, 0.005, winding=2) if standing is None else standing,
        standing_score=score,
        from_bus=False,
    )


def change(
    *named: Kind, size: Level | None = None, probabilities: Mapping[Kind, float] | None = None
) -> Change:
    return Change(
        since_ns=SINCE_NS,
        detected_ns=SINCE_NS + NANOSECONDS_PER_DAY,
        probabilities=probabilities or {kind: 1.0 / len(named) for kind in named},
        named=named,
        level=level(0.01) if size is None else size,
        channel=0,
        size=0.02,
    )


def assessment(seen: Change | None = None, **further: object) -> Assessment:
    found = Assessment(
        as_of_ns=AS_OF_NS,
        reference=reference(),
        change=seen,
        standing_fault=False,
        statistic=3.0,
        threshold=16.0,
    )
    return replace(found, **further)  # type: ignore[arg-type]  # fields by name


def judged(found: Assessment | None) -> Condition:
    return condition_of(MOTOR, found, AS_OF_NS)


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
    assert any("would be in phase b: 1.20 %" in reason for reason in condition.reasons)
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


KINDS = st.sampled_from([kind for kind in Kind if kind is not Kind.NONE])
LEVELS = st.builds(
    Level, st.floats(-0.01, 0.3), st.floats(1e-6, 0.05), st.sampled_from([0, 1, 2]), st.floats(0, 4)
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
