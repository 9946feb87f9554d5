"""The speed from currents: as true as its interval says, and not seen where it is not there."""

import json
from dataclasses import replace

import numpy as np
import pytest

from core.signals.clarke import clarke
from core.speed.comb import Comb
from core.speed.finding import SpeedFinding, SpeedSource, SpeedState
from core.speed.memory import LineMemory
from core.speed.record import SpeedRecord, speed_record, why_unsuited
from core.speed.search import SEEN_MARGIN, find_peak
from core.speed.telling import learn, tell_speed
from tests.core.speed.motor_currents import MotorCurrents

MOTOR = MotorCurrents()
RATE_HZ = 5_000.0


def record_of(
    motor: MotorCurrents, duration_s: float = 0.5, rate_hz: float = RATE_HZ, *, phases: int = 3
) -> SpeedRecord:
    currents = motor.abc(duration_s, rate_hz)
    found = clarke(currents) if phases == 3 else currents[:1]
    return speed_record(found, rate_hz, motor.frequency_hz, motor.pole_pairs)


def told(
    motor: MotorCurrents, duration_s: float = 0.5, rate_hz: float = RATE_HZ, phases: int = 3
) -> SpeedFinding:
    return tell_speed(record_of(motor, duration_s, rate_hz, phases=phases), LineMemory(motor.bars))


def error_rpm(found: SpeedFinding, motor: MotorCurrents) -> float:
    assert found.speed_rpm is not None
    return found.speed_rpm - motor.speed_rpm


@pytest.mark.parametrize(
    "motor",
    [
        MOTOR,
        replace(MOTOR, backward=True),
        replace(MOTOR, frequency_hz=49.93, slip=0.009),
        replace(MOTOR, frequency_hz=60.02, slip=0.055),
        replace(MOTOR, bars=46, slip=0.011, lines=1.5),
        replace(MOTOR, bars=34, pole_pairs=3),
        replace(MOTOR, slip_change=0.001),
    ],
    ids=["plain", "backward", "light", "heavy", "46 bars", "six poles", "load changes"],
)
@pytest.mark.parametrize("rate_hz", [4_000.0, 10_000.0])
def test_sees_the_speed_of_half_a_second(motor: MotorCurrents, rate_hz: float) -> None:
    found = told(motor, rate_hz=rate_hz)
    assert (found.state, found.source) == (SpeedState.SEEN, SpeedSource.CURRENT)
    assert found.speed_rpm_ci95 is not None
    low, high = found.speed_rpm_ci95
    assert 0.1 < high - low < 2.0
    assert abs(error_rpm(found, motor)) < 0.6
    assert found.slip == pytest.approx(motor.slip + motor.slip_change / 2.0, abs=5e-4)
    assert found.rotor_bars == motor.bars


def test_intervals_hold_what_they_say() -> None:
    seen = inside = 0
    for seed in range(40):
        motor = replace(MOTOR, seed=seed, slip=0.01 + 0.0007 * seed, noise=0.004)
        found = told(motor)
        if found.speed_rpm_ci95 is not None:
            seen += 1
            inside += found.speed_rpm_ci95[0] <= motor.speed_rpm <= found.speed_rpm_ci95[1]
    assert seen >= 36
    assert inside >= 0.9 * seen


def test_a_longer_record_is_surer() -> None:
    short, long = told(MOTOR), told(MOTOR, 2.0)
    assert short.speed_rpm_ci95 is not None
    assert long.speed_rpm_ci95 is not None
    assert np.ptp(long.speed_rpm_ci95) < 0.75 * np.ptp(short.speed_rpm_ci95)
    assert abs(error_rpm(long, MOTOR)) < 0.3


def test_one_current_alone_shows_the_speed() -> None:
    assert abs(error_rpm(told(MOTOR, phases=1), MOTOR)) < 1.0


@pytest.mark.parametrize("phases", [1, 3])
def test_noise_alone_shows_nothing(phases: int) -> None:
    for seed in range(40):
        motor = replace(MOTOR, lines=0.0, noise=0.01, seed=seed)
        found = told(motor, phases=phases)
        assert found.state is SpeedState.NOT_SEEN
        assert found.speed_rpm is None
        assert "do not stand out" in found.reasons[0]


def test_white_noise_without_a_supply_shows_nothing_whatever_the_bars() -> None:
    random = np.random.default_rng(1)
    for _ in range(10):
        record = speed_record(random.standard_normal((2, 2_500)), RATE_HZ, 50.0, 2)
        assert tell_speed(record, LineMemory()).state is SpeedState.NOT_SEEN


