"""What a start tells of the rotor's resistance beside the stator's."""

from math import hypot

import pytest

from core.starts.examined import Interval, StartParameters

ROTOR, STATOR = "rotor_resistance_ohm", "stator_resistance_ohm"


def _parameters(ci95: dict[str, Interval], rotor_ohm: float = 3.0) -> StartParameters:
    return StartParameters({ROTOR: rotor_ohm, STATOR: 4.0}, ci95, 0.5, None, "constant", 0.01, ())


def test_a_start_tells_the_ratio_of_both_resistances() -> None:
    found = _parameters({ROTOR: (2.94, 3.06), STATOR: (3.88, 4.12)}).rotor_over_stator
    assert found is not None
    assert found == pytest.approx((0.75, hypot(0.02, 0.03) / 1.96))


def test_without_both_resistances_there_is_no_ratio() -> None:
    assert _parameters({STATOR: (3.9, 4.1)}).rotor_over_stator is None
    assert _parameters({ROTOR: (-0.1, 0.1), STATOR: (3.9, 4.1)}, rotor_ohm=0.0).rotor_over_stator is None
