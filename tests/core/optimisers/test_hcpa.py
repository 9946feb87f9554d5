"""The Hyperbolic Cross Point Algorithm: chapter 4's worked examples, its promises, and its minima."""

from time import process_time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult

from core.optimisers import hcpa
from core.optimisers.evaluations import Evaluations
from core.optimisers.exclusion import Exclusion
from core.optimisers.objective import OptimiserError, checked_bounds

Array = NDArray[np.float64]
ONE = 1 << hcpa.DIGITS


@pytest.mark.parametrize(
    ("coordinate", "level"), [(0.0, 0), (0.5, 1), (-0.5, 1), (0.25, 2), (0.375, 3), (-0.0625, 4)]
)
def test_level_of_a_coordinate(coordinate: float, level: int) -> None:
    assert hcpa.level(round(coordinate * ONE)) == level


def unit_search(dimensions: int, *, fineness: int = 14, exclusion: float = 0.0) -> hcpa._Search:
    box = checked_bounds([(-0.5, 0.5)] * dimensions)
    objective = Evaluations(lambda points: np.asarray((points**2).sum(axis=1)), box)
    return hcpa._Search(objective, fineness, exclusion, [None] * dimensions)


def test_the_worked_example_of_the_thesis() -> None:
    """[0, 0.5] at degree 2 has the neighbours [+-0.25, 0.5] and [0, 0.375]; [0, 0.625] is outside."""
    neighbours = unit_search(2)._neighbours((0, ONE // 2), 2)
    assert {tuple(x / ONE for x in point) for point in neighbours} == {
        (0.25, 0.5),
        (-0.25, 0.5),
        (0.0, 0.375),
    }
    assert {sum(hcpa.level(x) for x in point) for point in neighbours} == {3}


def test_the_first_steps_are_those_of_the_flowchart() -> None:
    """By hand, alpha = 0: the middle, its neighbours of degree 1, then the best point's, (4.5) and (4.6)."""
    result = hcpa.minimise(
        lambda x: float((x[0] - 0.4) ** 2 + (x[1] - 0.1) ** 2), [(-0.5, 0.5)] * 2, adaptiveness=0.0,
        max_global=10, max_local=0, exclusion=0.0,
    )  # fmt: skip
    assert result.points.tolist() == [
        [0.0, 0.0],
        *[[-0.5, 0.0], [0.5, 0.0], [0.0, -0.5], [0.0, 0.5]],  # the middle at degree 1: steps of 2^-1
        *[[0.25, 0.0], [0.5, -0.5], [0.5, 0.5]],  # the best, [0.5, 0], at degree 1: steps of 2^-2 and 2^-1
        *[[0.375, 0.0], [0.5, -0.25]],  # still the best, at degree 2: 2^-3 and 2^-2; the budget ends it
    ]
    assert result.levels.tolist() == [0, 1, 1, 1, 1, 2, 2, 2, 3, 3]


@pytest.mark.parametrize(
    ("dimensions", "fineness", "points"), [(1, 6, 33), (2, 6, 145), (2, 4, 29), (3, 4, 69)]
)
def test_every_hyperbolic_cross_point_below_the_fineness_is_evaluated_once(
    dimensions: int, fineness: int, points: int
) -> None:
    """As many as a Clenshaw-Curtis grid of the same level has; Fig. 4.5 counts 147 for 145."""
    result = hcpa.minimise(
        lambda x: float((x**2).sum()), [(-1, 2)] * dimensions, fineness=fineness, exclusion=0.0
    )
    assert result.nfev == points
    assert result.message == f"every reachable point of a level below {fineness} is evaluated"


@pytest.mark.parametrize("adaptiveness", [0.0, 0.3, 0.7, 1.0])
def test_the_point_expanded_has_the_least_goodness_of_all(adaptiveness: float) -> None:
    """Against (4.5) computed for every point, with all ranks sorted anew."""
    search = unit_search(3, fineness=9)
    search._evaluate([(0, 0, 0)], 0)
    for _ in range(150):
        values = np.array([search._value_of[point] for point in search._points])
        ranks = np.searchsorted(np.sort(values), values) + 1
        sums = np.array(search._levels) + np.array(search._degrees)
        goodness = np.maximum(sums, 1) ** adaptiveness * ranks ** (1.0 - adaptiveness)
        # A point is spent once its neighbours would reach the fineness.
        least = goodness[sums < 9].min() if len(values) > 1 else goodness[0]
        chosen = search._least_goodness(adaptiveness)
        assert chosen is not None
        if sums[chosen] + 1 < 9 and least == goodness[sums + 1 < 9].min():
            assert goodness[chosen] == pytest.approx(least)
        search._evaluate(*search._expand(chosen))


@pytest.mark.parametrize(
    ("dimensions", "fineness", "exclusion", "adaptiveness"),
    [(2, 14, 0.02, 0.5), (3, 7, 0.05, 0.4), (4, 5, 0.08, 0.2), (5, 4, 0.15, 0.15), (6, 3, 0.3, 0.1)],
)
def test_what_is_not_said_is_taken_from_table_4_1(
    dimensions: int, fineness: int, exclusion: float, adaptiveness: float
) -> None:
    def cost(points: Array) -> Array:
        return np.asarray(((points - 0.21) ** 2).sum(axis=1) + 0.1 * np.cos(9.0 * points).sum(axis=1))

    bounds = [(-1.0, 1.0)] * dimensions
    said = hcpa.minimise(
        cost, bounds, fineness=fineness, exclusion=exclusion, adaptiveness=adaptiveness, batch=True
    )
    assert np.array_equal(hcpa.minimise(cost, bounds, batch=True).points, said.points)


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


@st.composite
def boxes(draw: st.DrawFn) -> list[tuple[float, float]]:
    """From 1e-12 to 1e12 wide, anywhere from -1e6 to 1e6: some hold only a few doubles."""
    found = []
    for _ in range(draw(st.integers(1, 5))):
        lower = draw(st.floats(-1e6, 1e6))
        upper = lower + 10.0 ** draw(st.integers(-12, 12))
        found.append((lower, upper if upper > lower else float(np.nextafter(lower, np.inf))))
    return found


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 1000),
    bounds=boxes(),
    adaptiveness=st.floats(0.0, 1.0),
    fineness=st.integers(1, 16),
    exclusion=st.sampled_from([0.0, 0.02, 0.3]),
)
def test_promises_hold_for_any_box(
    seed: int, bounds: list[tuple[float, float]], adaptiveness: float, fineness: int, exclusion: float
) -> None:
    lower, upper = np.array(bounds).T
    weights = np.random.default_rng(seed).uniform(-3, 3, (2, len(bounds)))

    def cost(points: Array) -> Array:
        unit = (points - lower) / (upper - lower)
        return np.asarray(np.sin(7 * unit @ weights[0]) + ((unit - weights[1]) ** 2).sum(axis=1))

    def search() -> OptimizeResult:
        return hcpa.minimise(
            cost, bounds, adaptiveness=adaptiveness, fineness=fineness, exclusion=exclusion, max_global=120,
            max_local=60, batch=True,
        )  # fmt: skip

    result = search()
    assert result.nfev == len(result.points) == len(result.costs) == len(result.levels) <= 180
    assert result.fun == result.costs.min()
    assert cost(result.x[np.newaxis])[0] == pytest.approx(result.fun)
    assert (result.points >= lower).all()
    assert (result.points <= upper).all()
    assert (result.levels < fineness).all()
    assert len(np.unique(result.points, axis=0)) == result.nfev
    again = search()
    assert np.array_equal(again.points, result.points)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 1000), dimensions=st.integers(1, 6), adaptiveness=st.floats(0.0, 1.0))
