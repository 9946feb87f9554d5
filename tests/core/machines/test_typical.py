"""Typical parameters: published motors lie within the intervals of their ratings."""

from dataclasses import replace
from math import pi, sqrt
from typing import NamedTuple

import pytest

from core.machines.parameters import MAGNETISING_OVER_SELF, Connection, MachineParameters, Nameplate
from core.machines.plausibility import plausible_parameters
from core.machines.typical import FACTORS, POWERS_W, atypical, typical_parameters
from testing.machines.motors import ALL, LARGE, VERY_LARGE

HORSEPOWER_W = 745.7


class Published(NamedTuple):
    """A published motor of four poles. reactances: X_ls = X_lr and X_m at rated frequency [ohm]."""

    nameplate: Nameplate
    parameters: MachineParameters


def of_reactances(
    power_W: float, voltage_V: float, R_s: float, X_ls: float, X_m: float, R_r: float, inertia: float
) -> Published:
    """Motors of Krause's table 4.10-1, of 60 Hz."""
    w = 2.0 * pi * 60.0
    figures = MachineParameters(R_s, R_r, X_ls / w, X_ls / w, X_m / w / 1.5, inertia)
    return Published(Nameplate(power_W, voltage_V, 60.0, 2), figures)


def of_inductances(
    power_W: float,
    voltage_V: float,
    frequency_Hz: float,
    R_s: float,
    L_ls: float,
    R_r: float,
    L_m: float,
    inertia: float,
) -> Published:
    """Motors of Simscape's presets."""
    return Published(
        Nameplate(power_W, voltage_V, frequency_Hz, 2),
        MachineParameters(R_s, R_r, L_ls, L_ls, L_m / 1.5, inertia),
    )


PUBLISHED = (
    of_reactances(3 * HORSEPOWER_W, 220, 0.435, 0.754, 26.13, 0.816, 0.089),
    of_reactances(50 * HORSEPOWER_W, 460, 0.087, 0.302, 13.08, 0.228, 1.662),
    of_reactances(500 * HORSEPOWER_W, 2300, 0.262, 1.206, 54.02, 0.187, 11.06),
    of_reactances(2250 * HORSEPOWER_W, 2300, 0.029, 0.226, 13.04, 0.022, 63.87),
    of_inductances(5 * HORSEPOWER_W, 460, 60, 1.115, 0.005974, 1.083, 0.2037, 0.02),
    of_inductances(10 * HORSEPOWER_W, 460, 60, 0.6837, 0.004152, 0.451, 0.1486, 0.05),
    of_inductances(50 * HORSEPOWER_W, 460, 60, 0.09961, 0.000867, 0.05837, 0.03039, 0.4),
    of_inductances(200 * HORSEPOWER_W, 460, 60, 0.01818, 0.00019, 0.009956, 0.009415, 2.6),
    of_inductances(4e3, 400, 50, 1.405, 0.005839, 1.395, 0.1722, 0.0131),
    of_inductances(15e3, 400, 50, 0.2147, 0.000991, 0.2205, 0.06419, 0.102),
    of_inductances(75e3, 400, 50, 0.03552, 0.000335, 0.02092, 0.0151, 1.25),
    of_inductances(160e3, 400, 50, 0.01379, 0.000152, 0.007728, 0.00769, 2.9),
    *(Published(motor.nameplate, motor.parameters) for motor in (*ALL, VERY_LARGE)),
)


@pytest.mark.parametrize("published", PUBLISHED, ids=lambda one: f"{one.nameplate.rated_power_W:.0f} W")
def test_published_motors_lie_within_the_intervals(published: Published) -> None:
    intervals = typical_parameters(published.nameplate).intervals
    outside = {
        name: (getattr(published.parameters, name), ends)
        for name, ends in intervals.items()
        if not ends[0] <= getattr(published.parameters, name) <= ends[1]
    }
    assert not outside


@pytest.mark.parametrize("connection", Connection)
@pytest.mark.parametrize("power_W", [50.0, *POWERS_W, 50e6])
def test_typical_parameters_are_plausible_at_any_rating(power_W: float, connection: Connection) -> None:
    nameplate = Nameplate(power_W, sqrt(power_W) * 10.0, 50.0, 3, connection)
    found = typical_parameters(nameplate)
    for one in plausible_parameters(nameplate):
        assert one.least < getattr(found.parameters, one.field) < one.most


def test_between_the_powers_of_the_table_parameters_follow_evenly() -> None:
    def reactance(power_W: float) -> float:
        plate = Nameplate(power_W, 1000.0, 50.0, 2)
        w, found = plate.rated_angular_frequency, typical_parameters(plate).parameters
        return w * found.magnetising_inductance_H / plate.base_impedance_ohm

    assert reactance(7.5e3) == pytest.approx(1.75)
    assert reactance(sqrt(7.5e3 * 75e3)) == pytest.approx(sqrt(1.75 * 2.30))
    assert reactance(100.0) == pytest.approx(1.15)


def test_the_factor_between_both_inductances_is_that_of_the_thesis() -> None:
    machine = MachineParameters.from_magnetising_inductance(
        stator_resistance_ohm=8.4,
        rotor_resistance_ohm=8.2,
        stator_leakage_H=0.0328,
        rotor_leakage_H=0.0328,
        magnetising_inductance_H=0.65655,
        inertia_kgm2=0.0229,
    )
    assert machine.stator_self_inductance_H == pytest.approx(0.4377)
    assert machine.magnetising_inductance_H == pytest.approx(0.65655)
    assert MAGNETISING_OVER_SELF == 1.5


def test_a_winding_in_delta_has_three_times_the_impedance() -> None:
    star, delta = (Nameplate(37e3, 400.0, 50.0, 2, connection) for connection in Connection)
    for name in FACTORS:
        in_star, in_delta = (getattr(typical_parameters(one).parameters, name) for one in (star, delta))
        assert in_delta == pytest.approx(in_star * (1.0 if name == "inertia_kgm2" else 3.0))


def test_what_lies_beyond_the_typical_is_named_with_its_factor() -> None:
    assert all(atypical(motor) == () for motor in (*ALL, VERY_LARGE))
    wrong = replace(LARGE, parameters=replace(LARGE.parameters, rotor_leakage_H=0.02172))
    (said,) = atypical(wrong)
    assert said.startswith("rotor_leakage_H is 9 times what is typical of the rating (")
    star = replace(LARGE, nameplate=replace(LARGE.nameplate, connection=Connection.STAR))
    assert atypical(star)[-1].startswith("all impedances are off alike: check connection")
