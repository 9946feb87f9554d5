"""The heating of a start against what the rotor withstands, and starts within an hour."""

from dataclasses import replace
from math import sqrt

import pytest

from core.machines.parameters import StartLimits
from core.starts.stress import HOUR_NS, locked_rotor_current_A, start_stress, starts_within_hour
from testing.machines.motors import MEDIUM
from testing.service.starts import START


def test_limits_of_the_motor_file_count() -> None:
    motor = replace(MEDIUM, start_limits=StartLimits(90.0, 10.0, 20.0))

    stress = start_stress(START, motor)

    assert stress.hot_limit_A2s == pytest.approx(81_000.0)
    assert stress.share_of_hot == pytest.approx(START.i2t_A2s / 81_000.0)
    assert stress.share_of_cold == pytest.approx(START.i2t_A2s / 162_000.0)
    assert stress.source == "motor file"


def test_without_them_the_standard_s_least_time_counts() -> None:
    stress = start_stress(START, MEDIUM)

    assert stress.hot_limit_A2s == pytest.approx(12.0 * locked_rotor_current_A(MEDIUM) ** 2)
    assert stress.cold_limit_A2s is None
    assert stress.share_of_cold is None
    assert "NEMA MG 1-12.49" in stress.source
    assert "from the parameters" in stress.source


def test_the_locked_rotor_draws_what_its_impedance_lets_through() -> None:
    p, w = MEDIUM.parameters, 314.159265
    rotor = p.rotor_resistance_ohm + 1j * w * p.rotor_leakage_H
    magnetising = 1j * w * p.magnetising_inductance_H
    impedance = (
        p.stator_resistance_ohm + 1j * w * p.stator_leakage_H + rotor * magnetising / (rotor + magnetising)
    )
    assert locked_rotor_current_A(MEDIUM) == pytest.approx(400.0 / sqrt(3.0) / abs(impedance), rel=1e-6)


def test_the_standard_says_nothing_of_large_motors() -> None:
    large = replace(MEDIUM, nameplate=replace(MEDIUM.nameplate, rated_voltage_V=3300.0))

    stress = start_stress(START, large)

    assert stress.share_of_hot is None
    assert "locked_rotor_hot_s" in stress.source


def test_starts_of_the_last_hour_are_counted_with_the_latest() -> None:
    times = [0, HOUR_NS // 2, HOUR_NS - 1, HOUR_NS, 5 * HOUR_NS]

    assert [starts_within_hour(times, one) for one in times] == [1, 2, 3, 3, 1]
