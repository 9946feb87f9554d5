"""How fast the level of shorted turns grows, and when it reaches a limit."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Forecast:
    """Growth of the level, and the time until it reaches a limit.

    Parameters
    ----------
    limit : float
        Level that is asked for, a fraction of the phase turns.
    days : tuple of float or None
        Time from the latest record until the limit: it is earlier than the first and later than the last
        with one chance in ten each, and as likely before as after the middle one [days]. None where the
        records show no trend towards the limit.
    growth_per_day : float or None
        Growth of the level today, a fraction of the phase turns a day; None where nothing changes.
    """

    limit: float
    days: tuple[float, float, float] | None = None
    growth_per_day: float | None = None
