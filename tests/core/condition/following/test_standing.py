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
