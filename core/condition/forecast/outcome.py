"""What a forecast says."""

from dataclasses import dataclass
from typing import Final

import numpy as np

HORIZONS_DAYS: Final = (
    *(0.0, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 14.0, 21.0, 30.0, 45.0, 60.0, 90.0, 120.0),
    *(180.0, 270.0, 365.0, 545.0, 730.0, 1095.0, 1825.0, 3650.0),
)
"""Times ahead of which the chances are kept [days]."""


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
    chances : tuple of float or None
        Probability that the level has reached the limit by each of HORIZONS_DAYS after the latest record;
        None where nothing changes, and where there are too few records to tell.
    """

    limit: float
    days: tuple[float, float, float] | None = None
    growth_per_day: float | None = None
    chances: tuple[float, ...] | None = None

    def reached_within(self, days: float) -> float | None:
        """Return the probability that the level reaches its limit within a time.

        Parameters
        ----------
        days : float
            The time from the latest record on [days].

        Returns
        -------
        float or None
            The probability; None where the growth is not known, or the time is beyond the forecast.
        """
        if self.chances is None or days > HORIZONS_DAYS[-1]:
            return None
        return float(np.interp(days, HORIZONS_DAYS, self.chances))
