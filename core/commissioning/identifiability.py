"""Identifiability: which unknowns the records determine, and which have to be fixed at an expected value.

An unknown is fixed if its confidence interval would be wider than what is known about it anyway. The worst
unknown is fixed first, and this is repeated until all the others are identifiable. The intervals allow for
errors of the fixed values. A record of steady running determines two unknowns only, because all it contains
is one current phasor (thesis 5.3.3).
"""

from dataclasses import dataclass, replace
from math import inf, log

import numpy as np

from core.commissioning.fit import Fit, Records
from core.commissioning.prior import PARAMETERS
from core.commissioning.uncertainty import (
    coherent_covariance,
    information_inverse,
    inherited_covariance,
    noise_covariance,
)
from core.commissioning.unknowns import LOAD_LEVEL, OF_A_CHANGE, OF_A_LOAD_CHANGE, TIME_OFFSET
from core.machines.base import Array

WIDEST_SHARE = 0.3
"""Widest half of a 95 % interval at which an unknown counts as identifiable.

It is relative for a parameter of the machine and absolute for the load level.
"""
WIDEST_CHANGE = 0.6
"""The same limit for what changes from a start to running."""
WIDEST_CYCLES = 0.05
"""The same limit for T_d, in cycles of the supply."""
WIDEST_FLUX = 0.5
"""The same limit for the switching flux, relative to the rated flux."""
TWO_SIDED = 1.96
"""Quantile of the normal distribution that bounds a two-sided 95 % interval."""
INRUSH = ("stator_resistance_ohm", "rotor_resistance_ohm", "stator_leakage_H")
"""Parameters that limit the inrush current."""


@dataclass(frozen=True, slots=True)
class Unidentifiable:
    """An unknown that has to be fixed because the records do not determine it.

    Parameters
    ----------
    name : str
        Name of the unknown.
    half_interval : float
        Half of the 95 % interval it would have: relative for a parameter, absolute for the load level, in
        cycles for T_d.
    partner : str or None
        Unknown with which it is correlated most.
    correlation : float
        Correlation of the two.
    """

    name: str
    half_interval: float
    partner: str | None
    correlation: float


def unidentifiable(records: Records, fit: Fit) -> list[Unidentifiable]:
    """Return the free unknowns that have to be fixed, the least identifiable first.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    list of Unidentifiable
        The unknowns.
    """
    names = records.coordinates.names
    found: list[Unidentifiable] = []
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
            Unidentifiable(
                names[entries[worst]],
                float(half[worst]),
                None if partner is None else names[entries[partner]],
                correlation,
            )
        )
        free[entries[worst]] = False
    return found


def compensating(records: Records, fit: Fit) -> list[Unidentifiable]:
    """Return free parameters that compensate for errors of the fixed ones and are not estimates.

    A parameter compensates in one of three cases. The fit has driven it out of the range that was searched.
    Or it is the only free parameter. Or no parameter that limits the inrush current is identifiable: then
    no torque is known, and the self-inductance and the inertia cannot be estimated either.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    list of Unidentifiable
        The unknowns.
    """
    names, prior = records.coordinates.names, records.coordinates.prior
    of_inrush = [PARAMETERS.index(name) for name in INRUSH]
    free = [entry for entry in range(len(PARAMETERS)) if fit.free[entry]]
    groundless = len(free) == 1 or not fit.free[of_inrush].any()
    return [
        Unidentifiable(names[entry], float("inf"), None, 0.0)
        for entry in free
        if groundless or abs(fit.vector[entry]) > log(prior.spread[names[entry]])
    ]


def condition_number(fit: Fit) -> float:
    """Return the greatest over the least singular value of the Jacobian of the free unknowns.

    The unknowns are scaled to order one.

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
        return WIDEST_SHARE
    if kind in OF_A_CHANGE:
        return WIDEST_CHANGE
    if kind in OF_A_LOAD_CHANGE:
        return inf  # there is nothing that they could be fixed at, and nobody uses them
    return WIDEST_CYCLES if kind == TIME_OFFSET else WIDEST_FLUX


def _partner(covariance: Array, worst: int) -> tuple[int | None, float]:
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    correlation = covariance[worst] / (spread * spread[worst])
    correlation[worst] = 0.0
    if correlation.size < 2:
        return None, 0.0
    partner = int(np.argmax(np.abs(correlation)))
    return partner, float(np.clip(correlation[partner], -1.0, 1.0))
