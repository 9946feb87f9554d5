"""What the benchmark's relays measure: frame, channels, repeatability."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.condition.courses import healthy, shape, with_current_error, with_fault
from benchmarks.condition.operation import Load, Times, draw_operation
from benchmarks.condition.population import SimulatedMotor, draw_motor
from benchmarks.condition.records import REAL_NOISE, measure, true_phasors
from core.condition.observation import VoltageChannels
from core.machines.parameters import Connection
from core.machines.winding_frame import terminal_winding, to_winding_frame
from core.signals.clarke import clarke
from core.signals.sequence import PhaseSequence

RECORDS = 40


def motor_with(sequence: PhaseSequence, connection: Connection) -> SimulatedMotor:
    for seed in range(100):
        motor = draw_motor(np.random.default_rng(seed))
        if motor.sequence is sequence and motor.motor.nameplate.connection is connection:
            return replace(motor, voltage_channels=VoltageChannels.PHASE)
    raise AssertionError("no such motor among a hundred")


@pytest.mark.parametrize("sequence", PhaseSequence)
@pytest.mark.parametrize("connection", Connection)
def test_windings_are_seen_in_the_frame_of_the_core(sequence: PhaseSequence, connection: Connection) -> None:
    motor = motor_with(sequence, connection)
    perfect = replace(
        motor,
        channels=replace(
            motor.channels,
            voltage=np.ones(3, dtype=np.complex128),
            current=np.ones(3, dtype=np.complex128),
        ),
    )
    random = np.random.default_rng(1)
    operation = draw_operation(random, RECORDS)
    course = with_fault(healthy(RECORDS), 1, 0.02 * shape(RECORDS, 10), 1.0)
    seen = measure(random, perfect, operation, course, 0.0)

    voltage, current = true_phasors(motor, operation, course)
    k = 30
    over_a_cycle = np.exp(2j * np.pi * np.arange(64) / 64)
    current_ab, voltage_ab = to_winding_frame(
        clarke((current[k][:, np.newaxis] * over_a_cycle).real),
        clarke((voltage[k][:, np.newaxis] * over_a_cycle).real),
        sequence,
        connection,
    )
    for (alpha, beta), first, second in (
        (voltage_ab, seen.positive_voltage_V, seen.negative_voltage_V),
        (current_ab, seen.positive_current_A, seen.negative_current_A),
    ):
        turned = (alpha + 1j * beta) / np.sqrt(1.5)
        assert first[k] == pytest.approx((turned / over_a_cycle).mean(), rel=1e-9)
        assert second[k] == pytest.approx((turned * over_a_cycle).mean().conj(), rel=1e-6)
    assert motor.terminal(1) == terminal_winding(1, sequence, connection)


def test_a_current_channel_shows_in_the_sum_of_the_currents() -> None:
    motor = motor_with(PhaseSequence.ACB, Connection.STAR)
    random = np.random.default_rng(2)
    operation = draw_operation(random, RECORDS, load=Load.RANDOM)
    quiet = measure(np.random.default_rng(3), motor, operation, healthy(RECORDS), 0.0)
    course = with_current_error(healthy(RECORDS), 1, 0.02, shape(RECORDS, 20))
    disturbed = measure(np.random.default_rng(3), motor, operation, course, 0.0)

    change = np.abs(disturbed.zero_current_A - quiet.zero_current_A)
    expected = 0.02 / 3 * np.abs(disturbed.positive_current_A)

    np.testing.assert_array_equal(change[:20], 0.0)
    np.testing.assert_allclose(change[20:], expected[20:], rtol=0.15)


def test_records_repeat_as_well_as_is_said() -> None:
    motor = motor_with(PhaseSequence.ABC, Connection.DELTA)
    random = np.random.default_rng(4)
    records = 4_000
    operation = draw_operation(random, records)
    true = measure(random, motor, operation, healthy(records), 0.0)
    seen = measure(random, motor, operation, healthy(records), REAL_NOISE)

    error = (seen.negative_voltage_V - true.negative_voltage_V) / np.abs(true.positive_voltage_V)

    assert np.sqrt(np.mean(np.abs(error) ** 2)) == pytest.approx(REAL_NOISE / np.sqrt(3), rel=0.1)


@pytest.mark.parametrize("times", Times)
def test_records_are_in_the_order_of_time(times: Times) -> None:
    operation = draw_operation(np.random.default_rng(5), 500, times=times)

    assert np.all(np.diff(operation.time_ns) > 0)
    assert np.all((operation.warming > 0.7) & (operation.warming < 1.6))
    assert np.abs(operation.unbalance).max() <= 0.05
