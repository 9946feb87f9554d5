"""The quality gate both ways: each defect is named by its own check, and motors in service are let through.

Records come from the simulator's physics: harmonics, unbalance, gains, delays and a swinging load included.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Verdict
from core.machines.parameters import Motor, Nameplate
from core.quality import Passed, examine
from core.quality.finding import QualityFinding
from core.recordings import Recording
from core.signals.terminals import terminals
from testing.machines.disturbed_records import Disturbances, disturbed_record, random_harmonics
from testing.machines.motors import ALL, LARGE, MEDIUM, REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
from testing.machines.steady_faults import Condition
from tests.core.diagnosis.spoiling import (
    CURRENTS,
    VOLTAGES,
    clipped,
    edited,
    exchanged,
    frozen,
    pulsed,
    repeated,
    saturated,
    with_line_voltages,
)

IDS = [motor.name for motor in ALL]
USUAL = Disturbances(
    gain_errors=(0.005, -0.005, 0.003, 0.004, -0.004, 0.002),
    delays_s=(0.0, 3e-5, 5e-5, 1e-5, 4e-5, 0.0),
    harmonics=((5, 0.04, 1.0), (7, 0.03, 2.0)),
    frequency_hz=50.3,
    swing=0.1,
    swing_frequency_hz=3.0,
    noise=0.002,
)


@cache
def in_service(motor: Motor, level: float) -> Recording:
    condition = Condition(load_level=0.7, unbalance=0.03j, level=level, winding=1)
    return disturbed_record(
        motor, condition, USUAL, start_s=3.3, cycles=25.0, sample_rate_hz=10_000.0, seed=1
    )


def gate(record: Recording, motor: Motor) -> tuple[list[QualityFinding], Passed | None]:
    return examine(terminals(record, longest_s=1.2), motor)


def failed(record: Recording, motor: Motor) -> set[str]:
    """Names of the checks that failed, without the channel's."""
    findings, passed = gate(record, motor)
    assert (passed is None) == any(not one.passed for one in findings)
    assert len({one.name for one in findings}) == len(findings)
    assert all(one.message for one in findings if not one.passed)
    assert all(np.isfinite([one.value, one.limit]).all() for one in findings)
    return {one.name for one in findings if not one.passed}


