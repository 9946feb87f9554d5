"""HCPA alone: what it costs to hold very many points, for a function that costs next to nothing."""

from collections.abc import Iterator
from time import process_time

import numpy as np
from scipy.optimize import OptimizeResult

from core.optimisers import hcpa
from core.optimisers.objective import Array

DIMENSIONS = 8
AIM_SECONDS = 5.0
"""For 100,000 points."""


def measure() -> Iterator[str]:
    for points in (10_000, 30_000, 100_000):
        taken = min(_seconds(points) for _ in range(3))
        aim = f" (limit {AIM_SECONDS:g} s)" if points == 100_000 else ""
        yield (
            f"{points:7d} points in {DIMENSIONS} dimensions: {taken:5.2f} s of CPU{aim}, "
            f"{taken / points * 1e6:4.1f} µs a point"
        )


def _seconds(points: int) -> float:
    begun = process_time()
    _search(points)
    return process_time() - begun


def _search(points: int) -> OptimizeResult:
    return hcpa.minimise(
        _valley, [(-1, 1)] * DIMENSIONS, adaptiveness=0.3, fineness=40, exclusion=0.0, max_global=points,
        max_local=0, batch=True,
    )  # fmt: skip


def _valley(points: Array) -> Array:
    return np.asarray(((points - 0.123) ** 2).sum(axis=1) + 0.3 * np.sin(9 * points).sum(axis=1))
