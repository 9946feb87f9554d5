"""When a rotor that gets worse reaches its limit, from the severities of its records.

A severity in decibels is the logarithm of an asymmetry of the rotor's resistance. The asymmetry itself grows
as the level of shorted turns does, and is about as large: so the same trends follow it.
"""

from collections.abc import Sequence
from statistics import median
from typing import Final

from core.condition.forecast.forecast import forecast
from core.condition.forecast.outcome import Forecast
from core.rotor.judgement import FAULT_DB
from core.rotor.trend import LEAST_DB

BEFORE: Final = 12
"""Records before the change that a forecast is made of as well."""


def rotor_forecast(
    severities: Sequence[tuple[int, float]], since_ns: int | None, baselines_dB: Sequence[float] = ()
) -> Forecast:
    """Tell when the asymmetry of a rotor reaches its limit.

    Parameters
    ----------
    severities : sequence of tuple of int and float
        Time [ns] and severity [dB] of each record that tells it, oldest first.
    since_ns : int or None
        First record of the change that is seen; None without one, and then nothing is forecast.
    baselines_dB : sequence of float, optional
        Severities of the first records, one a load [dB].

    Returns
    -------
    Forecast
        Chances that the asymmetry, a fraction of the rotor's resistance, has reached the limit.
    """
    limit, standing = _asymmetry(FAULT_DB), _asymmetry(median(baselines_dB) if baselines_dB else LEAST_DB)
    if since_ns is None:
        return Forecast(limit)
    before = sum(time_ns < since_ns for time_ns, _ in severities)
    shown = severities[max(before - BEFORE, 0) :]
    changes = [(time_ns, _asymmetry(severity_dB) - standing) for time_ns, severity_dB in shown]
    return forecast(changes, limit, standing=standing)


def _asymmetry(severity_dB: float) -> float:
    return float(10.0 ** (max(severity_dB, LEAST_DB) / 20.0))
