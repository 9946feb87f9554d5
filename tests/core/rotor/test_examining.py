"""The rotor's cage in single records, simulated in phase variables."""

from dataclasses import dataclass, replace
from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray

from core.diagnosis.acceptance import accept
from core.diagnosis.stator import diagnose_accepted
from core.machines.parameters import Motor
from core.recordings import Recording
from core.rotor.baseband import baseband_of
from core.rotor.examining import examine_rotor
from core.rotor.finding import RotorFinding, RotorState, load_bin
from ied_sim.motor.supply import Supply
from testing.machines.motors import LARGE, MEDIUM, REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
from testing.machines.rotor_records import FREQUENCY_HZ, RotorCase

ONE_BAR = 1.0 / 28.0
ONE_BAR_DB = RotorCase(MEDIUM, broken_share=ONE_BAR).asymmetry_dB
"""What the simulated cage's network of bars and rings has with one broken bar of 28."""
WITHIN_DB = 0.6
"""What a cage's leakage adds to its asymmetry is known in the middle only."""


@dataclass(frozen=True, slots=True)
class PulsatingSupply(Supply):
    """A supply whose voltage pulsates."""

    pulsation: float = 0.0
    pulsation_hz: float = 1.0

    def phase_voltages(self, time_s: NDArray[np.float64]) -> NDArray[np.float64]:
        steady = Supply.phase_voltages(self, time_s)
        return np.asarray(steady * (1.0 + self.pulsation * np.cos(2.0 * pi * self.pulsation_hz * time_s)))


def _found(record: Recording, motor: Motor, *, currents_only: bool = False) -> RotorFinding:
    acceptance = accept(record, motor, currents_only=currents_only)
    assert acceptance.accepted is not None, acceptance.quality
    accepted = acceptance.accepted
    return examine_rotor(baseband_of(accepted), accepted, diagnose_accepted(acceptance))


def _severity(finding: RotorFinding) -> float:
    assert finding.severity_dB is not None
    return finding.severity_dB


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_a_broken_bar_is_found_and_measured_whatever_the_inertia(motor: Motor) -> None:
    for inertia_factor in (1.0, 5.0):
        case = RotorCase(motor, broken_share=ONE_BAR, inertia_factor=inertia_factor)
        found = _found(case.record(5.0), motor)
        assert found.state is RotorState.FAULT
        assert _severity(found) == pytest.approx(ONE_BAR_DB, abs=WITHIN_DB)
        assert found.severity_dB_ci95 is not None
        assert found.severity_dB_ci95[0] < ONE_BAR_DB < found.severity_dB_ci95[1]
        assert found.load_level == pytest.approx(case.load_level, abs=0.03)


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize("load_level", [0.3, 1.0])
def test_the_leakage_of_a_broken_cage_is_not_taken_for_resistance(motor: Motor, load_level: float) -> None:
    case = RotorCase(motor, load_level=load_level, broken_share=3.0 * ONE_BAR)
    found = _found(case.record(5.0), motor)
    assert _severity(found) == pytest.approx(case.asymmetry_dB, abs=WITHIN_DB)
    assert found.severity_dB_ci95 is not None
    assert found.severity_dB_ci95[0] < case.asymmetry_dB < found.severity_dB_ci95[1]


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_a_healthy_cage_is_healthy_with_a_limit_far_below_a_broken_bar(motor: Motor) -> None:
    found = _found(RotorCase(motor).record(5.0), motor)
    assert found.state is RotorState.HEALTHY
    assert found.detection_limit_dB is not None
    assert found.detection_limit_dB < ONE_BAR_DB - 20.0
    assert found.slip == pytest.approx(RotorCase(motor).slip(), rel=0.02)


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM], ids=lambda motor: motor.name)
def test_a_load_that_swings_at_twice_the_slip_is_told_from_a_broken_bar(motor: Motor) -> None:
    swings = RotorCase(motor, swing=0.1)
    swings = replace(swings, swing_hz=2.0 * swings.slip() * FREQUENCY_HZ)
    found = _found(swings.record(5.0), motor)
    assert found.state is RotorState.HEALTHY
    assert found.lower_sideband_dB is not None
    assert found.lower_sideband_dB > -35.0
    assert found.load_oscillation_dB == pytest.approx(-20.0, abs=0.5)
    assert any(reason.startswith("load oscillation") for reason in found.reasons)
    both = _found(replace(swings, broken_share=ONE_BAR).record(5.0), motor)
    assert both.state is RotorState.FAULT
    assert _severity(both) == pytest.approx(ONE_BAR_DB, abs=WITHIN_DB)


def test_parameters_that_are_off_bend_no_swinging_load_into_a_broken_bar() -> None:
    swings = RotorCase(MEDIUM, swing=0.1)
    record = replace(swings, swing_hz=2.0 * swings.slip() * FREQUENCY_HZ).record(5.0)
    machine = MEDIUM.parameters
    for factors in ((1.05, 1.08, 0.94, 0.95, 1.08), (0.95, 0.93, 1.06, 0.94, 0.92)):
        wrong = replace(
            machine,
            stator_resistance_ohm=factors[0] * machine.stator_resistance_ohm,
            rotor_resistance_ohm=factors[1] * machine.rotor_resistance_ohm,
            stator_leakage_H=factors[2] * machine.stator_leakage_H,
            rotor_leakage_H=factors[3] * machine.rotor_leakage_H,
            stator_self_inductance_H=factors[4] * machine.stator_self_inductance_H,
        )
        assert _found(record, replace(MEDIUM, parameters=wrong)).state is RotorState.HEALTHY


