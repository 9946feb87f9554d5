"""The answer of a motor, from a condition, a rotor and records that are given."""

from typing import Any

import pytest

from core.classification.classification import Classification
from core.classification.motor import MotorEvidence, classify_motor
from core.classification.record_answer import RecordAnswer
from core.condition.kinds import Kind, State
from core.diagnosis.causes import Cause
from core.rotor.finding import RotorState
from core.rotor.trend import RotorCondition
from core.starts.compared import ChangeState, StartCause, StartChanges
from core.tracking.finding import DriftCause, TrackedParameters, TrackingState

HEALTHY: dict[str, Any] = {"state": State.HEALTHY, "kind": Kind.NONE, "candidates": (), "phase": None}
UNKNOWN = HEALTHY | {"state": State.UNKNOWN}
EVEN = RotorCondition(RotorState.HEALTHY, -70.0, (-74.0, -66.0), None, 0, (), ())
UNEVEN = RotorCondition(RotorState.FAULT, -29.0, (-30.0, -28.0), 30.0, 0, (), ())
QUIET = RecordAnswer(
    {
        Cause.PULSATION: -2.0,
        Cause.ECCENTRICITY: -2.0,
        Cause.SUPPLY: -1.5,
        Cause.PARAMETERS: -1.5,
        Cause.VOLTAGE_CHANNEL: -1.0,
        Cause.CURRENT_CHANNEL: -1.0,
    },
    {},
)
LOADS = [0.6, 0.62, 0.58, 0.61, 0.6, 0.59, 0.63, 0.6, 0.61, 0.6, 0.62, 0.6]


def _answer(condition: dict[str, Any] = HEALTHY, **known: Any) -> Classification:
    usual: dict[str, Any] = {"rotor": EVEN, "records": [QUIET] * 3, "load_levels": LOADS}
    return classify_motor(MotorEvidence(**(condition | usual | known)))


def _condition(kind: Kind, state: State = State.FAULT, *candidates: Kind) -> dict[str, Any]:
    return {"state": state, "kind": kind, "candidates": candidates, "phase": "b"}


def test_a_motor_with_nothing_unusual_is_healthy() -> None:
    found = _answer()
    assert found.is_told
    assert found.words == "healthy"


@pytest.mark.parametrize(
    ("kind", "cause"),
    [
        (Kind.SHORTED_TURNS, Cause.SHORTED_TURNS),
        (Kind.VOLTAGE_CHANNEL, Cause.VOLTAGE_CHANNEL),
        (Kind.CURRENT_CHANNEL, Cause.CURRENT_CHANNEL),
        (Kind.CONNECTION, Cause.CONNECTION),
    ],
)
def test_what_the_condition_names_is_the_answer(kind: Kind, cause: Cause) -> None:
    found = _answer(_condition(kind))
    assert found.is_told
    assert found.answer.causes == {cause}
    assert not any("differs" in reason for reason in found.reasons)


def test_what_the_condition_leaves_open_is_left_open_with_what_would_tell() -> None:
    condition = _condition(Kind.UNCLEAR, State.FAULT, Kind.SHORTED_TURNS, Kind.CONNECTION)
    found = _answer(condition)
    assert not found.is_told
    assert {pair.other.causes | pair.one.causes for pair in found.not_told_apart} >= {
        frozenset({Cause.SHORTED_TURNS, Cause.CONNECTION})
    }
    assert any("another load" in test for test in found.not_told_apart[0].tests)


def _probability(found: Classification, cause: Cause) -> float:
    return next(one.probability for one in found.likelihoods if one.cause is cause)


def test_candidates_of_a_fault_are_together_as_sure_as_one_that_is_named() -> None:
    named = _answer(_condition(Kind.SHORTED_TURNS))
    either = _answer(_condition(Kind.UNCLEAR, State.FAULT, Kind.SHORTED_TURNS, Kind.CONNECTION))
    assert _probability(either, Cause.HEALTHY) == pytest.approx(_probability(named, Cause.HEALTHY), rel=0.1)
    open_ones = [either.answer, *(pair.other for pair in either.not_told_apart)]
    assert {one.causes for one in open_ones} == {
        frozenset({Cause.SHORTED_TURNS}),
        frozenset({Cause.CONNECTION}),
    }


@pytest.mark.parametrize("likelier", [Cause.SHORTED_TURNS, Cause.CONNECTION])
def test_records_tell_which_candidate_of_a_fault_is_there(likelier: Cause) -> None:
    condition = _condition(Kind.UNCLEAR, State.FAULT, Kind.SHORTED_TURNS, Kind.CONNECTION)
    ratios = {"SHORTED_TURNS": 20.0, "CONNECTION": 20.0, likelier.name: 26.0}
    found = _answer(condition, records=_with(**ratios))
    assert found.is_told
    assert found.answer.causes == {likelier}


def test_the_records_tell_while_the_condition_does_not_know_what_surprises() -> None:
    records = _with(SHORTED_TURNS=19.5, CONNECTION=12.0, VOLTAGE_CHANNEL=8.0)
    found = _answer(_condition(Kind.UNCLEAR, State.WATCH), records=records)
    assert found.is_told
    assert found.answer.causes == {Cause.SHORTED_TURNS}


def test_what_is_only_watched_leaves_a_sound_motor_open() -> None:
    """Six sound motors in a thousand are watched, so that records alone make nothing of it certain."""
    condition = _condition(Kind.UNCLEAR, State.WATCH, Kind.SHORTED_TURNS, Kind.VOLTAGE_CHANNEL)
    found = _answer(condition, records=_with(SHORTED_TURNS=9.0, VOLTAGE_CHANNEL=1.0))
    assert not found.is_told
    assert frozenset() in {pair.other.causes for pair in found.not_told_apart}


