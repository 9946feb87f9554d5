"""How large a change of a channel or a joint is now, in its own measure."""

from math import hypot, inf
from typing import Any, Final

import numpy as np

from core.condition.changes.evidence import along, learnt_without, of_size, signature
from core.condition.changes.hypotheses import Hypotheses, Hypothesis
from core.condition.changes.naming import SIZES
from core.condition.filter.change_bank import RAMP_LENGTH
from core.condition.filter.state import Candidate, FilterState
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled
from core.normal_distribution import NORMAL_95

DRIFT_SHAPE: Final = 0.12
"""Relative standard deviation of the size of a change that drifts: no drift is a straight line."""


def size_of(
    filters: Any, bank: Any, hypotheses: Hypotheses, at: int, fitting: Array
) -> tuple[float, tuple[float, float]]:
    """Return the size of a change at the latest record.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter.
    bank : array of Candidate
        Candidates.
    hypotheses : array of Hypothesis
        All places of all causes.
    at : int
        Index of the place: of a channel or a joint.
    fitting : ndarray, shape (5,)
        What fits it best, as naming found it: the candidate, and whether the change drifts. The rest is not
        used.

    Returns
    -------
    size : float
        Relative error of a channel, or voltage drop of a joint at rated current over rated voltage.
    interval : tuple of float
        Its 95 % interval; that of a joint is not below zero.
    """
    drifts = bool(fitting[1])
    value, deviation = _size_now(filters, bank, hypotheses, int(fitting[0]), drifts, at)
    half = NORMAL_95 * hypot(deviation, DRIFT_SHAPE * value if drifts else 0.0)
    unit, least = float(hypotheses[at]["unit"]), 0.0 if hypotheses[at]["one_sided"] else -inf
    return max(least, value) * unit, (max(least, value - half) * unit, max(least, value + half) * unit)


@compiled
def _size_now(
    filters: list[FilterState], bank: list[Candidate], hypotheses: list[Hypothesis],
    onset: int, drifts: bool, at: int,
) -> tuple[float, float]:  # fmt: skip
    """Return the size now and its standard deviation.

    The size that naming found will not do. Naming gives the records less weight than they have, and its size
    of a drift is the growth in RAMP_LENGTH records.
    """
    state, one, it = filters[0], bank[onset], hypotheses[at]
    u, direction = signature(learnt_without(state, one, drifts), it)
    out = np.empty(5)
    along(one, it.column, drifts, u, out)
    _, size, deviation = of_size(
        out[0], out[1], out[2], out[3], out[4], SIZES[1] * it.spread, direction, it.one_sided
    )
    grown = (state.records - one.onset) / RAMP_LENGTH if drifts else 1.0
    return grown * size, grown * deviation
