"""Circuits from catalogues: published motors are found again, within the intervals."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

from core.commissioning.catalogue import circuit_from_catalogue, figures_of
from core.commissioning.catalogue_data import CatalogueData
from core.commissioning.circuit_doubts import circuit_doubts
from core.commissioning.errors import CommissioningError
from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate
from testing.machines.wound_rotors import HOIST, MILL
from tests.core.machines.test_typical import PUBLISHED, Published

PUMP = Nameplate(450e3, 3300.0, 50.0, 1)
COMPLETE = CatalogueData(0.958, 0.90, 92.0, 2972.0, 5.5, 0.7, 2.6)


def steady(machine: MachineParameters, nameplate: Nameplate, slip: float) -> tuple[complex, float]:
    """Current of a winding and air-gap power of all three at rated voltage, from the meshes' equations."""
    w = nameplate.rated_angular_frequency
    X_m = w * machine.magnetising_inductance_H
    stator = complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H + X_m)
    rotor = complex(machine.rotor_resistance_ohm / slip, w * machine.rotor_leakage_H + X_m)
    volts = nameplate.rated_voltage_V / (1.0 if nameplate.connection == "delta" else sqrt(3.0))
    currents = np.linalg.solve(np.array([[stator, -1j * X_m], [-1j * X_m, rotor]]), [volts, 0.0])
    power = 3.0 * abs(currents[1]) ** 2 * machine.rotor_resistance_ohm / slip
    return complex(currents[0]), float(power)


def catalogue_of(published: Published, further: float) -> CatalogueData:
    """What a catalogue would say; further: losses that are not of the windings, over those that are."""
    nameplate, machine = published.nameplate, published.parameters
    volts = nameplate.rated_voltage_V / (1.0 if nameplate.connection == "delta" else sqrt(3.0))
    line = sqrt(3.0) if nameplate.connection == "delta" else 1.0

    def losses(slip: float) -> float:
        current, power = steady(machine, nameplate, slip)
        return further * (3.0 * machine.stator_resistance_ohm * abs(current) ** 2 + slip * power)

    def short_of(slip: float) -> float:
        return steady(machine, nameplate, slip)[1] * (1.0 - slip) - losses(slip) / 2 - nameplate.rated_power_W

    slip = float(brentq(short_of, 1e-5, 0.08))
    current, _power = steady(machine, nameplate, slip)
    current += losses(slip) / 2.0 / (3.0 * volts)
    taken = 3.0 * volts * current.real
    locked, at_standstill = steady(machine, nameplate, 1.0)
    greatest = max(steady(machine, nameplate, one)[1] for one in np.geomspace(1e-3, 1.0, 400))
    rated = nameplate.rated_power_W / (1.0 - slip)
    synchronous = 60.0 * nameplate.rated_frequency_Hz / nameplate.pole_pairs
    return CatalogueData(
        efficiency=round(nameplate.rated_power_W / taken, 3),
        power_factor=round(current.real / abs(current), 2),
        rated_current_A=line * abs(current),
        rated_speed_rpm=round(synchronous * (1.0 - slip)),
        locked_rotor_current=round(abs(locked) / abs(current), 1),
        locked_rotor_torque=round(max(at_standstill / rated, 0.1), 1),
        breakdown_torque=round(greatest / rated, 1),
    )


@pytest.mark.parametrize("published", PUBLISHED, ids=lambda one: f"{one.nameplate.rated_power_W:.0f} W")
def test_published_motors_lie_within_the_intervals_of_their_own_catalogue(published: Published) -> None:
    for further in (0.5, 1.0):
        found = circuit_from_catalogue(catalogue_of(published, further), published.nameplate)
        for name, (low, high) in found.intervals.items():
            assert low <= getattr(published.parameters, name) <= high, (further, name)
        narrow = found.intervals["rotor_resistance_ohm"]
        assert narrow[1] / narrow[0] < 1.6
        assert max(abs(one.deviations or 0.0) for one in found.compared) < 1.0
        assert circuit_doubts(found.parameters, found.compared, published.nameplate) == ()


@pytest.mark.parametrize("motor", [HOIST, MILL], ids=lambda motor: motor.name)
def test_a_wound_rotor_has_the_resistance_of_its_plate_and_no_deep_bars(motor: Motor) -> None:
    """Its catalogue has no locked rotor: it never starts with shorted rings."""
    complete = catalogue_of(Published(motor.nameplate, motor.parameters), 0.7)
    data = replace(complete, rated_speed_rpm=None, locked_rotor_current=None, locked_rotor_torque=None)
    found = circuit_from_catalogue(data, motor.nameplate, motor.wound_rotor)
    for name, (low, high) in found.intervals.items():
        assert low <= getattr(motor.parameters, name) <= high, name
    without_speed = replace(motor.nameplate, rated_speed_rpm=None)
    as_a_cage = circuit_from_catalogue(data, without_speed).intervals
    assert _width(found.intervals["rotor_resistance_ohm"]) < _width(as_a_cage["rotor_resistance_ohm"])
    locked = next(one for one in found.compared if one.name == "locked_rotor_torque")
    assert locked.computed == pytest.approx(complete.locked_rotor_torque, abs=0.4)


def _width(interval: tuple[float, float]) -> float:
    return interval[1] / interval[0]


