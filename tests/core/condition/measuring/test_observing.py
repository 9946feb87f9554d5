"""Observations of records made by independent phase circuits: phasors, scatter, recorder."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.condition.measuring.impedance import negative_impedance
from core.condition.measuring.observing import observe
from core.condition.observation import VoltageChannels
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Verdict
from core.findings.examining import examine
from core.machines.parameters import Connection, MachineParameters, Motor
from core.recordings import Channel, Quantity, Recording, read
from core.recordings.comtrade.writer import write
from core.signals.sequence import PhaseSequence
from testing.machines.motors import LARGE, REFERENCE
from testing.machines.phase_circuits import Fault, Operation, recording, running

TURN = np.exp(2j * np.pi / 3.0)
PHASES_TO_SEQUENCES = np.array([[1, TURN, TURN**2], [1, TURN**2, TURN], [1, 1, 1]]) / 3.0
GAINS = np.array([1.0, 1.01, 0.98])
"""Of the voltage channels: they make a zero sequence."""


def with_gains(truth: Operation) -> Operation:
    return replace(truth, phase_voltage=truth.phase_voltage * GAINS)


def sequences(phases: np.ndarray[tuple[int], np.dtype[np.complex128]]) -> list[complex]:
    return [complex(one) for one in PHASES_TO_SEQUENCES @ phases]


def in_delta(star: Motor) -> Motor:
    """The motor that looks the same at its terminals, with windings of three times the impedance."""
    machine = star.parameters
    windings = MachineParameters(
        stator_resistance_ohm=3.0 * machine.stator_resistance_ohm,
        rotor_resistance_ohm=3.0 * machine.rotor_resistance_ohm,
        stator_leakage_H=3.0 * machine.stator_leakage_H,
        rotor_leakage_H=3.0 * machine.rotor_leakage_H,
        stator_self_inductance_H=3.0 * machine.stator_self_inductance_H,
        inertia_kgm2=machine.inertia_kgm2,
    )
    return replace(star, parameters=windings, nameplate=replace(star.nameplate, connection=Connection.DELTA))


@pytest.mark.parametrize("connection", Connection)
@pytest.mark.parametrize("reverse", [False, True], ids=["abc", "acb"])
def test_phasors_are_those_of_the_windings_in_a_supply_that_turns_forwards(
    connection: Connection, reverse: bool
) -> None:
    truth = with_gains(running(REFERENCE, 0.6, fault=Fault(0.03, 1), unbalance=0.01, reverse=reverse))
    motor = REFERENCE if connection is Connection.STAR else in_delta(REFERENCE)
    seen = observe(recording(truth), motor)
    assert seen is not None
    voltage, current = truth.phase_voltage, truth.line_current
    zero = complex(voltage.mean())
    if reverse:  # terminals b and c change places
        voltage, current = voltage[[0, 2, 1]], current[[0, 2, 1]]
    if connection is Connection.DELTA:
        voltage, current = voltage - np.roll(voltage, -1), (current - np.roll(current, -1)) / 3.0
    V1, V2, _ = sequences(voltage)
    I1, I2, _ = sequences(current)
    assert seen.sequence is (PhaseSequence.ACB if reverse else PhaseSequence.ABC)
    assert seen.positive_voltage_V == pytest.approx(np.sqrt(2.0) * abs(V1), rel=1e-6)
    assert seen.zero_voltage_V is not None
    for found, wanted in [
        (seen.negative_voltage_V, V2),
        (seen.zero_voltage_V, zero),
        (seen.positive_current_A, I1),
        (seen.negative_current_A, I2),
    ]:
        assert found / seen.positive_voltage_V == pytest.approx(wanted / V1, rel=1e-4, abs=1e-9)
    assert abs(seen.zero_current_A / seen.positive_current_A) < 1e-6
    assert seen.load_level == pytest.approx(0.6, abs=0.08)  # losses of the fault count


def test_a_common_current_is_seen_as_zero_sequence() -> None:
    truth = running(REFERENCE, 0.6)
    gains = (1.01, 1.0, 1.0)
    seen = observe(recording(truth, current_gains=gains), REFERENCE)
    assert seen is not None
    I1, _, I0 = sequences(truth.line_current * np.array(gains))
    assert seen.zero_current_A / seen.positive_current_A == pytest.approx(I0 / I1, rel=1e-4)


def test_the_scatter_is_that_of_y() -> None:
    """Records that differ in their noise alone differ as each of them says."""
    truth = running(REFERENCE, 0.6, unbalance=0.02)
    y, claimed = [], []
    for seed in range(40):
        seen = observe(recording(truth, noise=0.01, sample_rate_hz=2_000.0, seed=seed), REFERENCE)
        assert seen is not None
        Z2 = negative_impedance(REFERENCE, seen.frequency_hz)
        y.append((seen.negative_voltage_V - Z2 * seen.negative_current_A) / seen.positive_voltage_V)
        claimed.append(seen.scatter)
    assert np.mean(claimed) == pytest.approx(float(np.var(y, ddof=1)), rel=0.4)


def test_what_the_supply_does_within_a_record_is_no_scatter() -> None:
    """An unbalance that wanders is answered by the motor, and cancels in y."""
    Z2 = negative_impedance(REFERENCE, 50.0)
    truth, record = running(REFERENCE, 0.6), recording(running(REFERENCE, 0.6), noise=1e-4)
    t = np.arange(record.samples.shape[1]) / record.sample_rate_hz
    wander = 0.01 * abs(truth.phase_voltage[0]) * np.sin(2.0 * np.pi * 3.0 * t)
    backwards = np.array([1.0, TURN, TURN**2])[:, np.newaxis]
    rows = np.concatenate([backwards / Z2, backwards])
    moving = np.sqrt(2.0) * np.real(rows * wander * np.exp(2j * np.pi * 50.0 * t))
    calm = observe(record, REFERENCE)
    restless = observe(replace(record, samples=record.samples + moving), REFERENCE)
    assert calm is not None
    assert restless is not None
    assert restless.scatter < 10.0 * calm.scatter
    assert abs(restless.negative_voltage_V) < 0.01 * abs(restless.positive_voltage_V)


@pytest.mark.parametrize(
    ("kept", "expected"),
    [((0, 1, 2), VoltageChannels.THREE_LINES), ((0, 1), VoltageChannels.TWO_LINES)],
)
def test_line_voltages_tell_no_zero_sequence(kept: tuple[int, ...], expected: VoltageChannels) -> None:
    record = recording(running(REFERENCE, 0.6, unbalance=0.01))
    phases = record.samples[3:]
    lines = (phases - np.roll(phases, -1, axis=0))[list(kept)]
    names = ("ab", "bc", "ca")
    channels = tuple(Channel(f"V{names[k]}", Quantity.LINE_VOLTAGE, names[k], "V") for k in kept)
    by_lines = replace(
        record, samples=np.vstack([record.samples[:3], lines]), channels=record.channels[:3] + channels
    )
    seen, by_phases = observe(by_lines, REFERENCE), observe(record, REFERENCE)
    assert seen is not None
    assert by_phases is not None
    assert seen.voltage_channels is expected
    assert seen.zero_voltage_V is None
    assert seen.negative_voltage_V == pytest.approx(by_phases.negative_voltage_V, rel=1e-6)


@pytest.mark.parametrize("joint", [None, (1, 0.3)], ids=["healthy", "an asymmetry of another kind"])
def test_a_record_is_diagnosed_and_observed_at_once(joint: tuple[int, float] | None) -> None:
    record = recording(running(REFERENCE, 0.6, joint=joint), noise=0.002)
    examined = examine(record, REFERENCE)
    alone = diagnose(record, REFERENCE)
    unlike = {"compute_seconds"}
    assert {key: value for key, value in examined.diagnosis.as_dict().items() if key not in unlike} == {
        key: value for key, value in alone.as_dict().items() if key not in unlike
    }
    assert examined.observation == observe(record, REFERENCE)
    assert examined.observation is not None


def test_a_record_without_voltages_or_refused_gives_none() -> None:
    record = recording(running(REFERENCE, 0.6))
    currents = replace(record, samples=record.samples[:3], channels=record.channels[:3])
    assert observe(currents, REFERENCE) is None
    assert examine(currents, REFERENCE, currents_only=True).observation is None
    stopped = replace(record, samples=record.samples * 1e-4)
    assert observe(stopped, REFERENCE) is None
    assert examine(stopped, REFERENCE).observation is None
    assert observe(recording(running(LARGE, 0.6)), REFERENCE) is None


def through_comtrade(record: Recording, folder: Path) -> Recording:
    write(folder / "RECORD.CFG", record)
    return read(folder / "RECORD.CFG")


def test_the_recorder_is_another_where_a_transformer_is_exchanged(tmp_path: Path) -> None:
    record = recording(running(REFERENCE, 0.6), noise=0.002)
    scaled = [replace(channel, full_scale=1_000.0) for channel in record.channels]
    record = replace(record, channels=tuple(scaled), station="MCC-1", device="A1", trigger_index=2_000)
    plain = observe(through_comtrade(record, tmp_path), REFERENCE)
    exchanged = [replace(one, transformer_ratio=20.0 if one.unit == "A" else None) for one in scaled]
    again = observe(through_comtrade(replace(record, channels=tuple(exchanged)), tmp_path), REFERENCE)
    assert plain is not None
    assert again is not None
    assert plain.recorder == "MCC-1/A1, IA, IB, IC, VA, VB, VC"
    assert again.recorder == "MCC-1/A1, IA 20:1, IB 20:1, IC 20:1, VA, VB, VC"
    assert plain.time_ns == record.first_time_ns + 200_000_000


def test_a_record_counts_even_where_no_fit_comes_near_it() -> None:
    record = recording(running(REFERENCE, 0.9), noise=0.002)
    machine = REFERENCE.parameters
    other = replace(machine, stator_resistance_ohm=8.0 * machine.stator_resistance_ohm)
    examined = examine(record, replace(REFERENCE, parameters=other))
    assert examined.diagnosis.verdict is Verdict.WATCH
    assert examined.diagnosis.reasons[0].startswith("the parameters do not fit")
    assert examined.observation is not None