def test_points_are_dyadic_and_levels_are_the_sums_of_their_binary_digits(
    seed: int, dimensions: int, adaptiveness: float
) -> None:
    shift = np.random.default_rng(seed).uniform(-0.5, 0.5, dimensions)
    result = hcpa.minimise(
        lambda points: np.asarray(((points - shift) ** 2).sum(axis=1)), [(-0.5, 0.5)] * dimensions,
        adaptiveness=adaptiveness, fineness=18, max_global=100, max_local=100, batch=True,
    )  # fmt: skip
    for point, level in zip(result.points.tolist(), result.levels.tolist(), strict=True):
        # A double is a fraction of whole numbers: its denominator is 2 to the number of binary digits.
        denominators = [x.as_integer_ratio()[1] for x in point]
        assert sum(one.bit_length() - 1 for one in denominators) == level


@settings(max_examples=60, deadline=None)
@given(
    centres=st.lists(st.lists(st.integers(-8, 8), min_size=3, max_size=3), max_size=12),
    centre=st.lists(st.integers(-8, 8), min_size=3, max_size=3),
    reach=st.integers(1, 5),
)
def test_what_lies_in_an_excluded_box_is_left_out(
    centres: list[list[int]], centre: list[int], reach: int
) -> None:
    exclusion = Exclusion(3, reach)
    boxes: list[list[int]] = []
    for one in centres:
        if not any(max(abs(a - b) for a, b in zip(one, box, strict=True)) < reach for box in boxes):
            boxes.append(one)
        exclusion.add((one[0], one[1], one[2]))
    around = [(*centre[:k], centre[k] + step, *centre[k + 1 :]) for k in range(3) for step in (-2, 2)]
    expected = [
        point
        for point in around
        if not any(max(abs(a - b) for a, b in zip(point, box, strict=True)) < reach for box in boxes)
    ]
    assert exclusion.outside((centre[0], centre[1], centre[2]), around) == expected


def test_the_region_around_a_minimum_is_searched_no_more() -> None:
    def two_wells(points: Array) -> Array:
        return np.asarray(np.minimum((points[:, 0] + 0.3) ** 2, (points[:, 0] - 0.3) ** 2 + 0.01))

    box = [(-0.5, 0.5)]
    every = hcpa.minimise(two_wells, box, fineness=11, exclusion=0.0, max_global=2000, batch=True)
    fewer = hcpa.minimise(two_wells, box, fineness=11, exclusion=0.1, max_global=2000, batch=True)
    assert fewer.nfev < every.nfev
    assert fewer.fun == every.fun


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


@pytest.mark.parametrize(("points", "fineness", "exclusion"), [(100_000, 40, 0.0), (30_000, 12, 0.3)])
def test_a_step_costs_hardly_more_after_a_hundred_thousand_points(
    points: int, fineness: int, exclusion: float
) -> None:
    """At the second go at the latest, where others share the caches. `make bench` tells the seconds."""
    assert _growth(points, fineness, exclusion) < 0.2 or _growth(points, fineness, exclusion) < 0.2


def _growth(points: int, fineness: int, exclusion: float) -> float:
    """CPU seconds of a search's last tenth beyond three times those of its second."""

    stamps: list[float] = []

    def cost(points: Array) -> Array:
        stamps.append(process_time())
        return np.asarray(((points - 0.123) ** 2).sum(axis=1) + 0.3 * np.sin(9 * points).sum(axis=1))

    result = hcpa.minimise(
        cost, [(-1, 1)] * 8, adaptiveness=0.3, fineness=fineness, exclusion=exclusion, max_global=points,
        max_local=0, batch=True,
    )  # fmt: skip
    assert result.nfev == points
    tenth = len(stamps) // 10
    return stamps[-1] - stamps[-tenth] - 3.0 * (stamps[2 * tenth] - stamps[tenth])
