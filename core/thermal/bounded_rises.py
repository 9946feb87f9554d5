"""Rises of a motor whose currents are known at times only: between bounds that known time closes."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from core.thermal import relay_model
from core.thermal.course import CurrentStep
from core.thermal.relay_model import RelaySettings
from core.thermal.two_bodies import Rises, TwoBodies, after

RATED = 1.0
"""Current, over the rated one, that a motor may have had while nothing was known of it."""


@dataclass(frozen=True, slots=True)
class BoundedRises:
    """Rises above the ambient temperature that are possible.

    Parameters
    ----------
    low, high : Rises
        As if the motor had stood, and as if it had run at rated current, whenever nothing was known.
    """

    low: Rises
    high: Rises


def bounded_rises(steps: Iterable[CurrentStep | float], motor: TwoBodies) -> BoundedRises:
    """Return between which bounds the rises lie.

    Parameters
    ----------
    steps : iterable of CurrentStep or float
        Currents in their order; a number is a time of which nothing is known [s].
    motor : TwoBodies
        The motor.

    Returns
    -------
    BoundedRises
        The bounds. Before the first step nothing is known either.
    """
    course = list(steps)
    hottest = Rises(motor.rated_rise_K, motor.frame_share * motor.rated_rise_K)
    return BoundedRises(
        low=after(Rises(), _with(course, 0.0), motor), high=after(hottest, _with(course, RATED), motor)
    )


def bounded_capacity(steps: Iterable[CurrentStep | float], settings: RelaySettings) -> tuple[float, float]:
    """Return between which bounds the thermal capacity lies that a relay's element has used.

    Parameters
    ----------
    steps : iterable of CurrentStep or float
        Currents in their order; a number is a time of which nothing is known [s].
    settings : RelaySettings
        Settings of the element.

    Returns
    -------
    tuple of float
        As if the motor had stood, and as if it had run at full load, whenever nothing was known; at 1 the
        relay trips.
    """
    course = list(steps)
    low = relay_model.after(relay_model.cold(settings), _with(course, 0.0), settings)
    high = relay_model.after(relay_model.warm(settings), _with(course, RATED), settings)
    return low.thermal_capacity_used, high.thermal_capacity_used


def _with(steps: Iterable[CurrentStep | float], current: float) -> Iterator[CurrentStep]:
    """Yield the steps with this current wherever nothing is known."""
    for step in steps:
        yield step if isinstance(step, CurrentStep) else CurrentStep(step, current)