def test_the_circuit_found_has_the_figures_that_it_is_said_to_have() -> None:
    found = circuit_from_catalogue(COMPLETE, PUMP)
    computed = {one.name: one.computed for one in found.compared}
    slip = 1.0 - computed["rated_speed_rpm"] / 3000.0
    current, power = steady(found.parameters, PUMP, slip)
    volts = 3300.0 / sqrt(3.0)
    # Half of the further losses are in the core, half at the shaft.
    further = 2.0 * (power * (1.0 - slip) - 450e3)
    copper = 3.0 * found.parameters.stator_resistance_ohm * abs(current) ** 2 + slip * power
    line = current + further / 2.0 / (3.0 * volts)
    assert 0.2 < further / (copper + further) < 0.7
    assert abs(line) == pytest.approx(computed["rated_current_A"], rel=5e-3)
    assert line.real / abs(line) == pytest.approx(computed["power_factor"], abs=2e-3)
    assert 450e3 / (3.0 * volts * line.real) == pytest.approx(computed["efficiency"], abs=2e-3)
    again = figures_of(found.parameters, COMPLETE, PUMP)
    assert {one.name: one.given for one in again} == {one.name: one.given for one in found.compared}
    assert {one.name: one.computed for one in again}["power_factor"] == pytest.approx(
        computed["power_factor"], abs=0.02
    )


def test_fewer_figures_leave_wider_intervals() -> None:
    few = CatalogueData(rated_speed_rpm=2972.0, rated_current_A=92.0, power_factor=0.90)
    wide, narrow = (circuit_from_catalogue(one, PUMP).intervals for one in (few, COMPLETE))
    for name in ("stator_resistance_ohm", "stator_leakage_H"):
        assert wide[name][1] / wide[name][0] > 1.1 * narrow[name][1] / narrow[name][0]


def test_a_measured_resistance_is_kept() -> None:
    measured = CatalogueData(0.958, 0.90, 92.0, 2972.0, 5.5, 0.7, 2.6, stator_resistance_ohm=0.23)
    found = circuit_from_catalogue(measured, PUMP)
    assert found.parameters.stator_resistance_ohm == pytest.approx(0.23, rel=0.03)
    low, high = found.intervals["stator_resistance_ohm"]
    assert high / low < 1.25


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (
            CatalogueData(efficiency=0.958, power_factor=0.9),
            "at least 3 figures .* found efficiency, power f",
        ),
        (
            CatalogueData(efficiency=0.00958),
            "efficiency: .* 30 to below 100 %, found 0.958 %: is it a fraction. then 95.8",
        ),
        (
            CatalogueData(rated_speed_rpm=1486.0),
            "rated speed: expected 2400 to below 3000 rpm, .* 1 pole pairs",
        ),
        (CatalogueData(rated_current_A=-92.0), "rated current: expected a number above zero"),
    ],
)
def test_impossible_figures_and_too_few_are_refused(data: CatalogueData, words: str) -> None:
    with pytest.raises(CommissioningError, match=words):
        circuit_from_catalogue(data, PUMP)


def test_a_circuit_that_cannot_bear_its_rated_torque_is_refused() -> None:
    machine = circuit_from_catalogue(COMPLETE, PUMP).parameters
    weak = MachineParameters(*(20.0 * getattr(machine, name) for name in machine.__dataclass_fields__))
    with pytest.raises(CommissioningError, match="a motor that bears its rated torque"):
        figures_of(weak, CatalogueData(), PUMP)


FAN = Nameplate(90e3, 400.0, 50.0, 2, Connection.DELTA)
OF_FAN = CatalogueData(0.952, 0.86, 159.0, 1483.0, 7.2, 2.5, 2.9)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("locked_rotor_current", 1145.0, "2 to 15 times .*, found 1145: is it in amperes. then 7.201"),
        ("locked_rotor_current", 720.0, "found 720: is it in percent. then 7.2"),
        ("locked_rotor_current", 72.0, "found 72: is it with the decimal point elsewhere. then 7.2"),
        ("locked_rotor_torque", 1450.0, "0.1 to 8 times .*, found 1450: is it in Nm. then 2.502"),
        ("breakdown_torque", 1680.0, "1.1 to 8 times .*, found 1680: is it in Nm. then 2.899"),
        ("rated_current_A", 159e3, "rated current: .* A, for 90 kW .* is it in milliamperes. then 159"),
        ("rated_current_A", 91.8, "is it that of a winding in delta. then 159"),
        ("rated_speed_rpm", 1.13, "is it the slip in percent. then 1483"),
        ("power_factor", 86.0, "0.3 to below 1, found 86: is it in percent. then 0.86"),
        ("stator_resistance_ohm", 69.0, "ohm of a winding, found 69: is it in milliohm. then 0.069"),
    ],
)
def test_a_figure_in_another_unit_is_refused_with_the_unit(name: str, value: float, words: str) -> None:
    with pytest.raises(CommissioningError, match=words):
        circuit_from_catalogue(replace(OF_FAN, **{name: value}), FAN)


def test_deviations_have_the_sign_of_what_is_shown() -> None:
    for one in circuit_from_catalogue(OF_FAN, FAN).compared:
        if one.given is not None:
            assert one.deviations is not None
            assert one.deviations * (one.computed - one.given) > 0.0, one.name


def test_a_circuit_unlike_those_of_the_rating_names_the_figures_of_the_catalogue() -> None:
    data = CatalogueData(rated_current_A=155.0, rated_speed_rpm=1290.0, locked_rotor_torque=3.0)
    found = circuit_from_catalogue(data, FAN)
    (doubt,) = circuit_doubts(found.parameters, found.compared, FAN)
    assert doubt.startswith("rotor resistance of the circuit: 8.3 times what is typical of the rating")
    assert doubt.endswith("check rated speed (1290), locked-rotor torque (3) and the nameplate")
    data = CatalogueData(rated_current_A=350.0, rated_speed_rpm=1250.0, efficiency=0.8)
    found = circuit_from_catalogue(data, FAN)
    for doubt in circuit_doubts(found.parameters, found.compared, FAN):
        assert "rated current (350)" in doubt
