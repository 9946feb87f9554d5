"""Best of several repetitions: the figure least disturbed by whatever else the machine does."""

from collections.abc import Callable
from time import perf_counter, process_time


def best_of(repetitions: int, work: Callable[[], object], clock: Callable[[], float] = perf_counter) -> float:
    """Shortest time of `work` by a clock [s], the wall's or another; it runs once beforehand, uncounted."""
    work()
    best = float("inf")
    for _ in range(repetitions):
        begun = clock()
        work()
        best = min(best, clock() - begun)
    return best


def processor_time_of(repetitions: int, work: Callable[[], object]) -> float:
    """Shortest processor time of `work`, of all threads of this process together [s]."""
    return best_of(repetitions, work, process_time)
