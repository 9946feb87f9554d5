"""Losses against simulated motors: what a fault adds to the power drawn at the same load is what it costs."""

from functools import cache

import pytest

from core.diagnosis.causes import Cause
from core.findings.examining import examine
from core.findings.findings import Findings
from core.losses.figures import LossFigures
from core.losses.other_losses import assigned_stray_W, other_losses
from core.machines.load_point import load_point
from core.machines.parameters import Motor, Nameplate
from core.machines.typical import typical_parameters
from testing.machines.cause_records import CauseCase, Sizes
from testing.machines.motors import LARGE, MEDIUM

LOAD, SEED = 0.75, 3


@cache
def found(motor: str, *causes: Cause) -> Findings:
    known = {"medium": MEDIUM, "large": LARGE}[motor]
    case = CauseCase(known, frozenset(causes), LOAD, SEED, Sizes(turns=0.03))
    return examine(case.record(), case.known())


def power_W(findings: Findings) -> float:
    assert findings.supply is not None
    assert findings.supply.active_power_W is not None
    return findings.supply.active_power_W


def added_W(motor: str, cause: Cause) -> float:
    return power_W(found(motor, cause)) - power_W(found(motor))


@pytest.mark.parametrize("motor", ["medium", "large"])
def test_shorted_turns_cost_what_the_motor_draws_more(motor: str) -> None:
    losses = found(motor, Cause.SHORTED_TURNS).losses
    assert losses.turns_loss_W == pytest.approx(added_W(motor, Cause.SHORTED_TURNS), rel=0.15)
    assert found(motor).losses.turns_loss_W == 0.0


@pytest.mark.parametrize("motor", ["medium", "large"])
def test_an_unbalanced_supply_costs_what_the_motor_draws_more(motor: str) -> None:
    losses = found(motor, Cause.SUPPLY).losses
    assert losses.unbalance_loss_W == pytest.approx(added_W(motor, Cause.SUPPLY), rel=0.25)


def test_a_broken_bar_costs_something_and_turns_nothing() -> None:
    losses = found("medium", Cause.ROTOR).losses
    assert losses.rotor_loss_W is not None
    assert losses.rotor_copper_W is not None
    assert 0.005 * losses.rotor_copper_W < losses.rotor_loss_W < 0.1 * losses.rotor_copper_W
    assert losses.turns_loss_W == 0.0


@pytest.mark.parametrize("causes", [(), (Cause.SHORTED_TURNS,), (Cause.SUPPLY,)])
def test_what_is_drawn_is_lost_or_comes_out_of_the_shaft(causes: tuple[Cause, ...]) -> None:
    findings = found("medium", *causes)
    losses = findings.losses
    parts = (
        losses.stator_copper_W,
        losses.rotor_copper_W,
        losses.iron_W,
        losses.friction_W,
        losses.stray_W,
    )
    assert sum(one for one in parts if one is not None) == pytest.approx(losses.losses_W)
    assert losses.output_W is not None
    assert losses.losses_W is not None
    assert losses.output_W + losses.losses_W == pytest.approx(power_W(findings))
    assert losses.efficiency == pytest.approx(losses.output_W / power_W(findings))
    assert losses.load_class == int(10.0 * losses.output_W / MEDIUM.nameplate.rated_power_W)


def test_the_shaft_gets_the_power_of_the_load_whatever_the_fault() -> None:
    """The simulated motor has no losses but those of its windings: the others are ours, and alike."""
    sound, faulty = found("large").losses, found("large", Cause.SHORTED_TURNS).losses
    assert sound.output_W is not None
    assert faulty.output_W == pytest.approx(sound.output_W, rel=0.04)
    assert faulty.efficiency is not None
    assert sound.efficiency is not None
    assert faulty.efficiency < sound.efficiency - 0.03


EFFICIENCY_CLASSES = {
    0.75e3: (0.721, 0.825),
    7.5e3: (0.860, 0.904),
    75e3: (0.927, 0.950),
    200e3: (0.940, 0.960),
}
"""IE1 and IE3 of IEC 60034-30-1 for four poles and 50 Hz, by rated power [W]."""


@pytest.mark.parametrize("power", EFFICIENCY_CLASSES)
def test_motors_of_usual_parameters_have_the_efficiency_of_their_class(power: float) -> None:
    plate = Nameplate(power, 400.0, 50.0, 2)
    motor = Motor("typical", plate, typical_parameters(plate).parameters)
    rated = load_point(motor, plate.winding_voltage_V, plate.rated_frequency_Hz, power)
    machine, other = motor.parameters, other_losses(motor)
    copper_W = 3.0 * machine.stator_resistance_ohm * abs(rated.current_A) ** 2
    copper_W += 3.0 * machine.rotor_resistance_ohm * abs(rated.rotor_current_A) ** 2
    losses_W = copper_W + other.iron_W + other.friction_W + other.stray_W
    low, high = EFFICIENCY_CLASSES[power]
    assert low - 0.03 < power / (power + losses_W) < high + 0.02


def test_stray_losses_are_those_that_the_standard_assigns() -> None:
    shares = [assigned_stray_W(watts, 1.0) for watts in (500.0, 1e3, 10e3, 100e3, 10e6, 50e6)]
    assert shares == pytest.approx([0.025, 0.025, 0.02, 0.015, 0.005, 0.005])


def test_what_keeps_the_losses_from_being_told_is_said() -> None:
    case = CauseCase(MEDIUM, frozenset(), LOAD, SEED)
    alone = examine(case.record(), case.known(), currents_only=True).losses
    assert alone == LossFigures.untold("no voltages recorded: the power drawn is not known")
