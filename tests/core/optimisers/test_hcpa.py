"""The Hyperbolic Cross Point Algorithm: chapter 4's worked examples, its promises, and its minima."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult

from core.optimisers import hcpa
from core.optimisers.objective import OptimiserError

Array = NDArray[np.float64]
ONE = 1 << hcpa.DIGITS


@pytest.mark.parametrize(
    ("coordinate", "level"), [(0.0, 0), (0.5, 1), (-0.5, 1), (0.25, 2), (0.375, 3), (-0.0625, 4)]
)
def test_level_of_a_coordinate(coordinate: float, level: int) -> None:
    assert hcpa.level(round(coordinate * ONE)) == level


def test_the_worked_example_of_the_thesis() -> None:
    """[0, 0.5] at degree 2 has the neighbours [+-0.25, 0.5] and [0, 0.375]; [0, 0.625] is outside."""
    search = hcpa._Search(np.zeros(2), np.ones(2), 14, 0.0, [None, None])
    found = {tuple(x / ONE for x in point) for point in search._neighbours((0, ONE // 2), 2)}
    assert found == {(0.25, 0.5), (-0.25, 0.5), (0.0, 0.375)}


def test_goldstein_price_is_found_exactly() -> None:
    def goldstein_price(x: Array) -> float:
        a, b = float(x[0]), float(x[1])
        first = 1 + (a + b + 1) ** 2 * (19 - 14 * a + 3 * a * a - 14 * b + 6 * a * b + 3 * b * b)
        second = 30 + (2 * a - 3 * b) ** 2 * (18 - 32 * a + 12 * a * a + 48 * b - 36 * a * b + 27 * b * b)
        return first * second

    result = hcpa.minimise(goldstein_price, [(-2, 2), (-2, 2)])
    assert result.fun == pytest.approx(3.0)
    assert result.x == pytest.approx([0.0, -1.0])


def test_local_phase_refines_what_the_global_phase_found() -> None:
    def bowl(points: Array) -> Array:
        return np.asarray(((points - np.array([0.3, -0.7])) ** 2).sum(axis=1), dtype=np.float64)

    coarse = hcpa.minimise(bowl, [(-1, 1)] * 2, adaptiveness=1.0, max_global=100, max_local=0, batch=True)
    fine = hcpa.minimise(
        bowl, [(-1, 1)] * 2, adaptiveness=1.0, fineness=30, max_global=100, max_local=200, batch=True
    )
    assert coarse.nfev == 100
    assert fine.fun < coarse.fun
    assert fine.x == pytest.approx([0.3, -0.7], abs=2e-3)


def test_allowed_values_are_the_only_ones_evaluated() -> None:
    seen: list[Array] = []

    def cost(points: Array) -> Array:
        seen.append(points)
        return np.asarray((points[:, 0] - 2.0) ** 2 + points[:, 1] ** 2, dtype=np.float64)

    result = hcpa.minimise(cost, [(0, 2), (-1, 1)], allowed=((0, 1, 2), None), batch=True, max_global=100)
    assert set(np.concatenate(seen)[:, 0]) == {0.0, 1.0, 2.0}
    assert result.x == pytest.approx([2.0, 0.0])


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 1000),
    dimensions=st.integers(1, 5),
    lower=st.floats(-1e6, 1e6),
    exponent=st.integers(-6, 12),
    adaptiveness=st.floats(0.0, 1.0),
    fineness=st.integers(1, 16),
    exclusion=st.sampled_from([0.0, 0.02, 0.3]),
)
def test_promises_hold_for_any_box(
    seed: int,
    dimensions: int,
    lower: float,
    exponent: int,
    adaptiveness: float,
    fineness: int,
    exclusion: float,
) -> None:
    span = 10.0**exponent
    if lower + span == lower:
        return
    weights = np.random.default_rng(seed).uniform(-3, 3, (2, dimensions))

    def cost(points: Array) -> Array:
        unit = (points - lower) / span
        return np.asarray(np.sin(7 * unit @ weights[0]) + ((unit - weights[1]) ** 2).sum(axis=1))

    def search() -> OptimizeResult:
        return hcpa.minimise(
            cost, [(lower, lower + span)] * dimensions, adaptiveness=adaptiveness, fineness=fineness,
            exclusion=exclusion, max_global=120, max_local=60, batch=True,
        )  # fmt: skip

    result = search()
    assert result.nfev == len(result.points) == len(result.costs) <= 180
    assert result.fun == result.costs.min()
    assert (result.points >= lower).all()
    assert (result.points <= lower + span).all()
    assert (result.levels < max(fineness, 1)).all()
    unit = (result.points - lower) / span
    if exponent >= 0 and abs(lower) < 10 * span:
        assert len(np.unique(np.round(unit * 2**20), axis=0)) == result.nfev
        assert unit * 2**17 == pytest.approx(np.round(unit * 2**17), abs=1e-4)
    again = search()
    assert np.array_equal(again.points, result.points)


def test_not_a_number_is_never_the_minimum() -> None:
    result = hcpa.minimise(
        lambda x: float("nan") if x[0] < 0.2 else float(x[0]), [(-1.0, 1.0)], max_global=50, max_local=0
    )
    assert result.fun >= 0.2
    assert result.success


def test_the_callback_stops_the_search() -> None:
    result = hcpa.minimise(
        lambda x: float(x[0] ** 2), [(-1, 3)], callback=lambda _, values: bool(values.min() < 0.3)
    )
    assert result.message == "stopped by the callback"
    assert result.nfev < 20


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ({"bounds": []}, "bounds"),
        ({"bounds": [(1.0, 0.0)]}, "bounds"),
        ({"bounds": [(0.0, float("inf"))]}, "bounds"),
        ({"adaptiveness": 1.5}, "adaptiveness"),
        ({"fineness": 0}, "fineness"),
        ({"allowed": ((0.0, 1.0), None)}, "allowed"),
        ({"allowed": ((0.1, 0.2),)}, "allowed"),
        ({"allowed": ((0.5, 7.0),)}, "allowed"),
    ],
)
def test_impossible_arguments_are_named(arguments: dict[str, object], word: str) -> None:
    bounds = arguments.pop("bounds", [(0.0, 1.0)])
    with pytest.raises(OptimiserError, match=word):
        hcpa.minimise(lambda x: float(x[0]), bounds, **arguments)  # type: ignore[arg-type]


def test_a_function_of_the_wrong_shape_is_refused() -> None:
    with pytest.raises(OptimiserError, match="expected 1 values for 1 points"):
        hcpa.minimise(lambda _: np.zeros(3), [(0.0, 1.0)], batch=True)


def test_a_hundred_thousand_points_in_eight_dimensions_take_seconds() -> None:
    """Cost per step must not grow with the points: the last tenth takes no more than thrice the first."""
    from time import perf_counter

    stamps: list[float] = []

    def cost(points: Array) -> Array:
        stamps.append(perf_counter())
        return np.asarray(((points - 0.123) ** 2).sum(axis=1))

    result = hcpa.minimise(
        cost,
        [(-1, 1)] * 8,
        adaptiveness=0.3,
        fineness=40,
        exclusion=0.0,
        max_global=30_000,
        max_local=0,
        batch=True,
    )
    tenth = len(stamps) // 10
    assert result.nfev == 30_000
    assert stamps[-1] - stamps[-tenth] < 3.0 * (stamps[tenth] - stamps[0]) + 0.2
