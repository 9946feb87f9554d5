"""Wrong parameters are noticed, and right ones with usual sensors are not."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from core.diagnosis.causes import Cause
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.current_locus import current_locus
from core.machines.parameters import Motor, ParametersSource
from core.machines.typical import TYPICAL_TOLERANCES
from core.recordings import Channel, Quantity, Recording
from testing.machines.motors import ALL, LARGE, MEDIUM, REFERENCE, VERY_LARGE
from testing.machines.phase_circuits import recording, running

CHANNELS = tuple(
    Channel(f"{letter}{phase}", quantity, phase, unit)
    for letter, quantity, unit in (("I", Quantity.CURRENT, "A"), ("V", Quantity.PHASE_VOLTAGE, "V"))
    for phase in "abc"
)
CIRCLE = ("stator_resistance_ohm", "stator_leakage_H", "rotor_leakage_H", "stator_self_inductance_H")


def in_file(motor: Motor, factor: float, *names: str) -> Motor:
    """The motor as a file has it that is wrong about it."""
    machine = motor.parameters
    wrong = {name: factor * getattr(machine, name) for name in names or (*CIRCLE, "rotor_resistance_ohm")}
    return replace(motor, parameters=replace(machine, **wrong))


def blames_parameters(found: Diagnosis) -> bool:
    return bool(found.hypotheses) and found.hypotheses[0].cause is Cause.PARAMETERS


def recorded(motor: Motor, load_level: float, random: np.random.Generator) -> Recording:
    """What a relay with channels of the usual class records, its offset within 100 us, on a usual supply."""
    unbalance = random.uniform(0.0, 0.015) * np.exp(2j * pi * random.uniform())
    operation = running(motor, load_level, unbalance=complex(unbalance))
    gains, delays = 1.0 + random.uniform(-0.01, 0.01, 6), random.uniform(-25e-6, 25e-6, 6)
    delays[:3] += random.uniform(-100e-6, 100e-6)
    phasors = np.concatenate([operation.line_current, operation.phase_voltage])
    phasors *= gains * np.exp(-2j * pi * 50.0 * delays)
    t = np.arange(2_500) / 5_000.0
    samples = np.sqrt(2.0) * np.real(phasors[:, np.newaxis] * np.exp(2j * pi * 50.0 * t))
    samples += 0.001 * np.abs(phasors)[:, np.newaxis] * random.normal(size=samples.shape)
    return Recording(samples, 5_000.0, 0, CHANNELS)


@pytest.mark.parametrize("motor", [*ALL, VERY_LARGE], ids=lambda motor: motor.name)
def test_a_motor_lies_on_its_circle_at_any_load(motor: Motor) -> None:
    machine, w = motor.parameters, 2.0 * pi * 50.0
    circle = current_locus(machine, w)
    for slip in (1e-4, 0.01, 0.05, 1.0, -0.02):
        rotor = machine.rotor_resistance_ohm / slip + 1j * w * machine.rotor_leakage_H
        magnetising = 1j * w * machine.magnetising_inductance_H
        stator = machine.stator_resistance_ohm + 1j * w * machine.stator_leakage_H
        admittance = 1.0 / (stator + magnetising * rotor / (magnetising + rotor))
        assert circle.distance(admittance) == pytest.approx(0.0, abs=1e-9 * circle.radius)
    assert circle.distance(circle.centre) == -circle.radius


def test_right_parameters_and_usual_sensors_are_never_blamed() -> None:
    random = np.random.default_rng(18)
    for motor in (*ALL, VERY_LARGE):
        for _ in range(12):
            found = diagnose(recorded(motor, random.uniform(0.0, 1.1), random), motor)
            assert not blames_parameters(found), found.reasons


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE, VERY_LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize("factor", [0.8, 1.25])
def test_a_wrong_magnetising_inductance_is_never_healthy(motor: Motor, factor: float) -> None:
    wrong = in_file(motor, factor, "stator_self_inductance_H")
    for load_level in (0.1, 0.3):
        record = recording(running(motor, load_level, unbalance=0.003), noise=0.002)
        found = diagnose(record, wrong)
        assert found.verdict in (Verdict.WATCH, Verdict.UNDIAGNOSABLE), (load_level, found.reasons)


def test_placeholders_that_make_a_level_below_zero_are_told_as_wrong_parameters() -> None:
    record = recording(running(REFERENCE, 0.05, unbalance=0.002), noise=0.002)
    found = diagnose(record, in_file(REFERENCE, 0.85))
    assert found.verdict is Verdict.WATCH
    assert found.phase is None
    assert found.reasons[0].startswith("the parameters do not fit: the currents lie ")
    assert "commission this motor (mcc commission)" in found.reasons[0]


def test_no_healthy_record_needs_an_offset_that_no_relay_has() -> None:
    random = np.random.default_rng(617)
    for motor in (REFERENCE, MEDIUM, LARGE):
        for _ in range(12):
            wrong = replace(motor, parameters=motor.parameters)
            for name in (*CIRCLE, "rotor_resistance_ohm"):
                wrong = in_file(wrong, float(random.choice([0.85, 1.15])), name)
            found = diagnose(recorded(motor, random.uniform(0.1, 1.0), random), wrong)
            if found.verdict is Verdict.HEALTHY:
                assert found.time_offset_s is not None
                # The parameters of the file turn a relay's usual offset by some.
                assert abs(found.time_offset_s) < 400e-6


def test_typical_parameters_are_not_blamed_for_what_they_are() -> None:
    typical = replace(
        in_file(MEDIUM, 1.3), parameters_source=ParametersSource.TYPICAL, tolerances=TYPICAL_TOLERANCES
    )
    found = diagnose(recording(running(MEDIUM, 0.5, unbalance=0.003), noise=0.002), typical)
    assert not blames_parameters(found)
    given = diagnose(recording(running(MEDIUM, 0.5, unbalance=0.003), noise=0.002), MEDIUM)
    assert found.detection_limit is not None
    assert given.detection_limit is not None
    assert found.detection_limit > 1.05 * given.detection_limit
