"""What losses cost a year, from a course of records that is given."""

from dataclasses import replace

import pytest

from core.losses.cost import DatedLosses, loss_cost
from core.losses.figures import LossFigures
from core.units import NANOSECONDS_PER_DAY

FIGURES = LossFigures(
    efficiency=0.9,
    efficiency_ci95=(0.88, 0.92),
    output_W=6750.0,
    load_class=9,
    losses_W=750.0,
    losses_W_ci95=(600.0, 900.0),
    stator_copper_W=300.0,
    rotor_copper_W=200.0,
    iron_W=150.0,
    friction_W=60.0,
    stray_W=40.0,
    turns_loss_W=0.0,
    unbalance_loss_W=20.0,
    voltage_loss_W=-5.0,
    rotor_loss_W=0.0,
    reasons=(),
)


def course(days: int, watts_a_day: float) -> list[DatedLosses]:
    """Records of each second day, whose shorted turns cost more and more."""
    return [
        DatedLosses(day * NANOSECONDS_PER_DAY, replace(FIGURES, turns_loss_W=100.0 + watts_a_day * day))
        for day in range(0, days, 2)
    ]


def test_energy_and_money_are_those_of_the_hours_that_it_runs() -> None:
    found = loss_cost(course(3, 0.0), running_hours_per_year=4000.0, price_per_kWh=0.25)
    turns, unbalance, voltage = found.causes
    assert (turns.cause, turns.loss_W) == ("shorted turns", 100.0)
    assert turns.energy_kWh_per_year == pytest.approx(400.0)
    assert turns.cost_per_year == pytest.approx(100.0)
    assert unbalance.cost_per_year == pytest.approx(20.0)
    assert voltage.cost_per_year == pytest.approx(-5.0), "a voltage that saves"
    assert turns.growth_W_per_year is None, "two records tell no growth"


def test_causes_that_cost_nothing_are_left_out() -> None:
    found = loss_cost(course(3, 0.0), running_hours_per_year=8760.0, price_per_kWh=None)
    assert [one.cause for one in found.causes] == [
        "shorted turns",
        "unbalance of the supply",
        "voltage off its rated value",
    ]
    assert {one.cost_per_year for one in found.causes} == {None}


@pytest.mark.parametrize("watts_a_day", [0.0, 1.5])
def test_growth_is_that_of_the_course(watts_a_day: float) -> None:
    found = loss_cost(course(60, watts_a_day), running_hours_per_year=8760.0, price_per_kWh=None)
    turns = found.causes[0]
    assert turns.growth_W_per_year == pytest.approx(365.0 * watts_a_day, abs=1e-6)
    assert turns.growth_W_per_year_ci95 is not None
    low, high = turns.growth_W_per_year_ci95
    assert low - 1e-6 <= 365.0 * watts_a_day <= high + 1e-6


def test_scatter_of_the_records_widens_the_interval_of_the_growth() -> None:
    smooth = course(60, 1.0)
    rough = []
    for number, one in enumerate(smooth):
        watts = (one.figures.turns_loss_W or 0.0) + 9.0 * (-1) ** number
        rough.append(replace(one, figures=replace(one.figures, turns_loss_W=watts)))
    ends = [
        loss_cost(one, running_hours_per_year=1.0, price_per_kWh=None).causes[0].growth_W_per_year_ci95
        for one in (smooth, rough)
    ]
    assert ends[0] is not None
    assert ends[1] is not None
    assert ends[1][1] - ends[1][0] > ends[0][1] - ends[0][0] + 10.0


def test_efficiencies_compare_within_a_load() -> None:
    half = replace(FIGURES, load_class=4, efficiency=0.85, efficiency_ci95=(0.8, 0.9))
    found = loss_cost(
        [*course(5, 0.0), DatedLosses(10 * NANOSECONDS_PER_DAY, half)],
        running_hours_per_year=1.0,
        price_per_kWh=None,
    )
    assert [(one.load_class, one.records, one.efficiency) for one in found.efficiencies] == [
        (4, 1, 0.85),
        (9, 3, 0.9),
    ]


def test_a_motor_without_records_has_no_losses() -> None:
    found = loss_cost((), running_hours_per_year=8760.0, price_per_kWh=0.1)
    assert (found.records, found.losses_W, found.efficiencies, found.causes) == (0, None, (), ())
