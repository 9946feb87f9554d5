"""The currents of a diagnosis, drawn again from its fitted parameters."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from core.diagnosis.errors import DiagnosisError
from core.diagnosis.methods import Model
from core.diagnosis.replay import replay
from core.diagnosis.stator import diagnose, learn_baseline
from core.diagnosis.verdict import FittedParameters
from core.machines.base import Array
from core.machines.parameters import Connection, Motor
from core.recordings import Recording
from core.signals.clarke import clarke
from testing.machines.motors import ALL, REFERENCE
from testing.machines.phase_circuits import Fault, recording, running

CONNECTIONS = {motor.nameplate.connection for motor in ALL}


def rms(current_abc: Array) -> float:
    """Return the rms value over both Clarke axes."""
    return float(np.sqrt(np.mean(np.sum(clarke(current_abc) ** 2, axis=0))))


def test_the_motors_of_these_tests_are_of_both_connections() -> None:
    assert set(Connection) == CONNECTIONS


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("reverse", [False, True], ids=["abc", "acb"])
def test_the_replay_leaves_the_residual_that_the_diagnosis_tells(motor: Motor, reverse: bool) -> None:
    truth = running(motor, 0.6, fault=Fault(0.04, 1), unbalance=0.01, reverse=reverse)
    record = recording(truth, noise=0.01, current_delay_s=40e-6)
    diagnosis = diagnose(record, motor)
    assert diagnosis.fit is not None
    assert diagnosis.fit.theta_f == 1
    again = FittedParameters(**json.loads(json.dumps(diagnosis.as_dict()))["fit"])
    drawn = replay(record, motor, again, model=diagnosis.model)
    assert drawn.residual_rms_A == pytest.approx(diagnosis.residual_rms_A, rel=1e-9)
    # What is drawn differs from what was measured by that much: the phases are the terminals' own.
    cycle = round(drawn.sample_rate_hz / 50.0) + 1
    compared = slice(cycle, None)  # the first cycle is the model's to settle
    left = (drawn.measured_abc - drawn.modelled_abc)[:, compared]
    assert rms(left) == pytest.approx(drawn.residual_rms_A, rel=0.01)
    assert rms(left) < 0.05 * rms(drawn.measured_abc[:, compared])


def test_the_replay_says_where_in_the_recording_it_lies() -> None:
    record = recording(running(REFERENCE, 0.5), seconds=2.0, noise=0.005)
    diagnosis = diagnose(record, REFERENCE)
    assert diagnosis.fit is not None
    drawn = replay(record, REFERENCE, diagnosis.fit, model=diagnosis.model)
    first = round(drawn.first_s * record.sample_rate_hz)
    there = record.samples[:3, first : first + drawn.measured_abc.shape[1]]
    np.testing.assert_array_equal(there, drawn.measured_abc)


def test_a_standing_asymmetry_that_was_taken_off_is_drawn() -> None:
    def record(load: float, seed: int) -> Recording:
        gains = (1.004, 0.998, 1.0)
        return recording(running(REFERENCE, load), noise=0.002, current_gains=gains, seed=seed)

    baseline = learn_baseline([record(load, k) for k, load in enumerate((0.4, 0.5, 0.6))], REFERENCE)
    one = record(0.55, 7)
    diagnosis = diagnose(one, REFERENCE, baseline=baseline)
    assert diagnosis.fit is not None
    drawn = replay(one, REFERENCE, diagnosis.fit, model=diagnosis.model, baseline=baseline)
    assert drawn.residual_rms_A == pytest.approx(diagnosis.residual_rms_A, rel=1e-9)
    without = replay(one, REFERENCE, diagnosis.fit, model=diagnosis.model)
    assert rms(drawn.modelled_abc - without.modelled_abc) > 0.0005 * rms(drawn.measured_abc)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"time_offset_s": 5.0}, "give no currents: time offsets: expected -"),
        ({"mu_f": float("nan")}, "give no"),
    ],
)
def test_parameters_that_give_no_currents_are_refused(changed: dict[str, Any], told: str) -> None:
    record = recording(running(REFERENCE, 0.5), noise=0.005)
    diagnosis = diagnose(record, REFERENCE)
    assert diagnosis.fit is not None
    with pytest.raises(DiagnosisError, match=told):
        replay(record, REFERENCE, replace(diagnosis.fit, **changed), model=diagnosis.model)


def test_a_recording_that_is_refused_and_an_unknown_model_are_told() -> None:
    record = recording(running(REFERENCE, 0.5), noise=0.005)
    fit = FittedParameters(
        mu_f=0.0, theta_f=0, load_level=0.5, time_offset_s=0.0, leakage=1.0, axis_rad=0.0, linkage=1.0
    )
    flat = replace(record, samples=record.samples * 0.0)
    with pytest.raises(DiagnosisError, match="quality gate refuses"):
        replay(flat, REFERENCE, fit, model=Model.SPLIT_WINDING)
    with pytest.raises(DiagnosisError, match="unknown; known: coil, split-winding"):
        replay(record, REFERENCE, fit, model="other")
