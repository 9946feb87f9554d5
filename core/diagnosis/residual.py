"""What a hypothesis leaves of the measured currents."""

import numpy as np

from core.diagnosis.case import Case
from core.machines.base import Array


def residual_rms_A(case: Case, modelled_ab: Array) -> float:
    """Return the rms distance of measured and modelled line currents over both Clarke axes."""
    window = case.window
    residual = case.space_vector(case.current_ab[:, window.first : window.last] - modelled_ab)
    return float(np.sqrt(np.mean(np.abs(residual) ** 2))) * case.line_per_winding_current
