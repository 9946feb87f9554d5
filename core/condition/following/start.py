"""The first records of a reference: put in order, so that an outlier among them fakes no change."""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from core.condition.following.folding import fold_first, restart
from core.condition.measuring.measurement import Measurement

FEWEST: Final = 4
LEAST_NOISE: Final = 3e-4**2
"""Least variance of y's noise to start from: what the records of measured motors repeat to."""
NOISE_STEPS: Final = tuple(2.0**k for k in range(11))
"""Multiples of the records' own scatter that the first records are tried with."""


def fold_start(filters: Any, sides: Any, circles: Any, records: Sequence[Measurement]) -> None:
    """Fold the first records in their order of ordinariness, with the noise that makes them likeliest.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter; x0 and P0 are set.
    sides : array of SideState
        Side channels.
    circles : array of CircleState, shape (1,)
        Filter of the current beside its circle.
    records : sequence of Measurement
        All records so far, in the order of time.
    """
    ordered = in_order(records)
    filters["balance"] = 0.0
    filters["balance"] = min(
        noise_of_currents(ordered) / _fold_likeliest(filters, sides, circles, ordered), 1.0
    )
    _fold_likeliest(filters, sides, circles, ordered)


def _fold_likeliest(filters: Any, sides: Any, circles: Any, records: Sequence[Measurement]) -> float:
    """Fold the first records with the noise that they tell; return its variance."""
    steps = starting_noise(records) * np.array(NOISE_STEPS)
    logs = np.array([_fold_all(filters, sides, circles, records, s2) for s2 in steps.tolist()])
    shares = np.exp(logs - logs.max())
    s2 = float(shares @ steps / shares.sum())
    _fold_all(filters, sides, circles, records, s2)
    return s2


def _fold_all(filters: Any, sides: Any, circles: Any, records: Sequence[Measurement], s2: float) -> float:
    """Fold the first records with noise of a variance; return the log of their likelihood."""
    restart(filters, sides, circles)
    filters["s2"] = s2
    total = 0.0
    for record in records:
        fold_first(filters, sides, circles, record)
        total += filters["log_likelihood"].item()
    return total


def in_order(records: Sequence[Measurement]) -> list[Measurement]:
    """Sort the first records by how far they lie from their median.

    Parameters
    ----------
    records : sequence of Measurement
        The first records, in the order of time.

    Returns
    -------
    list of Measurement
        The same records, the most ordinary first.
    """
    y = np.array([record.y for record in records])
    median = complex(np.median(y.real), np.median(y.imag))
    return [records[k] for k in np.argsort(np.abs(y - median), kind="stable")]


def noise_of_currents(records: Sequence[Measurement]) -> float:
    """Return the variance that the currents' noise gives to j2, as I0 tells, which has little else.

    Parameters
    ----------
    records : sequence of Measurement
        The first records.

    Returns
    -------
    float
        Variance, both parts together; 0 of fewer than four records.
    """
    if len(records) < FEWEST:
        return 0.0
    i0 = np.array([record.i0 for record in records])
    j1 = np.array([abs(record.j1) for record in records])
    apart = np.abs(i0 - complex(np.median(i0.real), np.median(i0.imag))) * j1
    # The median of |x|^2 is ln 2 of its mean where x is normal.
    return float(np.median(apart**2) / np.log(2.0))


def starting_noise(records: Sequence[Measurement]) -> float:
    """Return the variance of y's noise that the records' own scatter tells.

    Parameters
    ----------
    records : sequence of Measurement
        The first records.

    Returns
    -------
    float
        Variance, both parts together.
    """
    return max(float(np.mean([record.scatter for record in records])), LEAST_NOISE)
