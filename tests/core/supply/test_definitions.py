"""Unbalance and distortion by the standards' own printed numbers and by arithmetic done otherwise."""

from cmath import rect
from math import pi, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.supply.definitions import (
    derating,
    harmonic_voltage_factor,
    nema_unbalance,
    total_harmonic_distortion,
    unbalance_of_magnitudes,
)


def test_unbalance_of_the_example_printed_in_nema_mg_1() -> None:
    assert nema_unbalance([460.0, 467.0, 450.0]) == pytest.approx(0.0196, abs=5e-5)


@given(
    share=st.floats(0.0, 0.99),
    angle=st.floats(0.0, 2.0 * pi),
    size=st.floats(0.01, 1e4),
)
def test_unbalance_of_magnitudes_is_that_of_the_sequences(share: float, angle: float, size: float) -> None:
    turn = rect(1.0, 2.0 * pi / 3.0)
    negative = rect(share, angle)
    magnitudes = [size * abs(turn**-n + negative * turn**n) for n in range(3)]
    assert unbalance_of_magnitudes(magnitudes) == pytest.approx(share, abs=1e-6)


def test_unbalance_of_a_motor_that_lost_a_phase_or_has_no_triangle_is_one() -> None:
    assert unbalance_of_magnitudes([10.0, 10.0, 0.0]) == pytest.approx(1.0)
    assert unbalance_of_magnitudes([10.0, 4.0, 4.0]) == 1.0


@pytest.mark.parametrize(
    ("unbalance", "factor"), [(0.0, 1.0), (0.01, 1.0), (0.015, 0.975), (0.03, 0.88), (0.05, 0.75)]
)
def test_derating_follows_the_curve(unbalance: float, factor: float) -> None:
    assert derating(unbalance) == pytest.approx(factor)


def test_above_five_percent_there_is_no_derating() -> None:
    assert derating(0.0501) is None


def test_distortion_is_the_root_of_the_sum_of_squares() -> None:
    assert total_harmonic_distortion([1.0, 0.0, 0.03, 0.0, 0.04]) == pytest.approx(0.05)


def test_the_harmonic_voltage_factor_takes_odd_orders_without_multiples_of_three() -> None:
    shares = [1.0, *[0.1] * 24]
    by_hand = sqrt(0.01 * (1 / 5 + 1 / 7 + 1 / 11 + 1 / 13 + 1 / 17 + 1 / 19 + 1 / 23 + 1 / 25))
    assert harmonic_voltage_factor(shares) == pytest.approx(by_hand)
    assert harmonic_voltage_factor([1.0, 0.1, 0.1, 0.1]) == 0.0
