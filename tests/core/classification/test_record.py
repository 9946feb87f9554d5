"""The answer of single records, simulated in phase variables with sensors and parameters that are off."""

from dataclasses import replace

import pytest

from core.classification.classification import Classification
from core.diagnosis.causes import Cause, Causes
from core.findings.examining import examine
from core.machines.parameters import Motor
from core.recordings import Channel, Quantity
from testing.machines.cause_records import CauseCase, Sizes
from testing.machines.motors import LARGE, MEDIUM, REFERENCE

SEED = 42


def _answer(case: CauseCase) -> Classification:
    known = case.known()
    return examine(case.record(), known).classification


def _of(*causes: Cause) -> Causes:
    return frozenset(causes)


@pytest.mark.parametrize(
    "causes",
    [
        _of(),
        _of(Cause.SHORTED_TURNS),
        _of(Cause.ROTOR),
        _of(Cause.SUPPLY),
        _of(Cause.CURRENT_CHANNEL),
        _of(Cause.PULSATION),
        _of(Cause.ECCENTRICITY),
        _of(Cause.SHORTED_TURNS, Cause.ROTOR),
        _of(Cause.SUPPLY, Cause.PULSATION),
    ],
    ids=lambda causes: "+".join(sorted(causes)) or "healthy",
)
def test_causes_are_told(causes: Causes) -> None:
    found = _answer(CauseCase(MEDIUM, causes, 0.7, SEED))
    assert found.is_told, found.words
    assert found.answer.causes == causes


def test_parameters_of_another_motor_are_likelier_than_a_healthy_one() -> None:
    """At this load the magnetising inductance is a small part of the current: it may be a long offset too."""
    found = _answer(CauseCase(MEDIUM, _of(Cause.PARAMETERS), 0.7, SEED))
    assert found.answer.causes == {Cause.PARAMETERS}
    assert {pair.other.causes for pair in found.not_told_apart} <= {_of()}


@pytest.mark.parametrize("motor", [REFERENCE, LARGE], ids=lambda motor: motor.name)
def test_turns_are_told_with_their_phase(motor: Motor) -> None:
    case = CauseCase(motor, _of(Cause.SHORTED_TURNS), 0.5, SEED)
    found = _answer(replace(case, sizes=Sizes(turns=0.08, turns_phase=2)))
    assert found.answer.causes == {Cause.SHORTED_TURNS}
    figure = next(one.figure for one in found.likelihoods if one.cause is Cause.SHORTED_TURNS)
    assert "phase c" in figure


def test_a_joint_in_one_record_is_told_or_left_open_beside_shorted_turns() -> None:
    found = _answer(CauseCase(MEDIUM, _of(Cause.CONNECTION), 0.9, SEED))
    assert found.answer.causes == {Cause.CONNECTION}
    open_ones = {pair.other.causes for pair in found.not_told_apart}
    assert open_ones <= {_of(Cause.SHORTED_TURNS)}
    for pair in found.not_told_apart:
        assert any("another load" in test for test in pair.tests)


def test_a_channel_that_the_quality_gate_refuses_is_named() -> None:
    case = CauseCase(MEDIUM, _of(Cause.CURRENT_CHANNEL), 0.7, SEED, Sizes(current_error=-0.2))
    found = _answer(case)
    assert found.answer.causes == {Cause.CURRENT_CHANNEL}
    untold = {one.cause for one in found.likelihoods if one.log_likelihood_ratio is None}
    assert {Cause.SHORTED_TURNS, Cause.ROTOR} <= untold


def test_line_voltages_leave_a_voltage_channel_and_turns_open_sooner() -> None:
    case = CauseCase(MEDIUM, _of(Cause.SHORTED_TURNS), 0.7, SEED)
    record, known = case.record(), case.known()
    phases = record.samples[3:]
    names = ("ab", "bc", "ca")
    channels = tuple(Channel(f"V{name}", Quantity.LINE_VOLTAGE, name, "V") for name in names)
    samples = record.samples.copy()
    samples[3:] = phases - phases[[1, 2, 0]]
    by_lines = replace(record, samples=samples, channels=record.channels[:3] + channels)
    found = examine(by_lines, known).classification
    assert found.answer.causes == {Cause.SHORTED_TURNS}


def test_the_document_holds_all_that_is_said() -> None:
    document = _answer(CauseCase(MEDIUM, _of(Cause.ROTOR), 0.7, SEED)).as_dict()
    assert document["answer"] == ["rotor-asymmetry"]
    assert document["is_told"] is True
    assert document["not_told_apart"] == []
    assert {"likelihoods", "explanations", "reasons", "probability", "words"} <= document.keys()