def course(low: float, high: float, steps: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """A factor that changes over the 5,000 samples of a record, in steps or, with many, in a ramp."""
    return np.repeat(np.linspace(low, high, steps), 5_000 // steps)


def single_phasing(record: Recording) -> Recording:
    samples = record.samples.copy()
    samples[0], samples[2] = 0.0, -samples[1]
    return replace(record, samples=samples)


def noise_in(rows: list[int], share: float) -> Callable[[Recording], Recording]:
    def spoil(record: Recording) -> Recording:
        samples = record.samples.copy()
        size = share * np.abs(samples[rows]).max(axis=1, keepdims=True)
        samples[rows] = size * np.random.default_rng(0).standard_normal(samples[rows].shape)
        return replace(record, samples=samples)

    return spoil


def lines(kept: list[int], row: int, factor: float) -> Callable[[Recording], Recording]:
    return lambda record: edited(with_line_voltages(record, kept), [row], factor)


DEFECTS: list[tuple[str, set[str], Callable[[Recording], Recording]]] = [
    ("a sample missing", {"missing samples"}, lambda r: frozen(r, [1], 300, 301, np.nan)),
    ("too short", {"duration"}, lambda r: replace(r, samples=r.samples[:, :700])),
    ("too slow", {"sample rate"}, lambda r: replace(r, samples=r.samples[:, ::25], sample_rate_hz=400.0)),
    ("crests cut", {"clipping IA"}, lambda r: clipped(r, 0, 0.9)),
    ("crests cut deeply", {"clipping IC"}, lambda r: clipped(r, 2, 0.4)),
    ("at the stated full scale", {"clipping IB"}, lambda r: clipped(r, 1, 0.97, stated=True)),
    ("voltage crests cut", {"clipping VB"}, lambda r: clipped(r, 4, 0.9)),
    ("current channel open", {"phase loss"}, lambda r: edited(r, [1], 0.0)),
    ("current channel open, crosstalk", {"phase loss"}, lambda r: edited(r, [1], 0.01)),
    ("one wire open", {"phase loss"}, single_phasing),
    ("voltage fuse blown", {"voltage loss"}, lambda r: edited(r, [4], 0.3)),
    ("one of two line voltages gone", {"voltage loss"}, lines([0, 1], 4, 0.0)),
    ("one of three line voltages gone", {"voltage loss"}, lines([0, 1, 2], 4, 0.0)),
    ("two currents exchanged", {"phase order"}, lambda r: exchanged(r, [0, 1], [1, 0])),
    ("two voltages exchanged", {"phase order"}, lambda r: exchanged(r, [4, 5], [5, 4])),
    ("currents in a ring", {"phase order"}, lambda r: exchanged(r, CURRENTS, [1, 2, 0])),
    ("currents in the other ring", {"phase order"}, lambda r: exchanged(r, CURRENTS, [2, 0, 1])),
    ("currents reversed", {"polarity"}, lambda r: edited(r, CURRENTS, -1.0)),
    ("voltages reversed", {"polarity"}, lambda r: edited(r, VOLTAGES, -1.0)),
    ("one current reversed", {"current polarity"}, lambda r: edited(r, [2], -1.0)),
    ("one voltage reversed", {"voltage polarity"}, lambda r: edited(r, [4], -1.0)),
    ("one of three line voltages reversed", {"voltage polarity"}, lines([0, 1, 2], 4, -1.0)),
    ("one of two line voltages reversed", {"voltage polarity"}, lines([0, 1], 4, -1.0)),
    ("the other of two reversed", {"voltage polarity"}, lines([1, 2], 3, -1.0)),
    ("one saturated transformer", {"saturation"}, lambda r: saturated(r, [0], 1.5)),
    ("three saturated transformers", {"saturation"}, lambda r: saturated(r, CURRENTS, 1.3)),
    ("one saturated by direct current", {"saturation"}, lambda r: saturated(r, [1], 0.9, 0.2)),
    ("load switched", {"steadiness"}, lambda r: edited(r, CURRENTS, course(1.0, 1.8, 2))),
    ("load rising", {"steadiness"}, lambda r: edited(r, CURRENTS, course(1.0, 1.8, 1_000))),
    ("voltage dip", {"supply steadiness"}, lambda r: edited(r, VOLTAGES, course(1.0, 0.75, 2))),
    ("a channel frozen", {"held samples IB"}, lambda r: frozen(r, [1], 1_210, 1_280)),
    ("a channel out for a cycle", {"held samples IB"}, lambda r: frozen(r, [1], 1_210, 1_450, 0.0)),
    ("every sample twice", {"held samples IA"}, lambda r: repeated(r, [0], 2)),
    ("every sample 25 times", {"held samples IC"}, lambda r: repeated(r, [2], 25)),
    ("voltage samples four times", {"held samples VA"}, lambda r: repeated(r, [3], 4)),
    ("mA for A", {"current"}, lambda r: edited(r, CURRENTS, 1_000.0)),
    ("kA for A", {"current"}, lambda r: edited(r, CURRENTS, 1e-3)),
    ("secondary amperes", {"current"}, lambda r: edited(r, CURRENTS, 0.01)),
    ("kV for V", {"voltage"}, lambda r: edited(r, VOLTAGES, 1e-3)),
    ("mV for V", {"voltage"}, lambda r: edited(r, VOLTAGES, 1_000.0)),
    ("a voltage ratio of 4", {"voltage"}, lambda r: edited(r, VOLTAGES, 0.25)),
    ("phase voltages said to be lines", {"voltage"}, lambda r: edited(r, VOLTAGES, 3**-0.5)),
    ("lines said to be phase voltages", {"voltage"}, lambda r: edited(r, VOLTAGES, 3**0.5)),
    ("one current's ratio", {"current sum"}, lambda r: edited(r, [1], 0.9)),
    ("one voltage's ratio", {"voltage ratio"}, lambda r: edited(r, [3], 1.25)),
    ("one line voltage's ratio", {"voltage ratio"}, lines([0, 1, 2], 4, 0.9)),
    ("no voltage", {"voltage"}, lambda r: edited(r, VOLTAGES, 0.0)),
    ("voltages of noise", {"frequency"}, noise_in(VOLTAGES, 0.7)),
    ("motor off, voltage on", {"not-running"}, noise_in(CURRENTS, 0.003)),
    ("motor off, no current at all", {"not-running"}, lambda r: edited(r, CURRENTS, 0.0)),
    ("all off", {"not-running"}, noise_in(CURRENTS + VOLTAGES, 3e-4)),
    ("inverter, 4 kHz", {"drive"}, lambda r: pulsed(r, 4_000.0)),
    ("inverter, 2 kHz", {"drive"}, lambda r: pulsed(r, 2_050.0)),
    ("inverter, 16 kHz folded down", {"drive"}, lambda r: pulsed(r, 16_000.0)),
    ("inverter at low voltage", {"drive"}, lambda r: pulsed(r, 3_000.0, 3.0)),
]  # fmt: skip


@pytest.mark.parametrize(("expected", "spoil"), [one[1:] for one in DEFECTS], ids=[one[0] for one in DEFECTS])
def test_a_defect_is_named_by_its_own_check(
    expected: set[str], spoil: Callable[[Recording], Recording]
) -> None:
    for motor, level in ((REFERENCE, 0.0), (MEDIUM, 0.1), (LARGE, 0.0)):
        assert failed(spoil(in_service(motor, level)), motor) == expected


@pytest.mark.parametrize("motor", ALL, ids=IDS)
@pytest.mark.parametrize("level", [0.0, 0.1])
def test_the_same_records_unspoilt_pass(motor: Motor, level: float) -> None:
    record = in_service(motor, level)
    assert failed(record, motor) == set()
    for kept in ([0, 1], [1, 2], [0, 2], [0, 1, 2]):
        assert failed(with_line_voltages(record, kept), motor) == set()


@pytest.mark.parametrize(("rate", "cycles"), [(800.0, 5.0), (960.0, 15.0), (1_600.0, 64.0), (10_000.0, 5.0)])
def test_motors_in_service_are_not_refused(rate: float, cycles: float) -> None:
    """Supply, load, sensors and parameters drawn at random; shorts of up to 19 % in every other record."""
    random = np.random.default_rng([int(rate), int(cycles)])
    for k in range(6):
        motor = ALL[k % 3]
        condition = Condition(
            load_level=float(random.uniform(0.0, 1.0)),
            unbalance=complex(random.uniform(0.0, 0.05) * np.exp(2j * np.pi * random.uniform())),
            level=float(random.uniform(0.01, 0.19)) if k % 2 else 0.0,
            winding=int(random.integers(3)),
        )
        disturbances = Disturbances(
            gain_errors=tuple(random.uniform(-0.01, 0.01, 6).tolist()),
            delays_s=tuple(random.uniform(0.0, 50e-6, 6).tolist()),
            harmonics=random_harmonics(random, 0.05, rate),
            frequency_hz=float(random.uniform(49.0, 51.0)),
            swing=0.1,
            swing_frequency_hz=float(random.uniform(0.5, 10.0)),
            parameter_factors=tuple(random.uniform(0.9, 1.1, 5).tolist()),
            noise=0.002,
        )
        record = disturbed_record(
            motor, condition, disturbances, start_s=3.0 * k, cycles=cycles, sample_rate_hz=rate, seed=k
        )
        assert failed(record, motor) == set(), (motor.name, condition, disturbances)


@pytest.mark.parametrize("motor", ALL, ids=IDS)
def test_extremes_of_service_are_not_refused(motor: Motor) -> None:
    """No load, where power nearly stops flowing, a supply unbalanced by 10 %, and noise of 20 dB."""
    for load, fault, unbalance, noise in (
        (0.0, None, 0.0, 0.0), (0.0, Fault(0.19, 2), 0.05, 0.0), (0.0, None, 0.05j, 0.0),
        (0.12, Fault(0.19, 0), -0.1, 0.1), (1.0, Fault(0.19, 1), 0.1j, 0.1),
    ):  # fmt: skip
        truth = running(motor, load, fault=fault, unbalance=unbalance)
        assert failed(recording(truth, noise=noise, current_delay_s=50e-6), motor) == set()
        mirrored = running(motor, load, fault=fault, unbalance=unbalance, reverse=True)
        assert failed(recording(mirrored, noise=noise), motor) == set()


@pytest.mark.parametrize("motor", ALL, ids=IDS)
@pytest.mark.parametrize("frequency_hz", [20.0, 35.0, 45.0, 60.0, 87.0])
def test_another_frequency_is_refused_as_such(motor: Motor, frequency_hz: float) -> None:
    record = recording(running(motor, 0.5), frequency_hz=frequency_hz, noise=0.003)
    assert failed(record, motor) == {"frequency"}


@pytest.mark.parametrize("motor", ALL, ids=IDS)
def test_a_locked_rotor_is_not_running(motor: Motor) -> None:
    """Standstill: the rotor's resistance unreduced, in the same circuit a hand calculation would use."""
    machine, w = motor.parameters, motor.nameplate.rated_angular_frequency
    reactance = w * (machine.stator_leakage_H + machine.rotor_leakage_H)
    impedance = machine.stator_resistance_ohm + machine.rotor_resistance_ohm + 1j * reactance
    per_line = 3.0 if motor.nameplate.connection == "delta" else 1.0
    locked = running(motor, 0.5)
    current = per_line * locked.phase_voltage / impedance
    assert failed(recording(replace(locked, line_current=current), noise=0.003), motor) == {"running"}


def test_what_cannot_be_seen_passes() -> None:
    """An inverter at the rated frequency behind a filter that takes its pulses away is like any supply.

    At another frequency it is refused by that.
    """
    for frequency_hz, expected in ((50.0, set[str]()), (42.0, {"frequency"})):
        fast = recording(running(REFERENCE, 0.5), frequency_hz=frequency_hz, sample_rate_hz=50_000.0)
        pulses = pulsed(fast, 4_000.0)
        smooth = pulses.samples.copy()
        for _ in range(3):  # means over 1 ms: 26 dB less at 4 kHz each
            smooth = np.apply_along_axis(np.convolve, 1, smooth, np.ones(50) / 50, "same")
        seen = replace(pulses, samples=smooth[:, 1_000:-1_000:20], sample_rate_hz=2_500.0)
        assert failed(seen, REFERENCE) == expected


def test_a_recorder_that_computes_the_third_current_shows_saturation_all_the_same() -> None:
    record = saturated(in_service(REFERENCE, 0.0), [0, 1], 1.6)
    samples = record.samples.copy()
    samples[2] = -samples[0] - samples[1]
    assert failed(replace(record, samples=samples), REFERENCE) == {"saturation"}


def test_sixty_hertz_at_the_slowest_rate() -> None:
    motor = replace(REFERENCE, nameplate=Nameplate(800.0, 380.0, 60.0, pole_pairs=2))
    record = recording(running(motor, 0.5), frequency_hz=60.0, sample_rate_hz=600.0)
    assert diagnose(record, motor).verdict is Verdict.HEALTHY


def test_a_refusal_says_what_is_wrong_and_what_to_do() -> None:
    result = diagnose(edited(in_service(REFERENCE, 0.0), [2], -1.0), REFERENCE)
    assert result.verdict is Verdict.UNDIAGNOSABLE
    assert result.reasons == (
        "current polarity: with IC the other way round the currents add up to nothing: exchange its wires",
    )
    (finding,) = [one for one in result.quality if not one.passed]
    assert finding.value > finding.limit
    assert finding.unit == "of one phase"
