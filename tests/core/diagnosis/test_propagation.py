"""The errors that a record is judged with add to its figures as told; verdicts agree with intervals."""

from dataclasses import replace

import numpy as np
import pytest

from core.diagnosis.acceptance import accept
from core.diagnosis.coil_likelihood import ShortedTurns
from core.diagnosis.record_errors import RecordErrors
from core.diagnosis.record_figures import RecordFigures, figures_of
from core.diagnosis.stator import diagnose, learn_baseline
from core.diagnosis.verdict import Verdict
from core.machines.base import Array
from core.machines.parameters import Connection, Motor
from core.machines.sensors import SensorClass
from core.machines.winding_frame import terminal_winding
from core.recordings import Recording
from testing.machines.motors import LARGE, MEDIUM, REFERENCE
from testing.machines.phase_circuits import Fault, Operation, _currents, recording, running

CYCLE = 200
CHANNELS = [
    f"{kind} of {name}" for name in ("IA", "IB", "IC", "VA", "VB", "VC") for kind in ("gain", "delay")
]


def figures(record: Recording, motor: Motor) -> RecordFigures:
    accepted = accept(record, motor).accepted
    assert accepted is not None
    return figures_of(accepted.terminals, accepted.case, accepted.phasors)


def seen(record: Recording, motor: Motor, turns: ShortedTurns, slip: float) -> Array:
    """What is beside the figures of a hypothesis."""
    return RecordErrors(figures(record, motor), motor).residual(turns, slip, 0.0)


SENSORS = SensorClass(voltage_gain=0.004, current_gain=0.01, voltage_delay_s=20e-6, current_delay_s=8e-6)
"""Every span different, so that none is taken for another."""


