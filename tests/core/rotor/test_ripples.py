"""Eccentricity and pulsating loads in single records, simulated in phase variables."""

from dataclasses import replace
from math import sqrt

import pytest

from core.diagnosis.acceptance import accept
from core.diagnosis.stator import diagnose_accepted
from core.machines.parameters import Motor
from core.rotor.baseband import Baseband, baseband_of
from core.rotor.eccentricity import examine_eccentricity
from core.rotor.pulsation import examine_pulsation
from core.rotor.running_point import without_delay
from ied_sim.motor.eccentricity import CENTRED, Eccentricity
from ied_sim.motor.load import Load, Pulsation
from testing.machines.motors import LARGE, MEDIUM, REFERENCE
from testing.machines.rotor_records import STEP_RATE_HZ, RotorCase, measured

RATE_HZ = 4_000.0
MIXED = Eccentricity(0.3, 0.2)


def _baseband(
    motor: Motor, *, eccentricity: Eccentricity = CENTRED, pulsations: tuple[Pulsation, ...] = ()
) -> Baseband:
    case = RotorCase(motor)
    plant = replace(case.plant, eccentricity=eccentricity, load=Load(case.load_level, pulsations=pulsations))
    operation = plant.operation(0.0, 3.0, RATE_HZ, settling_s=2.0, step_rate_hz=STEP_RATE_HZ)
    acceptance = accept(measured(case, operation, RATE_HZ, 0), motor)
    assert acceptance.accepted is not None, acceptance.quality
    delay_s = diagnose_accepted(acceptance).time_offset_s
    found = without_delay(baseband_of(acceptance.accepted), motor, delay_s, assumed=False)
    assert found is not None
    return found


def _permeance_ripple(eccentricity: Eccentricity) -> float:
    """First harmonic of the simulated permeance, from its greatest and its least value."""
    static, dynamic = eccentricity.static, eccentricity.dynamic
    near, far = (1.0 / sqrt(1.0 - (static + sign * dynamic) ** 2) for sign in (1.0, -1.0))
    return (near - far) / (near + far)


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_the_ripple_of_the_gap_is_measured_beside_a_load_that_swings_once_a_turn(motor: Motor) -> None:
    swings = (Pulsation(0.05, per_turn=1.0),)
    found = examine_eccentricity(_baseband(motor, eccentricity=MIXED, pulsations=swings), motor)
    assert found.permeance_ripple == pytest.approx(_permeance_ripple(MIXED), rel=0.1)
    assert found.load_torque == pytest.approx(0.05, rel=0.1)
    assert found.standard_deviation is not None
    assert found.standard_deviation < 0.02


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_a_load_that_swings_once_a_turn_is_no_eccentricity(motor: Motor) -> None:
    found = examine_eccentricity(_baseband(motor, pulsations=(Pulsation(0.05, per_turn=1.0),)), motor)
    assert found.permeance_ripple is not None
    assert found.detection_limit is not None
    assert found.permeance_ripple < found.detection_limit
    assert found.lower_sideband_dB is not None
    assert found.lower_sideband_dB > -55.0


def test_two_poles_tell_nothing_of_the_gap() -> None:
    two_poles = replace(MEDIUM, nameplate=replace(MEDIUM.nameplate, pole_pairs=1))
    found = examine_eccentricity(_baseband(MEDIUM), two_poles)
    assert found.permeance_ripple is None
    assert "one pole pair" in found.reasons[0]


def test_a_swing_of_the_load_is_found_with_frequency_and_torque() -> None:
    swings = (Pulsation(0.06, frequency_Hz=7.3),)
    found = examine_pulsation(_baseband(MEDIUM, pulsations=swings), MEDIUM, even_rotor=True)
    assert found.frequency_hz == pytest.approx(7.3, abs=0.01)
    assert found.load_torque == pytest.approx(0.06, rel=0.1)
    assert found.noise is not None
    assert found.noise < 0.01
    assert found.load_torque is not None
    assert found.load_torque_deviation is not None
    assert abs(found.load_torque - 0.06) < 1.96 * found.load_torque_deviation
    assert found.detection_limit is not None
    assert 4.0 * found.noise < found.detection_limit < 0.03


def test_a_steady_load_does_not_swing() -> None:
    found = examine_pulsation(_baseband(MEDIUM), MEDIUM, even_rotor=False)
    assert found.load_torque is not None
    assert found.load_torque < 0.01
