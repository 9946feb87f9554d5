"""Motors for any frequency that a motor file may name: the fault is found, and another supply refused."""

from dataclasses import replace

import pytest

from core.diagnosis.verdict import Verdict
from core.findings.examining import examine
from core.machines.parameters import Motor
from core.signals.clarke import clarke
from core.signals.phasors import fundamental_frequency
from testing.machines.motors import MEDIUM
from testing.machines.phase_circuits import Fault, recording, running

FREQUENCIES_HZ = (10.0, 16.7, 25.0, 100.0, 120.0, 200.0, 400.0)


def rated(frequency_hz: float) -> Motor:
    """The motor with the same reactances at another frequency, so that its phasors are the same.

    The channels' delays are the same angle: of 25 us, those of usual transformers, 400 Hz makes 3.6 degrees.
    """
    share = 50.0 / frequency_hz
    machine, sensors = MEDIUM.parameters, MEDIUM.sensors
    return replace(
        MEDIUM,
        sensors=replace(
            sensors,
            voltage_delay_s=sensors.voltage_delay_s * share,
            current_delay_s=sensors.current_delay_s * share,
        ),
        nameplate=replace(MEDIUM.nameplate, rated_frequency_Hz=frequency_hz),
        parameters=replace(
            machine,
            stator_leakage_H=machine.stator_leakage_H * share,
            rotor_leakage_H=machine.rotor_leakage_H * share,
            stator_self_inductance_H=machine.stator_self_inductance_H * share,
        ),
    )


@pytest.mark.parametrize("frequency_hz", FREQUENCIES_HZ)
def test_the_same_fault_is_found(frequency_hz: float) -> None:
    record = recording(
        running(MEDIUM, 0.5, fault=Fault(0.05, 1)),
        frequency_hz=frequency_hz,
        sample_rate_hz=100 * frequency_hz,
        seconds=max(40 / frequency_hz, 0.4),
    )
    diagnosis = examine(record, rated(frequency_hz)).diagnosis
    # Instants of currents and voltages may differ by some 100 us: 14 degrees at 400 Hz leave less evidence.
    assert diagnosis.verdict is (Verdict.FAULT if frequency_hz < 400 else Verdict.WATCH), diagnosis.reasons
    assert diagnosis.mu_f_ci95 is not None
    assert diagnosis.mu_f_ci95[0] > 0.005
    assert diagnosis.mu_f_ci95[0] < 0.05 < diagnosis.mu_f_ci95[1]
    assert diagnosis.phase_probabilities is not None
    assert diagnosis.phase_probabilities[1] > 0.9


@pytest.mark.parametrize("frequency_hz", [10.0, 400.0])
def test_a_supply_of_another_frequency_is_refused_with_both(frequency_hz: float) -> None:
    found = 1.2 * frequency_hz
    record = recording(
        running(MEDIUM, 0.5), frequency_hz=found, sample_rate_hz=100 * found, seconds=40 / found
    )
    diagnosis = examine(record, rated(frequency_hz)).diagnosis
    assert diagnosis.verdict is Verdict.UNDIAGNOSABLE
    assert f"{found:.2f} Hz is not the rated {frequency_hz:g} Hz" in diagnosis.reasons[0]


def test_the_range_follows_the_motor() -> None:
    assert rated(50.0).nameplate.frequency_range_Hz == pytest.approx((20.0, 120.0))
    record = recording(running(MEDIUM, 0.5), frequency_hz=400.0, sample_rate_hz=20_000.0)
    voltages = clarke(record.samples[3:])
    search_hz = rated(400.0).nameplate.frequency_range_Hz
    assert fundamental_frequency(voltages, 20_000.0, search_hz=search_hz) == pytest.approx(400.0)
