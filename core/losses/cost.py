"""What faults and supply cost a motor over time: energy and money a year, and how fast that grows."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from statistics import linear_regression, median
from typing import Final

from core.losses.figures import LossCause, LossFigures
from core.normal_distribution import NORMAL_95
from core.units import NANOSECONDS_PER_DAY

HOURS_PER_YEAR: Final = 8760.0
DAYS_PER_YEAR: Final = 365.0
LATEST: Final = 5
"""Records whose median tells what is lost now."""
FEWEST, SHORTEST_DAYS = 8, 14.0
"""Records, and days from the first to the last one, from which on a growth is told."""
WATTS_PER_KILOWATT: Final = 1000.0


@dataclass(frozen=True, slots=True)
class DatedLosses:
    """Losses of one record.

    Parameters
    ----------
    time_ns : int
        Time of the record, UTC [ns].
    figures : LossFigures
        Its losses, all of which are told.
    """

    time_ns: int
    figures: LossFigures


@dataclass(frozen=True, slots=True)
class LoadEfficiency:
    """The efficiency at one load.

    Parameters
    ----------
    load_class : int
        Tenth of the rated power at the shaft.
    records : int
        Records that tell it.
    efficiency : float
        Median of theirs.
    efficiency_ci95 : tuple of float
        Medians of the ends of their 95 % intervals: what is not known of a motor is so in each record.
    """

    load_class: int
    records: int
    efficiency: float
    efficiency_ci95: tuple[float, float]


@dataclass(frozen=True, slots=True)
class CauseCost:
    """What one cause costs.

    Parameters
    ----------
    cause : LossCause
        The cause.
    loss_W : float
        Median of the latest records [W].
    energy_kWh_per_year : float
        Energy in a year of as many hours as the motor runs now [kWh].
    cost_per_year : float or None
        The same in money; None without a price.
    growth_W_per_year : float or None
        By how much the loss grows in a year [W]; None of too few records.
    growth_W_per_year_ci95 : tuple of float or None
        Its 95 % interval, from the scatter of the records [W].
    """

    cause: LossCause
    loss_W: float
    energy_kWh_per_year: float
    cost_per_year: float | None
    growth_W_per_year: float | None
    growth_W_per_year_ci95: tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class LossCost:
    """What a motor loses, and what of it faults and supply cost.

    Parameters
    ----------
    records : int
        Records that tell of the losses.
    running_hours_per_year : float
        Hours for which energies are told [h].
    losses_W : float or None
        Median of all losses in the latest records [W]; None without a record.
    efficiencies : tuple of LoadEfficiency
        Efficiency by load.
    causes : tuple of CauseCost
        What each cause costs, the dearest first; one that saves is below zero.
    """

    records: int
    running_hours_per_year: float
    losses_W: float | None
    efficiencies: tuple[LoadEfficiency, ...]
    causes: tuple[CauseCost, ...]


def loss_cost(
    course: Sequence[DatedLosses], *, running_hours_per_year: float, price_per_kWh: float | None
) -> LossCost:
    """Tell what a motor's losses cost.

    Parameters
    ----------
    course : sequence of DatedLosses
        What its records tell, oldest first.
    running_hours_per_year : float
        Hours in a year that it runs [h].
    price_per_kWh : float or None
        Price of energy; None where it is not known.

    Returns
    -------
    LossCost
        Efficiencies, causes and costs.
    """
    by_cause: dict[LossCause, list[float]] = {}
    for one in course:
        for cause, watts in one.figures.by_cause_W.items():
            by_cause.setdefault(cause, []).append(watts)
    times_ns = [one.time_ns for one in course]
    costs = [
        _cost(cause, times_ns, watts, running_hours_per_year, price_per_kWh)
        for cause, watts in by_cause.items()
        if any(watts)
    ]
    costs.sort(key=lambda one: -one.loss_W)
    latest_W = [one.figures.losses_W or 0.0 for one in course[-LATEST:]]
    return LossCost(
        records=len(course),
        running_hours_per_year=running_hours_per_year,
        losses_W=median(latest_W) if latest_W else None,
        efficiencies=_efficiencies(course),
        causes=tuple(costs),
    )


def _cost(
    cause: LossCause, times_ns: Sequence[int], watts: Sequence[float], hours: float, price: float | None
) -> CauseCost:
    loss_W = median(watts[-LATEST:])
    energy_kWh = loss_W * hours / WATTS_PER_KILOWATT
    growth, interval = _growth(times_ns, watts)
    return CauseCost(
        cause=cause,
        loss_W=loss_W,
        energy_kWh_per_year=energy_kWh,
        cost_per_year=None if price is None else energy_kWh * price,
        growth_W_per_year=growth,
        growth_W_per_year_ci95=interval,
    )


def _growth(
    times_ns: Sequence[int], watts: Sequence[float]
) -> tuple[float, tuple[float, float]] | tuple[None, None]:
    """Return the slope of a straight line through the records, with what their scatter leaves open."""
    days = [(one - times_ns[0]) / NANOSECONDS_PER_DAY for one in times_ns]
    if len(days) < FEWEST or days[-1] < SHORTEST_DAYS:
        return None, None
    slope, offset = linear_regression(days, watts)
    mean = sum(days) / len(days)
    squares = sum((one - mean) ** 2 for one in days)
    scatter = sum((value - offset - slope * day) ** 2 for day, value in zip(days, watts, strict=True))
    half = NORMAL_95 * sqrt(scatter / (len(days) - 2) / squares)
    low, middle, high = (DAYS_PER_YEAR * one for one in (slope - half, slope, slope + half))
    return middle, (low, high)


def _efficiencies(course: Sequence[DatedLosses]) -> tuple[LoadEfficiency, ...]:
    found: dict[int, list[LossFigures]] = {}
    for one in course:
        if one.figures.load_class is not None and one.figures.efficiency_ci95 is not None:
            found.setdefault(one.figures.load_class, []).append(one.figures)
    return tuple(
        LoadEfficiency(
            load_class=number,
            records=len(figures),
            efficiency=median(one.efficiency or 0.0 for one in figures),
            efficiency_ci95=(
                median(one.efficiency_ci95[0] for one in figures if one.efficiency_ci95),
                median(one.efficiency_ci95[1] for one in figures if one.efficiency_ci95),
            ),
        )
        for number, figures in sorted(found.items())
    )
