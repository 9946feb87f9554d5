"""The Ritter-Novak grid generator of SG++ on the test functions, in an environment of its own.

SG++ (PyPI: pysgpp) needs numpy below 2. `python benchmarks/optimisers/sgpp_worker.py` reads tasks as JSON
from stdin, [{"function": name, "lower": [..], "upper": [..], "budget": n}], and writes
[{"points": .., "costs": ..}].
"""

import json
import sys
from pathlib import Path

import numpy as np
import pysgpp

sys.path.insert(0, str(Path(__file__).parents[2]))

from benchmarks.optimisers.test_functions import by_name

ADAPTIVENESS = 0.85
"""SG++'s own default, gamma: 0 global, 1 greedy."""


def generate(function: str, lower: list[float], upper: list[float], budget: int) -> dict[str, object]:
    """Points of the unit box and costs in the order of evaluation."""
    fun, low, high = by_name(function).fun, np.array(lower), np.array(upper)
    points: list[list[float]] = []
    costs: list[float] = []

    class Objective(pysgpp.ScalarFunction):  # type: ignore[misc]  # pysgpp has no types
        def __init__(self) -> None:
            super().__init__(len(lower))

        def eval(self, x: object) -> float:
            unit = [float(x[k]) for k in range(len(lower))]  # type: ignore[index]  # a vector of pysgpp
            cost = float(fun((low + np.array(unit) * (high - low))[np.newaxis])[0])
            points.append(unit)
            costs.append(cost)
            return cost

    # The generator does not keep its objective alive.
    objective = Objective()
    grid = pysgpp.Grid.createModBsplineGrid(len(lower), 3)
    pysgpp.OptIterativeGridGeneratorRitterNovak(objective, grid, budget, ADAPTIVENESS).generate()
    return {"points": points, "costs": costs}


if __name__ == "__main__":
    pysgpp.omp_set_num_threads(1)
    pysgpp.Printer.getInstance().setVerbosity(-1)
    json.dump([generate(**task) for task in json.load(sys.stdin)], sys.stdout)
