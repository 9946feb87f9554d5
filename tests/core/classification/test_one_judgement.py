"""The answer of a record says what its verdict says."""

from dataclasses import replace

import pytest

from core.diagnosis.causes import OF_ONE_ASYMMETRY, Cause
from core.diagnosis.verdict import Verdict
from core.findings.examining import examine
from testing.machines.slot_fault_records import USUAL, drawn_case, with_other_parameters


@pytest.mark.parametrize("power_kW", [7.5, 160.0])
@pytest.mark.parametrize("seed", range(400, 406))
def test_shorted_turns_that_are_a_fault_are_in_the_answer(power_kW: float, seed: int) -> None:
    """Whatever else is open: an unbalanced supply beside them, say."""
    case = drawn_case(seed, level=0.05, power_kW=power_kW, sensors=USUAL, most_path_ratio=2.0)
    case = replace(case, sample_rate_hz=2_000.0, duration_s=0.5)
    motor = replace(with_other_parameters(case.motor, seed), sensors=USUAL)
    examined = examine(case.steady_recording(), motor)
    assert examined.diagnosis.verdict is Verdict.FAULT
    found = examined.classification
    assert found.is_told
    assert Cause.SHORTED_TURNS in found.answer.causes
    assert not any("the verdict differs" in reason for reason in found.reasons)


def test_a_record_has_one_cause_of_an_asymmetry() -> None:
    case = drawn_case(401, level=0.03, power_kW=7.5, sensors=USUAL)
    case = replace(case, sample_rate_hz=2_000.0, duration_s=0.5)
    examined = examine(case.steady_recording(), replace(case.motor, sensors=USUAL))
    found = examined.classification
    assert all(len(one.causes & OF_ONE_ASYMMETRY) < 2 for one in found.explanations)
    told = {one.cause: one.probability for one in found.likelihoods if one.cause in OF_ONE_ASYMMETRY}
    stator = {one.cause: one.probability for one in examined.diagnosis.hypotheses}
    assert told[Cause.SHORTED_TURNS] == pytest.approx(stator[Cause.SHORTED_TURNS], abs=0.02)
