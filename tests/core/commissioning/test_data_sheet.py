"""Impedances of a data sheet: every form of the same motor gives the same windings."""

from dataclasses import replace
from math import pi

import pytest

from core.commissioning.data_sheet import (
    intervals_of_data_sheet,
    winding_parameters,
    winding_resistance_ohm,
)
from core.commissioning.data_sheet_forms import Impedances, Reading, Unit, Values
from core.commissioning.errors import CommissioningError
from core.machines.parameters import Connection, MachineParameters, Nameplate

STAR = Nameplate(450e3, 3300.0, 50.0, 1)
DELTA = replace(STAR, connection=Connection.DELTA)
PER_PHASE = Impedances(r1=0.23, r2=0.206, x1=1.815, x2=2.057, xm=77.44)
"""Of a phase of the equivalent star [ohm]."""
W = 2.0 * pi * 50.0


def times(factor: float) -> Impedances:
    return Impedances(*(factor * getattr(PER_PHASE, name) for name in Impedances.__dataclass_fields__))


def values_of(machine: MachineParameters) -> list[float]:
    return [
        machine.stator_resistance_ohm,
        machine.rotor_resistance_ohm,
        machine.stator_leakage_H * W,
        machine.rotor_leakage_H * W,
        machine.magnetising_inductance_H * W,
    ]


@pytest.mark.parametrize(
    ("nameplate", "impedances", "reading", "winding"),
    [
        (STAR, times(1.0), Reading(), 1.0),
        (STAR, times(1.0), Reading(values=Values.STAR), 1.0),
        (STAR, times(1.0), Reading(values=Values.WINDING), 1.0),
        (STAR, times(3.0), Reading(values=Values.DELTA), 1.0),
        (DELTA, times(1.0), Reading(values=Values.STAR), 3.0),
        (DELTA, times(3.0), Reading(values=Values.DELTA), 3.0),
        (DELTA, times(3.0), Reading(values=Values.WINDING), 3.0),
        (STAR, times(525e3 / 3300.0**2), Reading(Unit.PER_UNIT, base_VA=525e3), 1.0),
        (DELTA, times(525e3 / 3300.0**2), Reading(Unit.PER_UNIT, base_VA=525e3), 3.0),
    ],
)
def test_every_form_gives_the_same_windings(
    nameplate: Nameplate, impedances: Impedances, reading: Reading, winding: float
) -> None:
    machine = winding_parameters(impedances, nameplate, reading)
    expected = [winding * one for one in (0.23, 0.206, 1.815, 2.057, 77.44)]
    assert values_of(machine) == pytest.approx(expected)
    # The factor between X_m and L_s: X_m = 1.5 * 2 pi f L_s.
    assert machine.stator_self_inductance_H == pytest.approx(winding * 77.44 / (1.5 * 314.15927))


def test_a_resistance_between_terminals_is_two_windings_in_series_or_one_beside_two() -> None:
    assert winding_resistance_ohm(0.46, Connection.STAR) == pytest.approx(0.23)
    winding = 0.69
    between = 1.0 / (1.0 / winding + 1.0 / (2.0 * winding))
    assert winding_resistance_ohm(between, Connection.DELTA) == pytest.approx(winding)


def test_cold_resistances_are_those_of_a_winding_at_work() -> None:
    cold = winding_parameters(PER_PHASE, STAR, Reading(temperature_C=20.0))
    warm = winding_parameters(PER_PHASE, STAR, Reading())
    copper = cold.stator_resistance_ohm / warm.stator_resistance_ohm
    assert copper == pytest.approx(1.0 + 0.00393 * 55.0, rel=2e-3)
    aluminium = cold.rotor_resistance_ohm / warm.rotor_resistance_ohm
    assert aluminium == pytest.approx(300.0 / 245.0)
    assert cold.stator_leakage_H == warm.stator_leakage_H


@pytest.mark.parametrize(
    ("nameplate", "impedances", "reading", "words"),
    [
        (DELTA, PER_PHASE, Reading(), r"values: expected what the ohms of this motor in delta are"),
        (STAR, PER_PHASE, Reading(Unit.PER_UNIT), r"base of per unit: expected .*--base-VA"),
        (STAR, replace(PER_PHASE, xm=0.0), Reading(), r"xm: expected a number above zero, found 0"),
        (STAR, replace(PER_PHASE, r1=float("nan")), Reading(), r"--r1, .*found nan"),
        (
            STAR,
            replace(PER_PHASE, x1=1815.0),
            Reading(),
            r"--x1: .* ohm, .*found 1815: .*milliohm. then 1.815",
        ),
        (STAR, PER_PHASE, Reading(temperature_C=400.0), r"temperature: expected -50 to 200"),
    ],
)
def test_what_is_missing_or_impossible_is_named(
    nameplate: Nameplate, impedances: Impedances, reading: Reading, words: str
) -> None:
    with pytest.raises(CommissioningError, match=words):
        winding_parameters(impedances, nameplate, reading)


def test_an_inertia_that_is_not_known_has_a_wide_interval() -> None:
    machine = winding_parameters(PER_PHASE, STAR, Reading())
    wide = intervals_of_data_sheet(machine, inertia_is_known=False, nameplate=STAR)
    low, high = wide["inertia_kgm2"]
    assert high == pytest.approx(100.0 * low)
    known = winding_parameters(PER_PHASE, STAR, Reading(), inertia_kgm2=4.1)
    assert known.inertia_kgm2 == 4.1
    narrow = intervals_of_data_sheet(known, inertia_is_known=True, nameplate=STAR)
    assert narrow["inertia_kgm2"] == pytest.approx((3.28, 4.92))
