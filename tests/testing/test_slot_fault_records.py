"""Records of turns shorted inside one coil: steady phasors, samples of them, and the simulation in time."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from core.recordings import Recording
from ied_sim.motor.coils import coils_of
from testing.machines.rated_motors import POLES, POWERS_KW, rated_motor
from testing.machines.slot_fault_records import IDEAL, PRECISE, SlotFaultCase, drawn_case, windings_of
from testing.machines.slot_faults import CoilFault

RATE_HZ = 8_000.0


def phasors(recording: Recording, order: int = 1) -> NDArray[np.complex128]:
    """Rms phasors of the six channels at a harmonic of 50 Hz; the fundamental of v_a is at angle 0."""
    n = recording.samples.shape[1]
    turn = np.exp(-2j * np.pi * 50.0 / RATE_HZ * np.arange(n))
    angle = np.angle(recording.samples[3] @ turn)
    found = np.sqrt(2) / n * recording.samples @ turn**order * np.exp(-1j * order * angle)
    return np.asarray(found, np.complex128)


@pytest.mark.parametrize("seed", [1, 3, 4])
def test_steady_and_simulated_records_agree_at_great_inertia(seed: int) -> None:
    case = drawn_case(seed, level=0.03, power_kW=(7.5, 37.0, 160.0)[seed % 3], sensors=PRECISE)
    heavy = 40 * case.motor.parameters.inertia_kgm2
    case = replace(case, noise=0.0, sample_rate_hz=RATE_HZ, inertia_kgm2=heavy)
    steady, simulated = case.steady_recording(), case.recording()
    for order, within, converters in ((1, 1e-3, 1e-4), (5, 0.05, 0.02), (7, 0.05, 0.02)):
        expected, found = phasors(steady, order), phasors(simulated, order)
        assert np.abs(found - expected)[:3].max() < within * np.abs(expected[:3]).max()
        assert np.abs(found - expected)[3:].max() < converters * np.abs(expected[3:]).max()


def test_phasors_as_the_channels_show_them_are_those_of_the_record() -> None:
    case = replace(drawn_case(2, level=0.02), noise=0.0, sample_rate_hz=RATE_HZ)
    seen, recorded = case.measured_phasors(), phasors(case.steady_recording())
    turn = np.exp(-1j * np.angle(seen.phase_voltage[0]))
    assert recorded[:3] == pytest.approx(seen.line_current * turn, rel=2e-3)
    assert recorded[3:] == pytest.approx(seen.phase_voltage * turn, rel=2e-3)


@pytest.mark.parametrize("poles", POLES)
def test_every_rating_may_have_every_winding_of_its_poles(poles: int) -> None:
    for power_kW in POWERS_KW:
        motor = rated_motor(power_kW, poles)
        for winding in windings_of(poles):
            coils = coils_of(motor, winding)
            assert len(coils.of_phase) == 3 * winding.coils_per_phase()
            case = SlotFaultCase(motor, winding, CoilFault(0, 1, 0.3))
            assert case.steady().slip < 0.08
            places = range(1, winding.coils_per_group(poles // 2) + 1)
            axes = np.angle(coils.fields[0, : len(places)])
            assert axes == pytest.approx([winding.axis_rad(poles // 2, place) for place in places], abs=1e-9)


def test_a_drawn_case_has_the_level_that_was_asked_for() -> None:
    for seed in range(20):
        case = drawn_case(seed, level=0.05)
        assert case.equivalent_level == pytest.approx(0.05)
        assert case.fault is not None
        assert case.fault.share <= 1 + 1e-12
        assert case == drawn_case(seed, level=0.05)
    assert drawn_case(0, level=None).equivalent_level == 0.0
    with pytest.raises(ValueError, match="in one coil"):
        drawn_case(0, level=0.9, poles=4)


def test_errors_of_channels_stay_within_their_class() -> None:
    case = drawn_case(5, level=0.02, sensors=PRECISE)
    true, seen = case.steady(), case.measured_phasors()
    ratio = seen.line_current / true.line_current
    assert np.abs(np.abs(ratio) - 1).max() < 0.002
    late_s = -np.angle(ratio) / (2 * np.pi * 50)
    assert np.ptp(late_s) < 10e-6
    ideal = replace(case, sensors=IDEAL, common_delay_s=0.0)
    assert ideal.measured_phasors().line_current == pytest.approx(true.line_current)
