"""When a change of a parameter is told as a drift, and what may have made it."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from core.machines.base import Array
from core.tracking.finding import DriftCause, ParameterName
from core.tracking.unknowns import ALIKE

FOLLOWED: Final = (
    ParameterName.STATOR_RESISTANCE,
    ParameterName.LEAKAGE_INDUCTANCE,
    ParameterName.MAGNETISING_INDUCTANCE,
    ParameterName.ROTOR_RESISTANCE,
)
"""The parameters in the order of the state's changes."""
TOLD_FROM: Final = np.array([0.15, 0.06, 0.015, 0.06])
"""Changes that are told; the weather alone makes half as much of R_s as is told."""
SURE: Final = 4.0
"""Standard deviations of a change that is told."""
OVER_BELOW: Final = 0.5
"""Share of the change that is told below which it is over."""
CONFIRMING: Final = 3
"""Records in a row that begin or end a drift."""
USUAL: Final = np.array([0.05, 0.003, 0.003, 0.02])
"""Standard deviation of what motors do anyway, over the year and with their work."""
EXPLAINED: Final = 11.34
"""What is left of three unknowns in 99 of 100 cases, over its variance (chi-square)."""
TOLD_APART: Final = 6.63
"""How much more a cause leaves than the best one does where it is none: one unknown in 99 of 100 cases."""
DIRECTIONS: Final = {
    DriftCause.WINDING_HOT: np.array([1.0, 0.0, 0.0, 0.0]),
    DriftCause.LEAKAGE: np.array([0.0, 1.0, 0.0, 0.0]),
    DriftCause.MAGNETISING: np.array([0.0, 0.0, 1.0, 0.0]),
    DriftCause.ROTOR: np.array([0.0, 0.0, 0.0, 1.0]),
    DriftCause.RATIO: ALIKE,
}
"""What each cause does to the four changes, each by itself first: that of R_R is beyond that of R_s."""
RISES: Final = frozenset({DriftCause.WINDING_HOT, DriftCause.ROTOR})
"""Causes that only raise a resistance."""


@dataclass(slots=True)
class Drift:
    """Whether one parameter drifts.

    Parameters
    ----------
    since_ns : int or None
        Time of the record with which it began; None while it is steady.
    against : int
        Records in a row that speak against that.
    first_ns : int or None
        Time of the first of them.
    """

    since_ns: int | None = None
    against: int = 0
    first_ns: int | None = None

    def see(self, *, shows: bool, is_over: bool, time_ns: int) -> None:
        """Take one record in.

        Parameters
        ----------
        shows : bool
            Whether a change is to be told from this record on.
        is_over : bool
            Whether none is.
        time_ns : int
            Time of the record [ns].
        """
        if not (shows if self.since_ns is None else is_over):
            self.against, self.first_ns = 0, None
            return
        self.against += 1
        self.first_ns = self.first_ns or time_ns
        if self.against >= CONFIRMING:
            self.since_ns = self.first_ns if self.since_ns is None else None
            self.against, self.first_ns = 0, None


def see_all(drifts: list[Drift], change: Array, deviation: Array, time_ns: int) -> None:
    """Take one record in for all parameters.

    Parameters
    ----------
    drifts : list of Drift
        In the order of `FOLLOWED`; they change.
    change, deviation : ndarray, shape (4,)
        Changes after the record, and their standard deviations.
    time_ns : int
        Time of the record [ns].
    """
    size = np.abs(change)
    shows = (size >= TOLD_FROM) & (size >= SURE * deviation)
    is_over = size < OVER_BELOW * TOLD_FROM
    for drift, one, over in zip(drifts, shows.tolist(), is_over.tolist(), strict=True):
        drift.see(shows=one, is_over=over, time_ns=time_ns)


def possible_causes(change: Array, covariance: Array, drifting: list[bool]) -> tuple[DriftCause, ...]:
    """Return what may have made the changes.

    Parameters
    ----------
    change : ndarray, shape (4,)
        Changes.
    covariance : ndarray, shape (4, 4)
        Their covariance.
    drifting : list of bool
        Which of them are told.

    Returns
    -------
    tuple of DriftCause
        Causes of which each explains the changes by itself; where none does, that of each change that is
        told.
    """
    if not any(drifting):
        return ()
    information = np.linalg.inv(covariance + np.diag(USUAL**2))
    whole = float(change @ information @ change)
    left = {}
    for cause, one in DIRECTIONS.items():
        along = float(one @ information @ change)
        if along > 0.0 or cause not in RISES:
            left[cause] = whole - along**2 / float(one @ information @ one)
    least = min(left.values())
    if least <= EXPLAINED:
        return tuple(cause for cause, rest in left.items() if rest <= least + TOLD_APART)
    own = list(DIRECTIONS)[: len(FOLLOWED)]
    return tuple(cause for cause, told in zip(own, drifting, strict=True) if told and cause in left)
