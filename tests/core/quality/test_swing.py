"""A load that swings regularly, and one that changes."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from core.diagnosis.acceptance import accept
from core.diagnosis.stator import diagnose_accepted
from core.diagnosis.verdict import Verdict
from core.quality.swing import without_swing
from core.rotor.baseband import baseband_of
from core.rotor.examining import examine_rotor
from core.rotor.finding import RotorState
from testing.machines.motors import MEDIUM
from testing.machines.rotor_records import FREQUENCY_HZ, RotorCase

STEP_S, POINTS = 5e-4, 2_400
TIME_S: NDArray[np.float64] = np.asarray(STEP_S * np.arange(POINTS), dtype=np.float64)
THREE_BARS = 3.0 / 28.0


def test_the_swing_is_taken_off_and_the_rest_stays() -> None:
    swing = 0.2 * np.exp(2j * np.pi * 4.1 * TIME_S) + 0.1j * np.exp(-2j * np.pi * 4.1 * TIME_S)
    beside = 0.02 * np.exp(2j * np.pi * 11.0 * TIME_S)
    left = without_swing(1.0 + swing + beside, STEP_S, 50.0)
    np.testing.assert_allclose(left, 1.0 + beside, atol=0.03)


@pytest.mark.parametrize(
    "course",
    [
        lambda t: (t > 0.3).astype(float),
        lambda t: (t > 1.1).astype(float),
        lambda t: t / t[-1],
        lambda t: 1.0 - np.exp(-t / 0.2),
        lambda t: np.cos(2.0 * np.pi * 0.3 * t),
    ],
    ids=["step", "late step", "ramp", "run-up", "part of a turn"],
)
def test_what_is_no_swing_stays(course: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> None:
    moved = np.asarray(1.0 + 0.3 * course(TIME_S), dtype=np.float64)
    np.testing.assert_array_equal(without_swing(moved, STEP_S, 50.0), moved)


@pytest.mark.parametrize("duration_s", [1.28, 4.0])
def test_broken_bars_beside_a_swinging_load_are_examined(duration_s: float) -> None:
    case = RotorCase(MEDIUM, load_level=1.0, broken_share=THREE_BARS)
    swings = RotorCase(
        MEDIUM, load_level=1.0, broken_share=THREE_BARS, swing=0.1, swing_hz=2.0 * case.slip() * FREQUENCY_HZ
    )
    acceptance = accept(swings.record(duration_s), MEDIUM)
    assert acceptance.accepted is not None, acceptance.quality
    accepted = acceptance.accepted
    found = examine_rotor(baseband_of(accepted), accepted, diagnose_accepted(acceptance))
    assert found.state is RotorState.FAULT
    assert found.duration_s > 0.95 * duration_s


def test_a_healthy_motor_whose_load_swings_strongly_has_no_shorted_turns() -> None:
    acceptance = accept(RotorCase(MEDIUM, load_level=0.7, swing=0.25, swing_hz=3.0).record(1.28), MEDIUM)
    assert acceptance.accepted is not None, acceptance.quality
    assert diagnose_accepted(acceptance).verdict is Verdict.HEALTHY