def with_channel_error(record: Recording, number: int) -> Recording:
    """The record with one standard deviation of one channel's gain (even) or delay (odd)."""
    samples = record.samples.copy()
    channel, is_delay = divmod(number, 2)
    current = channel < 3
    if is_delay:
        # A sine's delay by so little turns it by w T_d: the part in quadrature is a quarter of a cycle away.
        delay_s = SENSORS.current_delay_s if current else SENSORS.voltage_delay_s
        turn = 2.0 * np.pi * 50.0 * delay_s / np.sqrt(3.0)
        quarter = np.roll(samples[channel], CYCLE // 4)
        samples[channel] = np.cos(turn) * samples[channel] + np.sin(turn) * quarter
    else:
        gain = SENSORS.current_gain if current else SENSORS.voltage_gain
        samples[channel] *= 1.0 + gain / np.sqrt(3.0)
    return replace(record, samples=samples)


def operation(motor: Motor, level: float, *, reverse: bool, at: Operation | None = None) -> Operation:
    """The running motor; `at`: on another one's voltage, and at its slip."""
    fault = Fault(level, 1) if level else None
    if at is None:
        return running(motor, 0.7, fault=fault, unbalance=0.02, reverse=reverse)
    direction = -1 if reverse else 1
    current = _currents(motor, at.phase_voltage, at.slip, fault, direction, None)[0]
    return Operation(current, at.phase_voltage, at.slip)


@pytest.mark.parametrize(("motor", "reverse"), [(REFERENCE, False), (MEDIUM, True), (LARGE, True)])
@pytest.mark.parametrize("level", [0.0, 0.04])
def test_every_error_adds_to_the_figures_what_is_told(motor: Motor, reverse: bool, level: float) -> None:
    """One standard deviation of each channel's gain and delay, and of each parameter, by another record."""
    motor = replace(motor, sensors=SENSORS)
    truth = operation(motor, level, reverse=reverse)
    record = recording(truth, noise=1e-6)
    errors = RecordErrors(figures(record, motor), motor)
    winding = terminal_winding(1, errors.figures.sequence, motor.nameplate.connection)
    turns = ShortedTurns(level, 1.0, 1.0 + 0.0j, winding)
    here = errors.residual(turns, truth.slip, 0.0)
    columns = errors.columns(turns, truth.slip)
    scale = float(np.sqrt(np.trace(errors.covariance(turns, truth.slip)) / here.size))
    for number, cause in enumerate(CHANNELS):
        channel, is_delay = divmod(number, 2)
        voltage, phase = divmod(channel, 3)
        winding = terminal_winding(phase, errors.figures.sequence, Connection.STAR)
        told = columns.others[4 * winding + 2 * voltage + is_delay]
        moved = seen(with_channel_error(record, number), motor, turns, truth.slip) - here
        assert moved == pytest.approx(told, abs=0.1 * scale), cause
    for name, told in errors.by_parameter(turns, truth.slip).items():
        other = getattr(motor.parameters, name) * 1.01
        true_motor = replace(motor, parameters=replace(motor.parameters, **{name: other}))
        other_truth = operation(true_motor, level, reverse=reverse, at=truth)
        moved = seen(recording(other_truth, noise=1e-6), motor, turns, truth.slip) - here
        assert moved == pytest.approx(0.01 * told, abs=0.02 * float(np.linalg.norm(0.01 * told))), name


def test_the_interval_holds_the_truth_where_the_scatter_does_not() -> None:
    """Each record with errors of its own within the tolerances: 5 misses of 24 are one in four hundred."""
    level_missed = load_missed = scatter_missed = 0
    for seed in range(24):
        random = np.random.default_rng(seed)
        factors = random.uniform(0.9, 1.1, 2)
        parameters = replace(
            REFERENCE.parameters,
            stator_resistance_ohm=REFERENCE.parameters.stator_resistance_ohm * factors[0],
            rotor_resistance_ohm=REFERENCE.parameters.rotor_resistance_ohm * factors[1],
        )
        level = (0.0, 0.01, 0.02, 0.05)[seed % 4]
        fault = Fault(level, seed % 3) if level else None
        truth = running(replace(REFERENCE, parameters=parameters), 0.5, fault=fault, unbalance=0.01)
        record = recording(truth, noise=0.002, seconds=0.3, seed=seed)
        gains = 1.0 + random.uniform(-0.01, 0.01, (6, 1))
        found = diagnose(replace(record, samples=record.samples * gains), REFERENCE)
        assert found.mu_f_ci95 is not None
        assert found.mu_f_scatter95 is not None
        assert found.load_level_ci95 is not None
        assert found.mu_f_ci95[0] <= found.mu_f_scatter95[0] <= found.mu_f_scatter95[1] <= found.mu_f_ci95[1]
        level_missed += not found.mu_f_ci95[0] <= level <= found.mu_f_ci95[1]
        load_missed += not found.load_level_ci95[0] <= 0.5 <= found.load_level_ci95[1]
        scatter_missed += not found.mu_f_scatter95[0] <= level <= found.mu_f_scatter95[1]
    assert max(level_missed, load_missed) <= 4
    assert scatter_missed >= 12


@pytest.mark.parametrize("gain", [1.0, 1.006, 1.012, 1.02])
def test_no_verdict_contradicts_its_interval(gain: float) -> None:
    for level in (0.0, 0.004, 0.01, 0.016, 0.02, 0.03):
        truth = running(REFERENCE, 0.5, fault=Fault(level, 1) if level else None)
        found = diagnose(recording(truth, noise=0.002, current_gains=(1.0, gain, 1.0)), REFERENCE)
        assert found.mu_f_ci95 is not None
        low, limit = found.mu_f_ci95[0], REFERENCE.limits.fault_level
        assert low > limit if found.verdict is Verdict.FAULT else True, (level, found.mu_f_ci95)
        assert low <= limit if found.verdict is Verdict.HEALTHY else True, (level, found.mu_f_ci95)
        assert found.detection_limit is not None
        if found.verdict is not Verdict.UNDIAGNOSABLE:
            assert f"95 % interval {low:.2%}" in found.reasons[0] or found.theta_f is None


def test_a_baseline_narrows_the_interval() -> None:
    gains = (0.99, 1.012, 1.0)
    records = [
        recording(running(MEDIUM, load, unbalance=0.01), noise=0.002, current_gains=gains, seed=seed)
        for seed, load in enumerate((0.45, 0.5, 0.6, 0.55))
    ]
    alone = diagnose(records[3], MEDIUM).mu_f_ci95
    within = diagnose(records[3], MEDIUM, baseline=learn_baseline(records[:3], MEDIUM)).mu_f_ci95
    assert alone is not None
    assert within is not None
    assert within[1] < 0.6 * alone[1]


def test_better_sensors_let_less_be_seen() -> None:
    """Detection limits of one record, by the class of the sensors; the default is 1 %, +-25 us."""
    record = recording(running(REFERENCE, 0.7, unbalance=0.02), noise=0.002)
    limits = {}
    for gain, delay_s in [(0.01, 25e-6), (0.005, 25e-6), (0.002, 10e-6)]:
        seen = diagnose(record, replace(REFERENCE, sensors=SensorClass(gain, gain, delay_s, delay_s)))
        assert seen.detection_limit is not None
        limits[gain] = seen.detection_limit
        assert seen.mu_f_ci95 is not None
        assert seen.mu_f_scatter95 is not None
        assert seen.mu_f_ci95[1] > seen.mu_f_scatter95[1]
    assert limits[0.01] == diagnose(record, REFERENCE).detection_limit
    assert limits[0.01] > limits[0.005] > limits[0.002]
    assert limits == pytest.approx({0.01: 0.046, 0.005: 0.044, 0.002: 0.043}, rel=0.1)


def test_one_quantity_may_be_better_than_the_other() -> None:
    record = recording(running(REFERENCE, 0.7, unbalance=0.01), noise=0.002)
    usual = diagnose(record, REFERENCE)
    better = {
        name: diagnose(record, replace(REFERENCE, sensors=replace(SensorClass(), **{name: 0.001})))
        for name in ("voltage_gain", "current_gain")
    }
    for one in better.values():
        assert one.detection_limit is not None
        assert usual.detection_limit is not None
        assert one.detection_limit < usual.detection_limit
    assert "voltages 0.5% each, currents 0.7%" in "".join(better["voltage_gain"].reasons)
