"""A wound rotor in single records, simulated in phase variables: stator, rotor winding, slip rings."""

import pytest

from core.diagnosis.verdict import Verdict
from core.findings.examining import examine
from core.findings.findings import Findings
from core.machines.parameters import Motor
from core.rotor.finding import RotorState
from testing.machines.wound_rotors import HOIST, HOIST_WITH_UNKNOWN_RESISTANCE, WoundRotorCase

BAD_CONTACT = (0.004, 0.0, 0.0)
"""About a tenth of the resistance of a rotor phase, which is 0.034 ohm."""


def _examined(case: WoundRotorCase, motor: Motor, duration_s: float = 4.0) -> Findings:
    return examine(case.record(duration_s), motor)


@pytest.mark.parametrize("load_level", [0.3, 0.9])
def test_a_healthy_motor_is_healthy(load_level: float) -> None:
    found = _examined(WoundRotorCase(load_level=load_level), HOIST)
    assert found.diagnosis.verdict is Verdict.HEALTHY
    assert found.rotor.state is RotorState.HEALTHY
    assert found.diagnosis.load_level == pytest.approx(load_level, abs=0.02)


@pytest.mark.parametrize("external_ohm", [0.0, 0.1, 0.3])
def test_shorted_turns_and_load_are_found_whatever_is_at_the_rings(external_ohm: float) -> None:
    case = WoundRotorCase(level=0.04, external_ohm=external_ohm)
    found = _examined(case, HOIST_WITH_UNKNOWN_RESISTANCE).diagnosis
    assert found.verdict is Verdict.FAULT
    assert found.theta_f is None
    assert found.reasons[1].startswith("the phase is not named: a wound rotor")
    assert found.mu_f_ci95 is not None
    assert found.mu_f_ci95[0] < 0.04 < found.mu_f_ci95[1]
    assert found.load_level == pytest.approx(case.load_level, abs=0.03)
    assert found.speed_rpm is None
    assert any("slip rings" in reason for reason in found.reasons)


def test_a_bad_contact_is_told_as_one_of_the_rotor_winding() -> None:
    """One of three phases with dR more makes dR / 3 of both the mean and half the difference of the axes."""
    found = _examined(WoundRotorCase(contacts_ohm=BAD_CONTACT), HOIST).rotor
    assert found.state is RotorState.FAULT
    assert "rotor winding" in found.reasons[0]
    assert "bar" not in found.reasons[0]
    ratio = 1.6203
    third_ohm = ratio**2 * BAD_CONTACT[0] / 3.0
    expected = third_ohm / (HOIST.parameters.rotor_resistance_ohm + third_ohm)
    assert found.severity_dB is not None
    assert 10.0 ** (found.severity_dB / 20.0) == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize("external_ohm", [0.02, 0.2])
def test_the_sidebands_of_a_bad_contact_tell_the_resistance_at_the_rings(external_ohm: float) -> None:
    case = WoundRotorCase(external_ohm=external_ohm, contacts_ohm=(0.02, 0.0, 0.0))
    found = _examined(case, HOIST_WITH_UNKNOWN_RESISTANCE).rotor
    assert found.slip == pytest.approx(case.slip(), rel=0.02)
    told = next(reason for reason in found.reasons if "ohm a phase" in reason)
    ohm = float(told.split(" ohm a phase")[0].rsplit(" ", 1)[1])
    assert ohm == pytest.approx(external_ohm + 0.02 / 3.0, rel=0.05, abs=0.002)


def test_without_sidebands_the_slip_is_said_to_be_unknown() -> None:
    found = _examined(WoundRotorCase(external_ohm=0.1), HOIST_WITH_UNKNOWN_RESISTANCE).rotor
    assert found.state is RotorState.HEALTHY
    assert found.slip is None
    assert any("slip is not known" in reason for reason in found.reasons)


def test_a_record_too_short_for_the_least_slip_finds_no_rotor_healthy() -> None:
    found = _examined(WoundRotorCase(load_level=0.3), HOIST_WITH_UNKNOWN_RESISTANCE, duration_s=0.8).rotor
    assert found.state is RotorState.UNSUPPORTED
    assert found.slip is None
