"""Samples of any kind: an estimate or a SignalError, never a warning and never another error."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from core.signals.errors import SignalError
from core.signals.phasors import fundamental_frequency, harmonic_phasors

ANY = st.floats(allow_nan=True, allow_infinity=True)
rates = st.one_of(
    st.sampled_from([600.0, 10_000.0, 50_000.0, 0.0, -1.0, math.nan, math.inf, 1e-300, 1e300]), ANY
)


@settings(max_examples=150, deadline=None)
@given(arrays(np.float64, (2, 12), elements=ANY), st.integers(0, 60), rates)
def test_a_frequency_or_a_signal_error(block: NDArray[np.float64], times: int, rate: float) -> None:
    try:
        frequency = fundamental_frequency(np.tile(block, times), rate)
    except SignalError as error:
        assert str(error)  # noqa: PT017 - either answer is right
    else:
        assert 20.0 <= frequency <= 120.0


@settings(max_examples=150, deadline=None)
@given(
    arrays(np.float64, (2, 12), elements=ANY),
    st.integers(0, 20),
    ANY,
    rates,
    st.sampled_from([(1,), (1, 2, 3), (1, 1)]),
)
def test_phasors_or_a_signal_error(
    block: NDArray[np.float64], times: int, frequency: float, rate: float, orders: tuple[int, ...]
) -> None:
    try:
        phasors = harmonic_phasors(np.tile(block, times), frequency, rate, orders)
    except SignalError as error:
        assert str(error)  # noqa: PT017 - either answer is right
    else:
        assert phasors.shape == (2, len(orders))


@pytest.mark.parametrize("size", [1e-300, 1e-150, 1e150, 1e300])
def test_size_does_not_matter(size: float) -> None:
    angle = 2 * np.pi * 49.7 / 10_000.0 * np.arange(2_000)
    samples = size * np.stack([np.cos(angle), np.sin(angle)])
    assert fundamental_frequency(samples, 10_000.0) == pytest.approx(49.7, abs=1e-6)
    assert abs(harmonic_phasors(samples, 49.7, 10_000.0)[0, 0]) == pytest.approx(
        size / math.sqrt(2), rel=1e-9
    )
