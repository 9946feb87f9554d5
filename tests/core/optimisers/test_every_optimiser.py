"""What every optimiser promises: bounds, counts, seeds, callbacks, stop reasons; and the minima they find."""

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult

from benchmarks.optimisers import clusters, multistart, nelder_mead
from benchmarks.optimisers.multistart import Refinement
from benchmarks.optimisers.test_functions import FUNCTIONS, TestFunction, by_name
from core.optimisers import genetic, hcpa, latin_hypercube, pattern_search
from core.optimisers.objective import OptimiserError

Array = NDArray[np.float64]
Minimise = Callable[..., OptimizeResult]

OPTIMISERS: dict[str, Minimise] = {
    "hcpa": partial(hcpa.minimise, max_global=150, max_local=50),
    "multistart": partial(multistart.minimise, max_global=60, max_evaluations=200),
    "genetic": partial(genetic.minimise, generations=8),
    "pattern search": partial(pattern_search.minimise, max_evaluations=200),
    "pattern search, D+1, samples": partial(
        pattern_search.minimise, pattern="D+1", samples=20, max_evaluations=200
    ),
    "Nelder-Mead": partial(nelder_mead.minimise, max_evaluations=200),
    "clusters": partial(clusters.minimise, clusters=2, max_global=100),
}


@pytest.mark.parametrize("name", OPTIMISERS)
@settings(max_examples=8, deadline=None)
@given(
    seed=st.integers(0, 1000),
    dimensions=st.integers(1, 4),
    lower=st.floats(-1e6, 1e6),
    exponent=st.integers(-12, 12),
)
def test_promises_hold_for_any_box(
    name: str, seed: int, dimensions: int, lower: float, exponent: int
) -> None:
    upper = max(lower + 10.0**exponent, float(np.nextafter(lower, np.inf)))
    well = np.random.default_rng(seed).uniform(-0.2, 1.2, dimensions)
    handed: list[Array] = []

    def cost(points: Array) -> Array:
        handed.append(points)
        unit = (points - lower) / (upper - lower)
        return np.asarray(((unit - well) ** 2 - 0.1 * np.cos(20 * unit)).sum(axis=1))

    result = OPTIMISERS[name](cost, [(lower, upper)] * dimensions, batch=True)
    evaluated = np.concatenate(handed)
    assert np.array_equal(result.points, evaluated)
    assert result.nfev == len(evaluated) == len(result.costs)
    assert len(np.unique(evaluated, axis=0)) == result.nfev, "a point was evaluated twice"
    assert (evaluated >= lower).all()
    assert (evaluated <= upper).all()
    assert result.fun == result.costs.min()
    assert result.x.tolist() == evaluated[int(np.argmin(result.costs))].tolist()
    assert result.message
    again = OPTIMISERS[name](cost, [(lower, upper)] * dimensions, batch=True)
    assert np.array_equal(again.points, result.points)


@pytest.mark.parametrize("name", ["genetic", "pattern search, D+1, samples"])
def test_another_seed_takes_another_path(name: str) -> None:
    def cost(x: Array) -> float:
        return float((x**2).sum())

    first, second = (OPTIMISERS[name](cost, [(-1.0, 2.0)] * 2, seed=seed).points for seed in (1, 2))
    assert not np.array_equal(first[: len(second)], second[: len(first)])


@pytest.mark.parametrize("name", OPTIMISERS)
def test_the_callback_stops_the_search(name: str) -> None:
    calls: list[int] = []

    def stop(points: Array, values: Array) -> bool:
        assert len(points) == len(values)
        calls.append(len(points))
        return len(calls) == 2

    result = OPTIMISERS[name](lambda x: float((x**2).sum()), [(-1.0, 2.0)] * 2, callback=stop)
    assert result.message == "stopped by the callback"
    assert len(calls) == 2
    assert result.nfev == sum(calls)


@pytest.mark.parametrize(
    ("name", "most"), [("multistart", 200), ("pattern search", 200), ("Nelder-Mead", 200), ("hcpa", 200)]
)
def test_no_more_is_evaluated_than_allowed(name: str, most: int) -> None:
    def valley(x: Array) -> float:
        return float(100.0 * (x[1] - x[0] ** 2) ** 2 + (x[0] - 1.0) ** 2 + 0.1 * np.sin(30 * x).sum())

    result = OPTIMISERS[name](valley, [(-2.0, 3.0), (-2.0, 9.0)])
    assert result.nfev <= most


