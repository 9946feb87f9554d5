import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from core.signals.spline import refine


@pytest.mark.parametrize("substeps", [1, 2, 3, 7])
@pytest.mark.parametrize("samples", [2, 3, 4, 5, 6, 20, 39, 40, 41, 1000])
def test_it_equals_scipys(samples: int, substeps: int) -> None:
    x = np.random.default_rng(samples).standard_normal((2, samples))
    at = np.arange((samples - 1) * substeps + 1) / substeps
    expected = CubicSpline(np.arange(samples), x, axis=1)(at)
    assert refine(x, substeps) == pytest.approx(expected, abs=1e-12)
