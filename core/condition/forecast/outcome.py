"""What a forecast says."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Forecast:
    """Growth of the level, and the time until it reaches a limit.

    Parameters
    ----------
    limit : float
        Level that is asked for, a fraction of the phase turns.
    days : tuple of float or None
        Time from the latest record until the limit: 5, 50 and 95 % quantiles of the mixture [days]. The
        outer ones are to be read as an interval of 80 %. None where the records show no trend towards the
        limit.
    growth_per_day : float or None
        Growth of the level today, a fraction of the phase turns a day; None where nothing changes, and
        where there are too few records to tell.
    """

    limit: float
    days: tuple[float, float, float] | None = None
    growth_per_day: float | None = None