@pytest.mark.parametrize("function", FUNCTIONS, ids=[function.name for function in FUNCTIONS])
def test_the_stated_minimum_is_the_least_value_near_it(function: TestFunction) -> None:
    values = function.fun(function.minimisers)
    assert values == pytest.approx(function.minimum, abs=1e-6)
    lower, upper = np.array(function.bounds).T
    spread = np.random.default_rng(5).uniform(lower, upper, (20_000, lower.size))
    near = np.clip(function.minimisers[0] + 1e-3 * (spread - function.minimisers[0]), lower, upper)
    assert function.fun(np.concatenate([spread, near])).min() >= function.minimum - 1e-12
    assert (function.minimisers >= lower).all()
    assert (function.minimisers <= upper).all()


@pytest.mark.parametrize("name", ["Goldstein-Price", "Rosenbrock", "Branin", "Himmelblau", "Hartman 3"])
def test_multistart_finds_the_minimum_in_a_box_that_flatters_nobody(name: str) -> None:
    function = by_name(name)
    lower, upper = np.array(function.bounds).T
    inwards = 0.13 * (upper - lower) * np.minimum(1.0, np.arange(1, lower.size + 1) / 2)
    assert (function.minimisers[0] > lower + inwards).any()
    box = list(zip(np.minimum(lower + inwards, function.minimisers.min(axis=0) - 0.07), upper, strict=True))
    result = multistart.minimise(function.fun, box, max_global=200, batch=True)
    assert result.fun == pytest.approx(function.minimum, abs=1e-5)


def test_a_further_round_goes_on_where_the_last_one_ended() -> None:
    function = by_name("Shekel 5")
    box = [(0.3, 9.0), (1.1, 10.0), (0.9, 9.5), (0.2, 9.7)]
    found = [
        multistart.minimise(
            function.fun, box, refinement=Refinement(rounds=rounds), max_evaluations=3_000, batch=True
        )
        for rounds in (1, 2, 4)
    ]
    for fewer, more in pairwise(found):
        assert np.array_equal(more.points[: fewer.nfev], fewer.points)
        assert more.nfev > fewer.nfev
        gaps = np.abs(more.starts[:, np.newaxis] - more.starts)[~np.eye(len(more.starts), dtype=bool)]
        assert (gaps.reshape(-1, 4) > 0.1 * 8.7 - 1e-9).any(axis=1).all()
    assert found[-1].fun == pytest.approx(function.minimum, abs=1e-5)


def test_least_squares_refines_every_hypothesis_round_a_closed_coordinate() -> None:
    """Three hypotheses, an angle known modulo one turn: the right one's valley lies across the seam."""
    times = np.linspace(0.0, 1.0, 40)

    def model(points: Array) -> Array:
        size, which, turn = (points[:, k, np.newaxis] for k in range(3))
        return np.asarray(size * np.cos(2 * np.pi * (times + turn)) + 0.3 * which * np.cos(6 * np.pi * times))

    truth = np.array([[0.7, 2.0, 0.985]])

    def residuals(points: Array) -> Array:
        return model(points) - model(truth)

    def cost(points: Array) -> Array:
        return np.asarray((residuals(points) ** 2).sum(axis=1))

    result = multistart.minimise(
        cost, [(0.0, 1.0), (0.0, 2.0), (0.0, 1.0)], residuals=residuals, refinement=Refinement(starts=1),
        max_global=40, allowed=(None, (0, 1, 2), None), periodic=(2,), batch=True,
    )  # fmt: skip
    assert result.x == pytest.approx(truth[0], abs=1e-5)
    assert sorted(start[1] for start in result.starts) == [0.0, 1.0, 2.0]
    assert result.nit == 3
    assert set(result.points[:, 1]) == {0.0, 1.0, 2.0}


def test_clusters_find_all_four_minima_of_himmelblau() -> None:
    """Section 4.4.5: 1,000 points at adaptiveness 0.8, four clusters, a local search from each centre."""
    function = by_name("Himmelblau")
    result = clusters.minimise(function.fun, function.bounds, clusters=4, batch=True)
    found = result.minimisers[np.lexsort(result.minimisers.T)]
    expected = function.minimisers[np.lexsort(function.minimisers.T)]
    assert found == pytest.approx(expected, abs=1e-4)
    assert result.minima == pytest.approx(np.zeros(4), abs=1e-8)


