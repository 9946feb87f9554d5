"""Best of several repetitions: the figure least disturbed by whatever else the machine does."""

from collections.abc import Callable
from time import perf_counter


def best_of(repetitions: int, work: Callable[[], object]) -> float:
    """Shortest wall time of `work` [s]; it runs once beforehand, uncounted."""
    work()
    best = float("inf")
    for _ in range(repetitions):
        begun = perf_counter()
        work()
        best = min(best, perf_counter() - begun)
    return best
