from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.recordings.skew import without_skew


@given(skew=st.floats(-0.99, 0.99), samples_a_cycle=st.floats(16, 200), angle=st.floats(-pi, pi))
def test_a_sine_is_brought_to_its_instants(skew: float, samples_a_cycle: float, angle: float) -> None:
    n = np.arange(100)
    found = without_skew(np.cos(2 * pi / samples_a_cycle * (n + skew) + angle), skew)
    expected = np.cos(2 * pi / samples_a_cycle * n + angle)
    assert found[2:-3] == pytest.approx(expected[2:-3], abs=1e-4)
    assert found == pytest.approx(expected, abs=5e-3), "at the ends, from one side"


def test_a_polynomial_is_exact_up_to_the_ends() -> None:
    n = np.arange(12.0)
    assert without_skew((n + 0.3) ** 5, 0.3) == pytest.approx(n**5, abs=1e-9)


@pytest.mark.parametrize("samples", [1, 2, 5])
def test_short_waveforms(samples: int) -> None:
    assert without_skew(np.full(samples, 7.0), 0.5) == pytest.approx(np.full(samples, 7.0))


def test_a_missing_sample_stays_near() -> None:
    x = np.ones(30)
    x[15] = np.nan
    assert np.flatnonzero(np.isnan(without_skew(x, 0.1))).tolist() == [12, 13, 14, 15, 16, 17]
