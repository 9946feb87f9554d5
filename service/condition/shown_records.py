"""What records show by themselves, as the pictures of pages and reports take it."""

from collections.abc import Sequence
from typing import Final

from core.condition.errors import ObservationError
from core.machines.parameters import Motor
from service.pictures.asymmetry import Asymmetry
from service.pictures.load import LoadPoint
from service.pictures.supply import SupplyPoint
from service.storage.records.history import SeenRecord

OF_NOW: Final = 16
"""Records whose mean is what the motor shows now."""
FEWEST_OF_MEAN: Final = 3
"""A mean of fewer records says little."""


def asymmetry_of_records(
    seen: Sequence[SeenRecord],
    motor: Motor,
    *,
    since_ns: int | None,
    detectable: float | None = None,
    state: str = "healthy",
) -> Asymmetry:
    """Return the asymmetry that records show: those before a change with their mean, and those since it.

    seen: oldest first.  since_ns: first record of the change; None without one.
    """
    before: list[complex] = []
    since: list[complex] = []
    for one in seen:
        level = _asymmetry_of(one, motor)
        if level is not None:
            is_before = since_ns is None or one.observation.time_ns < since_ns
            (before if is_before else since).append(level)
    return Asymmetry(
        before=before,
        since=since,
        standing=_mean(before),
        now=_mean(since[-OF_NOW:]),
        detectable=detectable,
        state=state,
    )


def load_points(seen: Sequence[SeenRecord]) -> list[LoadPoint]:
    """Return the fault level of each record at its load, where both are known."""
    return [
        LoadPoint(
            one.observation.load_level,
            one.figures.mu_f,
            one.figures.mu_f_ci95_low,
            one.figures.mu_f_ci95_high,
            one.figures.state.value,
        )
        for one in seen
        if one.observation.load_level is not None and one.figures is not None and one.figures.mu_f is not None
    ]


def supply_points(seen: Sequence[SeenRecord]) -> list[SupplyPoint]:
    """Return how unbalanced voltages and currents are in each record; NaN where nothing flows."""
    observed = [one.observation for one in seen]
    return [
        SupplyPoint(
            _ratio(one.negative_voltage_V, one.positive_voltage_V),
            _ratio(one.negative_current_A, one.positive_current_A),
        )
        for one in observed
    ]


def _asymmetry_of(one: SeenRecord, motor: Motor) -> complex | None:
    from core.condition.measuring.asymmetry import asymmetry_of  # numbers, where they are needed

    try:
        return asymmetry_of(one.observation, motor)
    except ObservationError:
        return None


def _mean(levels: Sequence[complex]) -> complex | None:
    return sum(levels) / len(levels) if len(levels) >= FEWEST_OF_MEAN else None


def _ratio(part: complex, whole: complex) -> float:
    return abs(part) / abs(whole) if whole else float("nan")
