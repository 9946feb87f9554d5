"""The level of a fault that stands from the first record on."""

import numpy as np
import pytest

from core.condition.following.standing import standing_of
from core.condition.measuring.signatures import PATHS, shorted_turns
from tests.core.condition.simulated import Plant, follow, motor_of


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("astray", [1.5, -1.5])
def test_the_interval_holds_the_level_whatever_the_path(path: float, astray: float) -> None:
    motor, deviation = motor_of(), 0.003
    u = 0.03 * shorted_turns(motor, 1, path)
    across = 1j * u / abs(u) * astray * deviation
    asymmetry = np.array([(u + across).real, (u + across).imag])
    standing = standing_of(motor, asymmetry, deviation**2 * np.eye(2), from_bus=False)
    low, high = standing.interval
    assert low < 0.03 < high
    assert low <= standing.level <= high


def test_the_assessment_tells_that_interval() -> None:
    assessment = follow(motor_of(), Plant(level=0.03, path=0.0).records(20)).assessment()
    assert assessment is not None
    standing = assessment.reference.standing
    assert standing.interval is not None
    low, high = standing.ci95
    assert low < 0.03 < high


@pytest.mark.parametrize("winding", [0, 1, 2])
def test_a_fault_on_a_constant_supply_does_not_come_to_stand(winding: int) -> None:
    """The filter takes it for an error of the impedance: only their priors tell that from E."""
    plant = Plant(supply_swing=0.0, unbalance=0.02, seed=1, winding=winding)
    follower = follow(motor_of(), plant.records(60))
    healthy = follower.assessment()
    plant.level = 0.03
    for record in plant.records(12):
        follower.fold(record)
    faulty = follower.assessment()
    assert healthy is not None
    assert faulty is not None
    assert faulty.change is not None
    assert faulty.change.level.winding == winding
    assert faulty.reference.standing_score == pytest.approx(healthy.reference.standing_score, abs=0.1)
