"""The optimisers on test functions in randomly shifted boxes."""

import json
import subprocess
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.optimisers.peers import BUDGET, METHODS, Task, first_success, run
from benchmarks.optimisers.test_functions import FUNCTIONS, TestFunction, by_name
from benchmarks.reporting import spread, table

Array = NDArray[np.float64]
Lines = tuple[str, ...]
WORKER = Path(__file__).parent / "sgpp_worker.py"

MOST_FOR_SHGO = 6
"""Dimensions; it triangulates its points, which in ten takes longer than all other methods together."""
PROCESSES = 2
LEAST_SHARE_KEPT = 0.7
"""Of the way from the minimum to each face of the box, when that is drawn closer at random."""
TOLERANCES = (1e-2, 1e-4)
SGPP = "SG++ Ritter-Novak"
COLUMNS = 6
"""Functions in a table: more would not fit the page."""


def shifted_box(function: TestFunction, seed: int) -> tuple[Array, Array]:
    """The function's box with every face drawn towards one of its minima by up to 30 %, at random.

    A minimum on a dyadic point of the original box flatters a method that begins there: Goldstein-Price is
    found by HCPA's second step, Rastrigin by its first.
    """
    random = np.random.default_rng((seed, 4))
    lower, upper = np.array(function.bounds).T
    minimum = function.minimisers[random.integers(len(function.minimisers))]
    kept = random.uniform(LEAST_SHARE_KEPT, 1.0, (2, lower.size))
    return minimum - kept[0] * (minimum - lower), minimum + kept[1] * (upper - minimum)


def allowance(function: TestFunction, tolerance: float) -> float:
    """The value that counts as found: relative to the minimum, absolute where that is (nearly) 0."""
    size = abs(function.minimum)
    return function.minimum + tolerance * (size if size > 0.1 else 1.0)


def functions(shifts: int, sgpp: str | None) -> Iterator[Lines]:
    """The section's lines so far, after each function.

    sgpp: an interpreter with pysgpp, or None.
    """
    remarks = [
        f"{shifts} random shifts of every box; methods that draw random points have another seed in each.",
        f"Error below {TOLERANCES[0]:.0%} / {TOLERANCES[1]:.2%} of the minimum (of 1 where that is 0).",
        f"SHGO triangulates its points: beyond {MOST_FOR_SHGO} dimensions it is not run.",
        "SG++ was left out: no interpreter with pysgpp was named (--sgpp)."
        if sgpp is None
        else "SG++: modified B-splines (no grid points on the faces of the box), gamma 0.85.",
        "",
    ]
    cells: dict[str, list[str]] = {name: [] for name in METHODS}
    if sgpp is not None:
        cells[SGPP] = []
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        for done, function in enumerate(FUNCTIONS, start=1):
            tasks = [(function.name, name, shifts) for name in METHODS]
            for name, cell in zip(METHODS, spread(_function_cell, tasks, function.name, pool), strict=True):
                cells[name].append(cell)
            if sgpp is not None:
                cells[SGPP].append(_sgpp_cell(function, shifts, sgpp))
            missing = [one.name for one in FUNCTIONS[done:]]
            left = [f"Not measured yet: {', '.join(missing)}.", ""] if missing else []
            yield (*remarks, *left, *_tables(cells, done))


def _tables(cells: dict[str, list[str]], measured: int) -> Iterator[str]:
    for first in range(0, measured, COLUMNS):
        part = slice(first, min(first + COLUMNS, measured))
        names = [function.name for function in FUNCTIONS[part]]
        yield from table(["method", *names], [[name, *row[part]] for name, row in cells.items()])
        yield ""


def _function_cell(task: tuple[str, str, int]) -> str:
    """A table's cell: function, method, shifts."""
    function, method, shifts = by_name(task[0]), task[1], task[2]
    if method == "scipy SHGO" and len(function.bounds) > MOST_FOR_SHGO:
        return "not run"
    runs = []
    for seed in range(shifts):
        low, high = shifted_box(function, seed)
        one = _function_task(function, low, high)
        runs.append(run(METHODS[method], one, budget=BUDGET, seed=seed)[1])
    return _cell(function, runs)


def _function_task(function: TestFunction, low: Array, high: Array) -> Task:
    least = allowance(function, TOLERANCES[-1])
    return Task(
        cost=lambda unit: function.fun(low + unit * (high - low)),
        dimensions=low.size,
        is_enough=lambda _, costs: bool(costs.min() <= least),
    )


def _cell(function: TestFunction, runs: list[Array]) -> str:
    parts = []
    for tolerance in TOLERANCES:
        least = allowance(function, tolerance)
        parts.append(_summary([first_success(costs, costs <= least) for costs in runs]))
    return " / ".join(parts)


def _summary(evaluations: list[float]) -> str:
    """Median and number of successes of the evaluations to success, infinite where there was none."""
    median = float(np.median(evaluations))
    successes = int(np.isfinite(evaluations).sum())
    return f"{median:.0f} ({successes})" if np.isfinite(median) else f"- ({successes})"


def _sgpp_cell(function: TestFunction, shifts: int, python: str) -> str:
    """SG++'s cell, from a process of the interpreter that has it."""
    tasks = []
    for seed in range(shifts):
        low, high = shifted_box(function, seed)
        tasks.append(
            {"function": function.name, "lower": low.tolist(), "upper": high.tolist(), "budget": BUDGET}
        )
    done = subprocess.run(
        [python, str(WORKER)], input=json.dumps(tasks), capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        return f"failed: {done.stderr.strip().splitlines()[-1]}"
    return _cell(function, [np.array(one["costs"]) for one in json.loads(done.stdout)])
