"""Whether the load changes during a start, by a step or along a rise, and where a fit of that begins.

Before a fit it is asked what a small change would do to the currents, at some instants and of some lengths:
what no other unknown explains of that is compared with what the fit left. It takes as long as one step of a
fit, so that starts under a constant load are hardly examined longer.
"""

from typing import Final

import numpy as np

from core.commissioning.fit import Fit, Records
from core.commissioning.result import Estimate, LoadChange
from core.commissioning.start import Start
from core.commissioning.unknowns import (
    LOWEST_LOAD,
    OF_A_LOAD_CHANGE,
    OF_A_START,
    SHORTEST_CHANGE_CYCLES,
)
from core.machines.base import Array

INSTANTS: Final = 8
LENGTHS: Final = (0.0, 0.125, 0.25, 0.5)
"""Of a step and of rises, over the part of the record that is compared."""
LARGEST: Final = 0.8
"""Change at which a fit begins, at most."""
SMALL: Final = 0.02
"""Change that is asked about, over the rated torque."""
LEAST_LEFT: Final = 0.05
"""Share of the squared residuals that a change must explain to be tried: little, as most of them is noise."""
MUCH: Final = 0.2
"""Share from which a change is likely. Of a motor with deep bars, errors of its model are left, too."""
LEAST_CHANGE: Final = 0.02
"""A smaller change, over the rated torque, is not told."""
LIKELY_LOAD: Final = 1.5
"""Load over the rated torque beyond which no motor is started: a fit went astray."""
STEP_CYCLES: Final = 2.0
"""A change within so many cycles is called a step."""
LEAST_EXPLAINED: Final = 1e-3
"""Share of the current that it must explain."""


def share_explained(records: Records, fit: Fit) -> float:
    """Return how much of what a fit left a step of the load would explain; a rise is much like one.

    Parameters
    ----------
    records : Records
        The starts, whose loads do not change.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    float
        The greatest share of a start's squared residuals; 0 of what is a negligible part of its current.
    """
    _, explained = _begun(records, fit, LENGTHS[0])
    energies = [float((start.measured_ab**2).sum()) for start in records.starts]
    left = [float((residual**2).sum()) for residual in fit.residuals]
    shares = [
        gain / error
        for gain, error, energy in zip(explained, left, energies, strict=True)
        if gain > LEAST_EXPLAINED**2 * energy
    ]
    return max(shares, default=0.0)


def least_explained(records: Records) -> float:
    """Return the share of the squared residuals that a change of the load must explain.

    Parameters
    ----------
    records : Records
        The starts.

    Returns
    -------
    float
        The share.
    """
    return MUCH if records.coordinates.changes else LEAST_LEFT


def beginnings(records: Records, fit: Fit) -> list[Array]:
    """Return where fits with changing loads begin.

    Parameters
    ----------
    records : Records
        The starts, whose loads do not change.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    list of ndarray
        Coordinates with the change of each load that fits best, of each of some lengths.
    """
    return [_begun(records, fit, length)[0] for length in LENGTHS]


def _begun(records: Records, fit: Fit, length: float) -> tuple[Array, list[float]]:
    """Return coordinates with the best change of a length, and what it explains in each start."""
    coordinates, changing = records.coordinates, with_load_changes(records)
    begin, count = coordinates.first_of(0), len(records.starts)
    own = fit.vector[begin:].reshape(count, len(OF_A_START))
    trials = [_trials(start, length) for start in records.starts]
    extended = [np.concatenate([mine, [0.0], one[0, 1:]]) for mine, one in zip(own, trials, strict=True)]
    vector = np.concatenate([fit.vector[:begin], *extended])
    gains = [0.0] * count
    for k in range(count):
        of_load = changing.coordinates.first_of(k) + len(OF_A_START) + np.arange(len(OF_A_LOAD_CHANGE))
        rows = np.tile(vector, (1 + len(trials[k]), 1))
        rows[1:, of_load] = trials[k]
        current = changing.currents(rows, k)
        if not np.isfinite(current).all():
            continue
        slopes = (current[1:] - current[0]) / SMALL
        change, explained = _best(slopes, fit.jacobians[k][coordinates.of_record(k)], fit.residuals[k])
        best = int(np.argmax(explained))
        vector[of_load] = np.clip(change[best], -LARGEST, LARGEST), *trials[k][best][1:]
        gains[k] = float(explained[best])
    return vector, gains


