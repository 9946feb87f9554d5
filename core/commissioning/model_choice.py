"""Which law the load follows, and whether the motor changes from a start to running: what the records tell.

A rotor of one loop with constant leakage comes first. Where two loops and leakage that saturates leave much
less of the currents unexplained, by far more than noise does, the motor has them. The law of the load is
chosen among machines of the same kind, because a machine of the wrong kind takes another law for its own.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from math import pi
from typing import Final

import numpy as np

from core.commissioning.errors import DivergenceError
from core.commissioning.fit import COARSELY, Fit, Records, every
from core.commissioning.load_change import (
    MUCH,
    are_possible,
    beginnings,
    least_explained,
    share_explained,
    with_load_changes,
)
from core.commissioning.prior import Prior
from core.commissioning.start import Start
from core.commissioning.uncertainty import preference
from core.commissioning.unknowns import KNEE_SHARPNESS, USUAL_CHANGE
from core.machines.base import Array
from core.machines.candidates import LoadLaw

SIGNIFICANCE: Final = 3.0
"""Standard deviations by which a law, or a change, must fit better than what it replaces."""
ROUGHLY: Final = 1e-4
"""Relative gain of a step at which a fit of a motor that changes ends: what tells laws apart is far more."""
MOST_LEFT: Final = 0.8
"""Share of the squared residuals of a machine that does not change which is left, at most, where one does."""
LEAST_EXPLAINED: Final = 1e-3
"""Share of the current that a change explains at least: less is of no use."""
OF_INTERPOLATION: Final = 0.06
"""That share over the cube of a sample's angle, where samples are few: twice what interpolation makes."""


@dataclass(frozen=True, slots=True)
class Chosen:
    """A law, a kind of machine, and what choosing them took.

    Parameters
    ----------
    law : LoadLaw
        How the load torque grows with speed.
    law_identified : bool
        Whether the records tell it. They do not where a law could not be tried, because the model's current
        grows without bound under it.
    changes : bool
        Whether the motor changes from a start to running.
    load_changes : bool
        Whether the load changes during a start.
    fit : Fit
        Fit of the thinned records under them.
    evaluations : int
        What choosing took.
    steadily : Chosen or None, optional
        The choice among loads that do not change, where this one is of loads that do.
    """

    law: LoadLaw
    law_identified: bool
    changes: bool
    load_changes: bool
    fit: Fit
    evaluations: int
    steadily: "Chosen | None" = None


def choose(starts: Sequence[Start], prior: Prior, vector: Array, wanted: LoadLaw | None) -> Chosen:
    """Choose the load's law and the kind of machine.

    Parameters
    ----------
    starts : sequence of Start
        Thinned starts.
    prior : Prior
        What is expected of the motor.
    vector : ndarray
        Coordinates near the best of a machine that does not change.
    wanted : LoadLaw or None
        The law where it is known.

    Returns
    -------
    Chosen
        The choice.

    Raises
    ------
    DivergenceError
        If the model's current grows without bound under every law.
    """
    laws = list(LoadLaw) if wanted is None else [wanted]
    plain = _fitted({law: (Records(starts, prior, law), vector) for law in laws})
    if not plain:
        raise DivergenceError(", ".join(start.source for start in starts))
    found = _chosen(plain, laws)
    changing = {}
    for law, (_, fit) in plain.items():
        records = Records(starts, prior, law, changes=True)
        changing[law] = records, records.coordinates.changing(fit.vector, np.array(USUAL_CHANGE))
    first = _fitted({found.law: changing.pop(found.law)})
    fits = plain
    if first and _is_better(*first[found.law], found.fit):
        fits = first | _fitted(changing)
        found = _chosen(fits, laws)
    return _with_load_changes(plain, fits, found, laws) or found


def _with_load_changes(plain: "Fits", fits: "Fits", found: Chosen, laws: Sequence[LoadLaw]) -> Chosen | None:
    """Return the choice among loads that change during the start; None where none is seen.

    A motor that does not change may seem to, where its load does: both kinds are tried.
    """
    share = share_explained(*fits[found.law])
    if share <= least_explained(fits[found.law][0]):
        return None
    if share <= MUCH and _with_change(fits, (found.law,), found) is None:
        return None  # all kinds and laws take long, and one says whether it is worth it
    best: Chosen | None = None
    for kind in (plain, fits) if fits is not plain else (plain,):
        best = _with_change(kind, laws, best or found) or best
    return None if best is None else replace(best, steadily=found)


def _with_change(kind: "Fits", laws: Sequence[LoadLaw], before: Chosen) -> Chosen | None:
    """Return the choice among these laws with loads that change; None where it is no better than before."""
    changing: Fits = {}
    for law, (records, fit) in kind.items():
        if law not in laws:
            continue
        begun = ({law: (with_load_changes(records), vector)} for vector in beginnings(records, fit))
        tried = [one for each in begun for one in _fitted(each).values() if are_possible(*one)]
        if tried:
            changing[law] = min(tried, key=lambda one: one[1].squared_error)
    if not changing:
        return None
    chosen = _chosen(changing, laws)
    records = changing[chosen.law][0]
    is_better = _is_better(records, chosen.fit, before.fit, most_left=1.0 - least_explained(records))
    return chosen if is_better else None


Fits = dict[LoadLaw, tuple[Records, Fit]]


def _fitted(beginnings: Mapping[LoadLaw, tuple[Records, Array]]) -> Fits:
    """Fit the records under each law, but those under which the model's current grows without bound."""
    found: Fits = {}
    for law, (records, vector) in beginnings.items():
        with suppress(DivergenceError):
            found[law] = records, _fit(records, vector)
    return found


def _fit(records: Records, vector: Array) -> Fit:
    """Fit all coordinates, but for the sharpness of a knee, along which the residuals hardly change."""
    coordinates, free = records.coordinates, every(vector)
    if not coordinates.changes:
        return records.fit(vector, free, converged=COARSELY)
    free[coordinates.names.index(KNEE_SHARPNESS)] = False
    return records.fit(vector, free, converged=ROUGHLY)


def _is_better(records: Records, fit: Fit, plain: Fit, *, most_left: float = MOST_LEFT) -> bool:
    energy = sum(float((start.measured_ab**2).sum()) for start in records.starts)
    explained = plain.squared_error - fit.squared_error
    angle = max(2.0 * pi * start.frequency_hz / start.sample_rate_hz for start in records.starts)
    least = max(LEAST_EXPLAINED, OF_INTERPOLATION * angle**3)
    if fit.squared_error > most_left * plain.squared_error or explained < least**2 * energy:
        return False
    return preference(records, fit, plain) > SIGNIFICANCE


def _chosen(fits: Fits, laws: Sequence[LoadLaw]) -> Chosen:
    """Choose the law that fits best; a constant torque where none is told apart from the others."""
    best, *others = sorted(fits, key=lambda law: fits[law][1].squared_error)
    records, fit = fits[best]
    identified = len(fits) == len(laws) and all(
        preference(records, fit, fits[law][1]) > SIGNIFICANCE for law in others
    )
    law = best if identified or LoadLaw.CONSTANT not in fits else LoadLaw.CONSTANT
    spent = sum(one.evaluations for _, one in fits.values())
    return Chosen(
        law,
        identified,
        changes=records.coordinates.changes,
        load_changes=records.coordinates.load_changes,
        fit=fits[law][1],
        evaluations=spent,
    )