def test_a_broken_cage_is_why_the_motor_has_another_impedance() -> None:
    drift = _drift(DriftCause.LEAKAGE, DriftCause.RATIO)
    condition = _condition(Kind.PARAMETERS, State.WATCH)
    broken = _answer(condition, rotor=UNEVEN, tracked=drift)
    assert broken.answer.causes == {Cause.ROTOR}
    assert "asymmetry" in next(one.figure for one in broken.likelihoods if one.cause is Cause.ROTOR)
    assert _answer(condition, tracked=drift).answer.causes == {Cause.PARAMETERS}
    beside = _condition(Kind.UNCLEAR, State.WATCH, Kind.PARAMETERS, Kind.SUPPLY)
    assert Cause.PARAMETERS not in _answer(beside, rotor=UNEVEN, tracked=drift).answer.causes


def test_causes_of_one_drift_are_not_there_all_at_once() -> None:
    found = _answer(tracked=_drift(DriftCause.ROTOR, DriftCause.LEAKAGE), records=_with(PARAMETERS=6.0))
    assert found.answer.causes == {Cause.PARAMETERS}
    assert found.is_told


def _with(**ratios: float) -> list[RecordAnswer]:
    told = {Cause[name]: ratio for name, ratio in ratios.items()}
    return [RecordAnswer({**QUIET.log_likelihood_ratios, **told}, {})] * 3


def _drift(*causes: DriftCause) -> TrackedParameters:
    return TrackedParameters(
        state=TrackingState.DRIFTING,
        parameters=(),
        records=60,
        as_of_ns=None,
        reference_complete=True,
        winding_excess_K=None,
        winding_excess_K_ci95=None,
        causes=causes,
        reasons=(),
    )


def test_what_a_change_explains_speaks_for_no_other_cause() -> None:
    records = _with(SHORTED_TURNS=60.0, PARAMETERS=38.0)
    assert _answer(_condition(Kind.SHORTED_TURNS), records=records).answer.causes == {Cause.SHORTED_TURNS}
    both = _answer(_condition(Kind.SHORTED_TURNS), records=_with(SHORTED_TURNS=20.0, SUPPLY=60.0))
    assert both.answer.causes == {Cause.SHORTED_TURNS, Cause.SUPPLY}


def test_two_causes_that_explain_the_same_are_not_both_told() -> None:
    found = _answer(records=_with(CURRENT_CHANNEL=20.0, VOLTAGE_CHANNEL=12.0))
    assert found.answer.causes == {Cause.CURRENT_CHANNEL}
    assert found.is_told


@pytest.mark.parametrize(
    ("gap", "causes"), [(40.0, {Cause.ECCENTRICITY}), (-4.0, {Cause.PARAMETERS})], ids=["uneven", "even"]
)
def test_another_magnetising_inductance_comes_with_an_eccentric_rotor(gap: float, causes: set[Cause]) -> None:
    found = _answer(
        records=_with(ECCENTRICITY=gap, PARAMETERS=2.0 if gap < 0.0 else -1.5),
        tracked=_drift(DriftCause.MAGNETISING),
    )
    assert found.answer.causes == causes


def test_faults_of_stator_and_rotor_are_told_together() -> None:
    found = _answer(_condition(Kind.SHORTED_TURNS), rotor=UNEVEN)
    assert found.answer.causes == {Cause.SHORTED_TURNS, Cause.ROTOR}


@pytest.mark.parametrize(("level", "changed"), [(0.25, True), (0.55, False), (0.95, True)])
def test_a_load_that_stays_another_is_told(level: float, *, changed: bool) -> None:
    found = _answer(load_levels=[*LOADS, level, level, level])
    assert (found.answer.causes == {Cause.LOAD}) == changed


def test_one_record_at_another_load_is_no_changed_load() -> None:
    assert _answer(load_levels=[*LOADS, 0.2, 0.6, 0.6]).words == "healthy"


def test_starts_tell_a_rotor_that_the_records_do_not() -> None:
    starts = StartChanges(ChangeState.CHANGED, (StartCause.ROTOR,), (), (), None, None, ("a slower start",))
    unsupported = RotorCondition(RotorState.UNSUPPORTED, None, None, None, None, (), ())
    with_starts = _answer(rotor=unsupported, starts=starts)
    without = _answer(rotor=unsupported)
    likelihood = {one.cause: one.log_likelihood_ratio for one in with_starts.likelihoods}
    assert likelihood[Cause.ROTOR] == pytest.approx(5.0)
    assert Cause.ROTOR in {one.cause for one in without.likelihoods if one.log_likelihood_ratio is None}


def test_a_motor_of_which_nothing_is_known_is_not_called_healthy() -> None:
    unsupported = RotorCondition(RotorState.UNSUPPORTED, None, None, None, None, (), ())
    found = _answer(UNKNOWN, rotor=unsupported, records=[], load_levels=[])
    assert not found.is_told


def test_records_are_read_back_from_their_documents() -> None:
    document = _answer(rotor=UNEVEN).as_dict()
    read = RecordAnswer.from_dict(document)
    assert read.log_likelihood_ratios[Cause.ROTOR] > 10.0
    with pytest.raises(TypeError, match="likelihoods"):
        RecordAnswer.from_dict({"likelihoods": None})
