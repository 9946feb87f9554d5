"""The first-order hold against scipy's matrix exponential of the augmented system (Van Loan)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import expm

from core.machines.discretisation import Hold, first_order_hold


def van_loan(A: NDArray[np.float64], h: float) -> tuple[NDArray[np.float64], ...]:
    M = np.zeros((13, 13))
    M[:5, :5] = A * h
    M[:4, 5:9] = h * np.eye(4)
    M[5:9, 9:] = np.eye(4)
    exponential = expm(M)
    hold, ramp = exponential[:5, 5:9], exponential[:5, 9:]
    return exponential[:5, :5], hold[:, :2] - ramp[:, :2], ramp[:, :2], hold[:, 2:]


@settings(max_examples=50, deadline=None)
@given(seed=st.integers(0, 10_000), scale=st.floats(1.0, 1e5), step=st.floats(1e-6, 1e-2))
def test_agrees_with_the_matrix_exponential(seed: int, scale: float, step: float) -> None:
    rng = np.random.default_rng(seed)
    A = scale * rng.standard_normal((5, 5))
    A -= (np.abs(np.linalg.eigvals(A).real).max() + scale) * np.eye(5)
    E, G0, G1, H = np.empty((5, 5)), np.empty((5, 2)), np.empty((5, 2)), np.empty((5, 2))
    first_order_hold(A, step, Hold(E, G0, G1, H))
    for ours, theirs in zip((E, G0, G1, H), van_loan(A, step), strict=True):
        assert ours == pytest.approx(theirs, rel=1e-7, abs=1e-10 * max(1.0, step))


def test_a_stiff_loop_decays_instead_of_blowing_up() -> None:
    A = np.diag([-100.0, -100.0, -100.0, -100.0, -1e9])
    E, G0, G1, H = np.empty((5, 5)), np.empty((5, 2)), np.empty((5, 2)), np.empty((5, 2))
    first_order_hold(A, 1e-4, Hold(E, G0, G1, H))
    assert np.abs(np.linalg.eigvals(E)).max() < 1.0
    assert E[4, 4] == pytest.approx(0.0, abs=1e-12)
