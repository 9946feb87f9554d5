"""Bounded least squares: minima inside and on the bounds, batches, counts, refusals."""

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks.optimisers import least_squares
from core.optimisers.objective import OptimiserError

Array = NDArray[np.float64]
TIMES = np.linspace(0.0, 2.0, 30)


def decay(points: Array) -> Array:
    """A exp(-t / T) at points (m, 2), less the curve of A = 3, T = 0.5."""
    curves = points[:, :1] * np.exp(-TIMES / points[:, 1:])
    return np.asarray(curves - 3.0 * np.exp(-TIMES / 0.5))


@pytest.mark.parametrize("central", [True, False])
def test_a_curve_s_parameters_are_found(central: bool) -> None:
    result = least_squares.minimise(decay, [(0.0, 10.0), (0.05, 5.0)], central=central, batch=True)
    assert result.x == pytest.approx([3.0, 0.5], rel=1e-6)
    assert result.nfev == len(result.points) == len(result.costs)
    assert result.costs == pytest.approx((decay(result.points) ** 2).sum(axis=1))
    assert "tolerance" in result.message


def test_a_minimum_outside_is_sought_on_the_bound() -> None:
    result = least_squares.minimise(decay, [(0.0, 2.0), (0.05, 5.0)], start=[1.9, 0.6], batch=True)
    assert result.x[0] == pytest.approx(2.0, abs=1e-4)
    assert (result.points <= [2.0, 5.0]).all()


def test_points_one_by_one_take_the_same_path_as_a_batch() -> None:
    box = [(0.0, 10.0), (0.05, 5.0)]
    batch = least_squares.minimise(decay, box, batch=True)
    single = least_squares.minimise(lambda point: decay(point[np.newaxis])[0], box)
    assert single.points == pytest.approx(batch.points)


def test_the_budget_and_the_callback_end_it() -> None:
    box = [(0.0, 10.0), (0.05, 5.0)]
    few = least_squares.minimise(decay, box, max_evaluations=7, batch=True)
    assert few.nfev == 7
    assert few.message == "evaluated the most points allowed, 7"
    stopped = least_squares.minimise(
        decay, box, callback=lambda _, values: bool(values.min() < 1.0), batch=True
    )
    assert stopped.message == "stopped by the callback"


@pytest.mark.parametrize(
    ("fun", "word"),
    [
        (lambda points: points[0], r"expected residuals \(1, n\)"),
        (lambda points: np.full((len(points), 3), np.nan), "finite"),
    ],
)
def test_residuals_of_the_wrong_kind_are_refused(fun: least_squares.Residuals, word: str) -> None:
    with pytest.raises(OptimiserError, match=word):
        least_squares.minimise(fun, [(0.0, 1.0)] * 2, batch=True)