def are_possible(records: Records, fit: Fit) -> bool:
    """Tell whether the loads of a fit can be, before their change and after it.

    Parameters
    ----------
    records : Records
        Starts under loads that change.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    bool
        Whether all of them can.
    """
    first = [records.coordinates.first_of(k) for k in range(len(records.starts))]
    before = fit.vector[first]
    after = before + fit.vector[[one + len(OF_A_START) for one in first]]
    loads = np.concatenate([before, after])
    return bool((loads > LOWEST_LOAD).all() and (loads < LIKELY_LOAD).all())


def with_load_changes(records: Records) -> Records:
    """Return the same starts under loads that may change.

    Parameters
    ----------
    records : Records
        The starts.

    Returns
    -------
    Records
        The starts.
    """
    coordinates = records.coordinates
    return Records(
        records.starts, coordinates.prior, records.load_law, changes=coordinates.changes, load_changes=True
    )


def found_load_change(start: Start, own: Array, half: Array) -> LoadChange | None:
    """Return how the load of a start changed.

    Parameters
    ----------
    start : Start
        The start.
    own : ndarray
        The start's own quantities, as in `Point.starts`.
    half : ndarray
        Half of the 95 % interval of each coordinate from the start's first on.

    Returns
    -------
    LoadChange or None
        The change; None where the load does not change, or by less than the record shows.
    """
    if own.size == len(OF_A_START):
        return None
    change, begins_s, lasts_s = own[len(OF_A_START) :].tolist()
    reach = float(half[len(OF_A_START)])
    end_s = start.compared_s[1] - STEP_CYCLES * start.cycle_s
    if abs(change) <= max(reach, LEAST_CHANGE) or begins_s > end_s:
        return None
    is_step = lasts_s < STEP_CYCLES * start.cycle_s
    if is_step:
        begins_s, lasts_s = begins_s + lasts_s / 2.0, 0.0
    return LoadChange(Estimate(change, (change - reach, change + reach)), begins_s, lasts_s, is_step)


def in_words(found: LoadChange) -> str:
    """Return a change of the load in words, with what to do.

    Parameters
    ----------
    found : LoadChange
        The change.

    Returns
    -------
    str
        The words.
    """
    way = "rises" if found.change.value > 0.0 else "falls"
    when = (
        f"at {found.begins_s:.2g} s"
        if found.is_step
        else (f"from {found.begins_s:.2g} s to {found.begins_s + found.lasts_s:.2g} s")
    )
    return (
        f"the load {way} by {abs(found.change.value):.0%} of the rated torque {when} after the switching on: "
        "the parameters allow for that; better record a start under a load that stays"
    )


def _trials(start: Start, share: float) -> Array:
    """Return coordinates of a small change of one length at some instants, (instants, 3)."""
    cycles = start.compared_cycles
    length = max(share * cycles, SHORTEST_CHANGE_CYCLES)
    instants = np.linspace(0.0, cycles, INSTANTS + 2)[1:-1]
    return np.array([(SMALL, max(at - length / 2.0, 0.0), length) for at in instants])


def _best(slopes: Array, jacobian: Array, residual: Array) -> tuple[Array, Array]:
    """Return the change of each trial that fits best, and what it explains of the squared residual."""
    flat, others = slopes.reshape(len(slopes), -1), jacobian.reshape(len(jacobian), -1)
    products = others @ others.T
    scale = 1.0 / np.sqrt(np.maximum(np.diag(products), 1e-300))
    gains = np.linalg.lstsq(
        products * scale * scale[:, np.newaxis], (others @ flat.T) * scale[:, np.newaxis]
    )[0]
    apart = flat - (gains * scale[:, np.newaxis]).T @ others
    along, own = apart @ residual.reshape(-1), np.einsum("ij,ij->i", apart, apart)
    own = np.where(own > 1e-6 * np.einsum("ij,ij->i", flat, flat), own, np.inf)
    return along / own, along**2 / own