def test_a_supply_that_pulsates_at_twice_the_slip_is_no_rotor_fault() -> None:
    steady = RotorCase(MEDIUM)
    pulsating = PulsatingSupply(
        400.0, FREQUENCY_HZ, pulsation=0.02, pulsation_hz=2.0 * steady.slip() * FREQUENCY_HZ
    )
    found = _found(replace(steady, supply=pulsating).record(5.0), MEDIUM)
    assert found.state is RotorState.HEALTHY
    assert found.lower_sideband_dB is not None
    assert found.lower_sideband_dB > -45.0
    assert _severity(found) < -50.0


def test_sidebands_that_a_record_does_not_resolve_are_unsupported_and_it_says_what_would_do() -> None:
    found = _found(RotorCase(LARGE, load_level=0.55, broken_share=ONE_BAR).record(1.28), LARGE)
    assert found.state is RotorState.UNSUPPORTED
    assert found.severity_dB is None
    assert found.load_bin == 5
    assert "it takes 2.2 s" in found.reasons[0]


def test_only_the_steady_end_of_a_record_is_examined() -> None:
    case = RotorCase(MEDIUM, broken_share=ONE_BAR)
    record = case.record(5.0)
    samples = record.samples.copy()
    samples[:, :5_000] = RotorCase(MEDIUM, load_level=0.1).record(1.0).samples
    found = _found(replace(record, samples=samples), MEDIUM)
    assert found.state is RotorState.FAULT
    assert found.duration_s == pytest.approx(3.95, abs=0.1)
    assert any(reason.startswith(f"the last {found.duration_s:.1f} s") for reason in found.reasons)
    samples[2, :10_000] = np.nan
    assert _found(replace(record, samples=samples), MEDIUM).duration_s == pytest.approx(2.96, abs=0.05)


def test_spikes_do_not_hide_a_broken_bar() -> None:
    record = RotorCase(MEDIUM, broken_share=ONE_BAR).record(5.0)
    samples = record.samples.copy()
    random = np.random.default_rng(4)
    samples[random.integers(0, 3, 40), random.integers(0, 25_000, 40)] += 20.0
    found = _found(replace(record, samples=samples), MEDIUM)
    assert _severity(found) == pytest.approx(ONE_BAR_DB, abs=WITHIN_DB)
    assert any("single samples" in reason for reason in found.reasons)


def test_without_voltages_a_broken_bar_is_no_more_than_watch() -> None:
    found = _found(RotorCase(MEDIUM, broken_share=ONE_BAR).record(5.0), MEDIUM, currents_only=True)
    assert found.state is RotorState.WATCH
    assert _severity(found) == pytest.approx(ONE_BAR_DB, abs=2.0)
    assert any(reason.startswith("no voltages recorded") for reason in found.reasons)


def test_currents_that_are_delayed_do_not_move_the_severity() -> None:
    record = RotorCase(MEDIUM, load_level=1.0, broken_share=ONE_BAR).record(5.0)
    samples = record.samples.copy()
    samples[:3, 5:] = samples[:3, :-5]
    found = _found(replace(record, samples=samples), MEDIUM)
    assert _severity(found) == pytest.approx(ONE_BAR_DB, abs=WITHIN_DB)


def test_a_motor_that_the_diagnosis_does_not_recognise_is_examined_where_its_currents_fit() -> None:
    acceptance = accept(RotorCase(MEDIUM, broken_share=ONE_BAR).record(5.0), MEDIUM)
    assert acceptance.accepted is not None
    nameless = replace(diagnose_accepted(acceptance), time_offset_s=None)
    accepted = acceptance.accepted
    assert examine_rotor(baseband_of(accepted), accepted, nameless).state is RotorState.FAULT
    machine = MEDIUM.parameters
    other = replace(machine, stator_self_inductance_H=1.6 * machine.stator_self_inductance_H)
    of_other = replace(accepted, case=replace(accepted.case, motor=replace(MEDIUM, parameters=other)))
    found = examine_rotor(baseband_of(of_other), of_other, nameless)
    assert found.state is RotorState.UNSUPPORTED
    assert "not those of this motor" in found.reasons[0]


def test_the_load_is_without_what_shorted_turns_take() -> None:
    record = recording(running(MEDIUM, 0.6, fault=Fault(0.08, 1)), noise=0.001)
    assert _found(record, MEDIUM).load_level == pytest.approx(0.6, abs=0.02)


def test_load_bins_are_tenths_of_the_rated_load() -> None:
    assert [load_bin(level) for level in (-0.1, 0.0, 0.25, 0.999, 1.0, 1.19, 3.0)] == [0, 0, 2, 9, 10, 11, 11]


def test_the_document_has_the_figures_of_the_contract() -> None:
    document = _found(RotorCase(REFERENCE).record(2.0), REFERENCE).as_dict()
    assert document["state"] == "healthy"
    assert isinstance(document["severity_dB_ci95"], list)
    assert {
        "lower_sideband_dB",
        "upper_sideband_dB",
        "severity_dB",
        "detection_limit_dB",
        "slip",
        "reasons",
    } <= (document.keys())