def test_where_nothing_is_seen_the_model_tells_the_speed() -> None:
    record = record_of(replace(MOTOR, lines=0.0))
    found = tell_speed(record, LineMemory(28), model_slip=0.02)
    assert (found.state, found.source) == (SpeedState.NOT_SEEN, SpeedSource.MODEL)
    assert found.speed_rpm == pytest.approx(1470.0)
    assert found.speed_rpm_ci95 is None
    assert found.seen_slip is None


def test_a_speed_far_from_the_model_is_a_false_one_unless_the_model_is_only_typical() -> None:
    record, memory = record_of(MOTOR), LineMemory(28)
    false = tell_speed(record, memory, model_slip=0.0015)
    assert false.state is SpeedState.NOT_SEEN
    assert "taken for others" in false.reasons[0]
    assert tell_speed(record, memory, model_slip=0.0015, is_model_sure=False).state is SpeedState.SEEN


def test_a_band_without_slot_lines_shows_nothing() -> None:
    motor = replace(MOTOR, bars=46, lines=3.0)
    assert told(motor, rate_hz=4_000.0).state is SpeedState.SEEN
    assert told(motor, rate_hz=2_000.0).state is SpeedState.NOT_SEEN


def test_slot_lines_that_harmonics_hide_do_not_tell_the_speed() -> None:
    """28 bars stand 14 s f beside a harmonic: 2.1 Hz here, within its line of half a second."""
    motor = replace(MOTOR, slip=0.003)
    assert told(motor).state is SpeedState.NOT_SEEN


def test_a_line_beside_a_harmonic_does_not_hold_the_speed() -> None:
    """At this slip the line 29 f_r + f is hidden; 1.4 rpm lower it would show, and pull the speed there."""
    motor = replace(MOTOR, seed=18, slip=0.039, lines=2.0, noise=0.001)
    assert abs(error_rpm(told(motor, 1.0), motor)) < 0.5


def test_says_why_a_record_is_unsuited() -> None:
    assert "0.4 s" in (why_unsuited(1_000, RATE_HZ) or "")
    assert "samples/s" in (why_unsuited(1_000, 1_000.0) or "")
    assert why_unsuited(2_500, RATE_HZ) is None


def test_bars_that_place_their_lines_alike_are_alternatives_until_records_tell_them_apart() -> None:
    memory, states = LineMemory(), []
    for number in range(24):
        motor = replace(MOTOR, seed=number, slip=0.012 + 0.0015 * number, lines=2.0, noise=0.001)
        record = record_of(motor, 1.0)
        found = tell_speed(record, memory)
        learn(record, found, memory)
        states.append(found.state)
        if found.state is SpeedState.SEEN:
            assert found.rotor_bars == motor.bars
            assert abs(error_rpm(found, motor)) < 0.5
        else:
            bars = {one.rotor_bars for one in found.alternatives}
            assert motor.bars in bars
            assert bars <= {16, 20, 24, 28, 32, 36, 40}
    assert states[0] is SpeedState.ALTERNATIVES
    assert states[-1] is SpeedState.SEEN
    assert memory.known_bars == MOTOR.bars


def test_learnt_lines_see_what_the_untrained_comb_does_not() -> None:
    memory = LineMemory(MOTOR.bars)
    for seed in range(30):
        record = record_of(replace(MOTOR, seed=seed, slip=0.01 + 0.001 * seed))
        learn(record, tell_speed(record, memory), memory)
    margins = []
    for seed in range(100, 108):
        record = record_of(replace(MOTOR, seed=seed, noise=0.012))
        found = [find_peak(record.pieces[0], comb, 2) for comb in (Comb.untrained(28), memory.comb(28))]
        margins.append([one.margin for one in found])
    untrained, learnt = np.array(margins).T
    assert np.median(learnt) > np.median(untrained) + 5.0
    for seed in range(20):
        record = record_of(replace(MOTOR, lines=0.0, noise=0.01, seed=seed))
        assert find_peak(record.pieces[0], memory.comb(28), 2).margin < SEEN_MARGIN


def test_the_memory_is_a_document() -> None:
    memory = LineMemory()
    record = record_of(replace(MOTOR, lines=2.0), 1.0)
    memory.weigh(record.evidence())
    memory.learn(record.pieces[0], 28, MOTOR.speed_rpm / 60.0)
    again = LineMemory.from_dict(json.loads(json.dumps(memory.as_dict())))
    assert again.as_dict() == memory.as_dict()
    assert again.candidates == memory.candidates
    np.testing.assert_allclose(again.comb(28).present, memory.comb(28).present, atol=1e-3)
