"""Which unknowns a record tells, and which must be taken from elsewhere.

An unknown whose interval would be wider than what is known anyway is fixed, the worst first, until all that
are left are told, whatever the fixed ones may be off by. Steady running has one current phasor: whatever
seven unknowns it is asked for, it tells two (thesis 5.3.3).
"""

from dataclasses import dataclass, replace
from math import log

import numpy as np

from core.commissioning.fit import Fit, Records
from core.commissioning.prior import PARAMETERS
from core.commissioning.uncertainty import (
    coherent_covariance,
    information_inverse,
    inherited_covariance,
    noise_covariance,
)
from core.commissioning.unknowns import LOAD_LEVEL, TIME_OFFSET
from core.machines.base import Array

UNTOLD_SHARE = 0.3
"""Half a 95 % interval of a parameter, relative, beyond which a record does not tell it; of LL, absolute."""
UNTOLD_CYCLES = 0.05
"""The same of T_d."""
UNTOLD_FLUX = 0.5
"""The same of the switching flux, over the rated one."""
TWO_SIDED = 1.96
INRUSH = ("stator_resistance_ohm", "rotor_resistance_ohm", "stator_leakage_H")


@dataclass(frozen=True, slots=True)
class Untold:
    """An unknown that has to be fixed, because the records do not tell it.

    Parameters
    ----------
    name : str
        Its name.
    half_interval : float
        Half the 95 % interval it would have: relative, of LL absolute, of T_d in cycles.
    partner : str or None
        Unknown that it moves with.
    correlation : float
        Their correlation.
    """

    name: str
    half_interval: float
    partner: str | None
    correlation: float


def untold(records: Records, fit: Fit) -> list[Untold]:
    """Return the free unknowns that have to be fixed, in that order.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    list of Untold
        The unknowns.
    """
    names = records.coordinates.names
    found: list[Untold] = []
    free = fit.free.copy()
    while free.any():
        part = replace(fit, free=free)
        entries = np.flatnonzero(free)
        covariance = (
            noise_covariance(records, part)
            + coherent_covariance(records, part)
            + inherited_covariance(records, part)
        )
        half = TWO_SIDED * np.sqrt(np.maximum(np.diag(covariance), 0.0))
        worst = int(np.argmax(half / np.array([_limit(names[entry]) for entry in entries])))
        if half[worst] <= _limit(names[entries[worst]]):
            break
        partner, correlation = _partner(covariance, worst)
        found.append(
            Untold(
                names[entries[worst]],
                float(half[worst]),
                None if partner is None else names[entries[partner]],
                correlation,
            )
        )
        free[entries[worst]] = False
    return found


def making_up(records: Records, fit: Fit) -> list[Untold]:
    """Return free parameters that only make up for held ones instead of being estimated.

    They are driven out of the range that was searched; or they are the last one left, all that a single
    phasor tells; or they are magnetising and inertia where nothing of what limits the inrush is told, so that
    no torque is known.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    list of Untold
        The unknowns.
    """
    names, prior = records.coordinates.names, records.coordinates.prior
    of_inrush = [PARAMETERS.index(name) for name in INRUSH]
    free = [entry for entry in range(len(PARAMETERS)) if fit.free[entry]]
    groundless = len(free) == 1 or not fit.free[of_inrush].any()
    return [
        Untold(names[entry], float("inf"), None, 0.0)
        for entry in free
        if groundless or abs(fit.vector[entry]) > log(prior.spread[names[entry]])
    ]


def condition_number(fit: Fit) -> float:
    """Return the greatest over the least singular value of the Jacobian of the free unknowns.

    Each unknown is of order one.

    Parameters
    ----------
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    float
        The condition number.
    """
    spread = np.linalg.eigvalsh(information_inverse(fit))
    return float(np.sqrt(spread[-1] / spread[0])) if spread[0] > 0.0 else float("inf")


def _limit(name: str) -> float:
    kind = name.partition("[")[0]
    if kind in PARAMETERS or kind == LOAD_LEVEL:
        return UNTOLD_SHARE
    return UNTOLD_CYCLES if kind == TIME_OFFSET else UNTOLD_FLUX


def _partner(covariance: Array, worst: int) -> tuple[int | None, float]:
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    correlation = covariance[worst] / (spread * spread[worst])
    correlation[worst] = 0.0
    if correlation.size < 2:
        return None, 0.0
    partner = int(np.argmax(np.abs(correlation)))
    return partner, float(np.clip(correlation[partner], -1.0, 1.0))
