"""The speed beside a diagnosis: seen in the current it corrects the model's, and places the sidebands."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from core.findings.examining import examine
from core.findings.findings import Findings
from core.machines.parameters import Motor
from core.recordings import Recording
from core.rotor.finding import RotorState
from core.rotor.seen_slip import PLACED
from core.speed.finding import SpeedSource, SpeedState
from core.speed.memory import LineMemory
from testing.machines.motors import MEDIUM
from testing.machines.rotor_records import FREQUENCY_HZ, RotorCase
from testing.machines.wound_rotors import HOIST

BARS, RATE_HZ = 28, 5_000.0
HEALTHY = RotorCase(MEDIUM, load_level=0.9)
BROKEN = replace(HEALTHY, broken_share=1.0 / BARS)
LINES = {(-3, BARS): 3e-3, (1, BARS): 3e-3, (3, BARS): 1.5e-3, (5, -BARS): 1e-3, (-3, 1): 1e-3}


def known(*, bars: int | None = BARS, rotor_resistance: float = 1.0) -> Motor:
    """The motor as its file has it."""
    machine = MEDIUM.parameters
    wrong = replace(machine, rotor_resistance_ohm=machine.rotor_resistance_ohm / rotor_resistance)
    return replace(MEDIUM, nameplate=replace(MEDIUM.nameplate, rotor_bars=bars), parameters=wrong)


def with_lines(case: RotorCase, duration_s: float) -> tuple[Recording, float]:
    """A record with lines of slots, and its slip."""
    record, slip = case.record(duration_s, RATE_HZ), case.slip()
    t = np.arange(record.samples.shape[1]) / RATE_HZ
    supply = 2.0 * pi * FREQUENCY_HZ * t
    shaft = supply * (1.0 - slip) / MEDIUM.nameplate.pole_pairs
    largest = float(np.abs(record.samples[0]).max())
    samples = record.samples.copy()
    for number, ((order, turns), size) in enumerate(LINES.items()):
        angle = order * supply + turns * shaft + number
        for phase in range(3):
            samples[phase] += size * largest * np.cos(angle - 2.0 * pi / 3.0 * phase)
    return replace(record, samples=samples), slip


def slip_of(found: Findings) -> float:
    assert found.speed.slip is not None
    return found.speed.slip


def test_the_seen_speed_stands_before_that_of_a_model_with_a_cold_rotor() -> None:
    record, slip = with_lines(HEALTHY, 1.0)
    found = examine(record, known(rotor_resistance=1.25))
    speed = found.speed
    assert (speed.state, speed.source, speed.rotor_bars) == (SpeedState.SEEN, SpeedSource.CURRENT, BARS)
    assert speed.speed_rpm_ci95 is not None
    assert speed.model_speed_rpm is not None
    true_rpm = 60.0 * FREQUENCY_HZ * (1.0 - slip) / MEDIUM.nameplate.pole_pairs
    assert speed.speed_rpm == pytest.approx(true_rpm, abs=0.5)
    assert speed.model_speed_rpm > true_rpm + 3.0
    assert "times the model's" in speed.reasons[0]
    assert found.as_dict()["speed"] == speed.as_dict()


@pytest.mark.parametrize("rotor_resistance", [1.0, 1.6])
def test_the_sidebands_of_a_broken_bar_are_placed_by_the_seen_speed(rotor_resistance: float) -> None:
    """A rotor resistance that is wrong by 1.6 puts the model's sidebands out of the search's reach."""
    record, slip = with_lines(BROKEN, 4.0)
    found = examine(record, known(rotor_resistance=rotor_resistance))
    assert found.speed.state is SpeedState.SEEN
    assert PLACED in found.rotor.reasons
    assert found.rotor.slip == pytest.approx(slip, rel=0.03)
    assert found.rotor.state is RotorState.FAULT
    without = examine(record, known(bars=None, rotor_resistance=rotor_resistance)).rotor
    assert PLACED not in without.reasons
    assert (without.state is RotorState.FAULT) == (rotor_resistance == 1.0)


def test_without_lines_the_model_tells_the_speed() -> None:
    found = examine(HEALTHY.record(1.0, RATE_HZ), known())
    assert (found.speed.state, found.speed.source) == (SpeedState.NOT_SEEN, SpeedSource.MODEL)
    assert found.speed.speed_rpm == pytest.approx(found.diagnosis.speed_rpm)
    assert PLACED not in found.rotor.reasons


def test_without_bars_and_memory_nothing_is_looked_for() -> None:
    record, _ = with_lines(HEALTHY, 0.5)
    found = examine(record, known(bars=None))
    assert found.speed.state is SpeedState.NOT_SEEN
    assert "rotor_bars" in found.speed.reasons[0]


def test_a_memory_weighs_the_bars() -> None:
    record, _ = with_lines(HEALTHY, 1.0)
    memory = LineMemory()
    found = examine(record, known(bars=None), lines=memory)
    assert found.speed.state is SpeedState.ALTERNATIVES
    assert found.speed.source is SpeedSource.MODEL
    assert BARS in {one.rotor_bars for one in found.speed.alternatives}
    assert len(memory.evidence) == 1


def test_short_and_slow_records_say_what_is_missing() -> None:
    assert "0.4 s" in examine(HEALTHY.record(0.3, RATE_HZ), known()).speed.reasons[0]
    assert "samples/s" in examine(HEALTHY.record(1.0, 2_000.0), known()).speed.reasons[0]


def test_a_refused_record_has_no_speed() -> None:
    record = HEALTHY.record(1.0, RATE_HZ)
    silent = replace(record, samples=0.0 * record.samples)
    speed = examine(silent, known()).speed
    assert (speed.state, speed.source, speed.speed_rpm) == (SpeedState.NOT_SEEN, None, None)


def test_a_wound_rotor_is_not_looked_at() -> None:
    case = RotorCase(HOIST)
    speed = examine(case.record(1.0, RATE_HZ), HOIST).speed
    assert speed.state is SpeedState.NOT_SEEN
    assert "cage" in speed.reasons[0]
