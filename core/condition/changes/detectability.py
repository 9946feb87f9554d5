"""How small a step of the fault level would be seen."""

from math import sqrt

import numpy as np

from core.condition.changes.evidence import learnt, signature
from core.condition.changes.hypotheses import Cause, Hypothesis
from core.condition.filter.state import FilterState
from core.machines.compiled import compiled_as_written as compiled

WITHIN = 10.0
"""Records within which a step is to be seen."""
NINE_OF_TEN = 1.2815515655446004
OCCAM = 5.0
"""Evidence that a step must have beyond the threshold: its onset, size and direction are unknown."""
LARGEST = 0.5
NEGLIGIBLE = 1e-4
"""Probability of an axis and a leakage below which they are left out."""
_TURNS = int(Cause.SHORTED_TURNS)


@compiled
def detectable(filters: list[FilterState], hypotheses: list[Hypothesis]) -> float:
    """Return the least step of the fault level that nine of ten times would be seen within ten records.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter, after a record: the next ones are taken to be alike.
    hypotheses : array of Hypothesis
        All places of all causes.

    Returns
    -------
    float
        Equivalent level in the winding, on the axis and with the leakage that show least, a fraction of the
        phase turns.
    """
    state = filters[0]
    H, P = state.H, state.P
    S = np.zeros((2, 2))
    for r in range(2):
        for q in range(2):
            for i in range(7):
                for j in range(7):
                    S[r, q] += H[r, i] * P[i, j] * H[q, j]
        S[r, r] += 0.5 * state.s2 / WITHIN
    determinant = S[0, 0] * S[1, 1] - S[0, 1] * S[1, 0]
    needed = sqrt(2.0 * (state.threshold + OCCAM)) + NINE_OF_TEN
    most, known = 0.0, learnt(state)
    for h in range(len(hypotheses)):
        it = hypotheses[h]
        if it.cause == _TURNS and it.share > NEGLIGIBLE:
            u, _ = signature(known, it)
            x, y = u.real, u.imag
            information = (x * x * S[1, 1] - 2.0 * x * y * S[0, 1] + y * y * S[0, 0]) / determinant
            most = max(most, needed / sqrt(information))
    return min(most, LARGEST)