def test_fuzzy_clusters_sit_in_the_middle_of_their_points() -> None:
    random = np.random.default_rng(3)
    middles = np.array([[0.0, 0.0], [5.0, 1.0], [1.0, 7.0]])
    points = np.concatenate([middle + 0.1 * random.standard_normal((50, 2)) for middle in middles])
    found = clusters.fuzzy_c_means(points, 3, seed=1)
    assert found.membership.sum(axis=1) == pytest.approx(np.ones(150))
    distance = np.linalg.norm(found.centres[:, np.newaxis] - middles, axis=2)
    assert distance.min(axis=0) == pytest.approx(np.zeros(3), abs=0.1)


def test_latin_hypercube_points_fill_every_slice_of_every_coordinate() -> None:
    points = latin_hypercube.unit_points(60, 4, seed=7)
    slices = np.floor(points * 60).astype(int)
    assert (np.sort(slices, axis=0) == np.arange(60)[:, np.newaxis]).all()


def test_pattern_search_tries_both_patterns_of_the_thesis() -> None:
    def bowl(x: Array) -> float:
        return float(((x - 0.45) ** 2).sum())

    both_ways = pattern_search.minimise(bowl, [(0.0, 1.0)] * 3, mesh=0.1, max_evaluations=7)
    assert sorted((both_ways.points[1:] - 0.5).round(9).tolist()) == sorted(
        [*(0.1 * np.eye(3)).tolist(), *(-0.1 * np.eye(3)).tolist()]
    )
    simplex = pattern_search.minimise(bowl, [(0.0, 1.0)] * 3, mesh=0.1, max_evaluations=5, pattern="D+1")
    assert sorted((simplex.points[1:] - 0.5).round(9).tolist()) == sorted(
        [*(0.1 * np.eye(3)).tolist(), [-0.1, -0.1, -0.1]]
    )


def test_a_pattern_search_is_trapped_where_latin_hypercube_points_are_not() -> None:
    def two_wells(points: Array) -> Array:
        far = ((points - 0.8) ** 2).sum(axis=1)
        return np.asarray(np.minimum(((points - 0.1) ** 2).sum(axis=1) + 0.05, 0.3 * far))

    box = [(0.0, 1.0)] * 2
    trapped = pattern_search.minimise(two_wells, box, start=[0.0, 0.0], mesh=0.05, batch=True)
    freed = pattern_search.minimise(two_wells, box, samples=60, mesh=0.05, batch=True)
    assert trapped.x == pytest.approx([0.1, 0.1], abs=1e-3)
    assert freed.x == pytest.approx([0.8, 0.8], abs=1e-3)


def test_the_genetic_algorithm_keeps_its_elite_and_counts_as_the_thesis_does() -> None:
    generations: list[float] = []

    def kept(points: Array, values: Array) -> None:
        generations.append(float(values.min()))

    result = genetic.minimise(
        lambda x: float(((x - 0.3) ** 2).sum()), [(0.0, 1.0)] * 3, seed=4, callback=kept
    )
    assert result.nit == 25
    assert result.nfev <= 20 + 25 * 15
    assert result.fun == min(generations)
    assert result.x == pytest.approx([0.3] * 3, abs=0.1)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (partial(genetic.minimise, elite=20), "elite"),
        (partial(genetic.minimise, crossover=1.2), "crossover"),
        (partial(genetic.minimise, population=1), "population"),
        (partial(pattern_search.minimise, mesh=0.0), "mesh"),
        (partial(pattern_search.minimise, start=[0.5], samples=3), "start, samples"),
        (partial(pattern_search.minimise, start=[1.5]), "start"),
        (partial(pattern_search.minimise, samples=-1), "samples"),
        (partial(nelder_mead.minimise, size=0.0), "size"),
        (partial(nelder_mead.minimise, max_evaluations=0), "max_evaluations"),
        (partial(clusters.minimise, clusters=0), "clusters"),
        (partial(clusters.minimise, clusters=2, share=0.0), "share"),
        (partial(multistart.minimise, periodic=(4,)), "periodic"),
        (partial(multistart.minimise, refinement=Refinement(starts=0)), "starts"),
    ],
)
def test_impossible_arguments_are_named(call: Minimise, word: str) -> None:
    with pytest.raises(OptimiserError, match=word):
        call(lambda x: float(x[0]), [(0.0, 1.0)])
